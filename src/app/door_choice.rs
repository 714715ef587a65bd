//! Is there to be a door? Doors beside gRPC are there by default, but a machine may have no room for one.

/// Whether there is a door.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum DoorChoice<C> {
    /// There is none.
    Off,
    /// Nobody asked for it: where it cannot be opened, the daemon says so in its log and serves the other doors.
    IfPossible(C),
    /// It was asked for: a daemon that cannot open it does not start.
    On(C),
}

impl<C> DoorChoice<C> {
    /// `enabled` is what was said of the door itself; who gives it an address or a name wants it.
    pub(super) fn new(enabled: Option<bool>, is_named: bool, config: C) -> Self {
        match (enabled, is_named) {
            (Some(false), _) => Self::Off,
            (Some(true), _) | (None, true) => Self::On(config),
            (None, false) => Self::IfPossible(config),
        }
    }

    /// Opens the door, if there is to be one.
    ///
    /// # Errors
    /// It was asked for, and cannot be opened.
    pub(super) async fn open<L, E: std::fmt::Display>(
        &self,
        name: &str,
        open: impl AsyncFnOnce(&C) -> Result<L, E>,
    ) -> Result<Option<L>, E> {
        let (config, asked_for) = match self {
            Self::Off => return Ok(None),
            Self::IfPossible(config) => (config, false),
            Self::On(config) => (config, true),
        };
        match open(config).await {
            Ok(door) => Ok(Some(door)),
            Err(error) if asked_for => Err(error),
            Err(error) => {
                tracing::warn!("there is no {name} door: {error}");
                Ok(None)
            }
        }
    }
}
