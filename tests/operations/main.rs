//! What operators see of the daemon: metrics, log lines, traces, the files of `deploy/` and the operator's page. The daemon is the
//! program itself, run as they run it.

mod daemon;
mod deploy;
mod hostile;
mod lines;
mod metrics;
mod page;
mod scrape;
mod traces;

/// Paths from the root of the repository.
fn repository(path: &str) -> std::path::PathBuf {
    std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}
