//! Scenes and what was done to them.

use super::count;
use super::geometry::{aabb, pose, shape};
use crate::limits::Limit;
use crate::scene::{Body, BodyRef, BroadPhaseKind, NewBody, Revision, RobotInScene, Snapshot};
use crate::service::{Changed, Door, Robots, SceneSummary};
use crate::transports::wire::from_proto::BodyPage;
use crate::transports::wire::v1;

/// A scene in short.
#[must_use]
pub fn scene_summary(summary: &SceneSummary) -> v1::SceneSummary {
    v1::SceneSummary {
        name: summary.name.clone(),
        epoch: summary.epoch.0,
        revision: summary.revision.0,
        bodies: count(summary.bodies),
        robots: count(summary.robots),
        broad_phase: broad_phase(summary.broad_phase),
    }
}

/// A page of the bodies in one revision of a scene, and everything else in it.
#[must_use]
pub fn scene_contents(
    name: &str,
    snapshot: &Snapshot,
    oldest: Revision,
    robots: &Robots,
    page: BodyPage,
) -> v1::SceneContents {
    let mut asked = snapshot.bodies_after(page.after);
    v1::SceneContents {
        name: name.to_owned(),
        epoch: snapshot.epoch().0,
        revision: snapshot.revision().0,
        oldest_revision: oldest.0,
        bodies: asked.by_ref().take(page.most).map(|b| body(b)).collect(),
        robots: snapshot.robots().map(|robot| robot_in_scene(robot, robots)).collect(),
        broad_phase: broad_phase(snapshot.broad_phase().kind()),
        body_count: snapshot.body_count() as u64,
        bodies_left: asked.next().is_some(),
    }
}

fn broad_phase(kind: BroadPhaseKind) -> i32 {
    i32::from(match kind {
        BroadPhaseKind::Tree => v1::BroadPhase::Tree,
        BroadPhaseKind::SweepAndPrune => v1::BroadPhase::SweepAndPrune,
        BroadPhaseKind::Exhaustive => v1::BroadPhase::Exhaustive,
    })
}

pub(super) fn robot_in_scene(robot: &RobotInScene, robots: &Robots) -> v1::RobotInScene {
    v1::RobotInScene {
        name: robot.name.to_string(),
        model: robots.id_of(&robot.model).unwrap_or_default(),
        base: Some(pose(&robot.base)),
    }
}

pub(super) fn body(body: &Body) -> v1::Body {
    v1::Body {
        id: body.id.0,
        name: body.name.to_string(),
        shape_kind: body.shape.kind().to_owned(),
        pose: Some(pose(&body.pose)),
        groups: body.groups.iter().map(ToString::to_string).collect(),
        layers: body.layers,
        mask: body.mask,
        bounds: body.bounds.as_ref().map(aabb),
        scale: body.scale,
        padding: body.padding,
        enabled: body.enabled,
    }
}

/// A body as a client adds it.
#[must_use]
pub fn add_body(body: &NewBody) -> v1::AddBody {
    v1::AddBody {
        name: body.name.clone(),
        shape: Some(shape(&body.shape)),
        pose: Some(pose(&body.pose)),
        groups: body.groups.clone(),
        layers: Some(body.layers),
        mask: Some(body.mask),
        padding: body.padding,
        scale: Some(body.scale),
    }
}

/// A body as a client names it.
#[must_use]
pub fn body_ref(body: &BodyRef) -> v1::BodyRef {
    let by = match body {
        BodyRef::Id(id) => v1::body_ref::By::Id(id.0),
        BodyRef::Name(name) => v1::body_ref::By::Name(name.clone()),
    };
    v1::BodyRef { by: Some(by) }
}

/// What an accepted list of edits led to.
#[must_use]
pub fn apply_response(changed: &Changed) -> v1::ApplyResponse {
    v1::ApplyResponse {
        epoch: changed.epoch.0,
        revision: changed.applied.revision.0,
        added: changed.applied.added.iter().map(|id| id.0).collect(),
    }
}

/// One way to ask.
#[must_use]
pub fn door(door: &Door) -> v1::Door {
    v1::Door { kind: door.kind.to_owned(), address: door.address.clone() }
}

/// A cap.
#[must_use]
pub fn limit(limit: &Limit) -> v1::Limit {
    v1::Limit {
        name: limit.name.to_owned(),
        unit: limit.unit.to_owned(),
        value: limit.value,
        what_happens: limit.what_happens.to_owned(),
    }
}
