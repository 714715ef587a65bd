//! What can be seen of the daemon from outside? Metrics for Prometheus, log lines of calls and of slow questions, traces.
//!
//! Everything here is told by the service ([`crate::service::Observer`]) or reads its figures; nothing below knows of it.

mod call_log;
#[cfg(feature = "metrics")]
mod call_metrics;
#[cfg(feature = "metrics")]
mod daemon_metrics;
#[cfg(feature = "metrics")]
mod endpoint;
#[cfg(feature = "metrics")]
mod exposition;
#[cfg(feature = "metrics")]
mod process_metrics;
#[cfg(feature = "metrics")]
mod scene_checks;
#[cfg(feature = "metrics")]
mod scene_metrics;
mod slow_queries;
#[cfg(feature = "traces")]
mod traces;

pub use call_log::{CallLog, TARGET};
#[cfg(feature = "metrics")]
pub use call_metrics::CallMetrics;
#[cfg(feature = "metrics")]
pub use endpoint::{Endpoint, EndpointError, MetricsConfig};
pub use slow_queries::SlowQueries;
#[cfg(feature = "traces")]
pub use traces::{TraceParents, Traces, TracesConfig, TracesError};
