//! Too many at the door: connections that never speak, a full table of connections, clients beyond their quotas, readers
//! that do not read. Whoever behaves is answered all the while and afterwards, and draining waits for no one who asks nothing.

use std::io::{ErrorKind, Read, Write};
use std::net::TcpStream;
use std::sync::Arc;
use std::time::{Duration, Instant};

use clearance::app::Drained;
use clearance::limits::Limits;
use clearance::transports::grpc::{Scope, Secret, TokenSource};
use clearance::transports::wire::v1;
use clearance::transports::wire::v1::queries_client::QueriesClient;
use clearance::transports::wire::v1::scenes_client::ScenesClient;
use clearance::transports::wire::v1::server_client::ServerClient;
use tonic::transport::Channel;
use tonic::{Code, Request, Status};

use crate::support::daemon::{RunningDaemon, config};
use crate::support::door::{Door, Grpc, Messages, Streams};
use crate::support::messages::*;
use crate::support::watchdog::{eventually, watched};

/// What a client of HTTP/2 says first: the preface and an empty SETTINGS frame.
const HELLO: &[u8] = b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n\x00\x00\x00\x04\x00\x00\x00\x00\x00";

fn idle(address: &str, says: &[u8]) -> TcpStream {
    let mut socket = TcpStream::connect(address).unwrap();
    socket.set_read_timeout(Some(Duration::from_secs(60))).unwrap();
    socket.write_all(says).unwrap();
    socket
}

/// Waits, on a thread of its own, until the daemon closes the connection.
async fn closed(mut socket: TcpStream) {
    let reading = tokio::task::spawn_blocking(move || {
        let mut bytes = [0; 4096];
        loop {
            match socket.read(&mut bytes) {
                Ok(0) => return,
                Ok(_) => {}
                Err(error) if error.kind() == ErrorKind::ConnectionReset => return,
                Err(error) => panic!("not closed: {error}"),
            }
        }
    });
    watched("the daemon's closing", reading).await.unwrap();
}

async fn info(channel: &Channel) -> Result<v1::GetServerInfoResponse, Status> {
    let mut client = ServerClient::new(channel.clone());
    Ok(watched("an answer", client.get_server_info(v1::GetServerInfoRequest {})).await?.into_inner())
}

async fn connected(address: &str) -> Channel {
    let endpoint = Channel::from_shared(format!("http://{address}")).unwrap();
    watched("connecting", endpoint.connect()).await.unwrap()
}

fn of(status: &Status, key: &str) -> String {
    status.metadata().get(key).map_or("", |value| value.to_str().unwrap()).to_owned()
}

