//! Where does a ray enter a ball, a box, a half-space or a plane? By a formula, and then by proof.
//!
//! A formula's root is only a proposal. The ray is outside before `t - d` if a plane parts it from the body there and lies across its way;
//! it is inside at `t + d` if that point is, by more than the error of its place. The least d for which both hold, a few errors over the
//! rate of approach, is the bracket.

use super::impact::Outcome;
use super::outcome::Termination;
use super::ray::{Local, Met};
use super::ray_trees::{self, Crossing};
use crate::geometry::tolerance::UNIT_ROUNDOFF;
use crate::geometry::{Core, Vec3, length};

/// What a formula says.
pub(super) enum Form {
    /// Proved.
    Known(Met),
    /// There is no formula for this, or its proof does not hold as near to the surface.
    Unknown,
}

/// Widths that are tried around a proposal, each four times the last.
const TRIES: i32 = 6;

/// A convex core with a ball of that radius swept over it, in its own frame.
pub(super) fn convex(ray: &Local, core: &Core, radius: f64) -> Form {
    match core {
        Core::Point => ball(ray, radius),
        Core::Cuboid { half_extents } if radius == 0.0 => cuboid(ray, *half_extents),
        Core::Segment([p, q]) if p == q => {
            let error = ray.error + 2.0 * UNIT_ROUNDOFF * (length(ray.start) + length(*p));
            ball(&Local { start: ray.start - p, error, ..*ray }, radius)
        }
        Core::Block(block) if radius == 0.0 => {
            let off = 8.0 * UNIT_ROUNDOFF * (length(ray.start) + length(block.min) + length(block.max));
            let shifted = Local { start: ray.start - block.center(), error: ray.error + off, ..*ray };
            cuboid(&shifted, block.half_extents())
        }
        Core::Triangle(corners) if radius == 0.0 => match ray_trees::triangle(ray, corners) {
            Crossing::Crosses(met) => Form::Known(met),
            Crossing::Misses => Form::Known(Met::nothing()),
            Crossing::Unknown => Form::Unknown,
        },
        Core::Cuboid { .. }
        | Core::AxialSegment { .. }
        | Core::Cylinder { .. }
        | Core::Cone { .. }
        | Core::Ellipsoid { .. }
        | Core::Convex(_)
        | Core::Triangle(_)
        | Core::Segment(_)
        | Core::HalfSpace { .. }
        | Core::Plane { .. }
        | Core::Mesh(_)
        | Core::HeightField(_)
        | Core::PointCloud(_)
        | Core::Voxels(_)
        | Core::Column(_)
        | Core::Block(_)
        | Core::Compound(_) => Form::Unknown,
    }
}

fn ball(ray: &Local, radius: f64) -> Form {
    let error = ray.error + 8.0 * UNIT_ROUNDOFF * (radius + length(ray.start));
    let middle = -ray.start.dot(&ray.direction);
    let nearest = ray.point(middle);
    let across = length(nearest);
    // Outside at the nearest point of the line: outside of the tangent plane there, along all of it.
    if across > radius + 2.0 * error {
        return Form::Known(Met::nothing());
    }
    let half = ((radius - across) * (radius + across)).max(0.0).sqrt();
    let proposal = middle - half;
    let is_outside = |t: f64| t <= middle && length(ray.point(t)) > radius + error;
    let is_inside = |t: f64| length(ray.point(t)) + error <= radius;
    let normal = ray.point(proposal.max(0.0)) / radius;
    if middle < 0.0 && length(ray.start) > radius + error {
        return Form::Known(Met::nothing()); // Going away.
    }
    settle(ray, proposal, half / radius, middle, error, normal, is_outside, is_inside, |_, _| false)
}

fn cuboid(ray: &Local, half: Vec3) -> Form {
    let error = ray.error + 8.0 * UNIT_ROUNDOFF * (length(half) + length(ray.start));
    let (mut enters, mut leaves, mut axis) = (f64::NEG_INFINITY, f64::INFINITY, 0);
    for i in 0..3 {
        let (x, d) = (ray.start[i], ray.direction[i]);
        if d == 0.0 {
            if x.abs() > half[i] + error {
                return Form::Known(Met::nothing());
            }
            continue;
        }
        let (one, two) = ((-half[i] - x) / d, (half[i] - x) / d);
        let (near, far) = if one < two { (one, two) } else { (two, one) };
        if near > enters {
            (enters, axis) = (near, i);
        }
        leaves = leaves.min(far);
    }
    if misses(ray, half, error) {
        return Form::Known(Met::nothing());
    }
    let is_outside = |t: f64| {
        let x = ray.point(t);
        (0..3).any(|i| x[i].abs() > half[i] + error && x[i] * ray.direction[i] <= 0.0)
    };
    let is_inside = |t: f64| {
        let x = ray.point(t);
        (0..3).all(|i| x[i].abs() + error <= half[i])
    };
    // A plate without thickness has no inside, but what is on one side of it before and on the other after went through.
    let is_through = |before: f64, after: f64| {
        let ends = [before, after].map(|t| ray.point(t));
        let within = |x: &Vec3| (0..3).all(|i| i == axis || x[i].abs() + error <= half[i]);
        let side = -ray.direction[axis].signum();
        ends.iter().all(within) && ends[0][axis] * side > error && ends[1][axis] * side < -error
    };
    let mut normal = Vec3::zeros();
    normal[axis] = -ray.direction[axis].signum();
    let rate = ray.direction[axis].abs();
    let middle = enters + 0.5 * (leaves - enters);
    settle(ray, enters, rate, middle, error, normal, is_outside, is_inside, is_through)
}

