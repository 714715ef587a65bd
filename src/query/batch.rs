//! Many items on one snapshot: in parts, on any number of threads, with the same answer.

use std::ops::Range;

use super::answer::{Answer, ItemAnswer, Refused, Verdict};
use super::context::length;
use super::motions::Motions;
use super::pairs::Pairs;
use super::request::{CheckMotions, CheckStates, Clearance, ClearanceOf, Mode, PairQuery};
use super::states::States;
use crate::narrow_phase::Cost;
use crate::scene::Snapshot;

/// A checked request on a snapshot. Runs of disjoint ranges may go on at the same time; [`Prepared::join`] puts their
/// parts together in order.
pub struct Prepared<'a> {
    snapshot: &'a Snapshot,
    mode: Mode,
    question: Question<'a>,
}

enum Question<'a> {
    States(States<'a>),
    Motions(Motions<'a>),
    Pairs(Pairs<'a>),
}

/// The answers to a range of items.
pub struct Part {
    items: Vec<ItemAnswer>,
    out_of_time: bool,
}

impl<'a> Prepared<'a> {
    /// Is the robot free in these states?
    ///
    /// # Errors
    /// A context that cannot be, a robot that is not in the scene, positions that are no whole number of states.
    pub fn check_states(snapshot: &'a Snapshot, request: &'a CheckStates) -> Result<Self, Refused> {
        let question = Question::States(States::new(snapshot, request)?);
        Ok(Self { snapshot, mode: request.mode, question })
    }

    /// Is the robot free all along these motions?
    ///
    /// # Errors
    /// A context, resolution or number of states that cannot be, a robot that is not in the scene or does not move, positions
    /// that are no whole number of motions.
    pub fn check_motions(snapshot: &'a Snapshot, request: &'a CheckMotions) -> Result<Self, Refused> {
        let question = Question::Motions(Motions::new(snapshot, request)?);
        Ok(Self { snapshot, mode: request.mode, question })
    }

    /// Which pairs touch?
    ///
    /// # Errors
    /// A context that cannot be.
    pub fn collide(snapshot: &'a Snapshot, request: &'a PairQuery) -> Result<Self, Refused> {
        let question = Question::Pairs(Pairs::collide(snapshot, request)?);
        Ok(Self { snapshot, mode: request.mode, question })
    }

    /// How far is the nearest?
    ///
    /// # Errors
    /// A context that cannot be.
    pub fn distance(snapshot: &'a Snapshot, request: &'a PairQuery) -> Result<Self, Refused> {
        let question = Question::Pairs(Pairs::distance(snapshot, request)?);
        Ok(Self { snapshot, mode: request.mode, question })
    }

    /// Which pairs are within a distance?
    ///
    /// # Errors
    /// A distance that is negative or not finite, and what the question about states or subjects refuses.
    pub fn clearance(snapshot: &'a Snapshot, request: &'a Clearance) -> Result<Self, Refused> {
        length("within", request.within)?;
        let (question, mode) = match &request.subjects {
            ClearanceOf::States(states) => {
                (Question::States(States::clearance(snapshot, states, request.within)?), states.mode)
            }
            ClearanceOf::Subjects(pairs) => {
                (Question::Pairs(Pairs::clearance(snapshot, pairs, request.within)?), pairs.mode)
            }
        };
        Ok(Self { snapshot, mode, question })
    }

    /// Number of items that a thread should take at a time, at least: fewer cost more in handing over than they gain.
    #[must_use]
    pub fn smallest_part(&self) -> usize {
        match &self.question {
            Question::States(_) | Question::Pairs(_) => 8,
            // A motion is the work of tens of states.
            Question::Motions(_) => 1,
        }
    }

    /// Number of items.
    #[must_use]
    pub fn len(&self) -> usize {
        match &self.question {
            Question::States(states) => states.len(),
            Question::Motions(motions) => motions.len(),
            Question::Pairs(pairs) => pairs.len(),
        }
    }

    /// Whether there is nothing to answer.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Answers the items of `range`. `stop` is asked before each item, and within long ones; once it says yes, what is
    /// left is not run.
    #[must_use]
    pub fn run(&self, range: Range<usize>, stop: &dyn Fn() -> bool) -> Part {
        match &self.question {
            Question::States(states) => {
                let mut scratch = states.scratch();
                self.run_items(range, stop, |i| states.answer(i, &mut scratch, stop))
            }
            Question::Motions(motions) => self.run_items(range, stop, |i| motions.answer(i, stop)),
            Question::Pairs(pairs) => self.run_items(range, stop, |i| pairs.answer(i, stop)),
        }
    }

    fn run_items(
        &self,
        range: Range<usize>,
        stop: &dyn Fn() -> bool,
        mut answer: impl FnMut(usize) -> ItemAnswer,
    ) -> Part {
        let count = range.len();
        let mut part = Part { items: Vec::with_capacity(count), out_of_time: false };
        for i in range {
            if stop() {
                part.out_of_time = true;
                break;
            }
            let item = answer(i);
            // An item that the clock cut short is no answer: its bracket would depend on the machine's speed.
            if stop() {
                part.out_of_time = true;
                break;
            }
            let stops = self.mode == Mode::StopAtFirst && item.verdict.stops_batch();
            part.items.push(item);
            if stops {
                break;
            }
        }
        part.items.resize(count, ItemAnswer::without_work(Verdict::NotRun));
        part
    }

    /// The answer, from the parts of consecutive ranges that cover all items.
    #[must_use]
    pub fn join(&self, parts: impl IntoIterator<Item = Part>) -> Answer {
        let mut answer = Answer {
            epoch: self.snapshot.epoch(),
            revision: self.snapshot.revision(),
            items: Vec::with_capacity(self.len()),
            stopped_at: None,
            out_of_time: false,
            cost: Cost::default(),
        };
        for part in parts {
            // What comes after a gap is not told when the first hit is asked for: an earlier one may be in the gap.
            let after_gap = self.mode == Mode::StopAtFirst && answer.out_of_time;
            answer.out_of_time |= part.out_of_time && answer.stopped_at.is_none();
            for item in part.items {
                if answer.stopped_at.is_some() || after_gap {
                    answer.items.push(ItemAnswer::without_work(Verdict::NotRun));
                    continue;
                }
                if self.mode == Mode::StopAtFirst && item.verdict.stops_batch() {
                    answer.stopped_at = Some(answer.items.len());
                }
                answer.cost += item.cost;
                answer.items.push(item);
            }
        }
        answer
    }

    /// Everything in one go.
    #[must_use]
    pub fn answer(&self, stop: &dyn Fn() -> bool) -> Answer {
        self.join([self.run(0..self.len(), stop)])
    }
}
