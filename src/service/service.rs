//! What do the doors call? One [`Service`] for all of them: it admits, finds the snapshot, keeps the time, and hands
//! the work to threads. It knows neither messages nor sockets.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use tokio::sync::watch;

use super::ServiceError;
use super::admission::{Admission, Permit};
use super::assets::{ContentHash, Stored, Upload};
use super::call::{Call, Observers};
use super::call_notes::{Asker, CallNotes, Rpc};
use super::contact_watch::ContactWatch;
use super::deadline::{Deadline, Patience, Stop, Waiting};
use super::library::{Library, UnusableMesh};
use super::mesh_cards::{MeshCardRequest, TimedMeshCard};
use super::observer::Observer;
use super::pose_feed::PoseFeed;
use super::revision_rule::{Found, RevisionRule};
use super::robots::{LoadedRobot, RobotDescription, Robots};
use super::scene_cell::Change;
use super::scene_health::SceneHealth;
use super::scene_watch::SceneWatch;
use super::scenes::{SceneFigures, SceneSummary, Scenes};
use super::traffic::Traffic;
use super::view::{View, check_samples};
use super::workers::{Workers, caught, prepare};
use crate::limits::Limits;
use crate::query::ContactQuestion;
use crate::scene::{Applied, Epoch, Revision, SceneOptions, Snapshot};

/// What a service is made with.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Config {
    /// Threads that answer questions; 0: one for each core.
    pub threads: usize,
    /// Its caps.
    pub limits: Limits,
}

/// So many plain items are answered by whoever has read them ([`Service::ask_at_once`], [`Service::ask_here`]): to hand them to
/// another thread and to be woken by it costs tens of microseconds, more than the answer.
pub const FEW_ITEMS: usize = 8;

/// One way to ask the daemon.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Door {
    /// For example `grpc`.
    pub kind: &'static str,
    /// For example `127.0.0.1:50551`.
    pub address: String,
}

/// The scene that is asked, and in which state.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Target {
    /// The scene's name.
    pub scene: String,
    /// Which revision may answer.
    pub revision: RevisionRule,
}

/// A change that was made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Changed {
    /// Of the scene.
    pub epoch: Epoch,
    /// The revision that contains the change, and what it added.
    pub applied: Applied,
}

/// The daemon without its doors.
#[derive(Debug)]
pub struct Service {
    limits: Limits,
    workers: Workers,
    library: Arc<Library>,
    robots: Arc<Robots>,
    scenes: Scenes,
    queries: Admission,
    watchers: Admission,
    streams: Admission,
    loads: Admission,
    doors: Mutex<Vec<Door>>,
    draining: watch::Sender<bool>,
    observers: Observers,
    calls: AtomicU64,
    traffic: Mutex<BTreeMap<&'static str, Arc<Traffic>>>,
}

impl Service {
    /// A service without scenes, robots or files.
    ///
    /// # Errors
    /// The system gives no threads.
    pub fn new(config: &Config) -> Result<Arc<Self>, rayon::ThreadPoolBuildError> {
        Self::observed(config, Vec::new())
    }

    /// The same, with those who are told of its calls.
    ///
    /// # Errors
    /// As [`Service::new`].
    pub fn observed(
        config: &Config,
        observers: Vec<Box<dyn Observer>>,
    ) -> Result<Arc<Self>, rayon::ThreadPoolBuildError> {
        let limits = &config.limits;
        let loads = Admission::new("max_uploads_in_flight", limits.max_uploads_in_flight);
        Ok(Arc::new(Self {
            limits: limits.clone(),
            workers: Workers::new(config.threads)?,
            library: Arc::new(Library::new(limits, loads.clone())),
            robots: Arc::new(Robots::new(limits)),
            scenes: Scenes::new(limits),
            queries: Admission::new("max_queries_in_flight", limits.max_queries_in_flight),
            watchers: Admission::new("max_watchers", limits.max_watchers),
            streams: Admission::new("max_streams", limits.max_streams),
            loads,
            doors: Mutex::default(),
            draining: watch::Sender::new(false),
            observers: observers.into(),
            calls: AtomicU64::new(0),
            traffic: Mutex::default(),
        }))
    }