/// Whether a plane along a face of the box, or along the ray and an edge, parts the cut ray from the box.
fn misses(ray: &Local, half: Vec3, error: f64) -> bool {
    let h = ray.direction * (0.5 * ray.length);
    let middle = ray.start + h;
    let reach = half.add_scalar(2.0 * error);
    if (middle.abs() - h.abs() - reach).max() > 0.0 {
        return true;
    }
    let d = ray.direction;
    let across = d.cross(&middle).abs();
    let d = d.abs();
    let limit = Vec3::new(reach.y * d.z + reach.z * d.y, reach.z * d.x + reach.x * d.z, reach.x * d.y + reach.y * d.x);
    (across - limit).add_scalar(-2.0 * error).max() > 0.0
}

/// A bracket around the proposal, or a hit at once, or nothing known. `rate`: how fast the surface comes nearer, in metres a metre.
#[expect(clippy::too_many_arguments, reason = "two forms, one proof: what they propose, and how they prove it")]
fn settle(
    ray: &Local,
    proposal: f64,
    rate: f64,
    middle: f64,
    error: f64,
    normal: Vec3,
    is_outside: impl Fn(f64) -> bool,
    is_inside: impl Fn(f64) -> bool,
    is_through: impl Fn(f64, f64) -> bool,
) -> Form {
    if is_inside(0.0) {
        let starts_inside = ray.offset == 0.0;
        return known(ray, [0.0, 0.0], starts_inside, normal);
    }
    // As many errors as parting and holding take, as the ray goes.
    let least = 3.0 * error / rate.max(1e-12) + 4.0 * UNIT_ROUNDOFF * proposal.abs();
    let widths = || (0..TRIES).map(|k| least * libm::exp2(f64::from(2 * k)));
    if proposal - least >= ray.length && is_outside(ray.length) {
        return Form::Known(Met::nothing());
    }
    let lower = widths().map(|width| proposal - width).find(|t| *t <= 0.0 || (*t <= ray.length && is_outside(*t)));
    let within = |t: f64| t >= 0.0 && t <= ray.length;
    let holds = |t: f64| is_inside(t) || lower.is_some_and(|lower| is_through(lower, t));
    let upper = widths().map(|width| proposal + width).chain([middle]).find(|t| within(*t) && holds(*t));
    match (lower, upper) {
        (Some(lower), Some(upper)) => known(ray, [lower.max(0.0), upper], false, normal),
        _ => Form::Unknown,
    }
}

fn known(ray: &Local, [lower, upper]: [f64; 2], starts_inside: bool, normal: Vec3) -> Form {
    let normal = if starts_inside { -ray.direction } else { normal };
    let termination = Termination::ClosedForm;
    Form::Known(Met { outcome: Outcome::Hit, lower, upper, starts_inside, normal, number: 0, termination })
}

/// A half-space or, thin, a plane, with a ball swept over it. `rate`: what the place of a point is off by more for each metre on the way.
pub(super) fn wall(ray: &Local, normal: Vec3, offset: f64, thin: bool, radius: f64, rate: f64) -> Met {
    // Both are divided by the largest component first, so that normals of extreme length neither over- nor underflow.
    let largest = normal.amax();
    let scaled = normal / largest;
    let up = scaled.normalize();
    let offset = offset / largest / scaled.dot(&up);
    let height = up.dot(&ray.start) - offset;
    let error = ray.error + 16.0 * UNIT_ROUNDOFF * (length(ray.start) + offset.abs() + radius);
    let side = if thin && height < 0.0 { -1.0 } else { 1.0 };
    let outwards = up * side;
    let (height, climb) = (height * side - radius, outwards.dot(&ray.direction));
    let met = |outcome, lower: f64, upper: f64, starts_inside: bool, termination| Met {
        outcome,
        lower: lower.max(0.0),
        upper: upper.min(ray.length),
        starts_inside,
        normal: if starts_inside { -ray.direction } else { outwards },
        number: 0,
        termination,
    };
    if height + error <= 0.0 {
        return met(Outcome::Hit, 0.0, 0.0, true, Termination::ClosedForm);
    }
    // Heights fall at this rate, more or less by what the direction is off.
    let (fastest, slowest) = (-climb + rate, -climb - rate);
    if height > error {
        if fastest <= 0.0 {
            return Met::nothing();
        }
        let lower = (height - error) / fastest * (1.0 - 8.0 * UNIT_ROUNDOFF);
        if lower > ray.length {
            return Met::nothing();
        }
        let upper = (height + error) / slowest * (1.0 + 8.0 * UNIT_ROUNDOFF);
        if slowest > 0.0 && upper <= ray.length {
            return met(Outcome::Hit, lower, upper, false, Termination::ClosedForm);
        }
        return met(Outcome::Undecided, lower, ray.length, false, Termination::RoundingFloor);
    }
    // On the surface, as far as can be told. Into it, or away from it?
    let upper = (height.abs() + 2.0 * error) / slowest;
    if !thin && slowest > 0.0 && upper <= ray.length {
        return met(Outcome::Hit, 0.0, upper, false, Termination::ClosedForm);
    }
    let away = (2.0 * error) / (climb - rate);
    let end = if climb > rate { away } else { ray.length };
    met(Outcome::Undecided, 0.0, end, false, Termination::RoundingFloor)
}
