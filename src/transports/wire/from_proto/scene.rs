//! Edits of a scene: from messages to plain structs. Meshes and robot models are looked up among what was uploaded.

use std::sync::Arc;

use prost::Message;

use super::query::unknown_value;
use super::{Path, fields, geometry};
use crate::geometry::Aabb;
use crate::limits::{LimitExceeded, Limits};
use crate::scene::{
    BodyId, BodyRef, BroadPhaseKind, Edit, Effect, Effects, Epoch, NewBody, Party, Revision, SceneOptions,
};
use crate::service::{Change, ContentHash, IdempotencyKey, Library, Robots, ServiceError};
use crate::transports::wire::v1;

/// A change of a scene.
///
/// # Errors
/// A field that is missing or cannot be, an asset or model that is not there.
pub fn change(request: &v1::ApplyRequest, library: &Library, robots: &Robots) -> Result<Change, ServiceError> {
    let limits = library.limits();
    LimitExceeded::check("max_edits", request.edits.len(), limits.max_edits)?;
    LimitExceeded::check("max_name_bytes", request.idempotency_key.len(), limits.max_name_bytes)?;
    let edit = |(index, message): (usize, &v1::Edit)| edit(&Path::root_item("edits", index), message, library, robots);
    Ok(Change {
        edits: request.edits.iter().enumerate().map(edit).collect::<Result<_, ServiceError>>()?,
        expected_epoch: request.expected_epoch.map(Epoch),
        expected_revision: request.expected_revision.map(Revision),
        key: idempotency_key(request),
    })
}

/// What is chosen when a scene is made.
///
/// # Errors
/// A broad phase that this version does not know.
pub fn scene_options(request: &v1::CreateSceneRequest) -> Result<SceneOptions, ServiceError> {
    let number = request.broad_phase;
    let broad_phase = match v1::BroadPhase::try_from(number) {
        Ok(v1::BroadPhase::Unspecified | v1::BroadPhase::Tree) => BroadPhaseKind::Tree,
        Ok(v1::BroadPhase::SweepAndPrune) => BroadPhaseKind::SweepAndPrune,
        Ok(v1::BroadPhase::Exhaustive) => BroadPhaseKind::Exhaustive,
        Err(_) => return Err(Path::root("broad_phase").invalid(format!("has the unknown value {number}"))),
    };
    Ok(SceneOptions { broad_phase })
}

/// Which bodies of a scene are listed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BodyPage {
    /// Those with ids above this.
    pub after: BodyId,
    /// At most so many.
    pub most: usize,
}

/// Which bodies of a scene are asked for.
///
/// # Errors
/// More than the cap allows.
pub fn body_page(request: &v1::GetSceneRequest, limits: &Limits) -> Result<BodyPage, ServiceError> {
    let most = request.max_bodies.map_or(limits.max_bodies_listed, |most| most as usize);
    LimitExceeded::check("max_bodies_listed", most, limits.max_bodies_listed)?;
    Ok(BodyPage { after: BodyId(request.after_body), most })
}

/// The same edits have the same bytes: protobuf's encoder writes fields in order.
fn idempotency_key(request: &v1::ApplyRequest) -> Option<IdempotencyKey> {
    let key = &request.idempotency_key;
    (!key.is_empty()).then(|| {
        let bytes: Vec<u8> = request.edits.iter().flat_map(Message::encode_length_delimited_to_vec).collect();
        IdempotencyKey { key: key.clone(), fingerprint: ContentHash::of(&bytes) }
    })
}

