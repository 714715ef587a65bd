//! One scene: changed by one at a time, in the order they come, and read by any number that never wait for it.
//!
//! Whoever holds the lock on the writer is the scene's single writer. Readers take what was published last; the lock is
//! never theirs to wait for.

use std::sync::Arc;

use arc_swap::ArcSwap;
use tokio::sync::{Mutex, watch};
use tokio::time::timeout_at;

use super::admission::{Admission, Permit};
use super::deadline::{Deadline, Stop};
use super::remembered_keys::{IdempotencyKey, RememberedKeys};
use super::revision_rule::{Kept, RevisionRule, Rule};
use super::scene_health::SceneHealth;
use super::scenes::SceneSummary;
use super::{ServiceError, workers};
use crate::limits::Limits;
use crate::scene::{Applied, Edit, Epoch, Revision, Scene, SceneOptions, Snapshot};

/// A change that is asked for.
#[derive(Clone, Debug)]
pub struct Change {
    /// Made in order, all or none.
    pub edits: Vec<Edit>,
    /// The epoch the caller means; `None`: any.
    pub expected_epoch: Option<Epoch>,
    /// The revision the caller means to change; `None`: any.
    pub expected_revision: Option<Revision>,
    /// Tells a repeated request from a new one.
    pub key: Option<IdempotencyKey>,
}

/// A scene of the daemon.
#[derive(Debug)]
pub(super) struct SceneCell {
    name: String,
    epoch: Epoch,
    queue: Admission,
    writer: Arc<Mutex<Writer>>,
    published: ArcSwap<Kept>,
    head: watch::Sender<Head>,
}

/// What those who wait for a revision look at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Head {
    At(Revision),
    Deleted,
}

#[derive(Debug)]
struct Writer {
    scene: Scene,
    keys: RememberedKeys<Applied>,
    /// A change panicked halfway: the scene is not changed any more, what was published can still be asked.
    broken: bool,
}

impl SceneCell {
    pub fn new(name: String, epoch: Epoch, limits: &Limits, options: &SceneOptions) -> Self {
        let scene = Scene::with_options(epoch, limits.clone(), options);
        let snapshot = scene.snapshot();
        let head = watch::Sender::new(Head::At(snapshot.revision()));
        let keys = RememberedKeys::new(limits.idempotency_keys_kept);
        Self {
            name,
            epoch,
            queue: Admission::new("max_queued_writes", limits.max_queued_writes),
            writer: Arc::new(Mutex::new(Writer { scene, keys, broken: false })),
            published: ArcSwap::from_pointee(Kept::new(snapshot)),
            head,
        }
    }

    pub fn summary(&self) -> SceneSummary {
        let latest = self.latest();
        SceneSummary {
            name: self.name.clone(),
            epoch: self.epoch,
            revision: latest.revision(),
            bodies: latest.body_count(),
            robots: latest.robots().count(),
            broad_phase: latest.broad_phase().kind(),
        }
    }

    pub fn health(&self) -> SceneHealth {
        let kept = self.published.load_full();
        SceneHealth::of(self.name.clone(), &kept)
    }

    pub fn epoch(&self) -> Epoch {
        self.epoch
    }

    pub fn latest(&self) -> Arc<Snapshot> {
        Arc::clone(self.published.load().latest())
    }

    pub fn oldest_revision(&self) -> Revision {
        self.published.load().oldest().revision()
    }

    /// A place in the queue of changes.
    pub fn queue(&self) -> Result<Permit, ServiceError> {
        Ok(self.queue.enter()?)
    }

    /// The snapshot that fits the rule; waits for one that is still to come.
    pub async fn snapshot(&self, rule: RevisionRule, deadline: Deadline) -> Result<Arc<Snapshot>, ServiceError> {
        self.check_epoch(rule.epoch)?;
        let mut head = self.head.subscribe();
        loop {
            if *head.borrow_and_update() == Head::Deleted {
                return Err(self.not_found());
            }
            if let Some(snapshot) = self.published.load().find(rule.rule)? {
                return Ok(Arc::clone(snapshot));
            }
            if timeout_at(deadline.at().into(), head.changed()).await.is_err() {
                return Err(self.not_yet(rule.rule));
            }
        }
    }

    /// Makes a change, after those that came before.
    pub async fn apply(self: &Arc<Self>, change: Change, stop: Stop, turn: Permit) -> Result<Applied, ServiceError> {
        self.check_epoch(change.expected_epoch)?;
        let writer = timeout_at(stop.deadline().at().into(), Arc::clone(&self.writer).lock_owned());
        let mut writer = writer.await.map_err(|_| ServiceError::DeadlineExceeded)?;
        let cell = Arc::clone(self);
        workers::prepare(move || {
            let _turn = turn;
            if stop.now() || *cell.head.borrow() == Head::Deleted {
                return Err(if stop.now() { ServiceError::DeadlineExceeded } else { cell.not_found() });
            }
            let applied = writer.apply(change)?;
            cell.publish(writer.scene.snapshot(), writer.scene.oldest_revision());
            Ok(applied)
        })
        .await
    }

    /// Wakes those who wait, and lets nobody change the scene any more.
    pub fn delete(&self) {
        self.head.send_replace(Head::Deleted);
    }

    /// Only the one who holds the lock on the writer calls this.
    fn publish(&self, snapshot: Arc<Snapshot>, oldest: Revision) {
        let before = self.published.load_full();
        if snapshot.revision() == before.latest().revision() {
            return; // A repeated request: nothing new.
        }
        let revision = snapshot.revision();
        self.published.store(Arc::new(before.with(snapshot, oldest)));
        self.head.send_if_modified(|head| {
            let alive = *head != Head::Deleted;
            if alive {
                *head = Head::At(revision);
            }
            alive
        });
    }

    fn check_epoch(&self, asked: Option<Epoch>) -> Result<(), ServiceError> {
        match asked {
            Some(asked) if asked != self.epoch => Err(ServiceError::WrongEpoch { asked, current: self.epoch }),
            Some(_) | None => Ok(()),
        }
    }

    fn not_found(&self) -> ServiceError {
        ServiceError::NotFound { what: "scene", name: self.name.clone() }
    }

    fn not_yet(&self, rule: Rule) -> ServiceError {
        let current = self.latest().revision();
        match rule {
            Rule::Exactly(asked) | Rule::AtLeast(asked) => ServiceError::RevisionNotYet { asked, current },
            Rule::Latest => ServiceError::DeadlineExceeded,
        }
    }
}

impl Writer {
    fn apply(&mut self, change: Change) -> Result<Applied, ServiceError> {
        if let Some(key) = &change.key
            && let Some(applied) = self.keys.recall(key)?
        {
            return Ok(applied);
        }
        if self.broken {
            return Err(workers::incident("a change of this scene panicked earlier; it is only read from now on"));
        }
        self.broken = true; // Unless the next line comes back.
        let outcome = self.scene.apply(&change.edits, change.expected_revision);
        self.broken = false;
        let applied = outcome?;
        if let Some(key) = change.key {
            self.keys.remember(key, applied.clone());
        }
        Ok(applied)
    }
}
