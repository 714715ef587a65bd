//! Poses that are streamed. Oracle: every pose that is acknowledged is in the revision that is named, or a later one of the
//! same body is, or it was refused by name.

use std::collections::BTreeMap;
use std::time::Duration;

use clearance::limits::Limits;
use clearance::transports::wire::v1;
use tonic::Code;

use super::through_doors_with_streams;
use crate::support::door::{Messages, Refusal, Streams};
use crate::support::messages::*;

through_doors_with_streams!(
    every_acknowledged_pose_is_in_the_revision_or_was_overtaken,
    a_bad_pose_is_refused_by_its_place_and_the_others_are_made,
    edits_of_others_come_in_between,
    a_caller_that_goes_away_leaves_no_half_message,
    an_interval_gathers_poses,
    streams_that_cannot_be_are_refused,
    waiting_poses_are_bounded,
);

fn limits() -> Limits {
    Limits { snapshots_kept: 10_000, max_streams: 2, max_edits: 50, ..Limits::default() }
}

fn first() -> v1::PoseStreamRequest {
    v1::PoseStreamRequest { scene: SCENE.to_owned(), ..v1::PoseStreamRequest::default() }
}

fn message(bodies: Vec<v1::BodyPose>) -> v1::PoseStreamRequest {
    v1::PoseStreamRequest { bodies, ..v1::PoseStreamRequest::default() }
}

fn to(body: v1::BodyRef, x: f64) -> v1::BodyPose {
    v1::BodyPose { body: Some(body), pose: Some(at(x, 0.0, 0.0)) }
}

async fn balls(door: &impl Streams, count: usize) {
    door.create_scene(SCENE).await.unwrap();
    let ball = |i: usize| add(&format!("{i}"), sphere(0.1), at(0.0, 0.0, 0.0));
    door.apply(apply((0..count).map(ball).collect())).await.unwrap();
}

/// Where bodies are along x, by id.
async fn places(door: &impl Streams, revision: u64) -> BTreeMap<u64, f64> {
    let rule = v1::revision_rule::Rule::Exactly(revision);
    let revision = Some(v1::RevisionRule { epoch: None, rule: Some(rule) });
    let request = v1::GetSceneRequest { scene: SCENE.to_owned(), revision, ..Default::default() };
    let place = |body: v1::Body| (body.id, body.pose.unwrap().translation.unwrap().x);
    door.get_scene(request).await.unwrap().bodies.into_iter().map(place).collect()
}

async fn every_acknowledged_pose_is_in_the_revision_or_was_overtaken(door: &impl Streams) {
    balls(door, 8).await;
    let (sender, mut told) = door.pose_stream().await.unwrap();
    const MESSAGES: u64 = 600;
    // Body i of message m goes to x = m, by id or by name, every body in some of the messages.
    let part_of = |m: u64, i: u64| (m * 7 + i * 3) % 5 < 2;
    let send = async move {
        sender.send(first()).await.unwrap();
        for m in 1..MESSAGES {
            let bodies = (1..=8).filter(|i| part_of(m, *i));
            let named_or_numbered =
                |i: u64| if (m + i).is_multiple_of(2) { numbered(i) } else { named(&format!("{}", i - 1)) };
            let poses = bodies.map(|i| to(named_or_numbered(i), m as f64)).collect();
            sender.send(message(poses)).await.unwrap();
            if m % 100 == 0 {
                tokio::time::sleep(Duration::from_millis(5)).await;
            }
        }
    };
    let receive = async {
        let mut acknowledged = Vec::new();
        while let Some(message) = told.message().await.unwrap() {
            acknowledged.push(message);
        }
        acknowledged
    };
    let ((), acknowledged) = tokio::join!(send, receive);
    let [mut made, mut overtaken, mut last] = [0; 3];
    for acknowledgement in &acknowledged {
        assert!(acknowledgement.messages > last, "{acknowledgement:?}");
        last = acknowledgement.messages;
        assert_eq!(acknowledgement.refused, []);
        let places = places(door, acknowledgement.revision).await;
        for (id, x) in places {
            let newest = (1..last).rev().find(|m| part_of(*m, id));
            assert_eq!(x, newest.unwrap_or(0) as f64, "body {id} in {acknowledgement:?}");
        }
        made += acknowledgement.poses;
        overtaken += acknowledgement.overtaken;
    }
    assert_eq!(last, MESSAGES);
    // One body by name and by id in one list is made twice, the later pose last: nothing is counted twice.
    let sent: u64 = (1..MESSAGES).map(|m| (1..=8).filter(|i| part_of(m, *i)).count() as u64).sum();
    assert_eq!(made + overtaken, sent);
    assert!(overtaken > 0 && acknowledged.len() > 5, "{overtaken}, {}", acknowledged.len());
}

