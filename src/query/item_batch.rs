//! A batch whose items are answered each on its own: in parts, on any number of threads, with the same answers.

use std::ops::Range;

use super::cast_answer::Answers;
use super::declared::Coverage;
use crate::scene::Snapshot;

/// A checked request of independent items.
pub trait ItemBatch: Sync {
    /// The answer to one.
    type Item: Send;

    /// What is asked.
    fn snapshot(&self) -> &Snapshot;

    /// Number of items.
    fn len(&self) -> usize;

    /// Whether there is nothing to answer.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Answers one item; `stop` is asked within long ones.
    fn answer(&self, item: usize, stop: &dyn Fn() -> bool) -> Self::Item;

    /// What stands for an item that was not looked at.
    fn not_run(&self) -> Self::Item;

    /// What none of the answers says anything about.
    fn coverage(&self) -> Coverage {
        Coverage::default()
    }

    /// Answers the items of a range, and says how many of them were looked at. `stop` is asked before each item; an item that it cut short is
    /// no answer.
    fn run(&self, range: Range<usize>, stop: &dyn Fn() -> bool) -> (Vec<Self::Item>, usize) {
        let count = range.len();
        let mut items = Vec::with_capacity(count);
        for index in range {
            if stop() {
                break;
            }
            let item = self.answer(index, stop);
            if stop() {
                break;
            }
            items.push(item);
        }
        let answered = items.len();
        items.resize_with(count, || self.not_run());
        (items, answered)
    }

    /// The answers, from those to consecutive ranges that cover all items.
    fn join(&self, parts: impl IntoIterator<Item = (Vec<Self::Item>, usize)>) -> Answers<Self::Item> {
        let (epoch, revision) = (self.snapshot().epoch(), self.snapshot().revision());
        let mut items = Vec::with_capacity(self.len());
        let mut answered = 0;
        for (part, looked_at) in parts {
            items.extend(part);
            answered += looked_at;
        }
        Answers { epoch, revision, out_of_time: answered < items.len(), answered, coverage: self.coverage(), items }
    }

    /// Everything in one go.
    fn answer_all(&self, stop: &dyn Fn() -> bool) -> Answers<Self::Item> {
        self.join([self.run(0..self.len(), stop)])
    }
}
