//! Queries: what a selector says, what is always replied, and work that stops.

use std::time::Duration;

use clearance::limits::Limits;
use clearance::transports::wire::v1;
use clearance::transports::zenoh::{Client, ClientError};
use prost::Message;
use zenoh::query::Reply;

use super::{slow_question, with_balls};
use crate::support::door::Door;
use crate::support::messages::*;
use crate::support::watchdog::{eventually, watched};
use crate::support::zenoh_door::{PREFIX, Zenoh};

const PATIENCE: Duration = Duration::from_secs(30);

/// What a plain query of zenoh is answered with: the error that the one reply has.
async fn refused(door: &Zenoh, selector: &str, payload: &[u8]) -> v1::QueryError {
    let replies = door.client.session().get(selector).payload(payload).timeout(PATIENCE).await.unwrap();
    let reply: Reply = watched("a reply", replies.recv_async()).await.unwrap();
    let error = reply.into_result().unwrap_err();
    v1::QueryError::decode(&*error.payload().to_bytes()).unwrap()
}

#[tokio::test(flavor = "multi_thread")]
async fn every_query_on_a_key_of_calls_has_a_reply_that_names_what_is_wrong() {
    let door = with_balls(Limits { max_message_bytes: 10_000, ..Limits::default() }, 1).await;
    let call = |rpc: &str| format!("{PREFIX}/v1/call/{rpc}");
    let cases = [
        (call("Queries/Guess"), "rpc: \"Queries/Guess\" is none that is answered with one message"),
        (call("Queries/QueryStream"), "rpc: \"Queries/QueryStream\" is none"),
        (call("Queries/**"), "key: names no rpc"),
        (call("**"), "key: names no rpc"),
        (format!("{}?speed=1", call("Queries/Collide")), "parameters: there is no \"speed\""),
        (format!("{}?timeout=soon", call("Queries/Collide")), "parameters.timeout: is no number of seconds"),
        (format!("{}?client=*", call("Queries/Collide")), "parameters.client: is no key"),
        (format!("{}?steps=0", call("Scenes/Watch")), "parameters.steps: is no whole number"),
        (format!("{}?steps=1", call("Scenes/ListScenes")), "parameters.steps: Scenes/ListScenes is answered at once"),
    ];
    for (selector, said) in cases {
        let error = refused(&door, &selector, b"").await;
        assert_eq!((error.code, error.reason()), (3, v1::ErrorReason::InvalidField), "{selector}");
        assert!(error.message.starts_with(said), "{selector}: {}", error.message);
        assert!(error.message.starts_with(&format!("{}: ", error.details["clearance-field"])), "{error:?}");
    }
    let garbage = refused(&door, &call("Queries/Collide"), b"\xff\xff\xff").await;
    assert_eq!(garbage.details["clearance-field"], "message");
    let large = refused(&door, &call("Queries/Collide"), &[0; 10_001]).await;
    assert_eq!((large.code, large.details["clearance-limit"].as_str()), (8, "max_message_bytes"));
    // After all that it answers.
    assert_eq!(door.get_scene(super::get_scene()).await.unwrap().bodies.len(), 1);
}

#[tokio::test(flavor = "multi_thread")]
async fn where_nobody_answers_a_caller_is_told_so_at_once() {
    let door = Zenoh::start(Limits::default()).await;
    let elsewhere = Client::connect(&door.endpoint, "nobody").await.unwrap();
    let error = watched("an answer", elsewhere.call("Server/GetServerInfo", [], PATIENCE)).await.unwrap_err();
    assert!(matches!(&error, ClientError::NoDaemon { prefix } if prefix == "nobody"), "{error}");
    assert_eq!(error.to_string(), "no daemon answers under \"nobody\"");
    assert!(Client::connect("tcp/127.0.0.1:1", PREFIX).await.is_err());
    assert!(matches!(Client::connect(&door.endpoint, "a/*").await, Err(ClientError::Prefix(_))));
}

