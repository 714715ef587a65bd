//! The daemon's life: doors are opened, then served, then drained.

use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;

use tokio::runtime::Handle;
use tokio::sync::watch;
use tokio::task::{JoinError, JoinSet};

use super::Config;
use super::observing;
use crate::service::{Door, Service};
#[cfg(feature = "grpc")]
use crate::transports::grpc;
#[cfg(feature = "shared-memory")]
use crate::transports::shared_memory;
#[cfg(feature = "zenoh")]
use crate::transports::zenoh as zenoh_door;

/// A daemon whose doors are open and not served yet.
#[derive(Debug)]
pub struct Daemon {
    service: Arc<Service>,
    doors: Doors,
    drain: Duration,
    #[cfg(feature = "metrics")]
    metrics: Option<observing::Metrics>,
}

/// The doors this program was built with.
#[derive(Debug)]
struct Doors {
    #[cfg(feature = "grpc")]
    grpc: grpc::Listening,
    #[cfg(feature = "shared-memory")]
    shared_memory: Option<shared_memory::Listening>,
    #[cfg(feature = "zenoh")]
    zenoh: Option<zenoh_door::Listening>,
}

/// Why a daemon did not begin.
#[derive(Debug, thiserror::Error)]
pub enum StartError {
    /// The system gives no threads.
    #[error("cannot start threads: {0}")]
    Threads(String),
    /// The metrics endpoint cannot be opened.
    #[cfg(feature = "metrics")]
    #[error(transparent)]
    Metrics(#[from] crate::observability::EndpointError),
    /// A door cannot be opened.
    #[cfg(feature = "grpc")]
    #[error(transparent)]
    Grpc(#[from] grpc::BindError),
    /// A door cannot be opened.
    #[cfg(feature = "shared-memory")]
    #[error(transparent)]
    SharedMemory(#[from] shared_memory::BindError),
    /// A door cannot be opened.
    #[cfg(feature = "zenoh")]
    #[error(transparent)]
    Zenoh(#[from] zenoh_door::BindError),
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
        #[cfg_attr(not(feature = "metrics"), allow(unused_mut, reason = "metrics observe, too"))]
        let mut observers = observing::observers(config);
        #[cfg(feature = "metrics")]
        let mut metrics = observing::Metrics::open(config).await?;
        #[cfg(feature = "metrics")]
        observers.extend(metrics.as_mut().map(observing::call_metrics));
        let service = Service::observed(&config.service, observers);
        let service = service.map_err(|error| StartError::Threads(error.to_string()))?;
        let doors = Doors::open(config, &service).await?;
        doors.list().into_iter().for_each(|door| service.add_door(door));
        Ok(Self {
            service,
            doors,
            drain: config.drain,
            #[cfg(feature = "metrics")]
            metrics,
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

    /// Where metrics are told, if they are.
    #[must_use]
    pub fn metrics_address(&self) -> Option<SocketAddr> {
        #[cfg(feature = "metrics")]
        return self.metrics.as_ref().map(|metrics| metrics.endpoint.address());
        #[cfg(not(feature = "metrics"))]
        None
    }

    /// Serves until `stop` comes. Then nothing new is taken, and what is under way has the configured time to end.
    ///
    /// # Errors
    /// A door closed by itself.
    pub async fn run(self, stop: impl Future<Output = ()>) -> Result<Drained, RunError> {
        // Its tasks end with this function: nobody waits for those who look at metrics.
        #[cfg(feature = "metrics")]
        let mut watched = JoinSet::new();
        #[cfg(feature = "metrics")]
        if let Some(metrics) = self.metrics {
            watched.spawn(metrics.endpoint.serve(Arc::clone(&self.service), metrics.registry));
        }
        let (drain, told_to_drain) = watch::channel(false);
        // On handles of our own, here and below: a runtime that ends drops a new task at once, and what zenoh does then panics while
        // the plain `spawn` looks at the current handle.
        let mut serving = Handle::current().spawn(self.doors.serve(Arc::clone(&self.service), told_to_drain));
        tokio::select! {
            ended = &mut serving => return Err(closed(ended)),
            () = stop => {}
        }
        tracing::info!(seconds = self.drain.as_secs(), "draining");
        self.service.begin_drain();
        drain.send_replace(true);
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
    async fn open(
        #[allow(unused_variables, reason = "there may be no door")] config: &Config,
        #[allow(unused_variables, reason = "there may be no door that needs it")] service: &Arc<Service>,
    ) -> Result<Self, StartError> {
        Ok(Self {
            #[cfg(feature = "grpc")]
            grpc: config.grpc.bind().await?,
            #[cfg(feature = "shared-memory")]
            shared_memory: shared_memory_door(config).await?,
            #[cfg(feature = "zenoh")]
            zenoh: config.zenoh.open("zenoh", async |door| door.bind(service).await).await?,
        })
    }

    fn list(&self) -> Vec<Door> {
        let doors: Vec<Option<Door>> = vec![
            #[cfg(feature = "grpc")]
            Some(self.grpc.door()),
            #[cfg(feature = "shared-memory")]
            self.shared_memory.as_ref().map(shared_memory::Listening::door),
            #[cfg(feature = "zenoh")]
            self.zenoh.as_ref().map(zenoh_door::Listening::door),
        ];
        doors.into_iter().flatten().collect()
    }

    /// Serves every door until it is told to drain, then until what is under way is answered.
    async fn serve(
        self,
        #[allow(unused_variables, reason = "there may be no door")] service: Arc<Service>,
        mut told_to_drain: watch::Receiver<bool>,
    ) -> Result<(), RunError> {
        let mut serving: JoinSet<Result<(), RunError>> = JoinSet::new();
        #[cfg(feature = "grpc")]
        {
            let served = self.grpc.serve(Arc::clone(&service), drained(told_to_drain.clone()));
            serving.spawn(async { served.await.map_err(|error| RunError::of("grpc", &error)) });
        }
        #[cfg(feature = "shared-memory")]
        if let Some(shared_memory) = self.shared_memory {
            let served = shared_memory.serve(Arc::clone(&service), drained(told_to_drain.clone()));
            serving.spawn(async { served.await.map_err(|error| RunError::of("shared-memory", &error)) });
        }
        #[cfg(feature = "zenoh")]
        if let Some(zenoh) = self.zenoh {
            let served = zenoh.serve(drained(told_to_drain.clone()));
            let served = async { served.await.map_err(|error| RunError::of("zenoh", &error)) };
            serving.spawn_on(served, &Handle::current());
        }
        if serving.is_empty() {
            drained(told_to_drain.clone()).await;
        }
        while let Some(ended) = serving.join_next().await {
            ended.map_err(|error| RunError::of("last", &error))??;
            if !*told_to_drain.borrow_and_update() {
                return Err(RunError::of("first", &"no reason given"));
            }
        }
        Ok(())
    }
}

/// Opening it takes memory, which may take its time.
#[cfg(feature = "shared-memory")]
async fn shared_memory_door(config: &Config) -> Result<Option<shared_memory::Listening>, StartError> {
    let open = async |door: &shared_memory::Config| -> Result<_, StartError> {
        let (door, limits) = (door.clone(), config.service.limits.clone());
        let opened = tokio::task::spawn_blocking(move || door.bind(&limits)).await;
        Ok(opened.map_err(|error| StartError::Threads(error.to_string()))??)
    };
    config.shared_memory.open("shared-memory", open).await
}

/// Comes when it is time to drain. A sender that is gone means the same as one that speaks.
async fn drained(mut told: watch::Receiver<bool>) {
    let _ = told.wait_for(|told| *told).await;
}

impl RunError {
    fn of(door: &'static str, problem: &dyn std::fmt::Display) -> Self {
        Self::Closed { door, problem: problem.to_string() }
    }
}

/// What to say of doors that closed before they were told to.
fn closed(ended: Result<Result<(), RunError>, JoinError>) -> RunError {
    match ended {
        Ok(Ok(())) => RunError::of("last", &"no reason given"),
        Ok(Err(error)) => error,
        Err(error) => RunError::of("last", &error),
    }
}
