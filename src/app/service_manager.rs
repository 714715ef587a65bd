//! What does systemd know of the daemon? When it can be asked, and when it ends; nothing where no `NOTIFY_SOCKET` is given.

use sd_notify::NotifyState;

/// A step in the daemon's life.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ServiceState {
    /// Its doors are open.
    Ready,
    /// It drains.
    Stopping,
}

/// Tells the service manager that started the daemon, if it wants to know.
pub fn tell_service_manager(state: ServiceState) {
    let state = match state {
        ServiceState::Ready => NotifyState::Ready,
        ServiceState::Stopping => NotifyState::Stopping,
    };
    // Without it the manager waits in vain and says so itself; the daemon serves all the same.
    if let Err(error) = sd_notify::notify(&[state]) {
        tracing::warn!(%error, "the service manager could not be told");
    }
}
