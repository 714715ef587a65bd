//! How long is the door open? It opens a session of zenoh, answers, and leaves the network when the daemon drains.

use std::sync::Arc;

use zenoh::Session;
use zenoh::config::Locator;

use super::calls::Desk;
use super::callers::token;
use super::changes::Scenes;
use super::config::{BadConfig, Config};
use super::keys::Keys;
use super::poses::Poses;
use crate::limits::Limits;
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

/// An open door that nobody serves yet.
#[derive(Debug)]
pub struct Listening {
    session: Session,
    keys: Keys,
    address: String,
}

impl Config {
    /// Opens the door. Calls are answered from [`Listening::serve`] on.
    ///
    /// # Errors
    /// [`BindError`].
    pub async fn bind(&self, limits: &Limits) -> Result<Listening, BindError> {
        let (keys, config) = (self.keys()?, self.of_zenoh(limits)?);
        let session = zenoh::open(config).await.map_err(system)?;
        let listens: Vec<String> = session.info().locators().await.iter().map(Locator::to_string).collect();
        let connects = self.connect.clone().unwrap_or_default();
        let address = if listens.is_empty() { connects } else { listens }.join(",");
        Ok(Listening { session, keys, address })
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
    pub async fn serve(self, service: Arc<Service>, drain: impl Future<Output = ()> + Send) -> Result<(), String> {
        let Self { session, keys, .. } = self;
        let told = |error: zenoh::Error| error.to_string();
        let desk = Desk::new(&session, &service, &keys).await.map_err(told)?;
        let calls = desk.open(&session).await.map_err(told)?;
        let poses = Poses::new(&session, &desk).await.map_err(told)?;
        let scenes = Scenes::new(&session, &desk);
        let alive = token(&session, keys.alive()).await.map_err(told)?;
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
