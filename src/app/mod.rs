//! The daemon put together: [`Config`] says what, [`Daemon`] is built, runs and drains.

mod config;
mod daemon;
mod logging;
mod signals;

#[cfg(feature = "shared-memory")]
pub use config::SharedMemory;
pub use config::{Config, ConfigError, GrpcSettings, Settings, SharedMemorySettings, defaults};
pub use daemon::{Daemon, Drained, RunError, StartError};
pub use logging::{BadFilter, log_to_stderr};
pub use signals::stop_signal;
