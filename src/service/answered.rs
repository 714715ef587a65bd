//! What was asked in a call, and what came out, in numbers: for whoever watches the daemon, not for the caller.

use std::ops::AddAssign;

use crate::narrow_phase::Cost;
use crate::query::{Answer, Answers, CastItem, CastVerdict, Context, Indeterminacy, NearestItem, OverlapItem};
use crate::query::{Verdict, Wants};

/// A question to a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Question {
    /// What its items are, for example `states`.
    pub of: &'static str,
    /// How many there are.
    pub items: usize,
    /// What was to be computed.
    pub wants: Wants,
    /// Metres.
    pub margin: f64,
    /// How narrow brackets were to be, metres.
    pub absolute_tolerance: f64,
    /// The same as a factor.
    pub relative_tolerance: f64,
}

impl Question {
    pub(super) fn new(of: &'static str, items: usize, context: &Context) -> Self {
        Self {
            of,
            items,
            wants: context.wants,
            margin: context.margin,
            absolute_tolerance: context.accuracy.absolute,
            relative_tolerance: context.accuracy.relative,
        }
    }
}

/// An answer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Answered {
    /// How many items came to which verdict.
    pub verdicts: Verdicts,
    /// What it cost, all items together.
    pub cost: Cost,
    /// The time ran out before every item was looked at.
    pub out_of_time: bool,
}

/// How many items came to which verdict.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Verdicts {
    /// Proved free; of casts: nothing is met.
    pub free: u64,
    /// Proved to be within the margin.
    pub margin: u64,
    /// Proved to collide; of casts: something is met.
    pub collision: u64,
    /// Undecided within the rounding of the numbers as given.
    pub rounding: u64,
    /// Undecided at the cap on iterations.
    pub iteration_limit: u64,
    /// Undecided when time ran out.
    pub time_limit: u64,
    /// Undecided at the resolution of a motion.
    pub resolution: u64,
    /// Not looked at.
    pub not_run: u64,
    /// Cannot be asked.
    pub invalid_input: u64,
}

impl Verdicts {
    /// All counts, each with its name and, of undecided items, why.
    #[must_use]
    pub fn named(&self) -> [(&'static str, &'static str, u64); 9] {
        [
            ("free", "", self.free),
            ("margin", "", self.margin),
            ("collision", "", self.collision),
            ("indeterminate", "rounding", self.rounding),
            ("indeterminate", "iteration_limit", self.iteration_limit),
            ("indeterminate", "time_limit", self.time_limit),
            ("indeterminate", "resolution", self.resolution),
            ("not_run", "", self.not_run),
            ("invalid_input", "", self.invalid_input),
        ]
    }

    /// Items in all.
    #[must_use]
    pub fn total(&self) -> u64 {
        self.named().iter().map(|(_, _, count)| count).sum()
    }

    pub(super) fn count(&mut self, verdict: Verdict) {
        *match verdict {
            Verdict::Free => &mut self.free,
            Verdict::Margin => &mut self.margin,
            Verdict::Collision => &mut self.collision,
            Verdict::Indeterminate(why) => self.undecided(why),
            Verdict::NotRun => &mut self.not_run,
            Verdict::InvalidInput => &mut self.invalid_input,
        } += 1;
    }

    fn undecided(&mut self, why: Indeterminacy) -> &mut u64 {
        match why {
            Indeterminacy::Rounding => &mut self.rounding,
            Indeterminacy::IterationLimit => &mut self.iteration_limit,
            Indeterminacy::TimeLimit => &mut self.time_limit,
            Indeterminacy::Resolution => &mut self.resolution,
        }
    }
}

impl AddAssign for Verdicts {
    fn add_assign(&mut self, other: Self) {
        self.free += other.free;
        self.margin += other.margin;
        self.collision += other.collision;
        self.rounding += other.rounding;
        self.iteration_limit += other.iteration_limit;
        self.time_limit += other.time_limit;
        self.resolution += other.resolution;
        self.not_run += other.not_run;
        self.invalid_input += other.invalid_input;
    }
}

/// The answer to one item, as far as it is counted.
pub trait CountedItem {
    /// What was decided.
    fn count(&self, verdicts: &mut Verdicts);
    /// What it cost.
    fn cost(&self) -> Cost;
}

impl CountedItem for CastItem {
    fn count(&self, verdicts: &mut Verdicts) {
        *match self.verdict {
            CastVerdict::Clear => &mut verdicts.free,
            CastVerdict::Hit => &mut verdicts.collision,
            CastVerdict::Indeterminate(why) => verdicts.undecided(why),
            CastVerdict::NotRun => &mut verdicts.not_run,
            CastVerdict::InvalidInput => &mut verdicts.invalid_input,
        } += 1;
    }

    fn cost(&self) -> Cost {
        self.cost
    }
}

impl CountedItem for OverlapItem {
    fn count(&self, verdicts: &mut Verdicts) {
        verdicts.count(self.verdict);
    }

    fn cost(&self) -> Cost {
        self.cost
    }
}

impl CountedItem for NearestItem {
    fn count(&self, verdicts: &mut Verdicts) {
        verdicts.count(self.verdict);
    }

    fn cost(&self) -> Cost {
        self.cost
    }
}

impl From<&Answer> for Answered {
    fn from(answer: &Answer) -> Self {
        let mut verdicts = Verdicts::default();
        answer.items.iter().for_each(|item| verdicts.count(item.verdict));
        Self { verdicts, cost: answer.cost, out_of_time: answer.out_of_time }
    }
}

impl<T: CountedItem> From<&Answers<T>> for Answered {
    fn from(answers: &Answers<T>) -> Self {
        let mut answered = Self { out_of_time: answers.out_of_time, ..Self::default() };
        for item in &answers.items {
            item.count(&mut answered.verdicts);
            answered.cost += item.cost();
        }
        answered
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::query::{Coverage, ItemAnswer};
    use crate::scene::{Epoch, Revision};

    #[test]
    fn each_verdict_is_counted_once_under_its_own_name() {
        let why = Indeterminacy::TimeLimit;
        let all = [Verdict::Free, Verdict::Margin, Verdict::Collision, Verdict::Indeterminate(why), Verdict::NotRun];
        let items = all.into_iter().map(ItemAnswer::without_work).collect();
        let answer = Answer {
            epoch: Epoch(1),
            revision: Revision(1),
            items,
            stopped_at: None,
            out_of_time: true,
            coverage: Coverage::default(),
            cost: Cost { pairs: 3, ..Cost::default() },
        };
        let answered = Answered::from(&answer);
        assert_eq!((answered.verdicts.total(), answered.cost.pairs, answered.out_of_time), (5, 3, true));
        let counted: Vec<_> = answered.verdicts.named().into_iter().filter(|(_, _, count)| *count == 1).collect();
        let names: Vec<_> = counted.iter().map(|(name, why, _)| (*name, *why)).collect();
        let undecided = ("indeterminate", "time_limit");
        assert_eq!(names, [("free", ""), ("margin", ""), ("collision", ""), undecided, ("not_run", "")]);
    }
}
