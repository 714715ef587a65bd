//! One caller that sends poses faster than scenes change: what waits is overtaken by what is newer, and made one revision.
//!
//! Nothing is kept but the latest pose of each body and robot that waits. A message is taken whole or not at all, and what
//! waits is made by one list of edits: nobody sees half of a message.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::{Duration, Instant};

use tokio::sync::watch;
use tokio::time::sleep_until;

use super::admission::Permit;
use super::deadline::{Deadline, Patience, Stop};
use super::scene_cell::{Change, SceneCell};
use super::{Service, ServiceError};
use crate::geometry::Pose;
use crate::limits::LimitExceeded;
use crate::scene::{BodyRef, Edit, Epoch, Reason, Revision, Snapshot};

/// What a pose is of.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum PoseOf {
    /// A body.
    Body(BodyRef),
    /// A robot's base, by the robot's name in the scene.
    Robot(String),
}

/// One pose as it came.
#[derive(Clone, Debug)]
pub struct NewPose {
    /// What is there.
    pub of: PoseOf,
    /// Its frame in the world, metres.
    pub pose: Pose,
    /// Path of the pose in its message, for what is said when it is refused.
    pub field: String,
}

/// A pose that was not made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RefusedPose {
    /// Which message of the caller, from 0.
    pub message: u64,
    /// Which field of it.
    pub field: String,
    /// What is wrong with it.
    pub problem: String,
}

/// What became of the poses since the last one of these.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PosesMade {
    /// Of the scene.
    pub epoch: Epoch,
    /// The first that contains them.
    pub revision: Revision,
    /// Messages of the caller that were taken: each of their poses is in the revision, overtaken or refused.
    pub messages: u64,
    /// How many were made.
    pub poses: usize,
    /// How many were overtaken.
    pub overtaken: usize,
    /// Those that were refused, in the order they came.
    pub refused: Vec<RefusedPose>,
}

/// A feed that is under way. Dropping it ends it; what waits then is not made.
#[derive(Debug)]
pub struct PoseFeed {
    service: Arc<Service>,
    cell: Arc<SceneCell>,
    waiting: BTreeMap<PoseOf, Waiting>,
    messages: u64,
    overtaken: usize,
    refused: Vec<RefusedPose>,
    /// Something was taken that no acknowledgement speaks of.
    untold: bool,
    interval: Duration,
    /// No revision before.
    not_before: Instant,
    draining: watch::Receiver<bool>,
    until: Option<Instant>,
    _permit: Permit,
}

#[derive(Clone, Debug)]
struct Waiting {
    pose: Pose,
    /// Which message, and which pose of it.
    place: (u64, usize),
    field: String,
}

impl PoseFeed {
    pub(super) fn new(
        service: Arc<Service>,
        cell: Arc<SceneCell>,
        interval: Duration,
        patience: Patience,
        permit: Permit,
    ) -> Self {
        let (draining, now) = (service.draining(), Instant::now());
        Self {
            service,
            cell,
            waiting: BTreeMap::new(),
            messages: 0,
            overtaken: 0,
            refused: Vec::new(),
            untold: false,
            interval,
            not_before: now,
            draining,
            until: patience.timeout.and_then(|timeout| now.checked_add(timeout)),
            _permit: permit,
        }
    }

    /// Takes one message: its poses, and those of it that cannot be.
    ///
    /// # Errors
    /// More poses wait than a list of edits may have.
    pub fn take(&mut self, poses: Vec<NewPose>, refused: Vec<(String, String)>) -> Result<(), ServiceError> {
        let message = self.messages;
        for (index, NewPose { of, pose, field }) in poses.into_iter().enumerate() {
            let before = self.waiting.insert(of, Waiting { pose, place: (message, index), field });
            self.overtaken += usize::from(before.is_some());
        }
        let most = self.service.limits().max_edits;
        LimitExceeded::check("max_edits", self.waiting.len().max(self.refused.len() + refused.len()), most)?;
        self.refused.extend(refused.into_iter().map(|(field, problem)| RefusedPose { message, field, problem }));
        self.messages += 1;
        self.untold = true;
        Ok(())
    }

    /// Whether anything is left to be made or told.
    #[must_use]
    pub fn is_idle(&self) -> bool {
        !self.untold
    }

    /// Whether a revision may be made now.
    #[must_use]
    pub fn is_due(&self) -> bool {
        Instant::now() >= self.not_before
    }

    /// Waits until a revision may be made again. Messages may be taken meanwhile.
    pub fn pause(&self) -> impl Future<Output = ()> + use<> {
        sleep_until(self.not_before.into())
    }

