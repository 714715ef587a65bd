//! One question on its way: a pinned snapshot, the moment to stop, and the batch split over threads.
//!
//! Parts are joined in the order of their items, so an answer is the same bytes for any number of threads.

use std::ops::Range;
use std::sync::Arc;

use rayon::prelude::*;

use super::ServiceError;
use super::answered::{Answered, CountedItem, Question};
use super::call_notes::CallNotes;
use super::deadline::Stop;
use super::revision_rule::Found;
use crate::limits::{LimitExceeded, Limits};
use crate::query::{
    Answer, Answers, CastItem, CastRays, CastShapes, Casts, CheckMotions, CheckMovingPairs, CheckStates, Clearance,
    ClearanceOf, Context, ItemBatch, MovingPairs, NearestBodies, NearestItem, Neighbours, Overlap, OverlapItem,
    Overlaps, Overlay, Overlays, PairQuery, Part, Prepared, Rays, Verdict, Wants, World, Worlds,
};
use crate::scene::{Revision, Snapshot};

/// A snapshot that is being asked. It exists only on the threads that answer questions.
#[derive(Debug)]
pub struct View {
    found: Found,
    /// The snapshot as it is, or what is supposed on it.
    pub(super) worlds: Worlds,
    pub(super) stop: Stop,
    pub(super) limits: Limits,
    /// Parts may be given to the threads that answer questions.
    many_threads: bool,
    /// Of the call that asks, if it is observed.
    pub(super) notes: Option<Arc<CallNotes>>,
}

/// Items that one thread takes at a time, at least: fewer cost more in handing over than they gain.
const SMALLEST_PART: usize = 8;
/// Parts for each thread, so that one slow part does not leave the others idle.
const PARTS_PER_THREAD: usize = 4;

impl View {
    pub(super) fn new(found: Found, stop: Stop, limits: &Limits) -> Self {
        let worlds = Worlds::as_is(&found.snapshot);
        Self { found, worlds, stop, limits: limits.clone(), many_threads: true, notes: CallNotes::current() }
    }

    /// A view for a thread that is none of those that answer questions, and answers all by itself.
    pub(super) fn on_one_thread(found: Found, stop: Stop, limits: &Limits) -> Self {
        Self { many_threads: false, ..Self::new(found, stop, limits) }
    }

    /// Does the parts of a batch, in order.
    fn each<T: Send>(
        &self,
        items: usize,
        smallest_part: usize,
        run: impl Fn(Range<usize>) -> T + Send + Sync,
    ) -> Vec<T> {
        if self.many_threads {
            return split(items, smallest_part).into_par_iter().map(run).collect();
        }
        (items > 0).then(|| run(0..items)).into_iter().collect()
    }

    /// The same with overlays: what is asked then is asked as if their edits had been applied.
    ///
    /// # Errors
    /// A cap, an edit that cannot be made, a body that cannot be held, an item whose alternative is not there, or a deadline
    /// that came first.
    pub fn supposing(&self, overlays: &Overlays) -> Result<Self, ServiceError> {
        let changes = |overlay: &Overlay| overlay.edits.len() + overlay.attached.len();
        let edits = changes(&overlays.common) + overlays.alternatives.iter().map(changes).sum::<usize>();
        LimitExceeded::check("max_overlays", overlays.alternatives.len() + 1, self.limits.max_overlays)?;
        LimitExceeded::check("max_overlay_edits", edits, self.limits.max_overlay_edits)?;
        let under = |base: &World, overlay: &Overlay, number: usize| {
            if self.stop.now() {
                return Err(ServiceError::DeadlineExceeded);
            }
            base.under(overlay, &self.limits).map_err(|error| ServiceError::of_overlay(error, number))
        };
        let common = under(&World::as_is(&self.found.snapshot), &overlays.common, 0)?;
        let alternatives = overlays.alternatives.par_iter().enumerate();
        let made: Vec<Result<World, ServiceError>> =
            alternatives.map(|(index, overlay)| under(&common, overlay, index + 1)).collect();
        // Of several that cannot be, the first is told, whatever thread was first.
        let alternatives = made.into_iter().collect::<Result<_, ServiceError>>()?;
        let worlds = Worlds::new(common, alternatives, overlays.of_item.clone())?;
        Ok(Self {
            found: self.found.clone(),
            worlds,
            stop: self.stop.clone(),
            limits: self.limits.clone(),
            many_threads: self.many_threads,
            notes: self.notes.clone(),
        })
    }

