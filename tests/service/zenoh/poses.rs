//! Poses as puts. Oracle: what is told on `poses/made` is in the revision that is named, and what is not is told on
//! `poses/refused`.

use clearance::geometry::{Pose, Quaternion, Vec3};
use clearance::limits::Limits;
use clearance::transports::wire::v1;
use clearance::transports::zenoh::Of;
use prost::Message;
use zenoh::handlers::FifoChannelHandler;
use zenoh::pubsub::Subscriber;
use zenoh::sample::Sample;

use super::{get_scene, with_balls};
use crate::support::door::Door;
use crate::support::messages::*;
use crate::support::watchdog::watched;
use crate::support::zenoh_door::Zenoh;

async fn listening(door: &Zenoh, key: String) -> Subscriber<FifoChannelHandler<Sample>> {
    door.client.session().declare_subscriber(key).await.unwrap()
}

async fn told<M: Message + Default>(subscriber: &Subscriber<FifoChannelHandler<Sample>>) -> M {
    let sample = watched("a message", subscriber.recv_async()).await.unwrap();
    M::decode(&*sample.payload().to_bytes()).unwrap()
}

async fn places(door: &Zenoh) -> Vec<f64> {
    let bodies = door.get_scene(get_scene()).await.unwrap().bodies;
    bodies.into_iter().map(|body| body.pose.unwrap().translation.unwrap().x).collect()
}

fn to(name: &str, x: f64) -> v1::BodyPose {
    v1::BodyPose { body: Some(named(name)), pose: Some(at(x, 0.0, 0.0)) }
}

fn many(bodies: Vec<v1::BodyPose>) -> v1::PoseStreamRequest {
    v1::PoseStreamRequest { bodies, ..v1::PoseStreamRequest::default() }
}

