//! What only a connection can show of a watch: that the socket changes not a byte, a reader that is slow, one that goes away,
//! deadlines, and a daemon that drains.

use std::sync::Arc;
use std::time::Duration;

use clearance::app::Drained;
use clearance::limits::Limits;
use clearance::transports::wire::v1;
use clearance::transports::wire::v1::queries_client::QueriesClient;
use prost::Message;
use tonic::transport::Channel;
use tonic::{Code, Request};

use crate::support::door::{Contacts, Door, Grpc, InProcess, Refusal, Watches};
use crate::support::messages::*;
use crate::support::watchdog::{eventually, watched};

/// Balls in a row, each touching the next.
async fn row(door: &impl Door, count: u32) {
    door.create_scene(SCENE).await.unwrap();
    let ball = |i: u32| add(&format!("{i}"), sphere(0.5), at(0.9 * f64::from(i), 0.0, 0.0));
    door.apply(apply((0..count).map(ball).collect())).await.unwrap();
}

/// Ellipsoids in one place, whose depths take seconds.
async fn crowd(door: &impl Door) -> v1::WatchContactsRequest {
    door.create_scene(SCENE).await.unwrap();
    let radii = Some(vec3(1.0, 0.8, 0.6));
    let body = |i: u32| {
        let core = v1::shape::Core::Ellipsoid(v1::Ellipsoid { radii });
        add(&format!("body{i}"), shape(core), at(0.001 * f64::from(i), 0.0, 0.0))
    };
    door.apply(apply((0..600).map(body).collect())).await.unwrap();
    let wants = Some(v1::Wants { witness: true, depth: true, ..v1::Wants::default() });
    v1::WatchContactsRequest { context: Some(v1::Context { wants, ..context() }), ..watch() }
}

