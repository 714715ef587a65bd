//! One caller that watches the contacts of a scene: waits for the next revision, and leads the contacts on to it.
//!
//! Nothing is worked out before it is asked for, and nothing is kept for a caller that does not ask: one that is slow is
//! led over several revisions at once. What was told last is the state that the next events lead on from.

use std::sync::Arc;
use std::time::{Duration, Instant};

use tokio::sync::watch;
use tokio::time::sleep_until;

use super::admission::Permit;
use super::deadline::{Deadline, Patience, Stop};
use super::scene_cell::SceneCell;
use super::{Service, ServiceError, workers};
use crate::query::{ContactChanges, ContactQuestion, ContactTracker, NotAdvanced};
use crate::scene::{Revision, Snapshot};

/// A watch that is under way. Dropping it ends it, and stops what is being worked out for it.
#[derive(Debug)]
pub struct ContactWatch {
    service: Arc<Service>,
    cell: Arc<SceneCell>,
    held: Held,
    /// The revision to begin with.
    first: Option<Arc<Snapshot>>,
    draining: watch::Receiver<bool>,
    /// When the caller no longer listens.
    until: Option<Instant>,
}

/// What goes with the work: a watch whose caller is gone keeps its place until its thread is free.
#[derive(Debug)]
struct Held {
    tracker: ContactTracker,
    _permit: Permit,
}

impl ContactWatch {
    pub(super) fn new(
        service: Arc<Service>,
        cell: Arc<SceneCell>,
        (question, first): (ContactQuestion, Arc<Snapshot>),
        patience: Patience,
        permit: Permit,
    ) -> Self {
        let draining = service.draining();
        Self {
            service,
            cell,
            held: Held { tracker: ContactTracker::new(question), _permit: permit },
            first: Some(first),
            draining,
            // A timeout beyond the end of the clock is none.
            until: patience.timeout.and_then(|timeout| Instant::now().checked_add(timeout)),
        }
    }

    /// Waits for a revision beyond the last one told, and tells what became of the contacts up to the newest; the first
    /// time at once. `told` makes of it what the caller needs, on the thread that worked it out.
    ///
    /// # Errors
    /// The scene was deleted, the daemon drains, the caller's time is up, a question that cannot be asked, or a cap. Then
    /// the watch has ended.
    pub async fn next<T: Send + 'static>(
        mut self,
        told: impl FnOnce(&ContactChanges) -> T + Send + 'static,
    ) -> Result<(Self, T), ServiceError> {
        let snapshot = match self.first.take() {
            Some(snapshot) => snapshot,
            None => self.newer().await?,
        };
        let longest = Duration::from_secs(self.service.limits().max_deadline_seconds as u64);
        let timeout = self.until.map(|until| until.saturating_duration_since(Instant::now()));
        let deadline = Deadline::new(Instant::now(), Patience { timeout, time_budget: None }, longest)?;
        let (stop, _waiting) = Stop::at(deadline);
        let mut held = self.held;
        let work = move || {
            let changes = held.tracker.advance(&snapshot, &|| stop.now()).map_err(service_error)?;
            Ok((told(&changes), held))
        };
        let (told, held) = self.service.workers().answer(work).await?;
        Ok((Self { held, ..self }, told))
    }

    /// The newest snapshot, once it is newer than the last one told.
    async fn newer(&mut self) -> Result<Arc<Snapshot>, ServiceError> {
        let told = self.held.tracker.revision().unwrap_or(Revision(0));
        let time_is_up = async {
            match self.until {
                Some(until) => sleep_until(until.into()).await,
                None => std::future::pending().await,
            }
        };
        tokio::select! {
            snapshot = self.cell.newer_than(told) => snapshot,
            // A sender that is gone means the same.
            _ = self.draining.wait_for(|draining| *draining) => Err(ServiceError::ShuttingDown),
            () = time_is_up => Err(ServiceError::DeadlineExceeded),
        }
    }
}

fn service_error(error: NotAdvanced) -> ServiceError {
    match error {
        NotAdvanced::Refused(refused) => refused.into(),
        NotAdvanced::TooMany(exceeded) => ServiceError::Limit(exceeded),
        NotAdvanced::Stopped => ServiceError::DeadlineExceeded,
        // A scene's cell has one epoch, and its newest revision only rises.
        NotAdvanced::OtherEpoch { .. } | NotAdvanced::Backwards { .. } => workers::incident(&error.to_string()),
    }
}
