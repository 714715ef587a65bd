//! Where do log lines go? To stderr; stdout belongs to data.

use std::io::IsTerminal;

use serde::Deserialize;
use tracing_subscriber::layer::SubscriberExt;
use tracing_subscriber::util::SubscriberInitExt;
use tracing_subscriber::{EnvFilter, Layer};

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

/// A text that is no filter of log lines.
#[derive(Debug, thiserror::Error)]
#[error("log {filter:?}: {problem}")]
pub struct BadFilter {
    /// As it was given.
    filter: String,
    /// What is wrong with it.
    problem: String,
}

/// Writes log lines that pass `filter` (for example `info` or `clearance=debug,warn`) to stderr from now on. Where a
/// program has its own subscriber, that one stays.
///
/// # Errors
/// [`BadFilter`].
pub fn log_to_stderr(filter: &str, format: LogFormat) -> Result<(), BadFilter> {
    let parsed = EnvFilter::try_new(filter)
        .map_err(|error| BadFilter { filter: filter.to_owned(), problem: error.to_string() })?;
    let lines = tracing_subscriber::fmt::layer().with_writer(std::io::stderr);
    let lines = match format {
        LogFormat::Text => lines.with_ansi(std::io::stderr().is_terminal()).boxed(),
        LogFormat::Json => lines.json().with_ansi(false).boxed(),
    };
    if tracing_subscriber::registry().with(lines.with_filter(parsed)).try_init().is_err() {
        tracing::debug!("a subscriber was there before");
    }
    Ok(())
}
