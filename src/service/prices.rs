//! What did the items cost, asked in one way? Times, widths, verdicts and counters of one row of an estimate.

use super::answered::Verdicts;
use crate::narrow_phase::{Bracket, Cost};
use crate::query::{ItemAnswer, Output, Verdict};

/// What items of a question cost for one output at one tolerance. Nothing stands here that was not measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Price {
    /// What was computed.
    pub output: Output,
    /// How wide a bracket might be, metres; 0: as narrow as rounding lets it be. Of motions the resolution, too. None where it
    /// changes nothing.
    pub tolerance: Option<f64>,
    /// Items that were measured.
    pub items: usize,
    /// They are the whole sample.
    pub complete: bool,
    /// What they came to.
    pub verdicts: Verdicts,
    /// How long an item took; none if there was no item that can be asked.
    pub times: Option<Times>,
    /// How narrow the brackets became; none if there were none.
    pub widths: Option<Widths>,
    /// What an item cost in counters; none if there was no item that can be asked.
    pub mean_cost: Option<MeanCost>,
}

/// Nanoseconds of an item: each by the quickest of its turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Times {
    /// Half of the items took no longer.
    pub median: u64,
    /// 99 of 100 items took no longer; of fewer than a hundred the longest.
    pub p99: u64,
}

/// Widths of brackets, metres: one for each item that has a nearest pair, of `Clearance` the widest of all that are listed. An overlap that
/// was proved, but not measured, does not count.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Widths {
    /// Items that have one.
    pub items: usize,
    /// Half of them are no wider.
    pub median: f64,
    /// None is wider.
    pub largest: f64,
    /// Items with a bracket wider than the tolerance: rounding, or a cap on iterations, ended the work first.
    pub wider: usize,
}

/// [`Cost`] of one item, on the mean.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MeanCost {
    /// As in [`Cost`].
    pub supports: f64,
    /// As in [`Cost`].
    pub gjk_iterations: f64,
    /// As in [`Cost`].
    pub epa_iterations: f64,
    /// As in [`Cost`].
    pub nodes: f64,
    /// As in [`Cost`].
    pub pairs: f64,
    /// As in [`Cost`].
    pub escalations: f64,
    /// As in [`Cost`].
    pub patch_corners: f64,
    /// As in [`Cost`].
    pub patch_cuts: f64,
    /// As in [`Cost`].
    pub derivative_separations: f64,
    /// As in [`Cost`].
    pub derivative_supports: f64,
    /// As in [`Cost`].
    pub derivative_corners: f64,
}

impl MeanCost {
    fn of(total: Cost, items: usize) -> Self {
        let mean = |total: u64| total as f64 / items as f64;
        Self {
            supports: mean(total.supports),
            gjk_iterations: mean(total.gjk_iterations),
            epa_iterations: mean(total.epa_iterations),
            nodes: mean(total.nodes),
            pairs: mean(total.pairs),
            escalations: mean(total.escalations),
            patch_corners: mean(total.patch_corners),
            patch_cuts: mean(total.patch_cuts),
            derivative_separations: mean(total.derivative_separations),
            derivative_supports: mean(total.derivative_supports),
            derivative_corners: mean(total.derivative_corners),
        }
    }
}

/// What is collected of a row while it is measured.
pub(super) struct Till {
    output: Output,
    tolerance: Option<f64>,
    /// Every listed pair is measured, not the nearest alone.
    all_pairs: bool,
    items: usize,
    verdicts: Verdicts,
    cost: Cost,
    widths: Vec<f64>,
    /// Nanoseconds of each item by its quickest turn; none of an item that cannot be asked.
    nanoseconds: Vec<Option<u64>>,
}

impl Till {
    pub fn new(output: Output, tolerance: Option<f64>, all_pairs: bool) -> Self {
        Self {
            output,
            tolerance,
            all_pairs,
            items: 0,
            verdicts: Verdicts::default(),
            cost: Cost::default(),
            widths: Vec::new(),
            nanoseconds: Vec::new(),
        }
    }

