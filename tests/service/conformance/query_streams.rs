//! Questions on one stream. Oracle: each is answered as a call of its own is.

use std::collections::BTreeMap;

use clearance::limits::Limits;
use clearance::transports::wire::v1;
use clearance::transports::wire::v1::query_stream_request::Question;
use clearance::transports::wire::v1::query_stream_response::Outcome;
use tonic::Code;

use super::through_doors_with_streams;
use crate::support::door::{Messages, Streams};
use crate::support::messages::*;

through_doors_with_streams!(
    questions_of_every_kind_are_answered_as_calls_are,
    answers_come_in_order_where_asked,
    a_question_that_is_refused_does_not_end_the_stream,
    options_that_cannot_be_end_the_stream,
);

fn limits() -> Limits {
    Limits { max_stream_in_flight: 8, max_items: 100, max_estimate_seconds: 60, ..Limits::default() }
}

async fn scene(door: &impl Streams) {
    door.create_scene(SCENE).await.unwrap();
    let model = door.load_robot(load(ROBOT)).await.unwrap().id;
    let ball = |i: i32| add(&format!("{i}"), sphere(0.3), at(0.5 * f64::from(i), 0.4, 0.0));
    let edits = (0..20).map(ball).chain([add_robot("arm", &model)]);
    door.apply(apply(edits.collect())).await.unwrap();
}

fn asked(id: u64, question: Question) -> v1::QueryStreamRequest {
    v1::QueryStreamRequest { id, question: Some(question) }
}

fn options(in_order: bool, max_in_flight: u32) -> v1::QueryStreamRequest {
    asked(0, Question::Options(v1::QueryStreamOptions { in_order, max_in_flight }))
}

/// Every answer, in the order they came.
async fn ask(door: &impl Streams, questions: Vec<v1::QueryStreamRequest>) -> Vec<v1::QueryStreamResponse> {
    let (sender, mut told) = door.query_stream().await.unwrap();
    let send = async move {
        for question in questions {
            sender.send(question).await.unwrap();
        }
    };
    let receive = async {
        let mut answers = Vec::new();
        while let Some(answer) = told.message().await.unwrap() {
            answers.push(answer);
        }
        answers
    };
    tokio::join!(send, receive).1
}

fn packed(values: Vec<f64>) -> Option<v1::Doubles> {
    Some(v1::Doubles { form: Some(v1::doubles::Form::Packed(v1::PackedDoubles { values })) })
}

async fn questions_of_every_kind_are_answered_as_calls_are(door: &impl Streams) {
    scene(door).await;
    let context = Some(context());
    let robot = "arm".to_owned();
    let q = || packed(vec![0.0, -0.5, 1.0, -0.5]);
    let states = states(vec![0.0, -0.5, 1.0, -0.2]);
    let collide = collide(vec![all_pairs(), body(named("3"))]);
    let distance = distance(vec![placed(sphere(0.1), at(0.0, 3.0, 0.0))]);
    let rays = v1::CastRaysRequest {
        context: context.clone(),
        origins: packed(vec![-5.0, 0.4, 0.0]),
        directions: packed(vec![1.0, 0.0, 0.0]),
        lengths: packed(vec![20.0]),
        ..v1::CastRaysRequest::default()
    };
    let shapes = v1::CastShapesRequest { context: context.clone(), ..v1::CastShapesRequest::default() };
    let moving = v1::CheckMovingPairsRequest { context: context.clone(), ..v1::CheckMovingPairsRequest::default() };
    let overlap = v1::OverlapRequest { context: context.clone(), ..v1::OverlapRequest::default() };
    let nearest =
        v1::NearestBodiesRequest { context: context.clone(), count: 1, ..v1::NearestBodiesRequest::default() };
    let motions = v1::CheckMotionsRequest {
        context: context.clone(),
        robot: robot.clone(),
        positions: q(),
        ..Default::default()
    };
    let path = v1::CheckPathRequest { context: context.clone(), robot, waypoints: q(), ..Default::default() };
    let near = v1::clearance_request::Subjects::Items(v1::ClearanceSubjects { items: vec![body(named("2"))] });
    let clearance = v1::ClearanceRequest { context, within: 0.5, subjects: Some(near), ..Default::default() };
    let of_states = states.clone();
    let questions = vec![
        asked(11, Question::CheckStates(states.clone())),
        asked(12, Question::Collide(collide.clone())),
        asked(13, Question::Distance(distance.clone())),
        asked(14, Question::CastRays(rays.clone())),
        asked(15, Question::CastShapes(shapes.clone())),
        asked(16, Question::CheckMovingPairs(moving.clone())),
        asked(17, Question::Overlap(overlap.clone())),
        asked(18, Question::NearestBodies(nearest.clone())),
        asked(19, Question::CheckMotions(motions.clone())),
        asked(20, Question::CheckPath(path.clone())),
        asked(21, Question::Clearance(clearance.clone())),
    ];
    let answers: BTreeMap<u64, Outcome> =
        ask(door, questions).await.into_iter().map(|answer| (answer.id, answer.outcome.unwrap())).collect();
    let answer = Some;
    let called = [
        Outcome::CheckStates(v1::CheckStatesResponse { answer: answer(door.check_states(states).await.unwrap()) }),
        Outcome::Collide(v1::CollideResponse { answer: answer(door.collide(collide).await.unwrap()) }),
        Outcome::Distance(v1::DistanceResponse { answer: answer(door.distance(distance).await.unwrap()) }),
        Outcome::CastRays(door.cast_rays(rays).await.unwrap()),
        Outcome::CastShapes(door.cast_shapes(shapes).await.unwrap()),
        Outcome::CheckMovingPairs(door.check_moving_pairs(moving).await.unwrap()),
        Outcome::Overlap(door.overlap(overlap).await.unwrap()),
        Outcome::NearestBodies(door.nearest_bodies(nearest).await.unwrap()),
        Outcome::CheckMotions(door.check_motions(motions).await.unwrap()),
        Outcome::CheckPath(door.check_path(path).await.unwrap()),
        Outcome::Clearance(v1::ClearanceResponse { answer: answer(door.clearance(clearance).await.unwrap()) }),
    ];
    assert_eq!(answers, (11..).zip(called).collect());
    // An estimate is a question, too, but measures anew each time.
    let question = v1::estimate_request::Question::CheckStates(of_states);
    let outputs = vec![v1::Output::Verdict.into()];
    let estimate = v1::EstimateRequest { question: Some(question), outputs, sample: Some(1), ..Default::default() };
    let estimated = ask(door, vec![asked(22, Question::Estimate(estimate))]).await.remove(0);
    let Some(Outcome::Estimate(estimated)) = estimated.outcome else { panic!("{estimated:?}") };
    assert_eq!((estimated.end(), estimated.sample), (v1::EstimateEnd::Complete, 1));
}

