//! The daemon put together: [`Config`] says what, [`Daemon`] is built, runs and drains.

mod config;
mod daemon;
#[cfg(any(feature = "shared-memory", feature = "zenoh"))]
mod door_choice;
mod grpc_settings;
mod logging;
mod metrics_settings;
mod observing;
mod service_manager;
mod shared_memory_settings;
mod signals;
mod traces_settings;
mod zenoh_settings;

pub use config::{Config, ConfigError, Settings, defaults};
pub use daemon::{Daemon, Drained, RunError, StartError};
#[cfg(any(feature = "shared-memory", feature = "zenoh"))]
pub use door_choice::DoorChoice;
pub use grpc_settings::{GrpcSettings, TlsSettings, TokenSettings, WebSettings};
pub use logging::{BadLogging, LogFormat, Logging};
pub use metrics_settings::MetricsSettings;
pub use service_manager::{ServiceState, tell_service_manager};
pub use shared_memory_settings::SharedMemorySettings;
pub use signals::stop_signal;
pub use traces_settings::TracesSettings;
pub use zenoh_settings::ZenohSettings;