    /// Waits until the daemon drains or the caller's time is up, and says which.
    pub async fn ends(&self) -> ServiceError {
        let mut draining = self.draining.clone();
        let time_is_up = async {
            match self.until {
                Some(until) => sleep_until(until.into()).await,
                None => std::future::pending().await,
            }
        };
        tokio::select! {
            _ = draining.wait_for(|draining| *draining) => ServiceError::ShuttingDown,
            () = time_is_up => ServiceError::DeadlineExceeded,
        }
    }

    /// Makes what waits one revision.
    ///
    /// # Errors
    /// The scene is gone, the daemon drains, the queue of changes stayed full, or a defect.
    pub async fn make(&mut self) -> Result<PosesMade, ServiceError> {
        let waiting = std::mem::take(&mut self.waiting);
        let made = self.apply(waiting).await?;
        self.not_before = Instant::now() + self.interval;
        self.untold = false;
        let (revision, poses) = made;
        let mut refused = std::mem::take(&mut self.refused);
        refused.sort_by_key(|refused| refused.message);
        let overtaken = std::mem::take(&mut self.overtaken);
        Ok(PosesMade { epoch: self.cell.epoch(), revision, messages: self.messages, poses, overtaken, refused })
    }

    /// The revision that has all of the poses that can be made, and how many these are.
    async fn apply(&mut self, mut waiting: BTreeMap<PoseOf, Waiting>) -> Result<(Revision, usize), ServiceError> {
        let mut tries = 0;
        loop {
            // Bodies that are known not to be there do not cost a try each.
            let snapshot = self.cell.newest()?;
            let gone: Vec<PoseOf> = waiting.keys().filter(|of| missing(&snapshot, of).is_some()).cloned().collect();
            for of in gone {
                self.refuse(&mut waiting, &of, missing(&snapshot, &of));
            }
            if waiting.is_empty() {
                return Ok((snapshot.revision(), 0));
            }
            // In the order they came, so that of one body by name and by id the later pose stays.
            let mut poses: Vec<(&PoseOf, &Waiting)> = waiting.iter().collect();
            poses.sort_by_key(|(_, waiting)| waiting.place);
            let edits: Vec<Edit> = poses.iter().map(|(of, waiting)| edit(of, waiting.pose)).collect();
            let count = edits.len();
            let change = Change { edits, expected_epoch: None, expected_revision: None, key: None };
            let longest = Duration::from_secs(self.service.limits().max_deadline_seconds as u64);
            let deadline = Deadline::new(Instant::now(), Patience::default(), longest)?;
            let (stop, _waiting) = Stop::at(deadline);
            match self.cell.apply(change, stop, self.turn(deadline).await?).await {
                Ok(applied) => return Ok((applied.revision, count)),
                // Somebody removed a body since the snapshot was looked at; the newest one tells which.
                Err(ServiceError::EditRefused { .. }) if tries < MOST_TRIES => tries += 1,
                Err(other) => return Err(other),
            }
        }
    }

    fn refuse(&mut self, waiting: &mut BTreeMap<PoseOf, Waiting>, of: &PoseOf, reason: Option<Reason>) {
        if let (Some(Waiting { place: (message, _), field, .. }), Some(reason)) = (waiting.remove(of), reason) {
            self.refused.push(RefusedPose { message, field, problem: reason.to_string() });
        }
    }

    /// A place in the queue of changes; one that is full is waited for.
    async fn turn(&self, deadline: Deadline) -> Result<Permit, ServiceError> {
        loop {
            match self.cell.queue() {
                Ok(turn) => return Ok(turn),
                Err(full) if deadline.is_past() => return Err(full),
                Err(_) => tokio::time::sleep(FULL_QUEUE).await,
            }
        }
    }
}

/// Lists of poses that somebody else's removals spoil, one after the other, before the feed gives up.
const MOST_TRIES: usize = 1000;
/// How long to wait before a queue that was full is looked at again.
const FULL_QUEUE: Duration = Duration::from_millis(2);

fn edit(of: &PoseOf, pose: Pose) -> Edit {
    match of {
        PoseOf::Body(body) => Edit::MoveBody { body: body.clone(), pose },
        PoseOf::Robot(robot) => Edit::MoveRobot { robot: robot.clone(), base: pose },
    }
}

fn missing(snapshot: &Snapshot, of: &PoseOf) -> Option<Reason> {
    match of {
        PoseOf::Body(BodyRef::Id(id)) => snapshot.body(*id).is_none().then_some(Reason::UnknownId { id: *id }),
        PoseOf::Body(BodyRef::Name(name)) => {
            snapshot.body_named(name).is_none().then(|| Reason::UnknownBody { name: name.clone() })
        }
        PoseOf::Robot(name) => snapshot.robot(name).is_none().then(|| Reason::UnknownRobot { name: name.clone() }),
    }
}
