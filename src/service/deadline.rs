//! When does a question have to stop? The only clock that queries have, and they see it as a "stop now?".

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use super::ServiceError;

/// How long a caller is willing to wait.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Patience {
    /// From the transport, counted from the arrival of the request: after it the caller no longer listens.
    pub timeout: Option<Duration>,
    /// From the request: after it the caller wants what is there by then.
    pub time_budget: Option<Duration>,
}

/// The part of a transport's timeout that is kept back, so that an answer cut by it still arrives in time.
const KEPT_BACK: f64 = 0.1;
/// More than this is never kept back.
const KEPT_BACK_AT_MOST: Duration = Duration::from_millis(100);

/// The moment a request stops at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Deadline(Instant);

impl Deadline {
    /// The earlier of timeout and budget, and never later than `longest` from now.
    ///
    /// # Errors
    /// There is no time at all.
    pub fn new(arrival: Instant, patience: Patience, longest: Duration) -> Result<Self, ServiceError> {
        let timeout = patience.timeout.map(|t| t.saturating_sub(t.mul_f64(KEPT_BACK).min(KEPT_BACK_AT_MOST)));
        let time = [timeout, patience.time_budget, Some(longest)].into_iter().flatten().min().unwrap_or(longest);
        let deadline = Self(arrival + time);
        if deadline.is_past() { Err(ServiceError::DeadlineExceeded) } else { Ok(deadline) }
    }

    /// The moment itself.
    #[must_use]
    pub fn at(self) -> Instant {
        self.0
    }

    /// Whether it has come.
    #[must_use]
    pub fn is_past(self) -> bool {
        Instant::now() >= self.0
    }
}

/// Becomes true when the deadline comes or the caller goes away.
#[derive(Clone, Debug)]
pub struct Stop {
    deadline: Deadline,
    abandoned: Arc<AtomicBool>,
}

/// Held by whoever waits for an answer; dropping it tells the work that nobody does any more.
#[derive(Debug)]
pub struct Waiting {
    abandoned: Arc<AtomicBool>,
}

impl Stop {
    /// A stop, and the guard of the one who waits.
    #[must_use]
    pub fn at(deadline: Deadline) -> (Self, Waiting) {
        let abandoned = Arc::new(AtomicBool::new(false));
        (Self { deadline, abandoned: Arc::clone(&abandoned) }, Waiting { abandoned })
    }

    /// When it becomes true by itself.
    #[must_use]
    pub fn deadline(&self) -> Deadline {
        self.deadline
    }

    /// The same for work that has to stop at `moment` already, if that comes first.
    #[must_use]
    pub fn not_after(&self, moment: Instant) -> Self {
        Self { deadline: Deadline(self.deadline.0.min(moment)), abandoned: Arc::clone(&self.abandoned) }
    }

    /// Whether to stop now.
    #[must_use]
    pub fn now(&self) -> bool {
        self.abandoned.load(Ordering::Relaxed) || self.deadline.is_past()
    }
}

impl Drop for Waiting {
    fn drop(&mut self) {
        self.abandoned.store(true, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LONGEST: Duration = Duration::from_secs(600);

    #[test]
    fn the_earliest_of_timeout_budget_and_cap_counts() {
        let now = Instant::now();
        let seconds = |s| Some(Duration::from_secs(s));
        let at = |timeout, time_budget| Deadline::new(now, Patience { timeout, time_budget }, LONGEST).unwrap().at();
        assert_eq!(at(None, None), now + LONGEST);
        assert_eq!(at(seconds(3), seconds(2)), now + Duration::from_secs(2));
        assert_eq!(at(seconds(7000), None), now + LONGEST);
        assert_eq!(at(seconds(4), seconds(9)), now + Duration::from_secs(4) - KEPT_BACK_AT_MOST);
    }

    #[test]
    fn no_time_at_all_is_refused() {
        let none = Patience { timeout: Some(Duration::ZERO), time_budget: None };
        assert_eq!(Deadline::new(Instant::now(), none, LONGEST), Err(ServiceError::DeadlineExceeded));
    }

    #[test]
    fn work_stops_when_the_one_who_waits_goes_away() {
        let deadline = Deadline::new(Instant::now(), Patience::default(), LONGEST).unwrap();
        let (stop, waiting) = Stop::at(deadline);
        assert!(!stop.now());
        drop(waiting);
        assert!(stop.now());
    }
}
