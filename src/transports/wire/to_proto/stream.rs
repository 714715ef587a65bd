//! What lasts: steps of a scene that is watched, and what became of poses.

use prost::Message;

use super::declared::{effects, party};
use super::geometry::{aabb, pose, shape};
use super::scene::{body, robot_in_scene};
use crate::scene::{Body, BodyId, ChangeKinds, PairEntry};
use crate::service::{PosesMade, Robots, SceneStep};
use crate::transports::wire::v1;

/// Bytes after which a message of a step is sent, and the next begun.
const FULL: usize = 1 << 20;

/// How much of a step was told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Told {
    /// The bodies up to this one.
    Bodies(BodyId),
    /// All bodies, and as many entries for pairs.
    Entries(usize),
}

impl Told {
    /// Nothing.
    pub const NOTHING: Self = Self::Bodies(BodyId(0));
}

/// The next message of a step, and what is told with it; nothing more to tell: `None`.
#[must_use]
pub fn watch_response(
    step: &SceneStep,
    told: Told,
    shapes: bool,
    robots: &Robots,
) -> (v1::WatchResponse, Option<Told>) {
    let snapshot = &step.snapshot;
    let mut message = v1::WatchResponse {
        epoch: snapshot.epoch().0,
        from_revision: step.from.map(|from| from.0),
        revision: snapshot.revision().0,
        compacted: step.compacted,
        oldest_revision: snapshot.oldest_change().0,
        ..v1::WatchResponse::default()
    };
    if told == Told::NOTHING {
        begin(&mut message, step, robots);
    }
    let mut bytes = 0;
    let mut entries = 0;
    match told {
        Told::Bodies(after) => {
            for (id, kinds) in changed_bodies(step, after) {
                if bytes >= FULL {
                    message.more = true;
                    // The one before was the last; ids rise.
                    return (message, Some(Told::Bodies(BodyId(id.0 - 1))));
                }
                if let Some(found) = snapshot.body(id) {
                    bytes += tell(&mut message, found, kinds, shapes);
                }
            }
        }
        Told::Entries(count) => entries = count,
    }
    for entry in &step.entries[entries..] {
        if bytes >= FULL {
            message.more = true;
            return (message, Some(Told::Entries(entries)));
        }
        let entry = pair_entry(entry);
        bytes += entry.encoded_len();
        message.entries.push(entry);
        entries += 1;
    }
    (message, None)
}

/// What leaves, and all robots: there are few of them, and entries speak of them.
fn begin(message: &mut v1::WatchResponse, step: &SceneStep, robots: &Robots) {
    let (snapshot, changes) = (&step.snapshot, &step.changes);
    let gone = changes.robots().iter().filter(|robot| robot.kinds.contains(ChangeKinds::REMOVED));
    message.removed_robots = gone.map(|robot| robot.name.to_string()).collect();
    // One that came and went again in one step was never told of.
    let gone = changes.bodies().iter().filter(|body| snapshot.body(body.id).is_none());
    let gone = gone.filter(|body| !body.kinds.contains(ChangeKinds::ADDED));
    message.removed_bodies = gone.map(|body| body.id.0).collect();
    let changed = |name: &str| step.from.is_none() || changes.robots().iter().any(|robot| *robot.name == *name);
    let changed = snapshot.robots().filter(|robot| changed(&robot.name));
    message.robots = changed.map(|robot| robot_in_scene(robot, robots)).collect();
}

/// The bodies beyond an id that came or changed, in the order of their ids, each with what changed of it.
fn changed_bodies(step: &SceneStep, after: BodyId) -> Box<dyn Iterator<Item = (BodyId, ChangeKinds)> + '_> {
    if step.from.is_none() {
        return Box::new(step.snapshot.bodies_after(after).map(|body| (body.id, ChangeKinds::ADDED)));
    }
    let changes = step.changes.bodies();
    let first = changes.partition_point(|change| change.id <= after);
    Box::new(changes[first..].iter().map(|change| (change.id, change.kinds)))
}

/// Puts a body into the message, and says how many bytes it takes.
fn tell(message: &mut v1::WatchResponse, found: &Body, kinds: ChangeKinds, shapes: bool) -> usize {
    if kinds == ChangeKinds::MOVED {
        let bounds = found.bounds.as_ref().map(aabb);
        let moved = v1::MovedBody { id: found.id.0, pose: Some(pose(&found.pose)), bounds };
        let bytes = moved.encoded_len();
        message.moved.push(moved);
        return bytes;
    }
    let is_new = kinds.contains(ChangeKinds::ADDED) || kinds.contains(ChangeKinds::RESHAPED);
    let shape = (shapes && is_new).then(|| shape(&found.shape));
    let watched = v1::WatchedBody { body: Some(body(found)), shape };
    let bytes = watched.encoded_len();
    message.bodies.push(watched);
    bytes
}

fn pair_entry(entry: &PairEntry) -> v1::PairEntry {
    let PairEntry { a, b, allowed, margin, effects: declared } = entry;
    let effects = declared.map(effects);
    v1::PairEntry { a: Some(party(a)), b: Some(party(b)), allowed: *allowed, margin: *margin, effects }
}

/// What became of the poses of a stream.
#[must_use]
pub fn pose_stream_response(made: PosesMade) -> v1::PoseStreamResponse {
    let refused = made.refused.into_iter().map(|refused| v1::RefusedPose {
        message: refused.message,
        field: refused.field,
        problem: refused.problem,
    });
    v1::PoseStreamResponse {
        epoch: made.epoch.0,
        revision: made.revision.0,
        messages: made.messages,
        poses: made.poses as u64,
        overtaken: made.overtaken as u64,
        refused: refused.collect(),
    }
}
