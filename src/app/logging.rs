//! Where do log lines go? To stderr; stdout belongs to data.

use std::io::IsTerminal;

use tracing_subscriber::EnvFilter;

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
pub fn log_to_stderr(filter: &str) -> Result<(), BadFilter> {
    let parsed = EnvFilter::try_new(filter)
        .map_err(|error| BadFilter { filter: filter.to_owned(), problem: error.to_string() })?;
    let subscriber = tracing_subscriber::fmt()
        .with_env_filter(parsed)
        .with_ansi(std::io::stderr().is_terminal())
        .with_writer(std::io::stderr);
    if subscriber.try_init().is_err() {
        tracing::debug!("a subscriber was there before");
    }
    Ok(())
}
