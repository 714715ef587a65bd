//! The scene that changes: lists of edits in, revisions out, all or nothing.

use std::collections::VecDeque;
use std::sync::Arc;

use super::{BodyId, Edit, Epoch, NotKept, Refusal, Revision, SceneOptions, Snapshot};
use crate::limits::{LimitExceeded, Limits};

/// Builds with debug assertions look at every snapshot of a scene of up to so many bodies as a whole.
const VALIDATED_BODIES: usize = 32;

/// A scene and its last snapshots. One owner changes it; everybody else reads snapshots.
#[derive(Debug)]
pub struct Scene {
    limits: Limits,
    /// Revisions without a gap, the latest last; never empty.
    kept: VecDeque<Arc<Snapshot>>,
    /// Bytes that the kept snapshots wrote, but for the oldest.
    written: usize,
}

/// What an accepted list of edits led to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Applied {
    /// The first revision that contains the edits.
    pub revision: Revision,
    /// The ids of the bodies that were added, in the order of the edits that added them.
    pub added: Vec<BodyId>,
}

impl Scene {
    /// An empty scene at revision zero, under the default caps.
    #[must_use]
    pub fn new(epoch: Epoch) -> Self {
        Self::with_limits(epoch, Limits::default())
    }

    /// As [`Scene::with_options`], with the default options.
    #[must_use]
    pub fn with_limits(epoch: Epoch, limits: Limits) -> Self {
        Self::with_options(epoch, limits, &SceneOptions::default())
    }

    /// An empty scene at revision zero. Of the caps it holds those on edits, bodies, robots, entries for pairs, groups,
    /// names and snapshots.
    #[must_use]
    pub fn with_options(epoch: Epoch, limits: Limits, options: &SceneOptions) -> Self {
        Self { limits, kept: VecDeque::from([Arc::new(Snapshot::empty(epoch, options))]), written: 0 }
    }

    /// The latest snapshot.
    #[must_use]
    pub fn snapshot(&self) -> Arc<Snapshot> {
        Arc::clone(self.latest())
    }

    /// The snapshot of a revision, as far as it is kept: by default the last 64 are.
    ///
    /// # Errors
    /// The revision is gone or not reached yet.
    pub fn at(&self, revision: Revision) -> Result<Arc<Snapshot>, NotKept> {
        let (oldest, latest) = (self.oldest_revision(), self.latest().revision());
        if revision > latest {
            return Err(NotKept::Ahead { asked: revision, latest });
        }
        let place = revision.0.checked_sub(oldest.0).ok_or(NotKept::Gone { asked: revision, oldest })?;
        Ok(Arc::clone(&self.kept[place as usize]))
    }

    /// The oldest revision that can still be had.
    #[must_use]
    pub fn oldest_revision(&self) -> Revision {
        self.kept[0].revision()
    }

    /// Makes all edits in their order, or none. Each is checked in the state that the earlier ones lead to.
    ///
    /// With `expected` given, only if the scene is at that revision: compare-and-set. Every accepted list makes one
    /// revision, an empty one too: a revision counts accepted lists, and an empty list tells whether `expected` holds.
    ///
    /// # Errors
    /// What was wrong first: the expected revision, the number of edits, or the first edit that cannot be made, with
    /// the field and the reason. The scene is as before, and no id was used up.
    pub fn apply(&mut self, edits: &[Edit], expected: Option<Revision>) -> Result<Applied, Refusal> {
        let actual = self.latest().revision();
        if let Some(expected) = expected.filter(|expected| *expected != actual) {
            return Err(Refusal::RevisionMismatch { expected, actual });
        }
        LimitExceeded::check("max_edits", edits.len(), self.limits.max_edits)?;
        let mut next = Snapshot::clone(self.latest());
        next.written = 0;
        let mut added = Vec::new();
        for (index, edit) in edits.iter().enumerate() {
            let outcome = next.change(edit, &self.limits);
            added.extend(outcome.map_err(|fault| Refusal::Edit { index, field: fault.field, reason: fault.reason })?);
        }
        let revision = Revision(actual.0 + 1);
        next.settle(self.latest(), revision);
        next.changes.close(revision, self.limits.snapshots_kept);
        debug_assert!(next.body_count() > VALIDATED_BODIES || next.validate() == Ok(()), "{:?}", next.validate());
        next.count_written(added.len());
        self.written += next.written();
        self.kept.push_back(Arc::new(next));
        self.let_go();
        Ok(Applied { revision, added })
    }

    /// Lets the oldest snapshots go that are too many, or hold too much beside the latest.
    fn let_go(&mut self) {
        while self.kept.len() > 1
            && (self.kept.len() > self.limits.snapshots_kept || self.written > self.limits.max_kept_bytes)
        {
            self.kept.pop_front();
            // The oldest kept holds all of its own; only what came after it is held beside.
            self.written -= self.kept[0].written();
        }
    }

    fn latest(&self) -> &Arc<Snapshot> {
        self.kept.back().expect("a scene keeps at least its latest snapshot")
    }
}