/// Before, a drain waited its full time for each connection that had not sent the preface of HTTP/2, and ended with "requests
/// were still under way"; so it did for clients that do not answer a GOAWAY.
#[tokio::test(flavor = "multi_thread")]
async fn a_drain_waits_for_no_connection_without_calls() {
    // Nobody loses patience in this test.
    let grpc = Grpc::open(Limits { max_handshake_seconds: 3600, ..Limits::default() }).await;
    let silent: Vec<_> = (0..200).map(|_| idle(&grpc.daemon.address, b"")).collect();
    let half: Vec<_> = (0..20).map(|_| idle(&grpc.daemon.address, &HELLO[..20])).collect();
    let deaf: Vec<_> = (0..20).map(|_| idle(&grpc.daemon.address, HELLO)).collect();
    // The daemon takes connections in their order: when this one is answered, it has the others.
    let channel = connected(&grpc.daemon.address).await;
    info(&channel).await.unwrap();
    let begun = Instant::now();
    assert_eq!(grpc.daemon.stop().await, Drained::Clean);
    // Ten seconds would be the time to drain; a busy machine may take a part of them.
    assert!(begun.elapsed() < Duration::from_secs(8), "{:?}", begun.elapsed());
    for socket in silent.into_iter().chain(half).chain(deaf) {
        closed(socket).await;
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn half_open_connections_are_closed_and_a_client_that_spoke_stays() {
    let grpc = Grpc::open(Limits { max_handshake_seconds: 1, ..Limits::default() }).await;
    let spoke = idle(&grpc.daemon.address, HELLO);
    for says in [&b""[..], &HELLO[..10], &HELLO[..HELLO.len() - 1]] {
        closed(idle(&grpc.daemon.address, says)).await;
    }
    // The others took a second and more each.
    spoke.set_nonblocking(true).unwrap();
    let mut spoke = spoke;
    let mut bytes = [0; 4096];
    let end = loop {
        match spoke.read(&mut bytes) {
            Ok(0) => break "closed".to_owned(),
            Ok(_) => {}
            Err(error) => break error.kind().to_string(),
        }
    };
    assert_eq!(end, ErrorKind::WouldBlock.to_string());
    assert!(info(&grpc.channel).await.is_ok());
}

#[tokio::test(flavor = "multi_thread")]
async fn a_connection_beyond_the_table_is_closed_and_a_place_that_is_left_is_taken() {
    let grpc = Grpc::open(Limits { max_connections: 5, max_handshake_seconds: 3600, ..Limits::default() }).await;
    info(&grpc.channel).await.unwrap();
    let mut inside: Vec<_> = (0..4).map(|_| idle(&grpc.daemon.address, HELLO)).collect();
    for _ in 0..20 {
        closed(idle(&grpc.daemon.address, b"")).await;
    }
    assert!(info(&grpc.channel).await.is_ok(), "who is inside is answered");
    drop(inside.pop());
    let mut answered = false;
    let address = format!("http://{}", grpc.daemon.address);
    let again = async {
        while !answered {
            if let Ok(channel) = Channel::from_shared(address.clone()).unwrap().connect().await {
                answered = info(&channel).await.is_ok();
            }
        }
    };
    watched("a place", again).await;
    assert_eq!(grpc.daemon.stop().await, Drained::Clean);
}

#[tokio::test(flavor = "multi_thread")]
async fn ten_thousand_calls_beyond_a_clients_share_are_refused_and_the_daemon_answers_afterwards() {
    let limits = Limits { max_client_calls: 8, ..Limits::default() };
    let grpc = Grpc::open(limits).await;
    grpc.create_scene(SCENE).await.unwrap();
    // Watches stay under way.
    let mut watches = Vec::new();
    for _ in 0..8 {
        let request = v1::WatchContactsRequest { context: Some(context()), ..v1::WatchContactsRequest::default() };
        let mut queries = QueriesClient::new(grpc.channel.clone());
        watches.push(watched("a watch", queries.watch_contacts(request)).await.unwrap().into_inner());
    }
    let asking: Vec<_> = (0..100)
        .map(|_| {
            let channel = grpc.channel.clone();
            tokio::spawn(async move {
                for _ in 0..100 {
                    let status = info(&channel).await.unwrap_err();
                    assert_eq!(status.code(), Code::ResourceExhausted, "{status:?}");
                    assert_eq!(of(&status, "clearance-reason"), "LIMIT_EXCEEDED");
                    let told = ["limit", "asked", "allowed"].map(|key| of(&status, &format!("clearance-{key}")));
                    assert_eq!((told[0].as_str(), told[2].as_str()), ("max_client_calls", "8"));
                    assert!(told[1].parse::<u64>().unwrap() > 8);
                }
            })
        })
        .collect();
    for task in asking {
        watched("refusals", task).await.unwrap();
    }
    drop(watches);
    let again = async { while info(&grpc.channel).await.is_err() {} };
    watched("an answer afterwards", again).await;
    let Grpc { daemon, channel: _kept, .. } = grpc;
    assert_eq!(daemon.stop().await, Drained::Clean);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_client_beyond_its_rate_is_told_when_to_come_back_and_others_are_not() {
    let limits =
        Limits { max_client_items_per_second: 100, max_client_bytes_per_second: 1_000_000, ..Limits::default() };
    let mut config = config(limits);
    let token = |name: &str| TokenSource {
        name: name.to_owned(),
        secret: Secret::Sha256(clearance::service::ContentHash::of(name.as_bytes()).to_string()),
        scopes: vec![Scope::Read, Scope::Write],
    };
    config.grpc.tokens = vec![token("greedy"), token("modest")];
    let daemon = RunningDaemon::start(&config).await;
    daemon.service.create_scene(SCENE, &clearance::scene::SceneOptions::default()).unwrap();
    let channel = connected(&daemon.address).await;
    let ask = async |name: &str, items: usize| {
        let mut request = Request::new(collide(vec![all_pairs(); items]));
        request.metadata_mut().insert("authorization", format!("Bearer {name}").parse().unwrap());
        watched("an answer", QueriesClient::new(channel.clone()).collide(request)).await
    };
    ask("greedy", 150).await.unwrap();
    let status = ask("greedy", 1).await.unwrap_err();
    assert_eq!(status.code(), Code::ResourceExhausted, "{status:?}");
    assert_eq!(of(&status, "clearance-limit"), "max_client_items_per_second");
    assert_eq!(of(&status, "clearance-allowed"), "100");
    let asked: u64 = of(&status, "clearance-asked").parse().unwrap();
    assert!((101..=150).contains(&asked), "{asked}");
    assert_eq!(of(&status, "clearance-retry-after-ms"), of(&status, "grpc-retry-pushback-ms"));
    let wait: u64 = of(&status, "clearance-retry-after-ms").parse().unwrap();
    assert!((1..=510).contains(&wait), "{wait}");
    // Another one on the same connection is not affected.
    ask("modest", 50).await.unwrap();
    tokio::time::sleep(Duration::from_millis(wait)).await;
    ask("greedy", 1).await.unwrap();
}

/// An estimate is charged with all that it asked.
#[tokio::test(flavor = "multi_thread")]
async fn an_estimate_is_taken_off_the_clients_share() {
    let limits = Limits { max_client_items_per_second: 50, max_estimate_seconds: 60, ..Limits::default() };
    let grpc = Grpc::open(limits).await;
    grpc.create_scene(SCENE).await.unwrap();
    grpc.apply(apply(vec![add("1", sphere(0.1), at(0.0, 0.0, 0.0))])).await.unwrap();
    let asked = distance(vec![body(named("1")); 20]);
    let question = Some(v1::estimate_request::Question::Distance(asked));
    let request = v1::EstimateRequest { question, tolerances: vec![1e-3], ..v1::EstimateRequest::default() };
    let told = watched("an estimate", grpc.estimate(request.clone())).await.unwrap();
    assert_eq!(told.asked, 3 * 20 * 7 + 6);
    let refusal = watched("a refusal", grpc.estimate(request)).await.unwrap_err();
    assert_eq!((refusal.code, refusal.reason.as_str()), (Code::ResourceExhausted, "LIMIT_EXCEEDED"), "{refusal:?}");
}

/// A message larger than what a second allows is read no faster than the rate; the next call is refused meanwhile.
#[tokio::test(flavor = "multi_thread")]
async fn bytes_come_no_faster_than_the_clients_rate() {
    let limits = Limits { max_client_bytes_per_second: 200_000, ..Limits::default() };
    let grpc = Grpc::open(limits).await;
    let begun = Instant::now();
    let mut queries = QueriesClient::new(grpc.channel.clone());
    let large = tokio::spawn(async move { queries.check_states(states(vec![0.0; 50_000])).await });
    let status = async {
        loop {
            if let Err(status) = info(&grpc.channel).await {
                return status;
            }
        }
    };
    let status = watched("a refusal", status).await;
    assert_eq!(of(&status, "clearance-limit"), "max_client_bytes_per_second");
    assert!(of(&status, "clearance-retry-after-ms").parse::<u64>().unwrap() > 0);
    let told = watched("an answer", large).await.unwrap();
    // 400 kB, of which one second's worth is there at the start.
    assert_eq!(told.unwrap_err().code(), Code::NotFound);
    assert!(begun.elapsed() > Duration::from_millis(500), "{:?}", begun.elapsed());
    let again = async { while info(&grpc.channel).await.is_err() {} };
    watched("an answer afterwards", again).await;
}

/// Answers of a stream are taken off the client's share as those of single calls are.
#[tokio::test(flavor = "multi_thread")]
async fn a_stream_is_answered_no_faster_than_the_clients_rate() {
    let limits = Limits { max_client_items_per_second: 100, ..Limits::default() };
    let grpc = Grpc::open(limits).await;
    grpc.create_scene(SCENE).await.unwrap();
    let begun = Instant::now();
    let (sender, mut told) = grpc.query_stream().await.unwrap();
    for id in 0..3 {
        let question = v1::query_stream_request::Question::Collide(collide(vec![all_pairs(); 100]));
        sender.send(v1::QueryStreamRequest { id, question: Some(question) }).await.unwrap();
    }
    drop(sender);
    for _ in 0..3 {
        watched("an answer", told.message()).await.unwrap().unwrap();
    }
    // The first answer empties the share, the second overdraws it by a second's worth, and the third has to wait for that.
    assert!(begun.elapsed() > Duration::from_millis(900), "{:?}", begun.elapsed());
}

/// What waits for a reader counts as under way: a client that does not read cannot ask without end, and others are answered.
#[tokio::test(flavor = "multi_thread")]
async fn a_slow_reader_holds_up_only_itself() {
    let limits = Limits { max_client_calls: 4, ..Limits::default() };
    let mut config = config(limits);
    let token = |name: &str| TokenSource {
        name: name.to_owned(),
        secret: Secret::Sha256(clearance::service::ContentHash::of(name.as_bytes()).to_string()),
        scopes: vec![Scope::Read, Scope::Write],
    };
    config.grpc.tokens = vec![token("slow"), token("quick")];
    let daemon = RunningDaemon::start(&config).await;
    let service = Arc::clone(&daemon.service);
    // Its windows take 64 KiB; the rest of an answer of some megabytes waits in the daemon.
    let endpoint = Channel::from_shared(format!("http://{}", daemon.address)).unwrap();
    let slow = watched("connecting", endpoint.initial_connection_window_size(65_535).connect()).await.unwrap();
    let quick = connected(&daemon.address).await;
    let as_client = |name: &str, question: v1::CollideRequest| {
        let mut request = Request::new(question);
        request.metadata_mut().insert("authorization", format!("Bearer {name}").parse().unwrap());
        request
    };
    service.create_scene(SCENE, &clearance::scene::SceneOptions::default()).unwrap();
    let mut change = Request::new(heap());
    change.metadata_mut().insert("authorization", "Bearer quick".parse().unwrap());
    ScenesClient::new(quick.clone()).apply(change).await.unwrap();
    // A body that is not read: the generated client would read it.
    let mut unread = Vec::new();
    for _ in 0..4 {
        let mut grpc = tonic::client::Grpc::new(slow.clone());
        grpc.ready().await.unwrap();
        let path = "/clearance.v1.Queries/Collide".parse().unwrap();
        let codec = tonic_prost::ProstCodec::<v1::CollideRequest, v1::CollideResponse>::default();
        let asked = grpc.server_streaming(as_client("slow", heap_listed(40)), path, codec);
        unread.push(watched("the head of an answer", asked).await.unwrap());
    }
    eventually("the answers are made", || service.queries_in_flight() == 0).await;
    let told = watched("a refusal", QueriesClient::new(slow.clone()).collide(as_client("slow", heap_listed(0))))
        .await
        .unwrap_err();
    assert_eq!(of(&told, "clearance-limit"), "max_client_calls", "{told:?}");
    let answer = watched("an answer", QueriesClient::new(quick).collide(as_client("quick", heap_listed(1)))).await;
    assert_eq!(answer.unwrap().into_inner().answer.unwrap().items.len(), 1);
    // Once it reads, everything is there. All at once, as they share a window.
    let reading: Vec<_> = unread
        .into_iter()
        .map(|answer: tonic::Response<tonic::Streaming<v1::CollideResponse>>| {
            tokio::spawn(async move { answer.into_inner().message().await.unwrap().unwrap() })
        })
        .collect();
    for message in reading {
        assert_eq!(watched("the rest", message).await.unwrap().answer.unwrap().items.len(), 40);
    }
    let again =
        async { while QueriesClient::new(slow.clone()).collide(as_client("slow", heap_listed(0))).await.is_err() {} };
    watched("an answer to the slow one", again).await;
    assert_eq!(daemon.stop().await, Drained::Clean);
}
