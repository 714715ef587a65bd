//! When is the daemon told to end? By SIGTERM, or by SIGINT from a terminal.

use std::io;

use tokio::signal::unix::{SignalKind, signal};

/// A future that ends when the first of the two comes. From the call on, neither ends the process by itself.
///
/// # Errors
/// The system takes no handlers.
pub fn stop_signal() -> io::Result<impl Future<Output = ()>> {
    let (mut terminate, mut interrupt) = (signal(SignalKind::terminate())?, signal(SignalKind::interrupt())?);
    Ok(async move {
        tokio::select! {
            _ = terminate.recv() => tracing::info!("SIGTERM"),
            _ = interrupt.recv() => tracing::info!("SIGINT"),
        }
    })
}
