//! Along which axis are the boxes sorted? The one along which the fewest pairs of them meet.
//!
//! The usual choice is the axis of greatest variance of the centres. It stands for what a sweep pays, the pairs of
//! intervals that meet; but it is blind to the lengths of the boxes, and two heaps far apart have a great variance and
//! meet within each heap as before. So the pairs themselves are counted, in a sample.

use super::segment::Entry;
use super::sweep_and_prune::SweepAndPrune;
use crate::geometry::Aabb;

/// Boxes of the sample: at 512 a share of one pair in a hundred is known to some 3 %, in some tens of microseconds.
const SAMPLE: usize = 512;

/// Sorting anew pays when another axis has fewer pairs by this factor: below it the next moves may turn it back.
const GAIN: f64 = 1.5;

/// The axis is looked at again after as many changes as there are entries, and after no fewer than this.
const LEAST_CHANGES: usize = 64;

impl SweepAndPrune {
    /// To be called after a list of changes: sorts along another axis if that pays by now. The sort costs N log N and
    /// shares nothing with earlier versions, so it comes at most once in as many changes as there are entries.
    pub fn settle(&mut self) {
        if self.changes < LEAST_CHANGES.max(self.count) {
            return;
        }
        self.changes = 0;
        let share = self.meeting_shares();
        let best = (0..3).min_by(|a, b| share[*a].total_cmp(&share[*b])).unwrap_or(0);
        if GAIN * share[best] < share[self.list.axis] {
            self.sort_along(best);
        }
    }

    /// For each axis the share of all pairs of boxes whose intervals meet there, estimated from a sample.
    pub(super) fn meeting_shares(&self) -> [f64; 3] {
        let stride = self.count.div_ceil(SAMPLE).max(1);
        let mut sample: Vec<Aabb> = self.entries_by_slot().step_by(stride).map(|Entry { tight, .. }| tight).collect();
        let pairs = sample.len() * sample.len().saturating_sub(1) / 2;
        [0, 1, 2].map(|axis| {
            sample.sort_unstable_by(|a, b| a.min[axis].total_cmp(&b.min[axis]));
            let after =
                |(i, one): (usize, &Aabb)| sample[i + 1..].partition_point(|other| other.min[axis] <= one.max[axis]);
            let meeting: usize = sample.iter().enumerate().map(after).sum();
            meeting as f64 / pairs.max(1) as f64
        })
    }
}
