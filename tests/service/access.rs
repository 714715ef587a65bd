//! Who may ask: certificates on both sides, tokens and what they allow. Clients that are not let in get a clear error, and
//! the daemon goes on.

use std::time::Duration;

use clearance::app::{Config, Drained};
use clearance::limits::Limits;
use clearance::transports::grpc::{Client, ClientError, Credentials, Scope, Secret, TlsFiles, TokenSource};
use clearance::transports::wire::v1;
use clearance::transports::wire::v1::scenes_client::ScenesClient;
use tonic::transport::Channel;
use tonic::{Code, Request};
use tonic_health::pb::HealthCheckRequest;
use tonic_health::pb::health_client::HealthClient;
use tonic_reflection::pb::v1::ServerReflectionRequest;
use tonic_reflection::pb::v1::server_reflection_client::ServerReflectionClient;

use crate::support::certificates::{Authority, Files, trusting};
use crate::support::daemon::{RunningDaemon, config};
use crate::support::door::Refusal;
use crate::support::watchdog::watched;

const READER: &str = "a-token-that-only-reads";
const WRITER: &str = "a-token-that-does-both";

fn with_tls(tls: TlsFiles) -> Config {
    let mut config = config(Limits::default());
    config.grpc.tls = Some(tls);
    config
}

/// A reader and a writer, known by their files.
fn with_tokens(files: &Files, config: &mut Config) {
    let token = |name: &str, text: &str, scopes: &[Scope]| TokenSource {
        name: name.to_owned(),
        secret: Secret::File(files.put(name, &format!("{text}\n"))),
        scopes: scopes.to_vec(),
    };
    config.grpc.tokens =
        vec![token("reader", READER, &[Scope::Read]), token("writer", WRITER, &[Scope::Read, Scope::Write])];
}

fn showing(token: &str) -> Credentials {
    Credentials { token: Some(token.to_owned()), ..Credentials::default() }
}

async fn asked(address: &str, credentials: &Credentials) -> Result<String, ClientError> {
    let ask = async {
        let client = Client::connect_as(address, credentials).await?;
        Ok(client.server_info().await?.version)
    };
    watched("an answer", ask).await
}

fn refused(error: ClientError) -> (Code, String) {
    let ClientError::Refused(refusal) = error else { panic!("not refused: {error}") };
    (refusal.code, refusal.reason)
}

#[tokio::test(flavor = "multi_thread")]
async fn tls_lets_in_who_trusts_the_daemons_certificate() {
    let (ca, other, files) = (Authority::new("ours"), Authority::new("theirs"), Files::new());
    let daemon = RunningDaemon::start(&with_tls(files.tls(&ca.server(), None))).await;
    let address = format!("https://{}", daemon.address);
    assert_eq!(asked(&address, &trusting(&ca)).await.unwrap(), env!("CARGO_PKG_VERSION"));
    // A bare address means TLS where there is a CA.
    assert!(asked(&daemon.address, &trusting(&ca)).await.is_ok());
    assert!(matches!(asked(&address, &trusting(&other)).await, Err(ClientError::Unreachable { .. })));
    // The system does not trust it, and without TLS nothing is understood.
    assert!(asked(&address, &Credentials::default()).await.is_err());
    assert!(asked(&daemon.address, &Credentials::default()).await.is_err());
    assert!(asked(&address, &trusting(&ca)).await.is_ok());
    assert_eq!(daemon.stop().await, Drained::Clean);
}

#[tokio::test(flavor = "multi_thread")]
async fn an_expired_certificate_does_not_keep_the_daemon_down_and_clients_refuse_it() {
    let (ca, files) = (Authority::new("ours"), Files::new());
    let daemon = RunningDaemon::start(&with_tls(files.tls(&ca.expired_server(), None))).await;
    let error = asked(&format!("https://{}", daemon.address), &trusting(&ca)).await.unwrap_err();
    assert!(matches!(error, ClientError::Unreachable { .. }), "{error}");
    assert!(chain(&error).contains("expired"), "{}", chain(&error));
    assert_eq!(daemon.stop().await, Drained::Clean);
}

fn chain(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut source = error.source();
    while let Some(error) = source {
        text.push_str(&format!(": {error:?}"));
        source = error.source();
    }
    text.to_lowercase()
}