    /// What is asked, with the overlay of all items.
    #[must_use]
    pub fn snapshot(&self) -> &Arc<Snapshot> {
        &self.worlds.common().snapshot
    }

    /// What is asked, with all overlays.
    #[must_use]
    pub fn worlds(&self) -> &Worlds {
        &self.worlds
    }

    /// The oldest revision that could be asked when the snapshot was looked up; not later than it.
    #[must_use]
    pub fn oldest_revision(&self) -> Revision {
        self.found.oldest
    }

    /// # Errors
    /// A cap, a question that cannot be asked, or a deadline that came before any answer.
    pub fn check_states(&self, question: &CheckStates) -> Result<Answer, ServiceError> {
        LimitExceeded::check("max_joint_values", question.positions.len(), self.limits.max_joint_values)?;
        self.answer("states", &Prepared::check_states(&self.worlds, question)?, &question.context)
    }

    /// # Errors
    /// As for [`View::check_states`].
    pub fn check_motions(&self, question: &CheckMotions) -> Result<Answer, ServiceError> {
        LimitExceeded::check("max_joint_values", question.positions.len(), self.limits.max_joint_values)?;
        LimitExceeded::check("max_motion_states", question.max_states, self.limits.max_motion_states)?;
        self.answer("motions", &Prepared::check_motions(&self.worlds, question)?, &question.context)
    }

    /// # Errors
    /// As for [`View::check_states`].
    pub fn clearance(&self, question: &Clearance) -> Result<Answer, ServiceError> {
        let (of, context) = match &question.subjects {
            ClearanceOf::States(states) => {
                LimitExceeded::check("max_joint_values", states.positions.len(), self.limits.max_joint_values)?;
                ("states", &states.context)
            }
            ClearanceOf::Subjects(pairs) => {
                LimitExceeded::check("max_items", pairs.items.len(), self.limits.max_items)?;
                ("subjects", &pairs.context)
            }
        };
        self.answer(of, &Prepared::clearance(&self.worlds, question)?, context)
    }

    /// # Errors
    /// As for [`View::check_states`].
    pub fn collide(&self, question: &PairQuery) -> Result<Answer, ServiceError> {
        // Before anything is made of the items; a refusal is told with their number, too.
        self.note_question("subjects", question.items.len(), &question.context);
        LimitExceeded::check("max_items", question.items.len(), self.limits.max_items)?;
        self.answer("subjects", &Prepared::collide(&self.worlds, question)?, &question.context)
    }

    /// # Errors
    /// As for [`View::check_states`].
    pub fn distance(&self, question: &PairQuery) -> Result<Answer, ServiceError> {
        // Before anything is made of the items; a refusal is told with their number, too.
        self.note_question("subjects", question.items.len(), &question.context);
        LimitExceeded::check("max_items", question.items.len(), self.limits.max_items)?;
        self.answer("subjects", &Prepared::distance(&self.worlds, question)?, &question.context)
    }

    /// # Errors
    /// As for [`View::check_states`].
    pub fn cast_rays(&self, question: &CastRays) -> Result<Answers<CastItem>, ServiceError> {
        self.answer_each("rays", &Rays::new(self.snapshot(), question)?, &question.context)
    }

    /// # Errors
    /// As for [`View::check_states`].
    pub fn cast_shapes(&self, question: &CastShapes) -> Result<Answers<CastItem>, ServiceError> {
        self.answer_each("shapes", &Casts::new(self.snapshot(), question)?, &question.context)
    }

    /// # Errors
    /// As for [`View::check_states`].
    pub fn check_moving_pairs(&self, question: &CheckMovingPairs) -> Result<Answers<CastItem>, ServiceError> {
        self.answer_each("moving pairs", &MovingPairs::new(self.snapshot(), question)?, &question.context)
    }