    /// The caps.
    #[must_use]
    pub fn limits(&self) -> &Limits {
        &self.limits
    }

    /// Files and the shapes made of them.
    #[must_use]
    pub fn library(&self) -> &Arc<Library> {
        &self.library
    }

    /// Robot models.
    #[must_use]
    pub fn robots(&self) -> &Arc<Robots> {
        &self.robots
    }

    /// Threads that answer questions.
    #[must_use]
    pub fn threads(&self) -> usize {
        self.workers.threads()
    }

    /// Questions being answered.
    #[must_use]
    pub fn queries_in_flight(&self) -> usize {
        self.queries.under_way()
    }

    /// Pieces of work that wait for a thread which answers questions.
    #[must_use]
    pub fn waiting_for_threads(&self) -> usize {
        self.workers.waiting()
    }

    /// Uploads and robot loadings under way.
    #[must_use]
    pub fn uploads_in_flight(&self) -> usize {
        self.loads.under_way()
    }

    /// The open doors.
    #[must_use]
    pub fn doors(&self) -> Vec<Door> {
        self.doors.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// A door is open from now on.
    pub fn add_door(&self, door: Door) {
        self.doors.lock().unwrap_or_else(PoisonError::into_inner).push(door);
    }

    /// A call has arrived at a door. What the door does of it within [`Call::answer`] or [`Call::work`] is noted; `asker` is
    /// asked for only where somebody observes.
    #[must_use]
    pub fn begin_call(&self, rpc: Rpc, asker: impl FnOnce() -> Asker) -> Call {
        if self.observers.is_empty() {
            return Call::unobserved();
        }
        let number = self.calls.fetch_add(1, Ordering::Relaxed) + 1;
        Call::begin(number, rpc, asker(), &self.observers)
    }

    /// Who asks in the call that this task works for; none where nobody observes.
    #[must_use]
    pub fn current_asker() -> Option<Asker> {
        CallNotes::current().map(|notes| notes.asker().clone())
    }

    /// The counts of a door, by its kind.
    #[must_use]
    pub fn traffic(&self, door: &'static str) -> Arc<Traffic> {
        Arc::clone(self.traffic.lock().unwrap_or_else(PoisonError::into_inner).entry(door).or_default())
    }

    /// The counts of all doors, in the order of their kinds.
    #[must_use]
    pub fn all_traffic(&self) -> Vec<(&'static str, Arc<Traffic>)> {
        let traffic = self.traffic.lock().unwrap_or_else(PoisonError::into_inner);
        traffic.iter().map(|(door, counts)| (*door, Arc::clone(counts))).collect()
    }

    /// Callers that watch scenes or contacts.
    #[must_use]
    pub fn watchers(&self) -> usize {
        self.watchers.under_way()
    }

    /// From now on every new request is refused; those under way are answered, and watches end.
    pub fn begin_drain(&self) {
        self.draining.send_replace(true);
    }

    /// A new, empty scene.
    ///
    /// # Errors
    /// The name cannot be or is taken, or there are too many scenes.
    pub fn create_scene(&self, name: &str, options: &SceneOptions) -> Result<SceneSummary, ServiceError> {
        self.check_open()?;
        let created = self.scenes.create(name, options)?;
        note(|notes| notes.note_scene(name));
        Ok(created)
    }

    /// All scenes, in the order of their names.
    #[must_use]
    pub fn scenes(&self) -> Vec<SceneSummary> {
        self.scenes.list()
    }

    /// A scene is gone; questions being answered are still answered.
    ///
    /// # Errors
    /// It is not there.
    pub fn delete_scene(&self, name: &str) -> Result<SceneSummary, ServiceError> {
        self.check_open()?;
        let deleted = self.scenes.delete(name)?;
        note(|notes| notes.note_scene(name));
        Ok(deleted)
    }

    /// How a scene is. Worked out on the threads that answer questions: it looks at all of the scene.
    ///
    /// # Errors
    /// The scene is not there, or too many questions are being answered.
    pub async fn scene_health(&self, scene: &str, against_rebuilt: bool) -> Result<SceneHealth, ServiceError> {
        self.check_open()?;
        let permit = self.queries.enter()?;
        let cell = self.scenes.get(scene)?;
        note(|notes| notes.note_scene(scene));
        self.workers
            .answer(move || {
                let _permit = permit;
                Ok(cell.health(against_rebuilt))
            })
            .await
    }

    /// Changes whenever scenes come or go.
    pub fn scenes_changed(&self) -> watch::Receiver<()> {
        self.scenes.changed()
    }

    /// How many scenes there are.
    #[must_use]
    pub fn scene_count(&self) -> usize {
        self.scenes.count()
    }

    /// Figures of the first `most` scenes in the order of their names, for whoever watches the daemon. Takes microseconds.
    #[must_use]
    pub fn scene_figures(&self, most: usize) -> Vec<SceneFigures> {
        self.scenes.figures(most)
    }

    /// What [`Service::scene_health`] tells, worked out on the calling thread: milliseconds for a hundred thousand bodies. `None`:
    /// the scene is gone.
    #[must_use]
    pub fn scene_health_here(&self, scene: &str) -> Option<SceneHealth> {
        self.scenes.get(scene).ok().map(|cell| cell.health(false))
    }

    /// Whether new requests are refused.
    #[must_use]
    pub fn is_draining(&self) -> bool {
        *self.draining.borrow()
    }

    /// Changes a scene, after the changes that came before. `change` is worked out on a thread of its own first; it may
    /// read meshes and build hulls.
    ///
    /// # Errors
    /// What `change` says, a scene that is not there, a queue that is full, a deadline that came first, or the refusal.
    pub async fn apply(
        &self,
        scene: &str,
        patience: Patience,
        change: impl FnOnce() -> Result<Change, ServiceError> + Send + 'static,
    ) -> Result<Changed, ServiceError> {
        self.check_open()?;
        let deadline = self.deadline(patience)?;
        let cell = self.scenes.get(scene)?;
        note(|notes| notes.note_scene(scene));
        let turn = cell.queue()?;
        let (stop, _waiting) = Stop::at(deadline);
        let change = prepare(change).await?;
        note(|notes| notes.note_edits(change.edits.len()));
        let applied = cell.apply(change, stop, turn).await?;
        note(|notes| notes.note_revision(applied.revision));
        Ok(Changed { epoch: cell.epoch(), applied })
    }

    /// Begins an upload.
    ///
    /// # Errors
    /// The daemon drains, or a cap.
    pub fn begin_upload(&self, hash: ContentHash, bytes: u64) -> Result<Upload, ServiceError> {
        self.check_open()?;
        self.library.assets().begin_upload(hash, bytes)
    }

    /// Checks and keeps what was uploaded.
    ///
    /// # Errors
    /// It is not what was announced.
    pub async fn finish_upload(&self, upload: Upload) -> Result<Stored, ServiceError> {
        prepare(move || upload.finish()).await
    }

    /// Loads a robot. `description` is worked out on the same thread.
    ///
    /// # Errors
    /// What `description` says, a cap, or a description that makes no robot.
    pub async fn load_robot(
        &self,
        description: impl FnOnce() -> Result<RobotDescription, ServiceError> + Send + 'static,
    ) -> Result<LoadedRobot, ServiceError> {
        self.check_open()?;
        let permit = self.loads.enter()?;
        let (robots, library) = (Arc::clone(&self.robots), Arc::clone(&self.library));
        prepare(move || {
            let _permit = permit;
            robots.load(&description()?, library.assets())
        })
        .await
    }

    /// Measures what a mesh costs as convex pieces. When time runs out the brackets are as narrow as they were then.
    ///
    /// # Errors
    /// What `request` says, a cap; `unusable` tells what is wrong with the mesh.
    pub async fn mesh_card(
        &self,
        request: MeshCardRequest,
        patience: Patience,
        unusable: impl FnOnce(UnusableMesh) -> ServiceError + Send + 'static,
    ) -> Result<TimedMeshCard, ServiceError> {
        self.check_open()?;
        let permit = self.loads.enter()?;
        let library = Arc::clone(&self.library);
        let (stop, _waiting) = Stop::at(self.deadline(patience)?);
        prepare(move || {
            let _permit = permit;
            library.mesh_card(&request, &|| stop.now()).map_err(unusable)
        })
        .await
    }

    /// Asks a scene. `question` runs on the threads that answer questions; dropping the future stops it.
    ///
    /// # Errors
    /// What `question` says, a scene or revision that is not there, a cap, or a deadline that came first.
    pub async fn ask<T: Send + 'static>(
        &self,
        target: &Target,
        patience: Patience,
        question: impl FnOnce(&View) -> Result<T, ServiceError> + Send + 'static,
    ) -> Result<T, ServiceError> {
        self.check_open()?;
        let permit = self.queries.enter()?;
        let deadline = self.deadline(patience)?;
        let cell = self.scenes.get(&target.scene)?;
        note(|notes| notes.note_scene(&target.scene));
        let found = cell.find(target.revision, deadline).await?;
        note(|notes| notes.note_revision(found.snapshot.revision()));
        let (stop, _waiting) = Stop::at(deadline);
        let view = View::new(found, stop.clone(), &self.limits);
        self.workers
            .answer(move || {
                // Given back only now: a question whose caller is gone keeps its place until its thread is free.
                let _permit = permit;
                if stop.now() { Err(ServiceError::DeadlineExceeded) } else { question(&view) }
            })
            .await
    }

