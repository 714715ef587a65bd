//! The daemon put together: [`Config`] says what, [`Daemon`] is built, runs and drains.

mod config;
mod daemon;
mod grpc_settings;
mod logging;
mod signals;

pub use config::{Config, ConfigError, Settings, defaults};
pub use daemon::{Daemon, Drained, RunError, StartError};
pub use grpc_settings::{GrpcSettings, TlsSettings, TokenSettings, WebSettings};
pub use logging::{BadFilter, log_to_stderr};
pub use signals::stop_signal;