async fn a_bad_pose_is_refused_by_its_place_and_the_others_are_made(door: &impl Streams) {
    balls(door, 2).await;
    let model = door.load_robot(load(ROBOT)).await.unwrap().id;
    door.apply(apply(vec![add_robot("arm", &model)])).await.unwrap();
    let (sender, mut told) = door.pose_stream().await.unwrap();
    let zero = v1::Pose { translation: None, rotation: Some(v1::Quaternion::default()) };
    let bodies = vec![
        to(named("0"), 1.0),
        to(named("0"), f64::NAN),
        to(named("nobody"), 1.0),
        to(numbered(77), 1.0),
        v1::BodyPose { body: None, pose: Some(at(0.0, 0.0, 0.0)) },
        v1::BodyPose { body: Some(named("1")), pose: None },
        v1::BodyPose { body: Some(named("1")), pose: Some(zero) },
        to(numbered(2), 3.0),
    ];
    let robot = |name: &str, x| v1::RobotPose { robot: name.to_owned(), base: Some(at(x, 0.0, 0.0)) };
    let robots = vec![robot("leg", 1.0), robot("arm", f64::INFINITY), robot("arm", 2.0)];
    sender.send(v1::PoseStreamRequest { bodies, robots, ..first() }).await.unwrap();
    let answer = told.message().await.unwrap().unwrap();
    assert_eq!((answer.revision, answer.messages, answer.poses, answer.overtaken), (3, 1, 3, 0));
    let mut refused: Vec<_> = answer.refused.iter().map(|refused| (refused.message, refused.field.as_str())).collect();
    refused.sort();
    let fields = [
        "bodies[1].pose.translation",
        "bodies[2].body",
        "bodies[3].body",
        "bodies[4].body",
        "bodies[5].pose",
        "bodies[6].pose.rotation",
        "robots[0].robot",
        "robots[1].base.translation",
    ];
    assert_eq!(refused, fields.map(|field| (0, field)));
    let problem = |field| answer.refused.iter().find(|refused| refused.field == field).unwrap().problem.as_str();
    assert_eq!(problem("bodies[2].body"), "no body is named \"nobody\"");
    assert_eq!(places(door, 3).await, BTreeMap::from([(1, 1.0), (2, 3.0)]));
    // Nothing but what is refused: told all the same, of the newest revision.
    sender.send(message(vec![to(named("nobody"), 1.0)])).await.unwrap();
    let answer = told.message().await.unwrap().unwrap();
    assert_eq!((answer.revision, answer.messages, answer.poses, answer.refused.len()), (3, 2, 0, 1));
    drop(sender);
    assert_eq!(told.message().await, Ok(None));
}

async fn edits_of_others_come_in_between(door: &impl Streams) {
    balls(door, 3).await;
    let (sender, mut told) = door.pose_stream().await.unwrap();
    let send = async move {
        sender.send(first()).await.unwrap();
        for m in 1..200 {
            sender.send(message(vec![to(named("0"), f64::from(m)), to(named("1"), f64::from(m))])).await.unwrap();
        }
    };
    let edit = async {
        for i in 0..50 {
            let edits = vec![move_to(named("2"), at(f64::from(i), 0.0, 0.0))];
            door.apply(apply(edits)).await.unwrap();
            if i == 25 {
                door.apply(apply(vec![remove(named("1"))])).await.unwrap();
            }
        }
    };
    let receive = async {
        let mut revisions = Vec::new();
        while let Some(message) = told.message().await.unwrap() {
            // Once the body is gone, every pose of it is refused, and nothing else is.
            assert!(message.refused.iter().all(|refused| refused.field == "bodies[1].body"), "{message:?}");
            revisions.push(message.revision);
        }
        revisions
    };
    let ((), (), revisions) = tokio::join!(send, edit, receive);
    assert!(revisions.is_sorted(), "{revisions:?}");
    let newest = revisions[revisions.len() - 1].max(52);
    let end = places(door, newest).await;
    assert_eq!((end[&1], end.len()), (199.0, 2));
}