    /// Asks a scene on the calling thread, for questions that take less time than to hand them over. Waits for a revision
    /// that is still to come.
    ///
    /// # Errors
    /// As for [`Service::ask`].
    pub async fn ask_at_once<T>(
        &self,
        target: &Target,
        patience: Patience,
        question: impl FnOnce(&View) -> Result<T, ServiceError>,
    ) -> Result<T, ServiceError> {
        self.check_open()?;
        let _permit = self.queries.enter()?;
        let deadline = self.deadline(patience)?;
        let cell = self.scenes.get(&target.scene)?;
        note(|notes| notes.note_scene(&target.scene));
        let found = cell.find(target.revision, deadline).await?;
        self.answer_here(found, deadline, question)
    }

    /// Answers a question on the calling thread, which waits for no other.
    fn answer_here<T>(
        &self,
        found: Found,
        deadline: Deadline,
        question: impl FnOnce(&View) -> Result<T, ServiceError>,
    ) -> Result<T, ServiceError> {
        let notes = CallNotes::current();
        let revision = found.snapshot.revision();
        let (stop, _waiting) = Stop::at(deadline);
        let view = View::on_one_thread(found, stop, &self.limits);
        let answer = || caught(|| question(&view));
        let Some(notes) = notes else { return answer() };
        notes.note_revision(revision);
        notes.note_waited(Duration::ZERO);
        notes.work(answer)
    }

