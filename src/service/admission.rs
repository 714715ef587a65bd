//! How many requests may be under way? A counter that refuses beyond its cap, and is given back by dropping a permit.
//!
//! There is no queue in front of it: a daemon that is too busy says so at once, and the caller decides.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::limits::LimitExceeded;

/// Permits for one kind of work.
#[derive(Clone, Debug)]
pub struct Admission {
    limit: &'static str,
    allowed: usize,
    under_way: Arc<AtomicUsize>,
}

/// The right to do one piece of work; dropping it gives the place back.
#[derive(Debug)]
pub struct Permit {
    under_way: Arc<AtomicUsize>,
}

impl Admission {
    /// `limit` is the field of [`crate::limits::Limits`] that `allowed` comes from.
    #[must_use]
    pub fn new(limit: &'static str, allowed: usize) -> Self {
        Self { limit, allowed, under_way: Arc::default() }
    }

    /// # Errors
    /// All places are taken.
    pub fn enter(&self) -> Result<Permit, LimitExceeded> {
        let take = |now: usize| (now < self.allowed).then_some(now + 1);
        match self.under_way.fetch_update(Ordering::AcqRel, Ordering::Acquire, take) {
            Ok(_) => Ok(Permit { under_way: Arc::clone(&self.under_way) }),
            Err(now) => Err(LimitExceeded { limit: self.limit, asked: now as u64 + 1, allowed: self.allowed as u64 }),
        }
    }

    /// How many permits are out.
    #[must_use]
    pub fn under_way(&self) -> usize {
        self.under_way.load(Ordering::Acquire)
    }
}

impl Drop for Permit {
    fn drop(&mut self) {
        self.under_way.fetch_sub(1, Ordering::AcqRel);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_place_of_a_dropped_permit_is_free_again() {
        let admission = Admission::new("max_queries_in_flight", 1);
        let permit = admission.enter().unwrap();
        let refused = admission.enter().unwrap_err();
        assert_eq!(refused, LimitExceeded { limit: "max_queries_in_flight", asked: 2, allowed: 1 });
        drop(permit);
        assert_eq!(admission.under_way(), 0);
        assert!(admission.enter().is_ok());
    }
}