async fn answers_come_in_order_where_asked(door: &impl Streams) {
    scene(door).await;
    // Long and short ones in turn.
    let question = |id: u64| {
        let items = if id.is_multiple_of(2) { vec![all_pairs(); 60] } else { vec![body(named("1"))] };
        asked(id, Question::Collide(collide(items)))
    };
    for (in_order, most) in [(true, 0), (true, 1), (false, 0), (false, 3)] {
        let questions = std::iter::once(options(in_order, most)).chain((0..60).map(question));
        let mut ids: Vec<u64> = ask(door, questions.collect()).await.iter().map(|answer| answer.id).collect();
        if !in_order {
            ids.sort_unstable();
        }
        assert_eq!(ids, (0..60).collect::<Vec<_>>(), "{in_order}, {most}");
    }
}

async fn a_question_that_is_refused_does_not_end_the_stream(door: &impl Streams) {
    scene(door).await;
    let mut elsewhere = collide(vec![all_pairs()]);
    elsewhere.context.as_mut().unwrap().scene = "elsewhere".to_owned();
    let questions = vec![
        options(true, 0),
        asked(1, Question::Collide(elsewhere)),
        asked(2, Question::Collide(collide(vec![all_pairs(); 101]))),
        v1::QueryStreamRequest { id: 3, question: None },
        asked(4, Question::Collide(collide(vec![v1::Subject { kind: None }]))),
        asked(5, Question::Collide(collide(vec![body(named("1"))]))),
    ];
    let answers = ask(door, questions).await;
    let refused = |answer: &v1::QueryStreamResponse| {
        let Some(Outcome::Error(error)) = &answer.outcome else { panic!("{answer:?}") };
        (error.code, error.reason(), error.details.get("clearance-field").cloned())
    };
    assert_eq!(answers.iter().map(|answer| answer.id).collect::<Vec<_>>(), [1, 2, 3, 4, 5]);
    assert_eq!(refused(&answers[0]), (i32::from(Code::NotFound), v1::ErrorReason::NotFound, None));
    assert_eq!(refused(&answers[1]), (i32::from(Code::ResourceExhausted), v1::ErrorReason::LimitExceeded, None));
    let invalid =
        |field: &str| (i32::from(Code::InvalidArgument), v1::ErrorReason::InvalidField, Some(field.to_owned()));
    assert_eq!(refused(&answers[2]), invalid("question"));
    assert_eq!(refused(&answers[3]), invalid("items[0]"));
    let Some(Outcome::Error(error)) = &answers[1].outcome else { panic!("{answers:?}") };
    assert_eq!(error.message, "max_items exceeded: asked for 101, allowed is 100");
    assert_eq!(error.details["clearance-limit"], "max_items");
    assert!(matches!(answers[4].outcome, Some(Outcome::Collide(_))));
}

async fn options_that_cannot_be_end_the_stream(door: &impl Streams) {
    scene(door).await;
    let question = || asked(1, Question::Collide(collide(vec![body(named("1"))])));
    for (messages, code) in
        [(vec![options(true, 9)], Code::ResourceExhausted), (vec![question(), options(true, 1)], Code::InvalidArgument)]
    {
        let (sender, mut told) = door.query_stream().await.unwrap();
        for message in messages {
            sender.send(message).await.unwrap();
        }
        let refusal = loop {
            if let Err(refusal) = told.message().await {
                break refusal;
            }
        };
        assert_eq!(refusal.code, code, "{refusal:?}");
    }
}