#[tokio::test(flavor = "multi_thread")]
async fn a_timeout_stops_the_work_and_is_told_by_the_daemon() {
    let door = with_balls(Limits::default(), 0).await;
    let question = slow_question(&door).await;
    let called = door.client.call("Queries/Collide", question, Duration::from_millis(200));
    // What was found by then, or that it was nothing.
    match watched("an outcome", called).await {
        Ok(answer) => {
            let answer = v1::CollideResponse::decode(answer).unwrap().answer.unwrap();
            assert!(answer.items.iter().any(|item| item.verdict() != v1::Verdict::Collision), "all of it was done");
        }
        Err(ClientError::Refused(refusal)) => assert_eq!(refusal.reason, "DEADLINE_EXCEEDED"),
        Err(other) => panic!("{other}"),
    }
    let service = &door.daemon.service;
    eventually("no work for nobody", || service.queries_in_flight() == 0).await;
}

#[tokio::test(flavor = "multi_thread")]
async fn work_stops_when_its_caller_leaves() {
    let door = with_balls(Limits::default(), 0).await;
    let question = slow_question(&door).await;
    let service = &door.daemon.service;
    let caller = Client::connect(&door.endpoint, PREFIX).await.unwrap();
    let asking = tokio::spawn(async move {
        let answered = caller.call("Queries/Collide", question, Duration::from_secs(300));
        drop(tokio::time::timeout(Duration::from_millis(500), answered).await);
        // The caller leaves here.
    });
    eventually("a question under way", || service.queries_in_flight() == 1).await;
    watched("the caller", asking).await.unwrap();
    eventually("no work for nobody", || service.queries_in_flight() == 0).await;
}

#[tokio::test(flavor = "multi_thread")]
async fn a_watch_that_is_dropped_gives_its_place_back_and_one_of_so_many_steps_ends() {
    let door = with_balls(Limits { max_watchers: 1, ..Limits::default() }, 1).await;
    let service = &door.daemon.service;
    let request = v1::WatchRequest { scene: SCENE.to_owned(), ..v1::WatchRequest::default() }.encode_to_vec();
    let mut watch = door.client.watch("Scenes/Watch", request.clone(), PATIENCE, None).await.unwrap();
    watched("content", watch.next()).await.unwrap().unwrap();
    assert_eq!(service.watchers(), 1);
    drop(watch);
    eventually("no watcher", || service.watchers() == 0).await;
    let mut two = door.client.watch("Scenes/Watch", request, PATIENCE, Some(2)).await.unwrap();
    watched("content", two.next()).await.unwrap().unwrap();
    door.apply(super::moved(2.0)).await.unwrap();
    let step = watched("a step", two.next()).await.unwrap().unwrap();
    assert_eq!(v1::WatchResponse::decode(step).unwrap().revision, 2);
    assert_eq!(watched("the end", two.next()).await.unwrap(), None);
    eventually("no watcher", || service.watchers() == 0).await;
}

#[tokio::test(flavor = "multi_thread")]
async fn a_daemon_that_drains_says_so_and_takes_its_token_back() {
    let door = with_balls(Limits::default(), 1).await;
    let keys = door.client.keys().clone();
    let alive = door.client.session().liveliness().declare_subscriber(keys.alive()).history(true).await.unwrap();
    let there = watched("a token", alive.recv_async()).await.unwrap();
    assert_eq!(there.kind(), zenoh::sample::SampleKind::Put);
    let scene = door.client.session().liveliness().get(keys.scene_alive(SCENE)).await.unwrap();
    assert!(watched("a scene's token", scene.recv_async()).await.is_ok());
    let request = v1::WatchRequest { scene: SCENE.to_owned(), ..v1::WatchRequest::default() }.encode_to_vec();
    let mut watch = door.client.watch("Scenes/Watch", request, PATIENCE, None).await.unwrap();
    watched("content", watch.next()).await.unwrap().unwrap();
    let Zenoh { daemon, .. } = door;
    let stopping = tokio::spawn(daemon.stop());
    let ClientError::Refused(refusal) = watched("the end", watch.next()).await.unwrap_err() else { panic!() };
    assert_eq!((refusal.code, refusal.reason), (14, "SHUTTING_DOWN"));
    let gone = watched("the token's end", alive.recv_async()).await.unwrap();
    assert_eq!(gone.kind(), zenoh::sample::SampleKind::Delete);
    assert_eq!(watched("the end", stopping).await.unwrap(), clearance::app::Drained::Clean);
}
