//! How long do the items of a sample take, asked in several ways? Rows of an estimate, measured by turns.
//!
//! They take turns item by item, so that whatever slows the machine for a while slows all of them.

use std::time::Instant;

use super::answered::Answered;
use super::deadline::Stop;
use super::prices::{Price, Till};
use crate::query::{OneByOne, Output, Prepared};

/// How often the sample is measured, if there is time: an item counts by its quickest turn.
pub(super) const TURNS: usize = 3;

/// What has been measured so far.
pub(super) struct Measured<'a> {
    /// None where time was over before the question was checked.
    questions: Vec<Option<Prepared<'a>>>,
    tills: Vec<Till>,
    all_pairs: bool,
    asked: u64,
    turns: usize,
}

impl<'a> Measured<'a> {
    /// Nothing. `all_pairs`: each listed pair is narrowed, not the nearest alone.
    pub fn new(all_pairs: bool) -> Self {
        Self { questions: Vec::new(), tills: Vec::new(), all_pairs, asked: 0, turns: 0 }
    }

    /// One more row.
    pub fn begin(&mut self, output: Output, tolerance: Option<f64>, question: Option<Prepared<'a>>) {
        self.questions.push(question);
        self.tills.push(Till::new(output, tolerance, self.all_pairs));
    }

    pub fn has_no_rows(&self) -> bool {
        self.tills.is_empty()
    }

    /// Measures every row on items `0..sample`, as often as there is time. Of a turn after the first that is not finished nothing counts.
    pub fn measure(&mut self, sample: usize, stop: &Stop) {
        let now = || stop.now();
        let Some(mut rows) = self.questions.iter().map(|row| row.as_ref().map(Prepared::one_by_one)).collect() else {
            return;
        };
        let rows: &mut Vec<OneByOne> = &mut rows;
        for row in &mut *rows {
            self.asked += 1;
            if row.answer(0, &now).is_none() {
                return;
            }
        }
        for turn in 0..TURNS {
            let mut times = vec![Vec::with_capacity(sample); rows.len()];
            for item in 0..sample {
                // Another row comes first in each round. What it asks first is not counted: all find the item in the caches.
                let first = (item + turn) % rows.len();
                self.asked += 1;
                if rows[first].answer(item, &now).is_none() {
                    return;
                }
                for index in (first..rows.len()).chain(0..first) {
                    self.asked += 1;
                    let begun = Instant::now();
                    let answer = rows[index].answer(item, &now);
                    let took = u64::try_from(begun.elapsed().as_nanos()).unwrap_or(u64::MAX);
                    let Some(answer) = answer else { return };
                    if turn == 0 {
                        self.tills[index].take(&answer, took);
                    } else {
                        times[index].push(took);
                    }
                }
            }
            self.tills.iter_mut().zip(&times).for_each(|(till, times)| till.again(times));
            self.turns += 1;
        }
    }

    /// How often the whole sample was measured.
    pub fn turns(&self) -> usize {
        self.turns
    }

    /// Items asked, those not counted included.
    pub fn asked(&self) -> u64 {
        self.asked
    }

    /// Whether no item was measured.
    pub fn is_empty(&self) -> bool {
        self.tills.iter().all(Till::is_empty)
    }

    /// For whoever watches the daemon: every item once for each row.
    pub fn answered(&self, out_of_time: bool) -> Answered {
        let mut answered = Answered { out_of_time, ..Answered::default() };
        for till in &self.tills {
            answered.verdicts += *till.verdicts();
            answered.cost += till.cost();
        }
        answered
    }

    /// The rows.
    pub fn prices(self, sample: usize) -> Vec<Price> {
        self.tills.into_iter().map(|till| till.price(sample)).collect()
    }
}
