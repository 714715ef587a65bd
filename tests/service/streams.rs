//! What only a connection can show of streams: work that stops when its caller is gone, and questions that are not read
//! before there is room for them.

use std::time::Duration;

use clearance::limits::Limits;
use clearance::transports::wire::v1;
use clearance::transports::wire::v1::query_stream_request::Question;

use crate::support::door::{Door, Grpc, Messages, Streams, Watches};
use crate::support::messages::*;
use crate::support::watchdog::{eventually, watched};

/// Ellipsoids in one place, whose depths take seconds.
async fn slow_question(door: &impl Door) -> v1::QueryStreamRequest {
    door.create_scene(SCENE).await.unwrap();
    let radii = Some(vec3(1.0, 0.8, 0.6));
    let body = |i: u32| {
        let core = v1::shape::Core::Ellipsoid(v1::Ellipsoid { radii });
        add(&format!("body{i}"), shape(core), at(0.001 * f64::from(i), 0.0, 0.0))
    };
    door.apply(apply((0..600).map(body).collect())).await.unwrap();
    let wants = Some(v1::Wants { witness: true, depth: true, ..v1::Wants::default() });
    let context = Some(v1::Context { wants, ..context() });
    let question = v1::CollideRequest { context, ..collide(vec![all_pairs(); 20]) };
    v1::QueryStreamRequest { id: 1, question: Some(Question::Collide(question)) }
}

#[tokio::test(flavor = "multi_thread")]
async fn work_stops_when_the_caller_of_a_stream_is_gone() {
    let grpc = Grpc::open(Limits::default()).await;
    let question = slow_question(&grpc).await;
    let service = &grpc.daemon.service;
    let (sender, told) = grpc.query_stream().await.unwrap();
    for _ in 0..4 {
        watched("sending", sender.send(question.clone())).await.unwrap();
    }
    eventually("four questions under way", || service.queries_in_flight() == 4).await;
    drop((sender, told));
    eventually("no work for nobody", || service.queries_in_flight() == 0 && service.streams() == 0).await;
}

#[tokio::test(flavor = "multi_thread")]
async fn no_more_questions_are_read_than_may_be_answered_at_a_time() {
    let grpc = Grpc::open(Limits::default()).await;
    let question = slow_question(&grpc).await;
    let service = &grpc.daemon.service;
    let (sender, told) = grpc.query_stream().await.unwrap();
    let options = Question::Options(v1::QueryStreamOptions { in_order: false, max_in_flight: 2 });
    sender.send(v1::QueryStreamRequest { id: 0, question: Some(options) }).await.unwrap();
    for _ in 0..10 {
        watched("sending", sender.send(question.clone())).await.unwrap();
    }
    eventually("two questions under way", || service.queries_in_flight() == 2).await;
    for _ in 0..40 {
        assert!(service.queries_in_flight() <= 2);
        tokio::time::sleep(Duration::from_millis(5)).await;
    }
    drop((sender, told));
    eventually("no work for nobody", || service.queries_in_flight() == 0).await;
}

#[tokio::test(flavor = "multi_thread")]
async fn a_daemon_that_drains_ends_streams_and_watches() {
    let grpc = Grpc::open(Limits::default()).await;
    grpc.create_scene(SCENE).await.unwrap();
    let request = v1::WatchRequest { scene: SCENE.to_owned(), ..v1::WatchRequest::default() };
    let mut watch = grpc.watch_scene(request).await.unwrap();
    watch.message().await.unwrap();
    let (poses, mut made) = grpc.pose_stream().await.unwrap();
    poses.send(v1::PoseStreamRequest { scene: SCENE.to_owned(), ..v1::PoseStreamRequest::default() }).await.unwrap();
    made.message().await.unwrap();
    let (_questions, mut answers) = grpc.query_stream().await.unwrap();
    grpc.daemon.service.begin_drain();
    for refusal in [
        watched("the watch", watch.message()).await.unwrap_err(),
        watched("the poses", made.message()).await.unwrap_err(),
        watched("the questions", answers.message()).await.unwrap_err(),
    ] {
        assert_eq!((refusal.code, refusal.reason.as_str()), (tonic::Code::Unavailable, "SHUTTING_DOWN"));
    }
}
