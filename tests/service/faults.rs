//! What breaks between a caller and the daemon, or either of them: the caller is told, no edit is half applied, and whoever
//! is left goes on. Scenes are in memory alone: of a daemon that was killed nothing is left, and the next one says so.

use std::sync::atomic::Ordering;
use std::time::Duration;

use clearance::limits::Limits;
use clearance::transports::wire::v1;
use clearance::transports::wire::v1::scenes_client::ScenesClient;
use clearance::transports::wire::v1::server_client::ServerClient;
use tonic::transport::{Channel, Endpoint};
use tonic::{Code, Request, Status};

use crate::process::{Killed, serve};
use crate::support::door::{Door, Grpc};
use crate::support::messages::*;
use crate::support::network::Network;
use crate::support::watchdog::{eventually, watched};

const MANY: usize = 2_000;

/// One list of edits, some hundred kilobytes long.
fn many_bodies() -> v1::ApplyRequest {
    let body = |i: usize| add(&format!("body{i}"), sphere(0.1), at(i as f64, 0.0, 0.0));
    apply((0..MANY).map(body).collect())
}

fn get_scene() -> v1::GetSceneRequest {
    v1::GetSceneRequest { scene: SCENE.to_owned(), ..v1::GetSceneRequest::default() }
}

fn bodies(contents: &v1::SceneContents) -> usize {
    contents.bodies.len()
}

async fn info(channel: &Channel, timeout: Duration) -> Result<(), Status> {
    let mut request = Request::new(v1::GetServerInfoRequest {});
    request.set_timeout(timeout);
    watched("an answer", ServerClient::new(channel.clone()).get_server_info(request)).await.map(drop)
}

/// The connection breaks at many places of a long list of edits: all of it is there afterwards, or nothing.
#[tokio::test(flavor = "multi_thread")]
async fn a_caller_that_goes_away_in_the_middle_of_an_apply_leaves_all_of_it_or_nothing() {
    let grpc = Grpc::open(Limits::default()).await;
    grpc.create_scene(SCENE).await.unwrap();
    let whole = prost::Message::encoded_len(&many_bodies());
    let (mut nothing, mut everything) = (0, 0);
    for part in [0.1, 0.5, 0.9, 0.99, 1.5] {
        let before = grpc.get_scene(get_scene()).await.unwrap();
        let network = Network::to(&grpc.daemon.address).await;
        network.state.breaks_after.store((part * whole as f64) as usize, Ordering::Release);
        let channel = network.channel().await;
        let outcome = watched("an outcome", ScenesClient::new(channel).apply(many_bodies())).await;
        let after = grpc.get_scene(get_scene()).await.unwrap();
        if outcome.is_ok() {
            assert_eq!((bodies(&after), after.revision), (MANY, before.revision + 1));
            everything += 1;
        } else {
            assert_eq!((bodies(&after), after.revision), (bodies(&before), before.revision), "{outcome:?}");
            nothing += 1;
        }
    }
    assert_eq!((nothing, everything), (4, 1), "every regime was reached");
}

/// A network that swallows everything costs a caller no more than its deadline; on the same connection or the next it is
/// answered when the network is there again.
#[tokio::test(flavor = "multi_thread")]
async fn a_network_that_is_cut_costs_the_deadline_and_heals() {
    let grpc = Grpc::open(Limits::default()).await;
    let network = Network::to(&grpc.daemon.address).await;
    let channel = network.channel().await;
    info(&channel, Duration::from_secs(20)).await.unwrap();
    network.state.held.store(true, Ordering::Release);
    let status = info(&channel, Duration::from_millis(300)).await.unwrap_err();
    let told = [Code::DeadlineExceeded, Code::Cancelled, Code::Unavailable, Code::Unknown];
    assert!(told.contains(&status.code()), "{status:?}");
    network.state.held.store(false, Ordering::Release);
    let healed = async { while info(&channel, Duration::from_secs(1)).await.is_err() {} };
    watched("an answer after the cut", healed).await;
}

#[tokio::test(flavor = "multi_thread")]
async fn an_apply_that_the_daemon_did_not_survive_is_an_error_and_the_next_daemon_has_nothing() {
    let (mut killed, address) = Killed::listening(&mut serve()).await;
    let network = Network::to(&address).await;
    let channel = network.channel().await;
    let mut scenes = ScenesClient::new(channel);
    let create = v1::CreateSceneRequest { name: SCENE.to_owned(), ..v1::CreateSceneRequest::default() };
    let first = watched("a scene", scenes.create_scene(create.clone())).await.unwrap().into_inner().scene.unwrap();
    let begun = network.state.passed.load(Ordering::Acquire);
    let mut applying = scenes.clone();
    let outcome = tokio::spawn(async move { applying.apply(many_bodies()).await });
    eventually("the first bytes of the edits", || network.state.passed.load(Ordering::Acquire) > begun).await;
    killed.kill();
    let status = watched("an outcome", outcome).await.unwrap().unwrap_err();
    assert!([Code::Unavailable, Code::Unknown, Code::Cancelled, Code::Internal].contains(&status.code()), "{status:?}");
    // The next one begins with nothing, and another epoch says that it is not the same scene.
    let (next, address) = Killed::listening(&mut serve()).await;
    let mut scenes = watched("connecting", ScenesClient::connect(format!("http://{address}"))).await.unwrap();
    let status = scenes.get_scene(get_scene()).await.unwrap_err();
    assert_eq!(status.code(), Code::NotFound);
    let second = scenes.create_scene(create).await.unwrap().into_inner().scene.unwrap();
    assert_ne!(first.epoch, second.epoch);
    let stale = v1::ApplyRequest { expected_epoch: Some(first.epoch), ..many_bodies() };
    let status = scenes.apply(stale).await.unwrap_err();
    assert_eq!(status.metadata().get("clearance-reason").unwrap(), "WRONG_EPOCH");
    assert_eq!(next.stopped().await.0, Some(0));
}

#[tokio::test(flavor = "multi_thread")]
async fn a_stopped_daemon_costs_no_more_than_the_deadline_and_answers_when_it_goes_on() {
    let (daemon, address) = Killed::listening(&mut serve()).await;
    let endpoint = Endpoint::from_shared(format!("http://{address}")).unwrap();
    let channel = watched("connecting", endpoint.connect()).await.unwrap();
    info(&channel, Duration::from_secs(20)).await.unwrap();
    daemon.signal("-STOP");
    let status = info(&channel, Duration::from_millis(300)).await.unwrap_err();
    assert!([Code::DeadlineExceeded, Code::Cancelled].contains(&status.code()), "{status:?}");
    daemon.signal("-CONT");
    let again = async { while info(&channel, Duration::from_secs(5)).await.is_err() {} };
    watched("an answer afterwards", again).await;
    assert_eq!(daemon.stopped().await.0, Some(0));
}
