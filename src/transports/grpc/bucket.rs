//! How much has a client taken lately? A bucket that fills at a steady rate and holds what one second brings.
//!
//! What a call takes is known only when it is over, so the bucket may be overdrawn: a call may begin while there is anything
//! in it, and what was taken too much has to flow in again before the next. Over time that is the rate, whatever the sizes.

use std::time::{Duration, Instant};

use crate::limits::LimitExceeded;

/// One client's share of one thing.
#[derive(Debug)]
pub(super) struct Bucket {
    /// The field of [`crate::limits::Limits`] that the rate comes from.
    limit: &'static str,
    /// What flows in, each second.
    rate: f64,
    /// What is in it; negative while it is overdrawn.
    level: f64,
    /// When that was so.
    at: Instant,
}

/// Why a call may not begin, and when one may.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Overdrawn {
    /// What was taken within the last second or is still owed, and what may be.
    pub exceeded: LimitExceeded,
    /// Until there is something in the bucket again.
    pub wait: Duration,
}

impl Bucket {
    /// A full one. A rate of zero means that nothing is counted.
    pub fn new(limit: &'static str, rate: usize, now: Instant) -> Option<Self> {
        let per_second = rate as f64;
        (rate > 0).then_some(Self { limit, rate: per_second, level: per_second, at: now })
    }

    /// # Errors
    /// Too much was taken before.
    pub fn check(&mut self, now: Instant) -> Result<(), Overdrawn> {
        self.fill(now);
        if self.level > 0.0 {
            return Ok(());
        }
        let (asked, allowed) = ((self.rate - self.level).ceil() as u64, self.rate as u64);
        // A little more than nothing has to be in it, or the caller comes back to an empty bucket.
        let wait = Duration::from_secs_f64((1.0 - self.level) / self.rate);
        Err(Overdrawn { exceeded: LimitExceeded { limit: self.limit, asked: asked.max(allowed + 1), allowed }, wait })
    }

    /// Takes `amount`, whether it is there or not.
    pub fn take(&mut self, amount: usize, now: Instant) {
        self.fill(now);
        self.level -= amount as f64;
    }

    /// Whether it is as full as a new one.
    pub fn is_full(&mut self, now: Instant) -> bool {
        self.fill(now);
        self.level >= self.rate
    }

    fn fill(&mut self, now: Instant) {
        let seconds = now.saturating_duration_since(self.at).as_secs_f64();
        self.level = (self.level + seconds * self.rate).min(self.rate);
        self.at = self.at.max(now);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_over_a_long_time_is_the_rate_whatever_the_sizes() {
        let start = Instant::now();
        for size in [1, 7, 90, 1000] {
            let mut bucket = Bucket::new("max_client_items_per_second", 100, start).unwrap();
            let mut taken = 0;
            for millisecond in 0..60_000 {
                let now = start + Duration::from_millis(millisecond);
                if bucket.check(now).is_ok() {
                    bucket.take(size, now);
                    taken += size;
                }
            }
            // One second's worth was there at the start, and one call may overdraw.
            assert!((5_990..=6_100 + size).contains(&taken), "{taken} in pieces of {size}");
        }
    }

    #[test]
    fn a_caller_that_waits_as_told_is_let_in() {
        let start = Instant::now();
        let mut bucket = Bucket::new("max_client_bytes_per_second", 1000, start).unwrap();
        bucket.take(3500, start);
        let refused = bucket.check(start).unwrap_err();
        let exceeded = LimitExceeded { limit: "max_client_bytes_per_second", asked: 3500, allowed: 1000 };
        assert_eq!(refused.exceeded, exceeded);
        assert!(bucket.check(start + refused.wait - Duration::from_millis(2)).is_err());
        assert!(bucket.check(start + refused.wait).is_ok());
    }

    #[test]
    fn nothing_is_counted_at_a_rate_of_zero_and_nothing_saved_beyond_a_second() {
        let start = Instant::now();
        assert!(Bucket::new("max_client_items_per_second", 0, start).is_none());
        let mut bucket = Bucket::new("max_client_items_per_second", 10, start).unwrap();
        bucket.take(1, start);
        assert!(!bucket.is_full(start));
        let later = start + Duration::from_secs(3600);
        assert!(bucket.is_full(later));
        bucket.take(10, later);
        assert!(bucket.check(later).is_err());
    }
}
