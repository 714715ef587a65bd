//! The daemon put together: [`Config`] says what, [`Daemon`] is built, runs and drains.

mod config;
mod daemon;
mod grpc_settings;
mod logging;
mod shared_memory_settings;
mod signals;

pub use config::{Config, ConfigError, Settings, defaults};
pub use daemon::{Daemon, Drained, RunError, StartError};
pub use grpc_settings::{GrpcSettings, TlsSettings, TokenSettings, WebSettings};
pub use logging::{BadFilter, log_to_stderr};
#[cfg(feature = "shared-memory")]
pub use shared_memory_settings::SharedMemory;
pub use shared_memory_settings::SharedMemorySettings;
pub use signals::stop_signal;