#[tokio::test(flavor = "multi_thread")]
async fn puts_move_bodies_by_name_by_id_and_together() {
    let door = with_balls(Limits::default(), 3).await;
    let made = listening(&door, door.client.keys().poses_made(SCENE)).await;
    let pose = |x: f64| Pose::new(Vec3::new(x, 0.0, 0.0), Quaternion::IDENTITY).unwrap();
    // A name with characters that keys give meanings to.
    door.apply(apply(vec![add("a*b$c#d?e%f é", sphere(0.1), at(9.0, 0.0, 0.0))])).await.unwrap();
    let mut messages = 0;
    for (of, x) in [(Of::Body("ball 0".into()), 10.0), (Of::Id(2), 20.0), (Of::Body("a*b$c#d?e%f é".into()), 90.0)] {
        door.client.put_pose(SCENE, &of, &pose(x)).await.unwrap();
        let answer: v1::PoseStreamResponse = told(&made).await;
        messages += 1;
        assert_eq!((answer.messages, answer.poses, answer.refused.len()), (messages, 1, 0), "{of:?}");
    }
    door.client.put_poses(SCENE, &many(vec![to("ball 0", 11.0), to("ball 2", 30.0)])).await.unwrap();
    let answer: v1::PoseStreamResponse = told(&made).await;
    assert_eq!((answer.poses, answer.revision), (2, 6));
    assert_eq!(places(&door).await, [11.0, 20.0, 30.0, 90.0]);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_robot_is_moved_by_its_name() {
    let door = with_balls(Limits::default(), 0).await;
    let model = door.load_robot(load(ROBOT)).await.unwrap().id;
    door.apply(apply(vec![add_robot("arm", &model)])).await.unwrap();
    let made = listening(&door, door.client.keys().poses_made(SCENE)).await;
    let base = Pose::new(Vec3::new(0.0, 0.0, 2.0), Quaternion::IDENTITY).unwrap();
    door.client.put_pose(SCENE, &Of::Robot("arm".to_owned()), &base).await.unwrap();
    assert_eq!(told::<v1::PoseStreamResponse>(&made).await.poses, 1);
    let robots = door.get_scene(get_scene()).await.unwrap().robots;
    assert_eq!(robots[0].base.unwrap().translation.unwrap().z, 2.0);
}

#[tokio::test(flavor = "multi_thread")]
async fn the_last_of_many_poses_wins_and_none_goes_uncounted() {
    let door = with_balls(Limits { snapshots_kept: 4, ..Limits::default() }, 2).await;
    let made = listening(&door, door.client.keys().poses_made(SCENE)).await;
    const PUTS: u64 = 2_000;
    for i in 1..=PUTS {
        door.client.put_poses(SCENE, &many(vec![to("ball 0", i as f64), to("ball 1", -(i as f64))])).await.unwrap();
    }
    let (mut poses, mut overtaken, mut acknowledged) = (0, 0, 0);
    while acknowledged < PUTS {
        let answer: v1::PoseStreamResponse = told(&made).await;
        assert!(answer.refused.is_empty() && answer.messages > acknowledged, "{answer:?}");
        (poses, overtaken, acknowledged) = (poses + answer.poses, overtaken + answer.overtaken, answer.messages);
    }
    assert_eq!(poses + overtaken, 2 * PUTS);
    assert!(overtaken > 0, "every put was a revision");
    assert_eq!(places(&door).await, [PUTS as f64, -(PUTS as f64)]);
}

#[tokio::test(flavor = "multi_thread")]
async fn what_cannot_be_is_told_by_field_and_the_rest_is_made() {
    let door = with_balls(Limits { max_edits: 50, ..Limits::default() }, 1).await;
    let keys = door.client.keys().clone();
    let made = listening(&door, keys.poses_made(SCENE)).await;
    let refused = listening(&door, keys.poses_refused(SCENE)).await;
    let (nan, nobody) = (to("ball 0", f64::NAN), to("nobody", 1.0));
    door.client.put_poses(SCENE, &many(vec![to("ball 0", 5.0), nan, nobody])).await.unwrap();
    let answer: v1::PoseStreamResponse = told(&made).await;
    let fields: Vec<_> = answer.refused.iter().map(|refused| refused.field.as_str()).collect();
    assert_eq!((answer.poses, fields), (1, vec!["bodies[1].pose.translation", "bodies[2].body"]));
    // Whole messages that cannot be.
    let put = async |message: Vec<u8>| door.client.session().put(keys.poses(SCENE), message).await.unwrap();
    put(b"\xff\xff".to_vec()).await;
    let error: v1::QueryError = told(&refused).await;
    assert_eq!((error.reason(), error.details["clearance-field"].as_str()), (v1::ErrorReason::InvalidField, "message"));
    for (message, field) in [
        (v1::PoseStreamRequest { scene: SCENE.to_owned(), ..many(Vec::new()) }, "scene"),
        (v1::PoseStreamRequest { epoch: Some(1), ..many(Vec::new()) }, "epoch"),
        (v1::PoseStreamRequest { interval: 1.0, ..many(Vec::new()) }, "interval"),
    ] {
        put(message.encode_to_vec()).await;
        let error: v1::QueryError = told(&refused).await;
        assert_eq!(error.details["clearance-field"], field);
    }
    // Too much ends what waits; the next put begins anew.
    put(many((0..51).map(|i| to(&format!("nobody {i}"), 0.0)).collect()).encode_to_vec()).await;
    assert_eq!(told::<v1::QueryError>(&refused).await.details["clearance-limit"], "max_edits");
    put(many(vec![to("ball 0", 7.0)]).encode_to_vec()).await;
    assert_eq!(told::<v1::PoseStreamResponse>(&made).await.poses, 1);
    assert_eq!(places(&door).await, [7.0]);
    // A scene that is not there, and what is no key of a pose.
    let elsewhere = listening(&door, keys.poses_refused("elsewhere")).await;
    door.client.put_poses("elsewhere", &many(Vec::new())).await.unwrap();
    assert_eq!(told::<v1::QueryError>(&elsewhere).await.reason(), v1::ErrorReason::NotFound);
    door.client.session().put(format!("{}/v1/scene/{SCENE}/pose/leg/x", keys.prefix()), b"").await.unwrap();
    assert_eq!(places(&door).await, [7.0]);
}
