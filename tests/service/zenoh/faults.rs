//! What breaks between a caller and the daemon: the caller is told in time, no edit is half applied, and whoever is left goes on.

use std::io::Write as _;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;

use clearance::app::DoorChoice;
use clearance::limits::Limits;
use clearance::transports::wire::v1;
use clearance::transports::wire::v1::server_client::ServerClient;
use clearance::transports::zenoh::{Client, ClientError, Config};
use prost::Message;

use super::{get_scene, slow_question, with_balls};
use crate::process::Killed;
use crate::support::daemon::{RunningDaemon, config};
use crate::support::door::Door;
use crate::support::messages::*;
use crate::support::network::Network;
use crate::support::watchdog::{eventually, watched};
use crate::support::zenoh_door::PREFIX;

const PATIENCE: Duration = Duration::from_secs(30);

/// A daemon of its own process, and where zenoh finds it.
async fn process(extra: &[&str]) -> (Killed, String) {
    let mut command = crate::process::serve_with(&["--no-shared-memory", "--zenoh-listen", "tcp/127.0.0.1:0"]);
    command.args(["--zenoh-prefix", PREFIX]).args(extra);
    Killed::listening_at(&mut command, "zenoh").await
}

async fn answers(client: &Client) -> bool {
    client.call("Server/GetServerInfo", [], Duration::from_millis(500)).await.is_ok()
}

#[tokio::test(flavor = "multi_thread")]
async fn a_daemon_that_is_killed_in_the_middle_of_a_question_is_told_at_once_and_the_next_is_found() {
    let (mut daemon, endpoint) = process(&[]).await;
    let client = Client::connect(&endpoint, PREFIX).await.unwrap();
    let create = v1::CreateSceneRequest { name: SCENE.to_owned(), ..v1::CreateSceneRequest::default() };
    client.call("Scenes/CreateScene", create.encode_to_vec(), PATIENCE).await.unwrap();
    let request = v1::WatchRequest { scene: SCENE.to_owned(), from_revision: Some(1), ..v1::WatchRequest::default() };
    let mut watch = client.watch("Scenes/Watch", request.encode_to_vec(), PATIENCE, None).await.unwrap();
    // One that waits for a revision is in the middle of its work.
    let waiting = v1::GetSceneRequest {
        revision: Some(v1::RevisionRule { epoch: None, rule: Some(v1::revision_rule::Rule::AtLeast(7)) }),
        ..get_scene()
    };
    let asking = async {
        let asked = client.call("Scenes/GetScene", waiting.encode_to_vec(), PATIENCE);
        tokio::join!(asked, async {
            tokio::time::sleep(Duration::from_millis(200)).await;
            daemon.kill();
        })
    };
    let (outcome, ()) = watched("an outcome", asking).await;
    assert!(matches!(outcome, Err(ClientError::NoDaemon { .. })), "{outcome:?}");
    assert_eq!(watched("the watch's end", watch.next()).await.unwrap(), None);
    // The next daemon at the same place has nothing of the first.
    let place = endpoint.clone();
    let mut command = crate::process::serve_with(&["--no-shared-memory", "--zenoh-prefix", PREFIX]);
    let (next, _) = Killed::listening_at(command.args(["--zenoh-listen", &place]), "zenoh").await;
    watched("the next daemon", async { while !answers(&client).await {} }).await;
    let error = client.call("Scenes/GetScene", get_scene().encode_to_vec(), PATIENCE).await.unwrap_err();
    assert!(matches!(&error, ClientError::Refused(refusal) if refusal.reason == "NOT_FOUND"), "{error}");
    assert_eq!(next.stopped().await.0, Some(0));
}

