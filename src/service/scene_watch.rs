//! One caller that watches a scene: waits for the next revision, and tells what changed up to it.
//!
//! Nothing is kept for a caller that does not ask: one that is slow is led over several revisions at once, and one that is
//! slower than changes are remembered is given the whole content instead, as is one that begins too far back. Watches of
//! etcd and Kubernetes end there and leave it to the caller to list and begin anew; here the list comes with the watch, so that
//! nothing can be missed in between, and a caller needs the code for it anyway, to begin with.

use std::sync::Arc;
use std::time::Instant;

use tokio::sync::watch;
use tokio::time::sleep_until;

use super::admission::Permit;
use super::deadline::Patience;
use super::scene_cell::SceneCell;
use super::{Service, ServiceError};
use crate::scene::{Changes, PairEntry, Revision, Snapshot};

/// What leads a copy of a scene from one revision to another.
#[derive(Debug)]
pub struct SceneStep {
    /// The scene as it is after the step.
    pub snapshot: Arc<Snapshot>,
    /// The revision the step leads on from; `None`: from nothing, and all of the snapshot counts as changed.
    pub from: Option<Revision>,
    /// What changed since the revision that the copy is at is not known any more.
    pub compacted: bool,
    /// What changed; empty where the step leads on from nothing.
    pub changes: Changes,
    /// Entries for pairs that changed, or all.
    pub entries: Vec<PairEntry>,
}

/// A watch that is under way. Dropping it ends it.
#[derive(Debug)]
pub struct SceneWatch {
    service: Arc<Service>,
    cell: Arc<SceneCell>,
    /// The revision that the caller's copy is at.
    told: Option<Revision>,
    first: bool,
    draining: watch::Receiver<bool>,
    /// When the caller no longer listens.
    until: Option<Instant>,
    _permit: Permit,
}

impl SceneWatch {
    pub(super) fn new(
        service: Arc<Service>,
        cell: Arc<SceneCell>,
        from: Option<Revision>,
        patience: Patience,
        permit: Permit,
    ) -> Self {
        let draining = service.draining();
        // A timeout beyond the end of the clock is none.
        let until = patience.timeout.and_then(|timeout| Instant::now().checked_add(timeout));
        Self { service, cell, told: from, first: true, draining, until, _permit: permit }
    }

    /// Waits for a revision beyond the last one told, and tells what leads to the newest; the first time at once, unless the
    /// caller is ahead of the scene. A step that is not asked for is not made.
    ///
    /// # Errors
    /// The scene was deleted, the daemon drains, or the caller's time is up. Then the watch has ended.
    pub async fn next(&mut self) -> Result<SceneStep, ServiceError> {
        let snapshot = self.newer().await?;
        let told = self.told;
        let step = self.work(move || Ok(SceneStep::between(told, snapshot))).await?;
        self.told = Some(step.snapshot.revision());
        self.first = false;
        Ok(step)
    }

    /// Does a caller's work for a step on the threads that answer questions.
    ///
    /// # Errors
    /// What `work` says.
    pub async fn work<T: Send + 'static>(
        &self,
        work: impl FnOnce() -> Result<T, ServiceError> + Send + 'static,
    ) -> Result<T, ServiceError> {
        self.service.workers().answer(work).await
    }

    async fn newer(&mut self) -> Result<Arc<Snapshot>, ServiceError> {
        let (cell, told) = (&self.cell, self.told);
        let newer = async {
            let Some(told) = told else { return cell.newest() };
            let newest = cell.newest()?;
            if self.first && newest.revision() == told { Ok(newest) } else { cell.newer_than(told).await }
        };
        let time_is_up = async {
            match self.until {
                Some(until) => sleep_until(until.into()).await,
                None => std::future::pending().await,
            }
        };
        tokio::select! {
            snapshot = newer => snapshot,
            // A sender that is gone means the same.
            _ = self.draining.wait_for(|draining| *draining) => Err(ServiceError::ShuttingDown),
            () = time_is_up => Err(ServiceError::DeadlineExceeded),
        }
    }
}

impl SceneStep {
    /// What leads from a revision to a snapshot, which is not older.
    fn between(from: Option<Revision>, snapshot: Arc<Snapshot>) -> Self {
        match from.map(|from| (from, snapshot.changes_since(from))) {
            Some((from, Ok(changes))) => {
                let entries = snapshot.changed_entries(&changes);
                Self { snapshot, from: Some(from), compacted: false, changes, entries }
            }
            from => {
                let (compacted, entries) = (from.is_some(), snapshot.pair_entries());
                Self { snapshot, from: None, compacted, changes: Changes::default(), entries }
            }
        }
    }
}