    /// The same without waiting: `None` where the revision is still to come.
    pub fn ask_here<T>(
        &self,
        target: &Target,
        patience: Patience,
        question: impl FnOnce(&View) -> Result<T, ServiceError>,
    ) -> Option<Result<T, ServiceError>> {
        let found = || {
            self.check_open()?;
            let permit = self.queries.enter()?;
            let deadline = self.deadline(patience)?;
            Ok(self.scenes.get(&target.scene)?.find_now(target.revision)?.map(|found| (permit, deadline, found)))
        };
        let (_permit, deadline, found) = match found() {
            Ok(found) => found?,
            Err(error) => return Some(Err(error)),
        };
        note(|notes| notes.note_scene(&target.scene));
        Some(self.answer_here(found, deadline, question))
    }

    /// Asks a scene on the threads that answer questions; `then` gets the answer there, which spares a caller that is no
    /// task the way back. Dropping what is returned stops the work. `None`: the revision is still to come, and
    /// [`Service::ask`] waits for it.
    ///
    /// # Errors
    /// A scene or revision that is not there, or a cap: `then` is not called.
    pub fn ask_then<T: 'static>(
        &self,
        target: &Target,
        patience: Patience,
        question: impl FnOnce(&View) -> Result<T, ServiceError> + Send + 'static,
        then: impl FnOnce(Result<T, ServiceError>) + Send + 'static,
    ) -> Result<Option<Waiting>, ServiceError> {
        self.check_open()?;
        let permit = self.queries.enter()?;
        let deadline = self.deadline(patience)?;
        let cell = self.scenes.get(&target.scene)?;
        note(|notes| notes.note_scene(&target.scene));
        let Some(found) = cell.find_now(target.revision)? else { return Ok(None) };
        note(|notes| notes.note_revision(found.snapshot.revision()));
        let (stop, waiting) = Stop::at(deadline);
        let view = View::new(found, stop.clone(), &self.limits);
        let work = move || {
            let _permit = permit;
            if stop.now() { Err(ServiceError::DeadlineExceeded) } else { question(&view) }
        };
        self.workers.answer_then(work, then);
        Ok(Some(waiting))
    }

    /// Watches the contacts of a scene. `question` is told the caps and the snapshot that comes first.
    ///
    /// # Errors
    /// What `question` says, a scene or revision that is not there, a cap, or a deadline that came first.
    pub async fn watch_contacts(
        self: &Arc<Self>,
        target: &Target,
        patience: Patience,
        question: impl FnOnce(&Snapshot, &Limits) -> Result<ContactQuestion, ServiceError>,
    ) -> Result<ContactWatch, ServiceError> {
        self.check_open()?;
        let permit = self.watchers.enter()?;
        let cell = self.scenes.get(&target.scene)?;
        note(|notes| notes.note_scene(&target.scene));
        let first = cell.find(target.revision, self.deadline(patience)?).await?.snapshot;
        let question = question(&first, &self.limits)?;
        check_samples(question.wants, question.derivatives.samples, &self.limits)?;
        Ok(ContactWatch::new(Arc::clone(self), cell, (question, first), patience, permit))
    }

    /// Watches a scene, from a revision of the given epoch on or from nothing.
    ///
    /// # Errors
    /// A scene that is not there or is in another epoch, or a cap.
    pub fn watch_scene(
        self: &Arc<Self>,
        scene: &str,
        epoch: Option<Epoch>,
        from: Option<Revision>,
        patience: Patience,
    ) -> Result<SceneWatch, ServiceError> {
        self.check_open()?;
        let permit = self.watchers.enter()?;
        let cell = self.scenes.get(scene)?;
        note(|notes| notes.note_scene(scene));
        cell.check_epoch(epoch)?;
        Ok(SceneWatch::new(Arc::clone(self), cell, from, patience, permit))
    }

    /// Takes poses for a scene, with at least `interval` between two revisions.
    ///
    /// # Errors
    /// A scene that is not there or is in another epoch, or a cap.
    pub fn feed_poses(
        self: &Arc<Self>,
        scene: &str,
        epoch: Option<Epoch>,
        interval: Duration,
        patience: Patience,
    ) -> Result<PoseFeed, ServiceError> {
        self.check_open()?;
        let permit = self.streams.enter()?;
        let cell = self.scenes.get(scene)?;
        note(|notes| notes.note_scene(scene));
        cell.check_epoch(epoch)?;
        Ok(PoseFeed::new(Arc::clone(self), cell, interval, patience, permit))
    }

    /// A place for a stream of questions.
    ///
    /// # Errors
    /// The daemon drains, or all places are taken.
    pub fn enter_stream(&self) -> Result<Permit, ServiceError> {
        self.check_open()?;
        Ok(self.streams.enter()?)
    }

    /// Streams of poses and questions.
    #[must_use]
    pub fn streams(&self) -> usize {
        self.streams.under_way()
    }

    pub(super) fn workers(&self) -> &Workers {
        &self.workers
    }

    /// Becomes true when the daemon drains.
    pub fn draining(&self) -> watch::Receiver<bool> {
        self.draining.subscribe()
    }

    fn check_open(&self) -> Result<(), ServiceError> {
        if self.is_draining() { Err(ServiceError::ShuttingDown) } else { Ok(()) }
    }

    fn deadline(&self, patience: Patience) -> Result<Deadline, ServiceError> {
        let longest = Duration::from_secs(self.limits.max_deadline_seconds as u64);
        Deadline::new(Instant::now(), patience, longest)
    }
}

/// Says something of the call that this task works for, if it is observed.
fn note(say: impl FnOnce(&CallNotes)) {
    if let Some(notes) = CallNotes::current() {
        say(&notes);
    }
}