#[tokio::test(flavor = "multi_thread")]
async fn the_socket_changes_not_a_byte() {
    let grpc = Grpc::open(Limits::default()).await;
    let library = InProcess { service: Arc::clone(&grpc.daemon.service) };
    row(&grpc, 50).await;
    let wants = Some(v1::Wants { witness: true, depth: true, ..v1::Wants::default() });
    let request =
        v1::WatchContactsRequest { context: Some(v1::Context { wants, ..context() }), stays: true, threshold: 0 };
    let mut over_socket = grpc.watch_contacts(request.clone()).await.unwrap();
    let mut in_process = library.watch_contacts(request).await.unwrap();
    for i in 0..20 {
        let (one, two) = (over_socket.message().await.unwrap(), in_process.message().await.unwrap());
        assert_eq!(one.revision, 1 + i);
        assert_eq!(one.encode_to_vec(), two.encode_to_vec());
        let moved = (0..5).map(|j| move_to(named(&format!("{}", 7 * j + i)), at(0.4 * (i + j) as f64, 0.1, 0.0)));
        grpc.apply(apply(moved.collect())).await.unwrap();
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_slow_reader_gets_fewer_and_larger_steps() {
    let grpc = Grpc::open(Limits::default()).await;
    row(&grpc, 2000).await;
    // Each step lists two thousand contacts, more than fits into the window of the connection.
    let narrow = Channel::from_shared(format!("http://{}", grpc.daemon.address)).unwrap();
    let narrow = narrow.initial_stream_window_size(65_535).initial_connection_window_size(65_535);
    let mut queries = QueriesClient::new(narrow.connect().await.unwrap());
    let request = v1::WatchContactsRequest { stays: true, ..watch() };
    let mut watch = queries.watch_contacts(request).await.unwrap().into_inner();
    let mut last = 0;
    for i in 0..60 {
        let moved = move_to(named("0"), at(if i % 2 == 0 { -3.0 } else { 0.0 }, 0.0, 0.0));
        last = grpc.apply(apply(vec![moved])).await.unwrap().revision;
    }
    let (mut steps, mut told, mut pairs) = (0, None, 0);
    while told != Some(last) {
        let message = watched("a message", watch.message()).await.unwrap().unwrap();
        assert_eq!(message.from_revision, told, "steps lead on from one another");
        pairs += message.events.iter().filter(|event| event.kind() != v1::ContactEventKind::End).count();
        if !message.more {
            assert_eq!(pairs as u64, message.contacts);
            (told, steps, pairs) = (Some(message.revision), steps + 1, 0);
        }
    }
    assert!(steps <= 10, "{steps} steps for {last} revisions: something kept them for the reader");
    grpc.apply(apply(vec![move_to(named("0"), at(-3.0, 0.0, 0.0))])).await.unwrap();
    assert_eq!(watched("the next", watch.message()).await.unwrap().unwrap().from_revision, Some(last));
}

#[tokio::test(flavor = "multi_thread")]
async fn a_reader_that_goes_away_ends_its_watch_and_the_work_for_it() {
    let grpc = Grpc::open(Limits::default()).await;
    let request = crowd(&grpc).await;
    let service = Arc::clone(&grpc.daemon.service);
    let mut queries = QueriesClient::new(grpc.channel.clone());
    let reading = tokio::spawn(async move { queries.watch_contacts(request).await?.into_inner().message().await });
    eventually("the watch begins", || service.watchers() == 1).await;
    tokio::time::sleep(Duration::from_millis(50)).await;
    assert!(!reading.is_finished(), "the first step takes long");
    reading.abort();
    // A watch counts until its thread is free.
    eventually("the watch has ended", || service.watchers() == 0).await;

    let mut idle = grpc.watch_contacts(v1::WatchContactsRequest { context: Some(nobody()), ..watch() }).await.unwrap();
    idle.message().await.unwrap();
    assert_eq!(service.watchers(), 1);
    drop(idle);
    eventually("a watch that waits has ended", || service.watchers() == 0).await;
}

/// Lets no body of the crowd through.
fn nobody() -> v1::Context {
    let ignore = (1..=600).map(numbered).collect();
    v1::Context { filter: Some(v1::Filter { ignore, ..v1::Filter::default() }), ..context() }
}

#[tokio::test(flavor = "multi_thread")]
async fn the_transports_deadline_ends_a_watch() {
    let grpc = Grpc::open(Limits::default()).await;
    row(&grpc, 2).await;
    let mut request = Request::new(watch());
    request.metadata_mut().insert("grpc-timeout", "300m".parse().unwrap());
    let mut stream = QueriesClient::new(grpc.channel.clone()).watch_contacts(request).await.unwrap().into_inner();
    assert_eq!(stream.message().await.unwrap().unwrap().contacts, 1);
    let refusal = Refusal::from(watched("the end", stream.message()).await.unwrap_err());
    assert_eq!((refusal.code, refusal.reason.as_str()), (Code::DeadlineExceeded, "DEADLINE_EXCEEDED"));
}

#[tokio::test(flavor = "multi_thread")]
async fn a_draining_daemon_ends_its_watches_and_is_clean() {
    let grpc = Grpc::open(Limits::default()).await;
    row(&grpc, 2).await;
    let Grpc { daemon, channel, .. } = grpc;
    let mut stream = QueriesClient::new(channel.clone()).watch_contacts(watch()).await.unwrap().into_inner();
    stream.message().await.unwrap().unwrap();
    let service = Arc::clone(&daemon.service);
    let stopping = tokio::spawn(daemon.stop());
    let refusal = Refusal::from(watched("the end of the watch", stream.message()).await.unwrap_err());
    assert_eq!((refusal.code, refusal.reason.as_str()), (Code::Unavailable, "SHUTTING_DOWN"));
    drop((stream, channel));
    assert_eq!(watched("the end", stopping).await.unwrap(), Drained::Clean);
    let late = InProcess { service }.watch_contacts(watch()).await.err().unwrap();
    assert_eq!(late.reason, "SHUTTING_DOWN");
}
