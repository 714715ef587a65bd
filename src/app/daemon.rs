//! The daemon's life: doors are opened, then served, then drained.

use std::sync::Arc;
use std::time::Duration;

use tokio::sync::oneshot;
use tokio::task::JoinError;

use super::Config;
use crate::service::{Door, Service};
#[cfg(feature = "grpc")]
use crate::transports::grpc;

/// A daemon whose doors are open and not served yet.
#[derive(Debug)]
pub struct Daemon {
    service: Arc<Service>,
    doors: Doors,
    drain: Duration,
}

/// The doors this program was built with.
#[derive(Debug)]
struct Doors {
    #[cfg(feature = "grpc")]
    grpc: grpc::Listening,
}

/// Why a daemon did not begin.
#[derive(Debug, thiserror::Error)]
pub enum StartError {
    /// The system gives no threads.
    #[error("cannot start threads: {0}")]
    Threads(String),
    /// A door cannot be opened.
    #[cfg(feature = "grpc")]
    #[error(transparent)]
    Grpc(#[from] grpc::BindError),
}

/// Why a daemon ended by itself.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// A door closed without being told to.
    #[error("the {door} door closed: {problem}")]
    Closed {
        /// Which.
        door: &'static str,
        /// Why.
        problem: String,
    },
}

/// How a daemon ended when it was told to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drained {
    /// Everything under way was answered.
    Clean,
    /// Time ran out first.
    Late,
}

impl Daemon {
    /// Makes the service and opens the doors.
    ///
    /// # Errors
    /// [`StartError`].
    pub async fn build(config: &Config) -> Result<Self, StartError> {
        let service = Service::new(&config.service).map_err(|error| StartError::Threads(error.to_string()))?;
        let doors = Doors::open(config).await?;
        doors.list().into_iter().for_each(|door| service.add_door(door));
        Ok(Self { service, doors, drain: config.drain })
    }

    /// What stands behind the doors.
    #[must_use]
    pub fn service(&self) -> &Arc<Service> {
        &self.service
    }

    /// The open doors.
    #[must_use]
    pub fn doors(&self) -> Vec<Door> {
        self.service.doors()
    }

    /// Serves until `stop` comes. Then nothing new is taken, and what is under way has the configured time to end.
    ///
    /// # Errors
    /// A door closed by itself.
    pub async fn run(self, stop: impl Future<Output = ()>) -> Result<Drained, RunError> {
        let (drain, told_to_drain) = oneshot::channel::<()>();
        // A sender that is gone means the same as one that speaks.
        let told_to_drain = async { told_to_drain.await.unwrap_or_default() };
        let mut serving = tokio::spawn(self.doors.serve(Arc::clone(&self.service), told_to_drain));
        tokio::select! {
            ended = &mut serving => return Err(closed(ended)),
            () = stop => {}
        }
        tracing::info!(seconds = self.drain.as_secs(), "draining");
        self.service.begin_drain();
        drop(drain);
        match tokio::time::timeout(self.drain, &mut serving).await {
            Ok(Ok(Ok(()))) => Ok(Drained::Clean),
            Ok(ended) => Err(closed(ended)),
            Err(_) => {
                serving.abort();
                Ok(Drained::Late)
            }
        }
    }
}

impl Doors {
    #[cfg(feature = "grpc")]
    async fn open(config: &Config) -> Result<Self, StartError> {
        Ok(Self { grpc: config.grpc.bind().await? })
    }

    #[cfg(feature = "grpc")]
    fn list(&self) -> Vec<Door> {
        vec![self.grpc.door()]
    }

    /// Serves every door until `drain` comes, then until what is under way is answered.
    #[cfg(feature = "grpc")]
    async fn serve(
        self,
        service: Arc<Service>,
        drain: impl Future<Output = ()> + Send + 'static,
    ) -> Result<(), RunError> {
        let served = self.grpc.serve(service, drain).await;
        served.map_err(|error| RunError::Closed { door: "grpc", problem: error.to_string() })
    }
}

/// A program built without doors: nobody can ask, and nothing can go wrong.
#[cfg(not(feature = "grpc"))]
impl Doors {
    async fn open(_config: &Config) -> Result<Self, StartError> {
        Ok(Self {})
    }

    fn list(&self) -> Vec<Door> {
        Vec::new()
    }

    async fn serve(
        self,
        _service: Arc<Service>,
        drain: impl Future<Output = ()> + Send + 'static,
    ) -> Result<(), RunError> {
        drain.await;
        Ok(())
    }
}

/// What to say of doors that closed before they were told to.
fn closed(ended: Result<Result<(), RunError>, JoinError>) -> RunError {
    match ended {
        Ok(Ok(())) => RunError::Closed { door: "last", problem: "no reason given".to_owned() },
        Ok(Err(error)) => error,
        Err(error) => RunError::Closed { door: "last", problem: error.to_string() },
    }
}
