//! How long does something take? In ticks of the processor's time stamp.

use std::arch::x86_64::{_mm_lfence, _rdtsc};
use std::time::{Duration, Instant};

/// Time stamp, with everything before it done and nothing after it begun.
#[inline(always)]
#[must_use]
pub fn tick() -> u64 {
    // SAFETY: every x86-64 processor has both instructions, and neither touches memory.
    unsafe {
        _mm_lfence();
        let now = _rdtsc();
        _mm_lfence();
        now
    }
}

/// What two stamps with nothing between them differ by, and the step that stamps grow by (26 ticks on some machines).
pub struct Timer {
    pub cost: f64,
    pub step: f64,
}

impl Timer {
    #[must_use]
    pub fn new() -> Self {
        let between = || {
            let start = tick();
            tick() - start
        };
        let mut costs: Vec<u64> = (0..20_001).map(|_| between()).collect();
        costs.sort_unstable();
        costs.truncate(costs.len() * 9 / 10); // the others were interrupted
        // The mean, for it resolves what lies between two steps.
        let cost = costs.iter().sum::<u64>() as f64 / costs.len() as f64;
        let second = costs.iter().find(|&&cost| cost > costs[0]);
        Self { cost, step: second.map_or(costs[0], |second| second - costs[0]) as f64 }
    }
}

#[must_use]
pub fn ticks_per_nanosecond() -> f64 {
    let (began, first) = (Instant::now(), tick());
    while began.elapsed() < Duration::from_millis(100) {}
    let elapsed = began.elapsed();
    (tick() - first) as f64 / elapsed.as_nanos() as f64
}
