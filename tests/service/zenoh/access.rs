//! Who may? With the files of `deploy/zenoh`, but for paths and addresses: certificates, what their names may do, passwords.

use std::path::{Path, PathBuf};
use std::time::Duration;

use clearance::app::DoorChoice;
use clearance::limits::Limits;
use clearance::transports::wire::v1;
use clearance::transports::zenoh::{BindError, Client, ClientError, Config};
use prost::Message;

use super::get_scene;
use crate::support::certificates::{Authority, Files, Signed};
use crate::support::daemon::{RunningDaemon, config};
use crate::support::messages::*;
use crate::support::watchdog::watched;

const PATIENCE: Duration = Duration::from_secs(10);
/// As in the files.
const PREFIX: &str = "clearance";
const DAEMON: &str = include_str!("../../../deploy/zenoh/daemon.json5");
const CLIENT: &str = include_str!("../../../deploy/zenoh/client.json5");

fn with(text: &str, changes: &[(&str, &str)]) -> String {
    changes.iter().fold(text.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    })
}

fn shown(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// A place with authorities for both sides.
struct Place {
    files: Files,
    servers: Authority,
    clients: Authority,
}

impl Place {
    fn new() -> Self {
        Self { files: Files::new(), servers: Authority::new("servers"), clients: Authority::new("clients") }
    }

    /// The daemon of `deploy/zenoh/daemon.json5`, with this certificate.
    async fn daemon(&self, server: &Signed) -> Result<(RunningDaemon, String), String> {
        let (certificate, key) = (self.files.put("s.pem", &server.certificate), self.files.put("s.key", &server.key));
        let ca = self.files.put("client_ca.pem", &self.clients.pem());
        let text = with(
            DAEMON,
            &[
                ("tls/0.0.0.0:50552", "tls/127.0.0.1:0"),
                ("/etc/clearance/client_ca.pem", shown(&ca)),
                ("/etc/clearance/certificate.pem", shown(&certificate)),
                ("/etc/clearance/key.pem", shown(&key)),
            ],
        );
        let file = self.files.put("daemon.json5", &text);
        started(file).await
    }

    /// A client of `deploy/zenoh/client.json5`, with this certificate.
    async fn client(&self, endpoint: &str, client: &Signed) -> Result<Client, ClientError> {
        let (certificate, key) = (self.files.put("c.pem", &client.certificate), self.files.put("c.key", &client.key));
        let ca = self.files.put("server_ca.pem", &self.servers.pem());
        let text = with(
            CLIENT,
            &[
                ("tls/daemon.example:50552", endpoint),
                ("/etc/clearance/server_ca.pem", shown(&ca)),
                ("/etc/clearance/planner.pem", shown(&certificate)),
                ("/etc/clearance/planner.key", shown(&key)),
            ],
        );
        let file = self.files.put("client.json5", &text);
        let config = zenoh::Config::from_file(file).unwrap();
        watched("connecting", Client::open(config, PREFIX)).await
    }
}

async fn started(file: PathBuf) -> Result<(RunningDaemon, String), String> {
    let mut config = config(Limits::default());
    let door = Config { file: Some(file), ..Config::on_loopback(PREFIX) };
    config.zenoh = DoorChoice::On(door);
    let daemon = RunningDaemon::start(&config).await;
    let endpoint = daemon.service.doors().last().unwrap().address.clone();
    Ok((daemon, endpoint))
}

async fn create(client: &Client) -> Result<(), ClientError> {
    let create = v1::CreateSceneRequest { name: SCENE.to_owned(), ..v1::CreateSceneRequest::default() };
    watched("an outcome", client.call("Scenes/CreateScene", create.encode_to_vec(), PATIENCE)).await.map(drop)
}

#[tokio::test(flavor = "multi_thread")]
async fn certificates_say_who_may_ask_and_who_may_change() {
    let place = Place::new();
    let (_daemon, endpoint) = place.daemon(&place.servers.server()).await.unwrap();
    let planner = place.client(&endpoint, &place.clients.client("planner")).await.unwrap();
    create(&planner).await.unwrap();
    let edits = apply(vec![add("ball 0", sphere(0.1), at(0.0, 0.0, 0.0))]).encode_to_vec();
    planner.call("Scenes/Apply", edits.clone(), PATIENCE).await.unwrap();
    let viewer = place.client(&endpoint, &place.clients.client("viewer")).await.unwrap();
    let contents = viewer.call("Scenes/GetScene", get_scene().encode_to_vec(), PATIENCE).await.unwrap();
    assert_eq!(v1::GetSceneResponse::decode(contents).unwrap().scene.unwrap().bodies.len(), 1);
    let mut follower = viewer.follow(SCENE).await.unwrap();
    watched("content", follower.next()).await.unwrap();
    // What is denied is not answered.
    let denied = viewer.call("Scenes/Apply", edits.clone(), Duration::from_secs(1)).await.unwrap_err();
    assert!(matches!(denied, ClientError::NoDaemon { .. } | ClientError::Timeout(_)), "{denied}");
    let pose = v1::Pose { translation: Some(vec3(7.0, 0.0, 0.0)), rotation: None }.encode_to_vec();
    let key = format!("{PREFIX}/v1/scene/{SCENE}/pose/body/ball%200");
    viewer.session().put(key.as_str(), pose.clone()).await.unwrap();
    // A name that no rule has may do nothing.
    let nobody = place.client(&endpoint, &place.clients.client("nobody")).await.unwrap();
    let denied = nobody.call("Server/GetServerInfo", [], Duration::from_secs(1)).await.unwrap_err();
    assert!(matches!(denied, ClientError::NoDaemon { .. } | ClientError::Timeout(_)), "{denied}");
    // The planner's put is the first that moves anything.
    planner.session().put(key.as_str(), pose).await.unwrap();
    let step = watched("a step", async {
        loop {
            let step = follower.next().await.unwrap();
            if !step.moved.is_empty() {
                return step;
            }
        }
    });
    assert_eq!(step.await.revision, 2);
}

#[tokio::test(flavor = "multi_thread")]
async fn strangers_and_the_expired_stay_outside() {
    let place = Place::new();
    let (_daemon, endpoint) = place.daemon(&place.servers.server()).await.unwrap();
    let stranger = Authority::new("strangers").client("planner");
    for (who, certificate) in [("a stranger", stranger), ("an expired one", place.clients.expired_client("planner"))] {
        // A session that opens has no connection: whoever is not let in reaches nobody.
        if let Ok(client) = place.client(&endpoint, &certificate).await {
            let outcome = watched("an outcome", client.call("Server/GetServerInfo", [], Duration::from_secs(1))).await;
            assert!(
                matches!(outcome, Err(ClientError::NoDaemon { .. } | ClientError::Timeout(_))),
                "{who}: {outcome:?}"
            );
        }
    }
    assert!(Client::connect(&endpoint.replace("tls/", "tcp/"), PREFIX).await.is_err(), "without TLS");
}

#[tokio::test(flavor = "multi_thread")]
async fn a_daemon_with_an_expired_certificate_is_not_believed() {
    let place = Place::new();
    let (_daemon, endpoint) = place.daemon(&place.servers.expired_server()).await.unwrap();
    if let Ok(client) = place.client(&endpoint, &place.clients.client("planner")).await {
        let outcome = watched("an outcome", client.call("Server/GetServerInfo", [], Duration::from_secs(1))).await;
        assert!(matches!(outcome, Err(ClientError::NoDaemon { .. } | ClientError::Timeout(_))), "{outcome:?}");
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn passwords_are_asked_for_where_a_file_has_them() {
    let files = Files::new();
    let passwords = files.put("passwords", "planner:secret\n");
    let text = format!(
        "{{ mode: 'peer', transport: {{ auth: {{ usrpwd: {{ user: 'daemon', password: 'own', dictionary_file: '{}' }} }} }} }}",
        passwords.display()
    );
    let (_daemon, endpoint) = started(files.put("daemon.json5", &text)).await.unwrap();
    let client = async |user: &str, password: &str| {
        let text = format!(
            "{{ mode: 'client', connect: {{ endpoints: ['{endpoint}'] }}, scouting: {{ multicast: {{ enabled: false }} }},
                transport: {{ auth: {{ usrpwd: {{ user: '{user}', password: '{password}' }} }} }} }}"
        );
        let config = zenoh::Config::from_json5(&text).unwrap();
        let client = watched("connecting", Client::open(config, PREFIX)).await?;
        watched("an outcome", client.call("Server/GetServerInfo", [], Duration::from_secs(1))).await.map(drop)
    };
    client("planner", "secret").await.unwrap();
    assert!(client("planner", "guess").await.is_err());
    assert!(client("stranger", "secret").await.is_err());
    assert!(Client::connect(&endpoint, PREFIX).await.is_err());
}

#[tokio::test(flavor = "multi_thread")]
async fn a_place_that_is_taken_or_open_to_strangers_is_an_error() {
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let service = clearance::service::Service::new(&clearance::service::Config::default()).unwrap();
    let at = |endpoint: String| Config { listen: Some(vec![endpoint]), ..Config::on_loopback(PREFIX) };
    let error = at(format!("tcp/{}", taken.local_addr().unwrap())).bind(&service).await.unwrap_err();
    assert!(matches!(error, BindError::System(_)), "{error}");
    let error = at("tcp/0.0.0.0:0".to_owned()).bind(&service).await.unwrap_err();
    assert!(matches!(error, BindError::Config(_)), "{error}");
}
