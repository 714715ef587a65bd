//! How does a client change a scene, for everybody or for one question?

use crate::geometry::{Pose, Shape};
use crate::scene::{BodyRef, Effects, NewBody, Party};
use crate::transports::wire::{to_proto, v1};

/// A change of a scene.
#[derive(Clone, Debug)]
pub enum RemoteEdit {
    /// A body enters the scene.
    AddBody(NewBody),
    /// A body is somewhere else from now on.
    MoveBody {
        /// Which.
        body: BodyRef,
        /// Its frame in the world, metres.
        pose: Pose,
    },
    /// A body leaves the scene.
    RemoveBody {
        /// Which.
        body: BodyRef,
    },
    /// A body gets another shape.
    ReplaceShape {
        /// Which.
        body: BodyRef,
        /// In the body's frame.
        shape: Shape,
    },
    /// A body takes part, or is seen by no question.
    SetEnabled {
        /// Which.
        body: BodyRef,
        /// Whether it takes part.
        enabled: bool,
    },
    /// A robot that was loaded before stands in the scene.
    AddRobot {
        /// Its name in the scene.
        name: String,
        /// The model's id.
        model: String,
        /// The root link's frame in the world, metres.
        base: Pose,
    },
    /// A robot's base is somewhere else from now on.
    MoveRobot {
        /// Its name in the scene.
        robot: String,
        /// The root link's frame in the world, metres.
        base: Pose,
    },
    /// A robot leaves the scene.
    RemoveRobot {
        /// Its name in the scene.
        robot: String,
    },
    /// What may be asked of pairs from now on.
    DeclareEffects {
        /// One side.
        a: Party,
        /// The other side.
        b: Party,
        /// None: nothing is declared of exactly these two any more.
        effects: Option<Effects>,
    },
    /// Any other, as a message: groups, layers, entries for pairs, voxels.
    Message(v1::Edit),
}

/// A body that a robot holds, for one question.
#[derive(Clone, Debug)]
pub struct RemoteAttachment {
    /// Which.
    pub body: BodyRef,
    /// The robot's name in the scene.
    pub robot: String,
    /// The link that holds it, by name.
    pub link: String,
    /// The body's frame in the link's, metres.
    pub body_in_link: Pose,
    /// Other links, by name, that it is not held against.
    pub may_touch: Vec<String>,
}

/// Changes that only a question sees.
#[derive(Clone, Debug, Default)]
pub struct RemoteOverlay {
    /// Made in order.
    pub edits: Vec<RemoteEdit>,
    /// What the robot holds, once they are made.
    pub attached: Vec<RemoteAttachment>,
}

pub(super) fn edit(edit: &RemoteEdit) -> v1::Edit {
    use v1::edit::Kind;
    let named = |body| Some(to_proto::body_ref(body));
    let kind = match edit {
        RemoteEdit::AddBody(body) => Kind::AddBody(to_proto::add_body(body)),
        RemoteEdit::MoveBody { body, pose } => {
            Kind::MoveBody(v1::MoveBody { body: named(body), pose: Some(to_proto::pose(pose)) })
        }
        RemoteEdit::RemoveBody { body } => Kind::RemoveBody(v1::RemoveBody { body: named(body) }),
        RemoteEdit::ReplaceShape { body, shape } => Kind::ReplaceShape(v1::ReplaceShape {
            body: named(body),
            shape: Some(to_proto::shape(shape)),
            ..v1::ReplaceShape::default()
        }),
        RemoteEdit::SetEnabled { body, enabled } => {
            Kind::SetEnabled(v1::SetEnabled { body: named(body), enabled: *enabled })
        }
        RemoteEdit::AddRobot { name, model, base } => {
            Kind::AddRobot(v1::AddRobot { name: name.clone(), model: model.clone(), base: Some(to_proto::pose(base)) })
        }
        RemoteEdit::MoveRobot { robot, base } => {
            Kind::MoveRobot(v1::MoveRobot { robot: robot.clone(), base: Some(to_proto::pose(base)) })
        }
        RemoteEdit::RemoveRobot { robot } => Kind::RemoveRobot(v1::RemoveRobot { robot: robot.clone() }),
        RemoteEdit::DeclareEffects { a, b, effects } => Kind::DeclareEffects(to_proto::declare_effects(a, b, *effects)),
        RemoteEdit::Message(message) => return message.clone(),
    };
    v1::Edit { kind: Some(kind) }
}

pub(super) fn overlay(overlay: &RemoteOverlay) -> v1::Overlay {
    let attached = |held: &RemoteAttachment| v1::AttachBody {
        body: Some(to_proto::body_ref(&held.body)),
        link: Some(v1::LinkRef { robot: held.robot.clone(), link: held.link.clone() }),
        body_in_link: Some(to_proto::pose(&held.body_in_link)),
        may_touch: held.may_touch.clone(),
    };
    v1::Overlay {
        edits: overlay.edits.iter().map(edit).collect(),
        attached: overlay.attached.iter().map(attached).collect(),
    }
}
