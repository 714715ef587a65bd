//! Where do log lines go? To stderr; stdout belongs to data. And spans, where they are wanted, to a collector.

use std::io::IsTerminal;

use serde::Deserialize;
use tracing_subscriber::layer::SubscriberExt;
use tracing_subscriber::util::SubscriberInitExt;
use tracing_subscriber::{EnvFilter, Layer};

use super::Config;
#[cfg(feature = "traces")]
use crate::observability::{Traces, TracesError};

/// How log lines look.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LogFormat {
    /// For people.
    Text,
    /// One object a line, for programs.
    Json,
}

impl std::str::FromStr for LogFormat {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "text" => Ok(Self::Text),
            "json" => Ok(Self::Json),
            other => Err(format!("{other:?} is neither text nor json")),
        }
    }
}

/// Why nothing can be logged as it was asked for.
#[derive(Debug, thiserror::Error)]
pub enum BadLogging {
    /// A text that is no filter of log lines.
    #[error("log {filter:?}: {problem}")]
    Filter {
        /// As it was given.
        filter: String,
        /// What is wrong with it.
        problem: String,
    },
    /// Spans have nowhere to go.
    #[cfg(feature = "traces")]
    #[error(transparent)]
    Traces(#[from] TracesError),
}

/// What is to be ended with the daemon.
#[derive(Debug)]
pub struct Logging {
    #[cfg(feature = "traces")]
    traces: Option<Traces>,
}

impl Logging {
    /// Writes log lines that pass the configured filter (for example `info` or `clearance=debug,warn`) to stderr from now on, and
    /// makes spans of calls where they are wanted. Where a program has its own subscriber, that one stays. Called within a
    /// runtime.
    ///
    /// # Errors
    /// [`BadLogging`].
    pub fn begin(config: &Config) -> Result<Self, BadLogging> {
        let bad = |problem: String| BadLogging::Filter { filter: config.log.clone(), problem };
        let filter = EnvFilter::try_new(&config.log).map_err(|error| bad(error.to_string()))?;
        let lines = tracing_subscriber::fmt::layer().with_writer(std::io::stderr);
        let lines = match config.log_format {
            LogFormat::Text => lines.with_ansi(std::io::stderr().is_terminal()).boxed(),
            LogFormat::Json => lines.json().with_ansi(false).boxed(),
        };
        let subscriber = tracing_subscriber::registry().with(lines.with_filter(filter));
        #[cfg(feature = "traces")]
        let traces = config.traces.as_ref().map(Traces::new).transpose()?;
        #[cfg(feature = "traces")]
        let subscriber = subscriber.with(traces.as_ref().map(Traces::layer));
        if subscriber.try_init().is_err() {
            tracing::debug!("a subscriber was there before");
        }
        Ok(Self {
            #[cfg(feature = "traces")]
            traces,
        })
    }

    /// Sends what is left to be sent. Called outside of the runtime, which still runs.
    pub fn finish(self) {
        #[cfg(feature = "traces")]
        if let Some(traces) = self.traces {
            traces.finish();
        }
    }
}
