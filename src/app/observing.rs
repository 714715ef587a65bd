//! What is told of the daemon, and to whom? Puts together who observes the service, as far as configuration asks for it: what
//! nobody asked for does not exist, and costs nothing.

use super::Config;
use crate::observability::{CallLog, SlowQueries, TARGET};
#[cfg(feature = "metrics")]
use crate::observability::{CallMetrics, Endpoint, EndpointError};
use crate::service::Observer;

/// The metrics endpoint, open and not served yet, and what it tells of calls.
#[cfg(feature = "metrics")]
#[derive(Debug)]
pub(super) struct Metrics {
    pub endpoint: Endpoint,
    pub registry: prometheus_client::registry::Registry,
}

#[cfg(feature = "metrics")]
impl Metrics {
    /// Opens the endpoint, where there is to be one.
    ///
    /// # Errors
    /// It cannot be opened.
    pub async fn open(config: &Config) -> Result<Option<Self>, EndpointError> {
        let Some(metrics) = &config.metrics else { return Ok(None) };
        Ok(Some(Self { endpoint: metrics.bind().await?, registry: Default::default() }))
    }
}

/// Those who are told of calls, but for metrics.
pub(super) fn observers(config: &Config) -> Vec<Box<dyn Observer>> {
    let mut observers: Vec<Box<dyn Observer>> = Vec::new();
    if tracing::enabled!(target: TARGET, tracing::Level::DEBUG) {
        observers.push(Box::new(CallLog));
    }
    if !config.slow_query.is_zero() {
        observers.push(Box::new(SlowQueries::new(config.slow_query)));
    }
    #[cfg(feature = "traces")]
    if config.traces.is_some() {
        // First, so that the others know the trace.
        observers.insert(0, Box::new(crate::observability::TraceParents::default()));
    }
    observers
}

/// The metrics of calls, as one who is told of them.
#[cfg(feature = "metrics")]
pub(super) fn call_metrics(metrics: &mut Metrics) -> Box<dyn Observer> {
    Box::new(CallMetrics::register(&mut metrics.registry))
}
