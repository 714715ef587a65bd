//! Questions about rays, motions, regions and neighbours, as a client sends them.

use super::count;
use super::geometry::{pose, shape, vec3};
use super::question::{context, doubles, subject};
use crate::query::{
    CastMode, CastRays, CastShapes, CheckMovingPairs, Moved, Mover, NearestBodies, Overlap, Region, Way,
};
use crate::scene::BodyId;
use crate::service::Target;
use crate::transports::wire::v1;

/// A question about rays.
#[must_use]
pub fn cast_rays_request(target: &Target, question: &CastRays) -> v1::CastRaysRequest {
    v1::CastRaysRequest {
        context: Some(context(target, &question.context)),
        origins: Some(doubles(&question.origins)),
        directions: Some(doubles(&question.directions)),
        lengths: Some(doubles(&question.lengths)),
        mode: mode(question.mode).into(),
    }
}

/// A question about moving shapes.
#[must_use]
pub fn cast_shapes_request(target: &Target, question: &CastShapes) -> v1::CastShapesRequest {
    v1::CastShapesRequest {
        context: Some(context(target, &question.context)),
        items: question.items.iter().map(mover).collect(),
        mode: mode(question.mode).into(),
        resolution: Some(question.resolution),
    }
}

/// A question about pairs of which both move.
#[must_use]
pub fn check_moving_pairs_request(target: &Target, question: &CheckMovingPairs) -> v1::CheckMovingPairsRequest {
    let pair = |[a, b]: &[Mover; 2]| v1::MovingPair { a: Some(mover(a)), b: Some(mover(b)) };
    v1::CheckMovingPairsRequest {
        context: Some(context(target, &question.context)),
        items: question.items.iter().map(pair).collect(),
        resolution: Some(question.resolution),
    }
}

/// A question about regions.
#[must_use]
pub fn overlap_request(target: &Target, question: &Overlap) -> v1::OverlapRequest {
    v1::OverlapRequest {
        context: Some(context(target, &question.context)),
        items: question.items.iter().map(region).collect(),
        bounds_only: question.bounds_only,
    }
}

/// A question for the nearest.
#[must_use]
pub fn nearest_bodies_request(target: &Target, question: &NearestBodies) -> v1::NearestBodiesRequest {
    v1::NearestBodiesRequest {
        context: Some(context(target, &question.context)),
        items: question.items.iter().map(subject).collect(),
        count: count(question.count),
    }
}

fn mover(mover: &Mover) -> v1::Mover {
    let moved = match &mover.moved {
        Moved::Shape(moved) => v1::mover::Moved::Shape(shape(moved)),
        Moved::Body(BodyId(id)) => v1::mover::Moved::Body(v1::BodyRef { by: Some(v1::body_ref::By::Id(*id)) }),
    };
    let way = match mover.way {
        Way::Still => v1::mover::Way::Still(v1::Still {}),
        Way::To(goal) => v1::mover::Way::To(pose(&goal)),
        Way::By { displacement, turn } => {
            v1::mover::Way::By(v1::Twist { displacement: Some(vec3(displacement)), turn: Some(vec3(turn)) })
        }
    };
    v1::Mover { moved: Some(moved), start: mover.start.as_ref().map(pose), way: Some(way) }
}

fn region(region: &Region) -> v1::Region {
    let kind = match region {
        Region::Box(bounds) => {
            v1::region::Kind::Box(v1::Aabb { min: Some(vec3(bounds.min)), max: Some(vec3(bounds.max)) })
        }
        Region::Ball { center, radius } => {
            v1::region::Kind::Ball(v1::RegionBall { center: Some(vec3(*center)), radius: *radius })
        }
        Region::Shape { shape: placed, pose: at } => {
            v1::region::Kind::Shape(v1::PlacedShape { shape: Some(shape(placed)), pose: Some(pose(at)) })
        }
    };
    v1::Region { kind: Some(kind) }
}

fn mode(mode: CastMode) -> v1::CastMode {
    match mode {
        CastMode::First => v1::CastMode::First,
        CastMode::All => v1::CastMode::All,
        CastMode::Any => v1::CastMode::Any,
    }
}
