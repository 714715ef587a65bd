//! What of a scene can be asked just now? Read without a lock: readers load a pointer, the writer swaps it.
//!
//! `tests/architecture` holds that neither this file nor what a question goes through after it names a lock.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use arc_swap::ArcSwap;

use super::ServiceError;
use super::revision_rule::{Found, Kept, Rule};
use crate::scene::{Revision, Snapshot};

/// The revisions of a scene that can be asked.
#[derive(Debug)]
pub(super) struct Published {
    kept: ArcSwap<Kept>,
    deleted: AtomicBool,
}

impl Published {
    pub fn new(first: Arc<Snapshot>) -> Self {
        Self { kept: ArcSwap::from_pointee(Kept::new(first)), deleted: AtomicBool::new(false) }
    }

    pub fn latest(&self) -> Arc<Snapshot> {
        Arc::clone(self.kept.load().latest())
    }

    /// All that can be asked, as it is now.
    pub fn all(&self) -> Arc<Kept> {
        self.kept.load_full()
    }

    /// The snapshot that fits, or `None` if it is still to come.
    ///
    /// # Errors
    /// It is gone.
    pub fn find(&self, rule: Rule) -> Result<Option<Found>, ServiceError> {
        self.kept.load().find(rule)
    }

    /// Whether the scene is gone.
    pub fn is_deleted(&self) -> bool {
        self.deleted.load(Ordering::Acquire)
    }

    /// Nobody asks the scene any more.
    pub fn delete(&self) {
        self.deleted.store(true, Ordering::Release);
    }

    /// Makes one more revision known, and forgets those before `oldest`. Only the one writer calls this.
    pub fn add(&self, snapshot: Arc<Snapshot>, oldest: Revision) {
        let next = self.kept.load().with(snapshot, oldest);
        self.kept.store(Arc::new(next));
    }
}
