//! May this be logged again already? What strangers can cause is logged at most once a second, with how often it happened.

use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// One kind of log line.
#[derive(Debug)]
pub struct Seldom {
    since: Instant,
    /// When the next line is due, milliseconds after `since`.
    next: AtomicU64,
    /// How often it happened since the last line.
    happened: AtomicU64,
}

const PAUSE: Duration = Duration::from_secs(1);

impl Default for Seldom {
    fn default() -> Self {
        Self::new()
    }
}

impl Seldom {
    /// Nothing has happened yet.
    #[must_use]
    pub fn new() -> Self {
        Self { since: Instant::now(), next: AtomicU64::new(0), happened: AtomicU64::new(0) }
    }

    /// Counts, and returns how often it happened since the last line if another one is due.
    pub fn due(&self) -> Option<u64> {
        self.happened.fetch_add(1, Ordering::AcqRel);
        let now = u64::try_from(self.since.elapsed().as_millis()).unwrap_or(u64::MAX);
        let pause = PAUSE.as_millis() as u64;
        let later = |next: u64| (next <= now).then_some(now.saturating_add(pause));
        self.next.fetch_update(Ordering::AcqRel, Ordering::Acquire, later).ok()?;
        Some(self.happened.swap(0, Ordering::AcqRel))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flood_is_one_line_a_second_and_nothing_goes_uncounted() {
        let line = Seldom::new();
        let mut counted: u64 = (0..1_000).filter_map(|_| line.due()).sum();
        assert!(counted < 1_000);
        std::thread::sleep(PAUSE);
        counted += line.due().unwrap();
        assert_eq!(counted, 1_001);
    }
}