async fn a_caller_that_goes_away_leaves_no_half_message(door: &impl Streams) {
    balls(door, 2).await;
    for _ in 0..10 {
        let (sender, mut told) = door.pose_stream().await.unwrap();
        let send = async {
            sender.send(first()).await.unwrap();
            for m in 1..50 {
                // Both bodies go together.
                let poses = vec![to(named("0"), f64::from(m)), to(named("1"), f64::from(m))];
                if sender.send(message(poses)).await.is_err() {
                    break;
                }
            }
        };
        let receive = async {
            told.message().await.unwrap();
            told.message().await.unwrap();
        };
        tokio::select! {
            ((), ()) = async { tokio::join!(send, receive) } => {}
            () = tokio::time::sleep(Duration::from_millis(3)) => {}
        }
        drop((sender, told));
    }
    tokio::time::sleep(Duration::from_millis(100)).await;
    let newest = door.get_scene(v1::GetSceneRequest { scene: SCENE.to_owned(), ..Default::default() }).await.unwrap();
    assert!(newest.revision > 1, "nothing was made at all");
    for revision in 1..=newest.revision {
        let places = places(door, revision).await;
        assert_eq!(places[&1], places[&2], "revision {revision}");
    }
    // Their places are free again.
    let mut tries = 0;
    loop {
        let (sender, mut told) = door.pose_stream().await.unwrap();
        sender.send(v1::PoseStreamRequest { bodies: vec![to(named("0"), 1.0)], ..first() }).await.unwrap();
        match told.message().await {
            Ok(_) => break,
            Err(refusal) => assert!(refusal.code == Code::ResourceExhausted && tries < 200, "{refusal:?}"),
        }
        tries += 1;
        tokio::time::sleep(Duration::from_millis(20)).await;
    }
}

async fn an_interval_gathers_poses(door: &impl Streams) {
    balls(door, 1).await;
    let (sender, mut told) = door.pose_stream().await.unwrap();
    let begin = v1::PoseStreamRequest { interval: 0.3, bodies: vec![to(named("0"), 1.0)], ..first() };
    sender.send(begin).await.unwrap();
    let one = told.message().await.unwrap().unwrap();
    assert_eq!((one.revision, one.messages, one.poses), (2, 1, 1));
    for m in 2..=10 {
        sender.send(message(vec![to(named("0"), f64::from(m))])).await.unwrap();
    }
    let two = told.message().await.unwrap().unwrap();
    assert_eq!((two.revision, two.messages, two.poses, two.overtaken), (3, 10, 1, 8));
    assert_eq!(places(door, 3).await[&1], 10.0);
}

/// What a stream ends with.
async fn ended(door: &impl Streams, messages: Vec<v1::PoseStreamRequest>) -> Refusal {
    let (sender, mut told) = door.pose_stream().await.unwrap();
    let send = async move {
        for message in messages {
            if sender.send(message).await.is_err() {
                break;
            }
        }
        sender
    };
    let receive = async {
        loop {
            if let Err(refusal) = told.message().await {
                return refusal;
            }
        }
    };
    let (_sender, refusal) = tokio::join!(send, receive);
    refusal
}

async fn streams_that_cannot_be_are_refused(door: &impl Streams) {
    balls(door, 1).await;
    let invalid = Code::InvalidArgument;
    let cases = [
        (vec![message(Vec::new())], invalid, "scene"),
        (vec![v1::PoseStreamRequest { interval: f64::NAN, ..first() }], invalid, "interval"),
        (vec![v1::PoseStreamRequest { interval: -1.0, ..first() }], invalid, "interval"),
        (vec![first(), first()], invalid, "scene"),
        (vec![first(), v1::PoseStreamRequest { interval: 1.0, ..message(Vec::new()) }], invalid, "interval"),
        (vec![v1::PoseStreamRequest { scene: "elsewhere".to_owned(), ..first() }], Code::NotFound, ""),
        (vec![v1::PoseStreamRequest { epoch: Some(1), ..first() }], Code::FailedPrecondition, ""),
    ];
    for (messages, code, field) in cases {
        let refusal = ended(door, messages).await;
        assert_eq!((refusal.code, refusal.field.as_str()), (code, field), "{refusal:?}");
    }
    let mut kept = Vec::new();
    for _ in 0..2 {
        let (sender, mut told) = door.pose_stream().await.unwrap();
        sender.send(v1::PoseStreamRequest { bodies: vec![to(named("0"), 1.0)], ..first() }).await.unwrap();
        told.message().await.unwrap();
        kept.push((sender, told));
    }
    let refusal = ended(door, vec![first()]).await;
    assert_eq!(refusal.message, "max_streams exceeded: asked for 3, allowed is 2");
    // A scene that is deleted ends the streams into it.
    door.delete_scene(SCENE).await.unwrap();
    let (sender, told) = &mut kept[0];
    sender.send(message(vec![to(named("0"), 1.0)])).await.unwrap();
    assert_eq!(told.message().await.unwrap_err().code, Code::NotFound);
}

async fn waiting_poses_are_bounded(door: &impl Streams) {
    balls(door, 1).await;
    let many = (0..51).map(|i| to(named(&format!("nobody {i}")), 0.0)).collect();
    let refusal = ended(door, vec![v1::PoseStreamRequest { bodies: many, ..first() }]).await;
    assert_eq!(refusal.message, "max_edits exceeded: asked for 51, allowed is 50");
}