pub(super) fn edit(path: &Path<'_>, edit: &v1::Edit, library: &Library, robots: &Robots) -> Result<Edit, ServiceError> {
    use v1::edit::Kind;
    match path.required(edit.kind.as_ref())? {
        Kind::AddBody(edit) => add_body(&path.field("add_body"), edit, library),
        Kind::MoveBody(edit) => {
            let path = path.field("move_body");
            let body = body_ref(&path.field("body"), edit.body.as_ref())?;
            Ok(Edit::MoveBody { body, pose: required_pose(&path.field("pose"), edit.pose.as_ref())? })
        }
        Kind::RemoveBody(edit) => {
            let path = path.field("remove_body");
            Ok(Edit::RemoveBody { body: body_ref(&path.field("body"), edit.body.as_ref())? })
        }
        Kind::ReplaceShape(edit) => {
            let path = path.field("replace_shape");
            Ok(Edit::ReplaceShape {
                body: body_ref(&path.field("body"), edit.body.as_ref())?,
                shape: Arc::new(geometry::shape(&path.field("shape"), edit.shape.as_ref(), library)?),
                scale: edit.scale.unwrap_or(1.0),
                padding: edit.padding,
            })
        }
        Kind::InsertPoints(edit) => {
            let path = path.field("insert_points");
            let body = body_ref(&path.field("body"), edit.body.as_ref())?;
            let points = fields::inserted_points(&path.field("points"), edit.points.as_ref(), library)?;
            Ok(Edit::InsertPoints { body, points: points.into() })
        }
        Kind::ClearBox(edit) => {
            let path = path.field("clear_box");
            let body = body_ref(&path.field("body"), edit.body.as_ref())?;
            let path = path.field("box");
            let corners = path.required(edit.r#box.as_ref())?;
            let corner = |name, v: &Option<v1::Vec3>| geometry::required_vec3(&path.field(name), v.as_ref());
            let bounds = Aabb { min: corner("min", &corners.min)?, max: corner("max", &corners.max)? };
            Ok(Edit::ClearBox { body, bounds })
        }
        Kind::SetGroups(edit) => {
            let path = path.field("set_groups");
            let body = body_ref(&path.field("body"), edit.body.as_ref())?;
            Ok(Edit::SetGroups { body, groups: edit.groups.clone() })
        }
        Kind::SetLayers(edit) => {
            let path = path.field("set_layers");
            Ok(Edit::SetLayers {
                body: body_ref(&path.field("body"), edit.body.as_ref())?,
                layers: edit.layers.unwrap_or(u32::MAX),
                mask: edit.mask.unwrap_or(u32::MAX),
            })
        }
        Kind::SetEnabled(edit) => {
            let path = path.field("set_enabled");
            Ok(Edit::SetEnabled { body: body_ref(&path.field("body"), edit.body.as_ref())?, enabled: edit.enabled })
        }
        Kind::SetAllowedCollision(edit) => {
            let path = path.field("set_allowed_collision");
            Ok(Edit::SetAllowedCollision {
                a: party(&path.field("a"), edit.a.as_ref())?,
                b: party(&path.field("b"), edit.b.as_ref())?,
                allowed: edit.allowed,
            })
        }
        Kind::SetPairMargin(edit) => {
            let path = path.field("set_pair_margin");
            Ok(Edit::SetPairMargin {
                a: party(&path.field("a"), edit.a.as_ref())?,
                b: party(&path.field("b"), edit.b.as_ref())?,
                margin: edit.margin,
            })
        }
        Kind::DeclareEffects(edit) => {
            let path = path.field("declare_effects");
            let declared = edit.effects.as_ref().map(|declared| effects(&path.field("effects"), declared));
            Ok(Edit::DeclareEffects {
                a: party(&path.field("a"), edit.a.as_ref())?,
                b: party(&path.field("b"), edit.b.as_ref())?,
                effects: declared.transpose()?,
            })
        }
        Kind::AddRobot(edit) => {
            let path = path.field("add_robot");
            Ok(Edit::AddRobot {
                name: edit.name.clone(),
                model: robots.get(&edit.model)?.model,
                base: geometry::pose(&path.field("base"), edit.base.as_ref())?,
            })
        }
        Kind::MoveRobot(edit) => {
            let path = path.field("move_robot");
            let base = required_pose(&path.field("base"), edit.base.as_ref())?;
            Ok(Edit::MoveRobot { robot: edit.robot.clone(), base })
        }
        Kind::RemoveRobot(edit) => Ok(Edit::RemoveRobot { robot: edit.robot.clone() }),
    }
}

fn add_body(path: &Path<'_>, edit: &v1::AddBody, library: &Library) -> Result<Edit, ServiceError> {
    Ok(Edit::AddBody(NewBody {
        name: edit.name.clone(),
        shape: Arc::new(geometry::shape(&path.field("shape"), edit.shape.as_ref(), library)?),
        scale: edit.scale.unwrap_or(1.0),
        padding: edit.padding,
        pose: geometry::pose(&path.field("pose"), edit.pose.as_ref())?,
        groups: edit.groups.clone(),
        layers: edit.layers.unwrap_or(u32::MAX),
        mask: edit.mask.unwrap_or(u32::MAX),
    }))
}

/// Moving to nowhere in particular is more likely a mistake than a wish for the origin.
pub(super) fn required_pose(path: &Path<'_>, pose: Option<&v1::Pose>) -> Result<crate::geometry::Pose, ServiceError> {
    path.required(pose)?;
    geometry::pose(path, pose)
}

pub(super) fn body_ref(path: &Path<'_>, body: Option<&v1::BodyRef>) -> Result<BodyRef, ServiceError> {
    match path.required(body.and_then(|body| body.by.as_ref()))? {
        v1::body_ref::By::Id(id) => Ok(BodyRef::Id(BodyId(*id))),
        v1::body_ref::By::Name(name) => Ok(BodyRef::Name(name.clone())),
    }
}

fn effects(path: &Path<'_>, effects: &v1::Effects) -> Result<Effects, ServiceError> {
    let effect = |(index, number): (usize, &i32)| match v1::Effect::try_from(*number) {
        Ok(v1::Effect::Verdict) => Ok(Effect::Verdict),
        Ok(v1::Effect::Margin) => Ok(Effect::Margin),
        Ok(v1::Effect::Distance) => Ok(Effect::Distance),
        Ok(v1::Effect::Witness) => Ok(Effect::Witness),
        Ok(v1::Effect::Depth) => Ok(Effect::Depth),
        Ok(v1::Effect::Patch) => Ok(Effect::Patch),
        Ok(v1::Effect::Motion) => Ok(Effect::Motion),
        Ok(v1::Effect::Derivatives) => Ok(Effect::Derivatives),
        Ok(v1::Effect::Events) => Ok(Effect::Events),
        Ok(v1::Effect::Unspecified) | Err(_) => Err(unknown_value(&path.item("effects", index), *number)),
    };
    effects.effects.iter().enumerate().map(effect).collect()
}

pub(super) fn party(path: &Path<'_>, party: Option<&v1::Party>) -> Result<Party, ServiceError> {
    use v1::party::Kind;
    match path.required(party.and_then(|party| party.kind.as_ref()))? {
        Kind::Body(body) => Ok(Party::Body(body_ref(&path.field("body"), Some(body))?)),
        Kind::Link(link) => Ok(Party::Link { robot: link.robot.clone(), link: link.link.clone() }),
        Kind::Group(group) => Ok(Party::Group(group.clone())),
        Kind::Robot(robot) => Ok(Party::Robot(robot.clone())),
        Kind::Everything(v1::Everything {}) => Ok(Party::Everything),
    }
}
