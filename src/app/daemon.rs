//! The daemon's life: doors are opened, then served, then drained.

use std::sync::Arc;
use std::time::Duration;

use tokio::sync::oneshot;

use super::Config;
use crate::service::{Door, Service};
#[cfg(feature = "grpc")]
use crate::transports::grpc;

/// A daemon whose doors are open and not served yet.
#[derive(Debug)]
pub struct Daemon {
    service: Arc<Service>,
    #[cfg(feature = "grpc")]
    grpc: grpc::Listening,
    drain: Duration,
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
        #[cfg(feature = "grpc")]
        let grpc = config.grpc.bind().await?;
        #[cfg(feature = "grpc")]
        service.add_door(grpc.door());
        Ok(Self {
            service,
            #[cfg(feature = "grpc")]
            grpc,
            drain: config.drain,
        })
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
    #[cfg(feature = "grpc")]
    pub async fn run(self, stop: impl Future<Output = ()>) -> Result<Drained, RunError> {
        let (drain, told_to_drain) = oneshot::channel();
        let serving = self.grpc.serve(Arc::clone(&self.service), async { told_to_drain.await.unwrap_or_default() });
        let mut serving = tokio::spawn(serving);
        tokio::select! {
            ended = &mut serving => return Err(closed(ended)),
            () = stop => {}
        }
        tracing::info!(seconds = self.drain.as_secs(), "draining");
        self.service.begin_drain();
        // The door may have closed by itself meanwhile; then there is nobody to tell.
        let _ = drain.send(());
        match tokio::time::timeout(self.drain, &mut serving).await {
            Ok(Ok(Ok(()))) => Ok(Drained::Clean),
            Ok(ended) => Err(closed(ended)),
            Err(_) => {
                serving.abort();
                Ok(Drained::Late)
            }
        }
    }

    /// A daemon built without doors has nothing to serve; it waits to be told to end.
    ///
    /// # Errors
    /// None.
    #[cfg(not(feature = "grpc"))]
    pub async fn run(self, stop: impl Future<Output = ()>) -> Result<Drained, RunError> {
        stop.await;
        Ok(Drained::Clean)
    }
}

/// What to say of a door that ended by itself.
#[cfg(feature = "grpc")]
fn closed<E: std::error::Error>(ended: Result<Result<(), E>, tokio::task::JoinError>) -> RunError {
    let problem = match ended {
        Ok(Ok(())) => "no reason given".to_owned(),
        Ok(Err(error)) => error.to_string(),
        Err(error) => error.to_string(),
    };
    RunError::Closed { door: "grpc", problem }
}