#[tokio::test(flavor = "multi_thread")]
async fn with_a_client_ca_only_its_clients_come_in() {
    let (ours, clients, other, files) =
        (Authority::new("ours"), Authority::new("clients"), Authority::new("theirs"), Files::new());
    let daemon = RunningDaemon::start(&with_tls(files.tls(&ours.server(), Some(&clients)))).await;
    let address = format!("https://{}", daemon.address);
    let with = |identity| Credentials { identity, ..trusting(&ours) };
    for stranger in [None, Some(other.client("planner").identity()), Some(clients.expired_client("planner").identity())]
    {
        let error = asked(&address, &with(stranger)).await.unwrap_err();
        // TLS 1.3 tells a client only after its part of the handshake is done, so the first call may fail instead.
        let told = matches!(&error, ClientError::Unreachable { .. })
            || error.refusal().is_some_and(|refusal| {
                matches!(refusal.code, Code::Unavailable | Code::Unknown | Code::Internal | Code::Cancelled)
            });
        assert!(told, "{error:?}");
    }
    let known = with(Some(clients.client("planner").identity()));
    let client = watched("connecting", Client::connect_as(&address, &known)).await.unwrap();
    // Without tokens, whom the CA knows may do everything.
    watched("a scene", client.create_scene("cell")).await.unwrap();
    assert_eq!(daemon.stop().await, Drained::Clean);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_token_allows_what_its_scopes_say_and_no_more() {
    let files = Files::new();
    let mut config = config(Limits::default());
    with_tokens(&files, &mut config);
    let daemon = RunningDaemon::start(&config).await;
    let told = async |credentials: &Credentials| refused(asked(&daemon.address, credentials).await.unwrap_err());
    let no_token = (Code::Unauthenticated, "NO_TOKEN".to_owned());
    let unknown = (Code::Unauthenticated, "UNKNOWN_TOKEN".to_owned());
    assert_eq!(told(&Credentials::default()).await, no_token);
    assert_eq!(told(&showing("a-token-that-only-read")).await, unknown);
    assert_eq!(told(&showing("")).await, unknown);
    let bad = asked(&daemon.address, &showing("line\nbreak")).await;
    assert!(matches!(bad, Err(ClientError::BadToken)));

    let reader = Client::connect_as(&daemon.address, &showing(READER)).await.unwrap();
    assert!(reader.server_info().await.is_ok());
    let missing = refused(watched("a refusal", reader.create_scene("cell")).await.unwrap_err());
    assert_eq!(missing, (Code::PermissionDenied, "MISSING_SCOPE".to_owned()));
    let writer = Client::connect_as(&daemon.address, &showing(WRITER)).await.unwrap();
    watched("a scene", writer.create_scene("cell")).await.unwrap();
    assert!(reader.server_info().await.is_ok(), "a refusal changes nothing for what is allowed");
    assert_eq!(daemon.service.scenes().len(), 1);
}

#[tokio::test(flavor = "multi_thread")]
async fn without_a_token_only_health_is_open() {
    let files = Files::new();
    let mut config = config(Limits::default());
    with_tokens(&files, &mut config);
    let daemon = RunningDaemon::start(&config).await;
    let channel = Channel::from_shared(format!("http://{}", daemon.address)).unwrap().connect().await.unwrap();
    let request = HealthCheckRequest { service: String::new() };
    let health = watched("health", HealthClient::new(channel.clone()).check(request)).await.unwrap().into_inner();
    assert_eq!(health.status, 1);
    let request = tokio_stream::once(ServerReflectionRequest::default());
    let told =
        watched("reflection", ServerReflectionClient::new(channel.clone()).server_reflection_info(request)).await;
    assert_eq!(Refusal::from(told.unwrap_err()).reason, "NO_TOKEN");
    // The text says what is wanted.
    let told = watched("a refusal", ScenesClient::new(channel).list_scenes(v1::ListScenesRequest {})).await;
    let status = told.unwrap_err();
    assert!(status.message().contains("authorization: Bearer"), "{status:?}");
}

#[tokio::test(flavor = "multi_thread")]
async fn certificate_and_token_are_both_wanted_where_both_are_configured() {
    let (ours, files) = (Authority::new("ours"), Files::new());
    let mut config = with_tls(files.tls(&ours.server(), Some(&ours)));
    with_tokens(&files, &mut config);
    let daemon = RunningDaemon::start(&config).await;
    let identity = Some(ours.client("planner").identity());
    let certificate = Credentials { identity: identity.clone(), ..trusting(&ours) };
    assert_eq!(refused(asked(&daemon.address, &certificate).await.unwrap_err()).1, "NO_TOKEN");
    let token = Credentials { token: Some(READER.to_owned()), ..trusting(&ours) };
    assert!(asked(&daemon.address, &token).await.is_err());
    let both = Credentials { token: Some(READER.to_owned()), ..certificate };
    assert!(asked(&daemon.address, &both).await.is_ok());
}

#[tokio::test(flavor = "multi_thread")]
async fn a_token_on_a_connection_that_was_open_before_is_looked_at_call_by_call() {
    let files = Files::new();
    let mut config = config(Limits::default());
    with_tokens(&files, &mut config);
    let daemon = RunningDaemon::start(&config).await;
    let channel = Channel::from_shared(format!("http://{}", daemon.address)).unwrap().connect().await.unwrap();
    let mut scenes = ScenesClient::new(channel);
    let mut told = Vec::new();
    for token in [None, Some(WRITER), Some("another-token-altogether"), Some(READER)] {
        let mut request = Request::new(v1::ListScenesRequest {});
        request.set_timeout(Duration::from_secs(30));
        if let Some(token) = token {
            request.metadata_mut().insert("authorization", format!("bearer {token}").parse().unwrap());
        }
        told.push(watched("an answer", scenes.list_scenes(request)).await.is_ok());
    }
    assert_eq!(told, [false, true, false, true]);
}