#[tokio::test(flavor = "multi_thread")]
async fn a_stopped_daemon_costs_no_more_than_the_timeout_and_answers_when_it_goes_on() {
    let (daemon, endpoint) = process(&[]).await;
    let client = Client::connect(&endpoint, PREFIX).await.unwrap();
    assert!(answers(&client).await);
    daemon.signal("-STOP");
    let error = watched("an outcome", client.call("Server/GetServerInfo", [], Duration::from_millis(300))).await;
    assert!(matches!(error, Err(ClientError::Timeout(_))), "{error:?}");
    daemon.signal("-CONT");
    watched("an answer afterwards", async { while !answers(&client).await {} }).await;
    assert_eq!(daemon.stopped().await.0, Some(0));
}

/// Many bodies in one list of edits, on a connection that breaks in the middle of it.
#[tokio::test(flavor = "multi_thread")]
async fn a_caller_that_is_cut_off_in_the_middle_of_an_apply_leaves_all_of_it_or_nothing() {
    let door = with_balls(Limits::default(), 0).await;
    let edits = apply((0..2_000).map(|i| add(&format!("body{i}"), sphere(0.1), at(f64::from(i), 0.0, 0.0))).collect());
    let message = edits.encode_to_vec();
    let (mut nothing, mut everything) = (0, 0);
    for part in [0.1, 0.5, 0.9, 2.0] {
        let network = Network::to(door.endpoint.strip_prefix("tcp/").unwrap()).await;
        let far = Client::connect(&format!("tcp/{}", network.address), PREFIX).await.unwrap();
        assert!(answers(&far).await);
        let passed = network.state.passed.load(Ordering::Acquire);
        network.state.breaks_after.store(passed + (part * message.len() as f64) as usize, Ordering::Release);
        let outcome = watched("an outcome", far.call("Scenes/Apply", message.clone(), Duration::from_secs(5))).await;
        let after = door.get_scene(get_scene()).await.unwrap();
        match outcome {
            Ok(_) => {
                assert_eq!((after.bodies.len(), after.revision), (2_000, 1));
                everything += 1;
            }
            Err(error) => {
                assert!(matches!(error, ClientError::NoDaemon { .. } | ClientError::Timeout(_)), "{error}");
                assert_eq!((after.bodies.len(), after.revision), (0, 0));
                nothing += 1;
            }
        }
    }
    assert_eq!((nothing, everything), (3, 1), "every regime was reached");
}

#[tokio::test(flavor = "multi_thread")]
async fn a_network_that_is_cut_and_healed_costs_the_timeout() {
    let door = with_balls(Limits::default(), 1).await;
    let network = Network::to(door.endpoint.strip_prefix("tcp/").unwrap()).await;
    let far = Client::connect(&format!("tcp/{}", network.address), PREFIX).await.unwrap();
    assert!(answers(&far).await);
    network.state.held.store(true, Ordering::Release);
    let held = watched("an outcome", far.call("Server/GetServerInfo", [], Duration::from_millis(300))).await;
    assert!(matches!(held, Err(ClientError::Timeout(_))), "{held:?}");
    network.state.held.store(false, Ordering::Release);
    watched("an answer", async { while !answers(&far).await {} }).await;
    network.state.cut.store(true, Ordering::Release);
    watched("the cut", async { while answers(&far).await {} }).await;
    let cut = watched("an outcome", far.call("Server/GetServerInfo", [], Duration::from_millis(300))).await;
    assert!(matches!(cut, Err(ClientError::NoDaemon { .. } | ClientError::Timeout(_))), "{cut:?}");
    network.state.cut.store(false, Ordering::Release);
    watched("an answer", async { while !answers(&far).await {} }).await;
}

/// A router of zenoh between the two, which goes away and comes back at the same place.
async fn router(endpoint: &str) -> zenoh::Session {
    let mut config = zenoh::Config::default();
    for (key, value) in [
        ("mode", "\"router\"".to_owned()),
        ("listen/endpoints", format!("[{endpoint:?}]")),
        ("scouting/multicast/enabled", "false".to_owned()),
        ("scouting/gossip/enabled", "false".to_owned()),
    ] {
        config.insert_json5(key, &value).unwrap();
    }
    zenoh::open(config).await.unwrap()
}

