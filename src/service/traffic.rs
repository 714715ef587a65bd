//! What goes through a door? Plain counts that the door keeps as it goes, and whoever watches the daemon reads.

use std::sync::atomic::{AtomicU64, Ordering};

/// A number that only rises.
#[derive(Debug, Default)]
pub struct Count(AtomicU64);

impl Count {
    /// So much more.
    pub fn add(&self, more: u64) {
        // Nothing is concluded from the order of two counts.
        self.0.fetch_add(more, Ordering::Relaxed);
    }

    /// How much by now.
    #[must_use]
    pub fn get(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }
}

/// The counts of one door.
#[derive(Debug, Default)]
pub struct Traffic {
    /// Bytes of messages that came.
    pub received_bytes: Count,
    /// Bytes of messages that went.
    pub sent_bytes: Count,
    /// Connections that were let in.
    pub connections_opened: Count,
    /// Those of them that are gone.
    pub connections_closed: Count,
    /// Connections that were closed at once: there were too many.
    pub connections_refused: Count,
    /// Connections that did not finish to shake hands.
    pub handshakes_failed: Count,
}
