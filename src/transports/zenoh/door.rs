//! How long is the door open? It opens a session of zenoh, answers, and leaves the network when the daemon drains.

use std::sync::Arc;

use zenoh::Session;
use zenoh::config::Locator;
use zenoh::query::Queryable;

use super::callers::token;
use super::calls::Desk;
use super::changes::Scenes;
use super::config::{BadConfig, Config};
use super::poses::Poses;
use crate::service::{Door, Service};

/// What the door is called.
pub(super) const DOOR: &str = "zenoh";

/// Why the door cannot be opened.
#[derive(Debug, thiserror::Error)]
pub enum BindError {
    /// The configuration cannot be.
    #[error(transparent)]
    Config(#[from] BadConfig),
    /// zenoh or the system refuses, for example an address that is taken.
    #[error("zenoh: {0}")]
    System(String),
}

/// An open door. Calls are answered already, and puts of poses wait: zenoh would not let anybody wait in front of it.
#[derive(Debug)]
pub struct Listening {
    address: String,
    alive: String,
    desk: Arc<Desk>,
    // The order of the fields is the order in which they are closed.
    calls: Queryable<()>,
    poses: Poses,
    session: Session,
}

impl Config {
    /// Opens the door.
    ///
    /// # Errors
    /// [`BindError`].
    pub async fn bind(&self, service: &Arc<Service>) -> Result<Listening, BindError> {
        let (keys, config) = (self.keys()?, self.of_zenoh(service.limits())?);
        let session = zenoh::open(config).await.map_err(system)?;
        let listens: Vec<String> = session.info().locators().await.iter().map(Locator::to_string).collect();
        let connects = self.connect.clone().unwrap_or_default();
        let address = if listens.is_empty() { connects } else { listens }.join(",");
        let desk = Desk::new(&session, service, &keys).await.map_err(system)?;
        let calls = desk.open(&session).await.map_err(system)?;
        let poses = Poses::new(&session, &desk).await.map_err(system)?;
        Ok(Listening { address, alive: keys.alive(), desk, calls, poses, session })
    }
}

fn system(error: zenoh::Error) -> BindError {
    BindError::System(error.to_string())
}

impl Listening {
    /// The door as the service lists it: where to connect, or, if it does not listen, the routers it is connected to.
    #[must_use]
    pub fn door(&self) -> Door {
        Door { kind: DOOR, address: self.address.clone() }
    }

    /// Serves until `drain` comes, then answers what is under way and closes.
    ///
    /// # Errors
    /// zenoh refuses a declaration.
    pub async fn serve(self, drain: impl Future<Output = ()> + Send) -> Result<(), String> {
        let Self { alive, desk, calls, poses, session, .. } = self;
        let told = |error: zenoh::Error| error.to_string();
        let scenes = Scenes::new(&session, &desk);
        let alive = token(&session, alive).await.map_err(told)?;
        tokio::select! {
            () = async { tokio::join!(poses.run(), scenes.run()); } => return Err("the session was closed".to_owned()),
            () = drain => {}
        }
        // Whoever looks for a daemon looks for another one now. Calls are refused by the service, and told so.
        alive.undeclare().await.map_err(told)?;
        desk.idle().await;
        calls.undeclare().await.map_err(told)?;
        session.close().await.map_err(told)
    }
}
