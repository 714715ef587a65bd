//! How long does it take? Times of one thing, and of several things in turn, so that whatever slows the machine for a while
//! slows all of them.

use std::time::{Duration, Instant};

use super::super::exit_code::Failed;

/// Times of one thing.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Times(Vec<Duration>);

impl Times {
    /// Does it once, and remembers how long it took.
    pub fn take(&mut self, work: impl FnOnce() -> Result<(), Failed>) -> Result<(), Failed> {
        let begun = Instant::now();
        work()?;
        self.0.push(begun.elapsed());
        Ok(())
    }

    /// Does it some times in a row: what comes first finds the machine as something else left it, what follows as it
    /// left it itself.
    pub fn take_block(&mut self, times: usize, mut work: impl FnMut() -> Result<(), Failed>) -> Result<(), Failed> {
        (0..times).try_for_each(|_| self.take(&mut work))
    }

    /// The time that this part of all samples does not exceed, seconds; none without samples.
    pub fn quantile(&self, part: f64) -> f64 {
        let mut sorted = self.0.clone();
        sorted.sort_unstable();
        let index = (part * sorted.len() as f64).ceil() as usize;
        sorted.get(index.saturating_sub(1)).map_or(f64::NAN, Duration::as_secs_f64)
    }

    /// How many samples.
    pub fn count(&self) -> usize {
        self.0.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_samples() {
        let times = Times((1..=100).rev().map(Duration::from_secs).collect());
        assert_eq!([0.5, 0.99, 1.0].map(|part| times.quantile(part)), [50.0, 99.0, 100.0]);
        assert!(Times::default().quantile(0.5).is_nan());
        assert_eq!(Times(vec![Duration::from_secs(7)]).quantile(0.99), 7.0);
    }
}
