//! The least signed distance of many pairs, as far as a goal needs it.
//!
//! The bracket of a minimum is the minimum of the brackets. A pair whose lower bound shows that it cannot matter is left out,
//! with that bound in the bracket in place of its own.

use super::goal::{Depth, Goal};
use super::outcome::{Bracket, Cost, Separation, Termination};

/// The least separation seen so far, and what is proved of the pairs that were not looked at.
pub(super) struct Least<'a> {
    asked: &'a Goal<'a>,
    best: Option<Separation>,
    lower: f64,
    upper: f64,
    /// A pair proved farther than this does not change the answer; metres.
    threshold: f64,
    pub cost: Cost,
    /// The gravest limit that any pair met: time after the cap on iterations.
    limit: Option<Termination>,
}

impl<'a> Least<'a> {
    pub fn new(asked: &'a Goal<'a>) -> Self {
        let (lower, upper) = (f64::INFINITY, f64::INFINITY);
        let threshold = threshold(asked, upper);
        Self { asked, best: None, lower, upper, threshold, cost: Cost::default(), limit: None }
    }

    /// What the next pair is asked: nothing more, once it is proved farther than the best.
    pub fn goal(&self) -> Goal<'a> {
        Goal { cut_off: self.asked.cut_off.min(self.upper), ..*self.asked }
    }

    /// A pair with a larger lower bound than this, metres, does not change the answer.
    pub fn threshold(&self) -> f64 {
        self.threshold
    }

    /// Leaves out a pair with that lower bound, if it cannot matter.
    pub fn leaves_out(&mut self, lower: f64) -> bool {
        let out = lower > self.threshold;
        if out {
            self.put_aside(lower);
        }
        out
    }

    /// What is left of the pairs, all with at least that lower bound, is not looked at.
    pub fn put_aside(&mut self, lower: f64) {
        self.lower = self.lower.min(lower);
    }

    /// Whether any pair was looked at. Until then there is no proof from above.
    pub fn has_witness(&self) -> bool {
        self.best.is_some()
    }

    /// A lower bound of what was looked at and left out, metres.
    pub fn lower(&self) -> f64 {
        self.lower
    }

    /// Whether the caller's time is over.
    pub fn must_stop(&mut self) -> bool {
        let stopped = (self.asked.stop)();
        if stopped {
            self.limit = Some(Termination::TimeLimit);
        }
        stopped
    }

    /// Takes a pair in; true when it is the least so far.
    pub fn take(&mut self, found: Separation) -> bool {
        self.cost += found.cost;
        if matches!(found.termination, Termination::IterationLimit | Termination::TimeLimit) {
            self.limit = self.limit.max(Some(found.termination));
        }
        self.lower = self.lower.min(found.bracket.lower);
        if found.bracket.upper < self.upper {
            self.upper = found.bracket.upper;
            self.threshold = threshold(self.asked, self.upper);
        }
        let least = self.best.as_ref().is_none_or(|best| found.signed_distance < best.signed_distance);
        if least {
            self.best = Some(found);
        }
        least
    }

    pub fn finish(self) -> Option<Separation> {
        let best = self.best?;
        let bracket = Bracket { lower: self.lower, upper: self.upper };
        let termination = self.limit.unwrap_or(best.termination);
        Some(Separation { bracket, termination, cost: self.cost, ..best })
    }
}

/// Beyond which lower bound a pair does not matter, when another pair is proved to be at most `upper` apart. Minus infinity when
/// nothing matters any more.
fn threshold(goal: &Goal, upper: f64) -> f64 {
    if upper <= 0.0 && goal.depth != Depth::Penetration {
        return f64::NEG_INFINITY; // A contact suffices.
    }
    let farther = goal.cut_off.min(upper);
    if goal.depth == Depth::Verdict {
        // Within the margin already: only a contact would change the verdict.
        let decided = if upper <= goal.margin { 0.0 } else { goal.margin };
        return farther.min(decided);
    }
    if upper == f64::INFINITY {
        return farther;
    }
    // The bracket of the whole may be as wide as asked. A thousandth is kept back for the rounding of this very sum. When `upper`
    // falls later on, the bound that counts is that of the pair that made it fall.
    let accuracy = goal.accuracy;
    let relative = upper.abs() * (accuracy.relative / (1.0 + accuracy.relative));
    let narrow = upper - 0.999 * accuracy.absolute.max(relative);
    // A width that straddles the verdict is not narrow enough.
    let narrow = if upper > goal.margin {
        narrow.max(goal.margin)
    } else if upper > 0.0 {
        narrow.max(0.0)
    } else {
        narrow
    };
    farther.min(narrow)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::narrow_phase::Accuracy;

    #[test]
    fn what_is_left_out_leaves_the_bracket_as_narrow_as_asked() {
        let accuracy = Accuracy { absolute: 1e-6, relative: 1e-3 };
        for depth in [Depth::Distance, Depth::Penetration] {
            for margin in [0.0, 0.3] {
                let goal = Goal { depth, accuracy, margin, ..Goal::penetration() };
                for upper in [1e-7, 1e-3, 0.2999, 0.3, 0.30001, 2.0, -1e-5, -0.5] {
                    let lower = threshold(&goal, upper);
                    let wanted = upper <= 0.0 && depth == Depth::Distance
                        || goal.is_met(&Bracket { lower: lower.next_up(), upper });
                    assert!(wanted, "{depth:?}, margin {margin}, upper {upper}: {lower}");
                }
            }
        }
    }

    #[test]
    fn a_verdict_needs_no_more_than_the_margin_and_a_contact_ends_everything() {
        let goal = Goal { margin: 0.1, cut_off: 5.0, ..Goal::verdict() };
        assert_eq!(threshold(&goal, f64::INFINITY), 0.1);
        assert_eq!(threshold(&goal, 0.05), 0.0);
        assert_eq!(threshold(&goal, 0.0), f64::NEG_INFINITY);
        assert_eq!(threshold(&Goal { depth: Depth::Distance, ..goal }, f64::INFINITY), 5.0);
    }
}