    /// The next item, at its first turn.
    pub fn take(&mut self, item: &ItemAnswer, nanoseconds: u64) {
        self.items += 1;
        self.verdicts.count(item.verdict);
        let can_be_asked = item.verdict != Verdict::InvalidInput;
        self.nanoseconds.push(can_be_asked.then_some(nanoseconds));
        if can_be_asked {
            self.cost += item.cost;
            self.widths.extend(self.width(item));
        }
    }

    /// How long every item took at a later turn.
    pub fn again(&mut self, turn: &[u64]) {
        for (best, now) in self.nanoseconds.iter_mut().zip(turn) {
            *best = best.map(|best| best.min(*now));
        }
    }

    /// The widest bracket that had to be narrow.
    fn width(&self, item: &ItemAnswer) -> Option<f64> {
        if !self.output.wants().closed().distance && !self.all_pairs && self.tolerance.is_none() {
            return None;
        }
        let measured = |bracket: &Bracket| bracket.upper > 0.0 || self.output.wants().depth;
        let listed = if self.all_pairs { item.pairs.as_slice() } else { &[] };
        let brackets = item.nearest.iter().chain(listed).map(|pair| pair.bracket);
        brackets.filter(measured).map(|bracket| bracket.width()).max_by(f64::total_cmp)
    }

    pub fn price(mut self, sample: usize) -> Price {
        let mut nanoseconds: Vec<u64> = self.nanoseconds.into_iter().flatten().collect();
        nanoseconds.sort_unstable();
        self.widths.sort_unstable_by(f64::total_cmp);
        let (widths, tolerance) = (&self.widths, self.tolerance);
        let wider = |tolerance: f64| widths.iter().filter(|width| **width > tolerance).count();
        Price {
            output: self.output,
            tolerance,
            items: self.items,
            complete: self.items == sample,
            verdicts: self.verdicts,
            times: quantile(&nanoseconds, 1, 2)
                .zip(quantile(&nanoseconds, 99, 100))
                .map(|(median, p99)| Times { median, p99 }),
            widths: quantile(widths, 1, 2).zip(widths.last()).map(|(median, &largest)| Widths {
                items: widths.len(),
                median,
                largest,
                wider: tolerance.map_or(0, wider),
            }),
            mean_cost: (!nanoseconds.is_empty()).then(|| MeanCost::of(self.cost, nanoseconds.len())),
        }
    }

    pub fn is_empty(&self) -> bool {
        self.items == 0
    }

    pub fn verdicts(&self) -> &Verdicts {
        &self.verdicts
    }

    pub fn cost(&self) -> Cost {
        self.cost
    }
}

/// The least of sorted values that a part of all, `part / whole`, do not exceed.
fn quantile<T: Copy>(sorted: &[T], part: usize, whole: usize) -> Option<T> {
    sorted.get((part * sorted.len()).div_ceil(whole).checked_sub(1)?).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_values_and_none_has_none() {
        let hundred: Vec<u64> = (1..=100).collect();
        assert_eq!((quantile(&hundred, 1, 2), quantile(&hundred, 99, 100)), (Some(50), Some(99)));
        assert_eq!((quantile(&[7], 1, 2), quantile(&[7], 99, 100)), (Some(7), Some(7)));
        assert_eq!(quantile::<u64>(&[], 1, 2), None);
    }

    #[test]
    fn an_item_counts_by_its_quickest_turn_and_one_that_cannot_be_asked_has_no_time() {
        let mut till = Till::new(Output::Verdict, None, false);
        till.take(&ItemAnswer::without_work(Verdict::Free), 70);
        till.take(&ItemAnswer::without_work(Verdict::InvalidInput), 3);
        till.take(&ItemAnswer::without_work(Verdict::Collision), 50);
        till.again(&[60, 1, 90]);
        let price = till.price(4);
        assert_eq!(price.times, Some(Times { median: 50, p99: 60 }));
        assert_eq!((price.items, price.complete, price.verdicts.invalid_input), (3, false, 1));
        let none = Till::new(Output::Depth, Some(0.0), false).price(4);
        assert_eq!((none.times, none.widths, none.mean_cost, none.items), (None, None, None, 0));
    }
}