    /// # Errors
    /// As for [`View::check_states`].
    pub fn overlap(&self, question: &Overlap) -> Result<Answers<OverlapItem>, ServiceError> {
        self.answer_each("regions", &Overlaps::new(self.snapshot(), question)?, &question.context)
    }

    /// # Errors
    /// As for [`View::check_states`].
    pub fn nearest_bodies(&self, question: &NearestBodies) -> Result<Answers<NearestItem>, ServiceError> {
        LimitExceeded::check("max_pairs", question.count, self.limits.max_pairs)?;
        self.answer_each("points", &Neighbours::new(self.snapshot(), question)?, &question.context)
    }

    fn answer_each<B: ItemBatch>(
        &self,
        of: &'static str,
        batch: &B,
        context: &Context,
    ) -> Result<Answers<B::Item>, ServiceError>
    where
        B::Item: CountedItem,
    {
        self.note_question(of, batch.len(), context);
        LimitExceeded::check("max_items", batch.len(), self.limits.max_items)?;
        self.check_context(context)?;
        let run = |part: Range<usize>| batch.run(part, &|| self.stop.now());
        let parts: Vec<(Vec<B::Item>, usize)> = self.each(batch.len(), SMALLEST_PART, run);
        let answers = batch.join(parts);
        self.note_answered(|| Answered::from(&answers));
        if answers.out_of_time && answers.answered == 0 {
            return Err(ServiceError::DeadlineExceeded);
        }
        Ok(answers)
    }

    fn answer(&self, of: &'static str, question: &Prepared<'_>, context: &Context) -> Result<Answer, ServiceError> {
        self.note_question(of, question.len(), context);
        LimitExceeded::check("max_items", question.len(), self.limits.max_items)?;
        self.check_context(context)?;
        let run = |part: Range<usize>| question.run(part, &|| self.stop.now());
        let parts: Vec<Part> = self.each(question.len(), question.smallest_part(), run);
        let answer = question.join(parts);
        self.note_answered(|| Answered::from(&answer));
        let nothing = answer.items.iter().all(|item| item.verdict == Verdict::NotRun);
        if answer.out_of_time && nothing {
            return Err(ServiceError::DeadlineExceeded);
        }
        Ok(answer)
    }

    fn check_context(&self, context: &Context) -> Result<(), LimitExceeded> {
        LimitExceeded::check("max_pairs", context.max_pairs, self.limits.max_pairs)?;
        check_samples(context.wants, context.derivatives.samples, &self.limits)
    }

    fn note_question(&self, of: &'static str, items: usize, context: &Context) {
        if let Some(notes) = &self.notes {
            notes.note_question(Question::new(of, items, context));
        }
    }

    fn note_answered(&self, answered: impl FnOnce() -> Answered) {
        if let Some(notes) = &self.notes {
            notes.note_answered(answered());
        }
    }
}

/// Samples count where derivatives are wanted.
pub(super) fn check_samples(wants: Wants, samples: u32, limits: &Limits) -> Result<(), LimitExceeded> {
    let asked = if wants.derivatives { samples as usize } else { 0 };
    LimitExceeded::check("max_derivative_samples", asked, limits.max_derivative_samples)
}

/// Ranges of items that follow one another, of `smallest` items at least but for the last.
fn split(items: usize, smallest: usize) -> Vec<Range<usize>> {
    let parts = PARTS_PER_THREAD * rayon::current_num_threads();
    let size = items.div_ceil(parts).max(smallest);
    (0..items).step_by(size).map(|first| first..(first + size).min(items)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_cover_the_items_in_order() {
        assert!(split(0, 8).is_empty());
        for items in [1, 7, 8, 9, 100, 4096] {
            let parts = split(items, 8);
            assert_eq!(parts[0].start, 0);
            assert_eq!(parts[parts.len() - 1].end, items);
            assert!(parts.windows(2).all(|pair| pair[0].end == pair[1].start));
        }
    }
}
