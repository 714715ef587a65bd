//! A daemon with both doors, whose shared memory has a name and a folder of its own.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use clearance::app::DoorChoice;
use clearance::limits::Limits;
use clearance::query::{CheckStates, Context, Mode};
use clearance::service::{RevisionRule, Rule, Target};
use clearance::transports::shared_memory::{Ask, Client, ClientError, Config, Options, Refusal, Reply};
use clearance::transports::wire::v1::queries_client::QueriesClient;
use tempfile::TempDir;
use tonic::transport::Channel;

use crate::support::daemon::{RunningDaemon, config};
use crate::support::door::{Door, InProcess};
use crate::support::messages::*;
pub use crate::support::shared_memory_door::{Name, unused_name};
use crate::support::watchdog::watched;

pub struct Place {
    pub daemon: RunningDaemon,
    pub inside: InProcess,
    pub queries: QueriesClient<Channel>,
    pub name: Name,
    pub root: TempDir,
}

/// Little memory, so that many tests can run beside one another.
pub fn small() -> Limits {
    Limits {
        max_shared_memory_clients: 2,
        max_shared_memory_request_bytes: 1 << 20,
        max_shared_memory_response_bytes: 1 << 20,
        ..Limits::default()
    }
}

impl Place {
    pub async fn open(limits: Limits) -> Self {
        let (name, root) = (unused_name(), tempfile::tempdir().unwrap());
        let door = Config { name: name.to_string(), root: root.path().to_owned(), spin: Duration::ZERO };
        let mut config = config(limits);
        config.shared_memory = DoorChoice::On(door);
        let daemon = watched("the start of a daemon", RunningDaemon::start(&config)).await;
        let queries = QueriesClient::connect(format!("http://{}", daemon.address)).await.unwrap();
        let inside = InProcess { service: Arc::clone(&daemon.service) };
        Self { daemon, inside, queries, name, root }
    }

    /// With a crane whose hook can reach a block, a ball beside it, and a body that is out of the way.
    pub async fn with_crane(limits: Limits) -> Self {
        let place = Self::open(limits).await;
        let robot = place.inside.load_robot(load(ROBOT)).await.unwrap();
        place.inside.create_scene(SCENE).await.unwrap();
        let edits = vec![
            add_robot("arm", &robot.id),
            add("block", cuboid(0.2, 0.2, 0.2), at(1.0, 0.0, -1.0)),
            add("ball", sphere(0.1), at(1.0, 0.5, -0.9)),
            add("far", sphere(0.5), at(0.0, -4.0, 0.0)),
        ];
        place.inside.apply(apply(edits)).await.unwrap();
        place
    }

    pub fn root(&self) -> PathBuf {
        self.root.path().to_owned()
    }

    pub fn client(&self) -> Client {
        connect(&self.name, &self.root()).unwrap()
    }
}

/// A connection, from a thread that may block.
pub fn connect(name: &str, root: &std::path::Path) -> Result<Client, ClientError> {
    tokio::task::block_in_place(|| Client::connect(name, root))
}

pub fn ask(client: &mut Client, question: Ask<'_>, options: &Options) -> Result<Reply, ClientError> {
    tokio::task::block_in_place(|| client.ask(&target(), question, options))
}

pub fn target() -> Target {
    Target { scene: SCENE.to_owned(), revision: RevisionRule::default() }
}

pub fn exactly(revision: u64) -> Target {
    let rule = Rule::Exactly(clearance::scene::Revision(revision));
    Target { scene: SCENE.to_owned(), revision: RevisionRule { epoch: None, rule } }
}

pub fn at_least(revision: u64) -> Target {
    let rule = Rule::AtLeast(clearance::scene::Revision(revision));
    Target { scene: SCENE.to_owned(), revision: RevisionRule { epoch: None, rule } }
}

pub fn crane_states(positions: Vec<f64>, context: Context) -> CheckStates {
    CheckStates { robot: "arm".to_owned(), positions, mode: Mode::All, context }
}

/// The refusal that an error is.
pub fn refusal(answer: Result<Reply, ClientError>) -> Refusal {
    match answer {
        Err(ClientError::Refused(refusal)) => refusal,
        other => panic!("no refusal: {other:?}"),
    }
}
