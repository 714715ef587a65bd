//! One scene: changed by one at a time, in the order they come, and read by any number that never wait for it.
//!
//! Whoever holds the lock on the writer is the scene's single writer. Readers take what was published last; the lock is
//! never theirs to wait for.

use std::sync::Arc;
use std::time::Instant;

use tokio::sync::{Mutex, watch};
use tokio::time::timeout_at;

use super::admission::{Admission, Permit};
use super::call_notes::CallNotes;
use super::deadline::{Deadline, Stop};
use super::published::Published;
use super::remembered_keys::{IdempotencyKey, RememberedKeys};
use super::revision_rule::{Found, RevisionRule, Rule};
use super::scene_health::SceneHealth;
use super::scenes::{SceneFigures, SceneSummary};
use super::{ServiceError, workers};
use crate::limits::Limits;
use crate::scene::{Applied, Edit, Epoch, Revision, Scene, SceneOptions, Snapshot};

/// A change that is asked for.
#[derive(Clone, Debug, Default)]
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
    published: Published,
    /// Wakes those who wait for a revision: each time there is one more, and when the scene is deleted.
    head: watch::Sender<()>,
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
        let head = watch::Sender::new(());
        let keys = RememberedKeys::new(limits.idempotency_keys_kept);
        Self {
            name,
            epoch,
            queue: Admission::new("max_queued_writes", limits.max_queued_writes),
            writer: Arc::new(Mutex::new(Writer { scene, keys, broken: false })),
            published: Published::new(snapshot),
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

    pub fn health(&self, against_rebuilt: bool) -> SceneHealth {
        SceneHealth::of(self.name.clone(), &self.published.all(), against_rebuilt)
    }

    pub fn figures(&self) -> SceneFigures {
        SceneFigures {
            summary: self.summary(),
            kept_revisions: self.published.all().iter().count(),
            waiting_changes: self.queue.under_way(),
        }
    }

    pub fn epoch(&self) -> Epoch {
        self.epoch
    }

    pub fn latest(&self) -> Arc<Snapshot> {
        self.published.latest()
    }

    /// A place in the queue of changes.
    pub fn queue(&self) -> Result<Permit, ServiceError> {
        Ok(self.queue.enter()?)
    }

    /// The snapshot that fits the rule. One that is there is given at once, without a lock; for one that is still to
    /// come the caller waits.
    pub async fn find(&self, rule: RevisionRule, deadline: Deadline) -> Result<Found, ServiceError> {
        self.check_epoch(rule.epoch)?;
        if let Some(found) = self.at_hand(rule.rule)? {
            return Ok(found);
        }
        let mut head = self.head.subscribe();
        loop {
            head.mark_unchanged();
            if let Some(found) = self.at_hand(rule.rule)? {
                return Ok(found);
            }
            if timeout_at(deadline.at().into(), head.changed()).await.is_err() {
                return Err(self.not_yet(rule.rule));
            }
        }
    }

    /// The snapshot that fits the rule, if it is there.
    pub fn find_now(&self, rule: RevisionRule) -> Result<Option<Found>, ServiceError> {
        self.check_epoch(rule.epoch)?;
        self.at_hand(rule.rule)
    }

    fn at_hand(&self, rule: Rule) -> Result<Option<Found>, ServiceError> {
        if self.published.is_deleted() { Err(self.not_found()) } else { self.published.find(rule) }
    }

    /// The newest snapshot, unless the scene is gone.
    pub fn newest(&self) -> Result<Arc<Snapshot>, ServiceError> {
        if self.published.is_deleted() { Err(self.not_found()) } else { Ok(self.latest()) }
    }

    /// The newest snapshot, once it is newer than `told`; with revisions that come in quick succession not the next.
    pub async fn newer_than(&self, told: Revision) -> Result<Arc<Snapshot>, ServiceError> {
        let mut head = self.head.subscribe();
        loop {
            head.mark_unchanged();
            if self.published.is_deleted() {
                return Err(self.not_found());
            }
            let latest = self.latest();
            if latest.revision() > told {
                return Ok(latest);
            }
            head.changed().await.map_err(|_| self.not_found())?;
        }
    }

    /// Makes a change, after those that came before.
    pub async fn apply(self: &Arc<Self>, change: Change, stop: Stop, turn: Permit) -> Result<Applied, ServiceError> {
        self.check_epoch(change.expected_epoch)?;
        let call = CallNotes::current().map(|notes| (notes, Instant::now()));
        let writer = timeout_at(stop.deadline().at().into(), Arc::clone(&self.writer).lock_owned()).await;
        if let Some((notes, queued)) = call {
            notes.note_waited(queued.elapsed());
        }
        let mut writer = writer.map_err(|_| ServiceError::DeadlineExceeded)?;
        let cell = Arc::clone(self);
        workers::prepare(move || {
            let _turn = turn;
            if stop.now() || cell.published.is_deleted() {
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
        self.published.delete();
        self.head.send_replace(());
    }

    /// Only the one who holds the lock on the writer calls this.
    fn publish(&self, snapshot: Arc<Snapshot>, oldest: Revision) {
        if snapshot.revision() == self.published.latest().revision() {
            return; // A repeated request: nothing new.
        }
        self.published.add(snapshot, oldest);
        self.head.send_replace(());
    }

    /// # Errors
    /// The scene is in another epoch than the caller means.
    pub fn check_epoch(&self, asked: Option<Epoch>) -> Result<(), ServiceError> {
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

#[cfg(test)]
mod tests {
    use std::pin::pin;
    use std::task::{Context, Poll, Waker};
    use std::time::Duration;

    use super::*;
    use crate::geometry::{Pose, Shape, Vec3};
    use crate::scene::NewBody;
    use crate::service::Patience;

    fn cell() -> Arc<SceneCell> {
        Arc::new(SceneCell::new("cell".to_owned(), Epoch(1), &Limits::default(), &SceneOptions::default()))
    }

    fn deadline() -> Deadline {
        Deadline::new(Instant::now(), Patience::default(), Duration::from_secs(60)).unwrap()
    }

    fn change(edits: Vec<Edit>) -> Change {
        Change { edits, expected_epoch: None, expected_revision: None, key: None }
    }

    fn ball() -> Edit {
        Edit::AddBody(NewBody::new("ball", Arc::new(Shape::sphere(1.0).unwrap()), Pose::identity()))
    }

    async fn apply(cell: &Arc<SceneCell>, edits: Vec<Edit>) -> Revision {
        let (stop, _waiting) = Stop::at(deadline());
        cell.apply(change(edits), stop, cell.queue().unwrap()).await.unwrap().revision
    }

    /// What a future is at its first poll: a reader that has to wait for anything is not ready.
    fn at_once<T>(future: impl Future<Output = T>) -> T {
        match pin!(future).poll(&mut Context::from_waker(Waker::noop())) {
            Poll::Ready(value) => value,
            Poll::Pending => panic!("it waits"),
        }
    }

    #[tokio::test]
    async fn readers_go_on_while_the_writer_is_stopped_in_the_middle() {
        let cell = cell();
        apply(&cell, vec![ball()]).await;
        let stopped = Arc::clone(&cell.writer).lock_owned().await;
        for _ in 0..1000 {
            for rule in [Rule::Latest, Rule::Exactly(Revision(0)), Rule::AtLeast(Revision(1))] {
                let found = at_once(cell.find(RevisionRule { epoch: None, rule }, deadline())).unwrap();
                assert_eq!(found.snapshot.body_count() as u64, found.snapshot.revision().0);
                assert_eq!(found.oldest, Revision(0));
            }
            assert_eq!(cell.summary().bodies, 1);
        }
        drop(stopped);
        assert_eq!(apply(&cell, vec![Edit::RemoveBody { body: "ball".into() }]).await, Revision(2));
    }

    #[tokio::test]
    async fn the_writer_goes_on_while_a_reader_holds_an_old_snapshot() {
        let cell = cell();
        apply(&cell, vec![ball()]).await;
        let held = cell.latest();
        for step in 0..200_u32 {
            let pose = Pose::new(Vec3::repeat(f64::from(step)), crate::geometry::Quaternion::IDENTITY).unwrap();
            let revision = apply(&cell, vec![Edit::MoveBody { body: "ball".into(), pose }]).await;
            assert_eq!(revision, Revision(u64::from(step) + 2));
        }
        // Long gone from the scene, and still what it was.
        assert!(cell.published.all().oldest().revision() > held.revision());
        assert_eq!((held.revision(), held.validate()), (Revision(1), Ok(())));
        assert_eq!(held.body_named("ball").unwrap().pose, Pose::identity());
    }

    #[tokio::test]
    async fn a_reader_that_waits_is_woken_by_the_revision_and_by_the_end() {
        let cell = cell();
        let rule = |asked| RevisionRule { epoch: None, rule: Rule::AtLeast(Revision(asked)) };
        let (waited, _) = tokio::join!(cell.find(rule(1), deadline()), apply(&cell, vec![ball()]));
        assert_eq!(waited.unwrap().snapshot.revision(), Revision(1));
        let (waited, ()) = tokio::join!(cell.find(rule(9), deadline()), async { cell.delete() });
        assert!(matches!(waited, Err(ServiceError::NotFound { .. })), "{waited:?}");
    }
}