#[tokio::test(flavor = "multi_thread")]
async fn a_router_that_restarts_brings_both_sides_together_again() {
    let place = {
        let free = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
        format!("tcp/{}", free.local_addr().unwrap())
    };
    let first = router(&place).await;
    let mut config = config(Limits::default());
    let door = Config { listen: Some(Vec::new()), connect: Some(vec![place.clone()]), ..Config::on_loopback(PREFIX) };
    config.zenoh = DoorChoice::On(door);
    let daemon = RunningDaemon::start(&config).await;
    assert_eq!(daemon.service.doors().last().unwrap().address, place);
    let client = Client::connect(&place, PREFIX).await.unwrap();
    watched("an answer through the router", async { while !answers(&client).await {} }).await;
    first.close().await.unwrap();
    watched("no answer without it", async { while answers(&client).await {} }).await;
    let gone = watched("an outcome", client.call("Server/GetServerInfo", [], Duration::from_millis(300))).await;
    assert!(matches!(gone, Err(ClientError::NoDaemon { .. } | ClientError::Timeout(_))), "{gone:?}");
    let second = router(&place).await;
    watched("an answer through the next router", async { while !answers(&client).await {} }).await;
    drop(second);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_full_table_of_connections_turns_one_away_and_those_within_go_on() {
    let door = with_balls(Limits { max_connections: 2, ..Limits::default() }, 1).await;
    let second = Client::connect(&door.endpoint, PREFIX).await.unwrap();
    assert!(answers(&second).await);
    let third = tokio::time::timeout(Duration::from_secs(20), Client::connect(&door.endpoint, PREFIX)).await;
    assert!(!matches!(third, Ok(Ok(_))), "there was no place for it");
    assert!(answers(&second).await && answers(&door.client).await);
    drop(second);
    let free = async {
        loop {
            if let Ok(Ok(client)) =
                tokio::time::timeout(Duration::from_secs(5), Client::connect(&door.endpoint, PREFIX)).await
            {
                return client;
            }
        }
    };
    assert!(answers(&watched("a place", free).await).await);
}

#[tokio::test(flavor = "multi_thread")]
async fn ten_thousand_questions_beyond_the_limit_are_each_told_so() {
    let door = with_balls(Limits { max_queries_in_flight: 2, ..Limits::default() }, 0).await;
    let question = slow_question(&door).await;
    let service = &door.daemon.service;
    let busy = Client::connect(&door.endpoint, PREFIX).await.unwrap();
    let asking = tokio::spawn(async move {
        let slow = || busy.call("Queries/Collide", question.clone(), Duration::from_secs(300));
        drop(tokio::time::timeout(Duration::from_secs(40), async { tokio::join!(slow(), slow()) }).await);
    });
    eventually("two questions under way", || service.queries_in_flight() == 2).await;
    let question = collide(vec![all_pairs()]).encode_to_vec();
    let flood = async {
        for _ in 0..100 {
            let mut under_way = Vec::new();
            for _ in 0..100 {
                under_way.push(door.client.call("Queries/Collide", question.clone(), PATIENCE));
            }
            for outcome in futures_of(under_way).await {
                let ClientError::Refused(refusal) = outcome.unwrap_err() else { panic!("not told so") };
                assert_eq!(refusal.reason, "LIMIT_EXCEEDED");
                assert_eq!(refusal.details["clearance-limit"], "max_queries_in_flight");
            }
        }
    };
    watched("ten thousand answers", flood).await;
    asking.abort();
    eventually("no work for nobody", || service.queries_in_flight() == 0).await;
    assert!(answers(&door.client).await);
}

/// All of them at the same time.
async fn futures_of<T>(futures: Vec<impl Future<Output = T>>) -> Vec<T> {
    let mut pinned: Vec<_> = futures.into_iter().map(|future| (Box::pin(future), None)).collect();
    std::future::poll_fn(|context| {
        for (future, outcome) in &mut pinned {
            if outcome.is_none()
                && let std::task::Poll::Ready(value) = future.as_mut().poll(context)
            {
                *outcome = Some(value);
            }
        }
        if pinned.iter().all(|(_, outcome)| outcome.is_some()) {
            std::task::Poll::Ready(())
        } else {
            std::task::Poll::Pending
        }
    })
    .await;
    pinned.into_iter().filter_map(|(_, outcome)| outcome).collect()
}

/// Connections that say nothing, half of a greeting or garbage take nothing from those who speak zenoh.
#[tokio::test(flavor = "multi_thread")]
async fn strangers_who_do_not_speak_zenoh_disturb_nobody() {
    let door = with_balls(Limits::default(), 1).await;
    let address = door.endpoint.strip_prefix("tcp/").unwrap();
    let mut open = Vec::new();
    for i in 0..50_u32 {
        let mut socket = std::net::TcpStream::connect(address).unwrap();
        match i % 3 {
            0 => {}
            1 => drop(socket.write_all(b"\x00")),
            _ => drop(socket.write_all(&[0xff; 5_000])),
        }
        open.push(socket);
    }
    for _ in 0..20 {
        assert!(answers(&door.client).await);
    }
    let new = watched("connecting", Client::connect(&door.endpoint, PREFIX)).await.unwrap();
    assert!(answers(&new).await);
}

/// A caller that asks for much and reads nothing. All others are answered meanwhile, whatever door they come through: replies that
/// wait for it hold up neither zenoh's threads nor the daemon's.
#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn a_caller_that_does_not_read_holds_up_nobody() {
    let door = with_balls(Limits { max_queries_in_flight: 1_000, ..Limits::default() }, 0).await;
    door.apply(heap()).await.unwrap();
    let network = Network::to(door.endpoint.strip_prefix("tcp/").unwrap()).await;
    let slow = Arc::new(Client::connect(&format!("tcp/{}", network.address), PREFIX).await.unwrap());
    assert!(answers(&slow).await);
    network.state.unread.store(true, Ordering::Release);
    // Half a megabyte an answer, until no more fits between the two; then small ones, of which some are there at once and some
    // are answered by tasks.
    let (large, small) = (heap_listed(10).encode_to_vec(), collide(vec![all_pairs()]).encode_to_vec());
    let mut asking = Vec::new();
    for question in [vec![large; 60], vec![small; 20]].concat() {
        let slow = Arc::clone(&slow);
        asking.push(tokio::spawn(async move { slow.call("Queries/Collide", question, Duration::from_secs(60)).await }));
    }
    for _ in 0..20 {
        let slow = Arc::clone(&slow);
        asking.push(tokio::spawn(async move { slow.call("Server/GetServerInfo", [], Duration::from_secs(60)).await }));
    }
    let mut server = ServerClient::connect(format!("http://{}", door.daemon.address)).await.unwrap();
    let begun = std::time::Instant::now();
    // Five seconds is what zenoh waits before it gives a connection up.
    while begun.elapsed() < Duration::from_secs(4) {
        let mut request = tonic::Request::new(v1::GetServerInfoRequest {});
        request.set_timeout(Duration::from_secs(2));
        server.get_server_info(request).await.unwrap();
        door.client.call("Server/GetServerInfo", [], Duration::from_secs(2)).await.unwrap();
        tokio::time::sleep(Duration::from_millis(20)).await;
    }
    network.state.cut.store(true, Ordering::Release);
    let service = &door.daemon.service;
    eventually("no work for nobody", || service.queries_in_flight() == 0).await;
    asking.iter().for_each(tokio::task::JoinHandle::abort);
    assert!(answers(&door.client).await);
}
