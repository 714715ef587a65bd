//! Which state of a scene is asked, and is it there?

use std::collections::VecDeque;
use std::sync::Arc;

use super::ServiceError;
use crate::scene::{Epoch, Revision, Snapshot};

/// Which revision may answer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Rule {
    /// The newest when the question is looked at.
    #[default]
    Latest,
    /// This one.
    Exactly(Revision),
    /// This one or a newer.
    AtLeast(Revision),
}

/// Which epoch and revision may answer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RevisionRule {
    /// The epoch the caller means; `None`: any.
    pub epoch: Option<Epoch>,
    /// The revision.
    pub rule: Rule,
}

/// What fits a rule, and what could be asked at the same instant.
#[derive(Clone, Debug)]
pub(super) struct Found {
    pub snapshot: Arc<Snapshot>,
    /// Never later than the snapshot.
    pub oldest: Revision,
}

/// The revisions that can be asked, oldest first. Never empty.
#[derive(Clone, Debug)]
pub(super) struct Kept {
    snapshots: VecDeque<Arc<Snapshot>>,
}

impl Kept {
    pub fn new(first: Arc<Snapshot>) -> Self {
        Self { snapshots: VecDeque::from([first]) }
    }

    /// The same with one more, and without those before `oldest`.
    pub fn with(&self, next: Arc<Snapshot>, oldest: Revision) -> Self {
        let mut snapshots = self.snapshots.clone();
        snapshots.push_back(next);
        while snapshots.len() > 1 && snapshots[0].revision() < oldest {
            snapshots.pop_front();
        }
        Self { snapshots }
    }

    pub fn iter(&self) -> impl Iterator<Item = &Arc<Snapshot>> {
        self.snapshots.iter()
    }

    pub fn oldest(&self) -> &Arc<Snapshot> {
        self.snapshots.front().expect("there is always one revision")
    }

    pub fn latest(&self) -> &Arc<Snapshot> {
        self.snapshots.back().expect("there is always one revision")
    }

    /// The snapshot that fits, or `None` if it is still to come.
    ///
    /// # Errors
    /// It is gone.
    pub fn find(&self, rule: Rule) -> Result<Option<Found>, ServiceError> {
        let (latest, oldest) = (self.latest(), self.oldest().revision());
        let snapshot = match rule {
            Rule::Latest => Some(latest),
            Rule::AtLeast(asked) => (latest.revision() >= asked).then_some(latest),
            Rule::Exactly(asked) if asked < oldest => return Err(ServiceError::RevisionGone { asked, oldest }),
            Rule::Exactly(asked) => self.snapshots.iter().find(|snapshot| snapshot.revision() == asked),
        };
        Ok(snapshot.map(|snapshot| Found { snapshot: Arc::clone(snapshot), oldest }))
    }
}
