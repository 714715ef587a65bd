//! Questions about rays, motions, regions and neighbours: from messages to plain structs.

use super::query::{body_id, context, doubles, subject, unknown_value};
use super::{Path, geometry};
use crate::geometry::{Aabb, Vec3};
use crate::limits::LimitExceeded;
use crate::query::{
    CastMode, CastRays, CastShapes, CheckMovingPairs, DEFAULT_RESOLUTION, Moved, Mover, NearestBodies, Overlap, Region,
    Way,
};
use crate::scene::Snapshot;
use crate::service::{Library, ServiceError};
use crate::transports::wire::v1;

/// A question about rays.
///
/// # Errors
/// A field that cannot be, a body that is not there.
pub fn cast_rays(request: &v1::CastRaysRequest, snapshot: &Snapshot) -> Result<CastRays, ServiceError> {
    Ok(CastRays {
        origins: doubles(&Path::root("origins"), request.origins.as_ref())?,
        directions: doubles(&Path::root("directions"), request.directions.as_ref())?,
        lengths: doubles(&Path::root("lengths"), request.lengths.as_ref())?,
        mode: mode(request.mode)?,
        context: context(request.context.as_ref(), snapshot)?,
    })
}

/// A question about moving shapes.
///
/// # Errors
/// A field that cannot be, a body or asset that is not there.
pub fn cast_shapes(
    request: &v1::CastShapesRequest,
    snapshot: &Snapshot,
    library: &Library,
) -> Result<CastShapes, ServiceError> {
    let item = |(index, item)| mover(&Path::root_item("items", index), item, snapshot, library);
    LimitExceeded::check("max_items", request.items.len(), library.limits().max_items)?;
    Ok(CastShapes {
        items: request.items.iter().enumerate().map(item).collect::<Result<_, ServiceError>>()?,
        mode: mode(request.mode)?,
        resolution: request.resolution.unwrap_or(DEFAULT_RESOLUTION),
        context: context(request.context.as_ref(), snapshot)?,
    })
}

/// A question about pairs of which both move.
///
/// # Errors
/// A field that cannot be, a body or asset that is not there.
pub fn check_moving_pairs(
    request: &v1::CheckMovingPairsRequest,
    snapshot: &Snapshot,
    library: &Library,
) -> Result<CheckMovingPairs, ServiceError> {
    let item = |(index, pair): (usize, &v1::MovingPair)| {
        let path = Path::root_item("items", index);
        let (a, b) = (path.field("a"), path.field("b"));
        let one = mover(&a, a.required(pair.a.as_ref())?, snapshot, library)?;
        Ok([one, mover(&b, b.required(pair.b.as_ref())?, snapshot, library)?])
    };
    LimitExceeded::check("max_items", request.items.len(), library.limits().max_items)?;
    Ok(CheckMovingPairs {
        items: request.items.iter().enumerate().map(item).collect::<Result<_, ServiceError>>()?,
        resolution: request.resolution.unwrap_or(DEFAULT_RESOLUTION),
        context: context(request.context.as_ref(), snapshot)?,
    })
}

/// A question about regions.
///
/// # Errors
/// A field that cannot be, a body or asset that is not there.
pub fn overlap(request: &v1::OverlapRequest, snapshot: &Snapshot, library: &Library) -> Result<Overlap, ServiceError> {
    let item = |(index, item)| region(&Path::root_item("items", index), item, library);
    LimitExceeded::check("max_items", request.items.len(), library.limits().max_items)?;
    Ok(Overlap {
        items: request.items.iter().enumerate().map(item).collect::<Result<_, ServiceError>>()?,
        bounds_only: request.bounds_only,
        context: context(request.context.as_ref(), snapshot)?,
    })
}

/// A question for the nearest.
///
/// # Errors
/// A field that cannot be, a body or asset that is not there.
pub fn nearest_bodies(
    request: &v1::NearestBodiesRequest,
    snapshot: &Snapshot,
    library: &Library,
) -> Result<NearestBodies, ServiceError> {
    let item = |(index, item)| subject(&Path::root_item("items", index), item, snapshot, library);
    LimitExceeded::check("max_items", request.items.len(), library.limits().max_items)?;
    Ok(NearestBodies {
        items: request.items.iter().enumerate().map(item).collect::<Result<_, ServiceError>>()?,
        count: request.count as usize,
        context: context(request.context.as_ref(), snapshot)?,
    })
}

fn mover(path: &Path<'_>, mover: &v1::Mover, snapshot: &Snapshot, library: &Library) -> Result<Mover, ServiceError> {
    use v1::mover;
    let moved = match path.field("moved").required(mover.moved.as_ref())? {
        mover::Moved::Shape(shape) => Moved::Shape(geometry::shape(&path.field("shape"), Some(shape), library)?),
        mover::Moved::Body(body) => Moved::Body(body_id(&path.field("body"), Some(body), snapshot)?),
    };
    let given_start = mover.start.as_ref().map(|pose| geometry::pose(&path.field("start"), Some(pose)));
    let way = match path.field("way").required(mover.way.as_ref())? {
        mover::Way::Still(v1::Still {}) => Way::Still,
        mover::Way::To(pose) => Way::To(geometry::pose(&path.field("to"), Some(pose))?),
        mover::Way::By(v1::Twist { displacement, turn }) => {
            let vector = |v: &Option<v1::Vec3>| v.as_ref().map_or_else(Vec3::zeros, geometry::vec3);
            Way::By { displacement: vector(displacement), turn: vector(turn) }
        }
    };
    Ok(Mover { moved, start: given_start.transpose()?, way })
}

fn region(path: &Path<'_>, region: &v1::Region, library: &Library) -> Result<Region, ServiceError> {
    use v1::region::Kind;
    Ok(match path.required(region.kind.as_ref())? {
        Kind::Box(bounds) => {
            let path = path.field("box");
            let corner = |name, v: &Option<v1::Vec3>| geometry::required_vec3(&path.field(name), v.as_ref());
            Region::Box(Aabb { min: corner("min", &bounds.min)?, max: corner("max", &bounds.max)? })
        }
        Kind::Ball(ball) => {
            let path = path.field("ball");
            let center = geometry::required_vec3(&path.field("center"), ball.center.as_ref())?;
            Region::Ball { center, radius: ball.radius }
        }
        Kind::Shape(placed) => {
            let path = path.field("shape");
            let shape = geometry::shape(&path.field("shape"), placed.shape.as_ref(), library)?;
            Region::Shape { shape, pose: geometry::pose(&path.field("pose"), placed.pose.as_ref())? }
        }
    })
}

fn mode(number: i32) -> Result<CastMode, ServiceError> {
    match v1::CastMode::try_from(number) {
        Ok(v1::CastMode::Unspecified | v1::CastMode::First) => Ok(CastMode::First),
        Ok(v1::CastMode::All) => Ok(CastMode::All),
        Ok(v1::CastMode::Any) => Ok(CastMode::Any),
        Err(_) => Err(unknown_value(&Path::root("mode"), number)),
    }
}
