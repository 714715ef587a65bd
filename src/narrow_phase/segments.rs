//! Points and segments, swept or not: spheres, capsules. Their nearest points have a formula.
//!
//! Two segments c + s h, s in -1..=1: the nearest pair of their lines, cut to the ends one after the other (Lumelsky 1985;
//! Ericson, Real-Time Collision Detection, 5.1.9). The formula is a guess as far as the proof goes: its points bound the
//! distance from above, the direction between them bounds it from below, and where the two do not meet, as with
//! segments that cross or nearly so, the general way is taken.

use super::bracketing::Target;
use super::convex::Convex;
use super::goal::Goal;
use super::outcome::{Cost, Separation, Termination};
use super::witness::{self, WITNESS_ERROR_ULPS};
use crate::geometry::tolerance::{SUPPORT_ERROR_ULPS, UNIT_ROUNDOFF, UNSCALED_EXTENT};
use crate::geometry::{Core, Vec3, length};

/// A segment in its place: its middle as an offset from the body's origin, and half its length; metres, common axes.
struct Half {
    middle: Vec3,
    half: Vec3,
}

fn placed(body: &Convex) -> Option<Half> {
    let turned = |v: Vec3| body.at.direction(v);
    match body.core {
        Core::Point => Some(Half { middle: Vec3::zeros(), half: Vec3::zeros() }),
        Core::AxialSegment { half_length } => {
            Some(Half { middle: Vec3::zeros(), half: turned(Vec3::new(0.0, 0.0, *half_length)) })
        }
        Core::Segment([p, q]) => Some(Half { middle: turned((p + q) * 0.5), half: turned((q - p) * 0.5) }),
        Core::Cuboid { .. }
        | Core::Cylinder { .. }
        | Core::Cone { .. }
        | Core::Ellipsoid { .. }
        | Core::Convex(_)
        | Core::Triangle(_)
        | Core::HalfSpace { .. }
        | Core::Plane { .. }
        | Core::Mesh(_)
        | Core::Compound(_) => None,
    }
}

/// The answer, when both cores are points or segments and the formula's bracket is as narrow as the goal needs it.
#[inline]
pub(super) fn separation(a: &Convex, b: &Convex, goal: &Goal) -> Option<Separation> {
    let (one, other) = (placed(a)?, placed(b)?);
    let between = (b.at.translation - a.at.translation) + (other.middle - one.middle);
    let (s, t) = nearest(between, one.half, other.half);
    let from_a_to_b = between + other.half * t - one.half * s;
    let distance = length(from_a_to_b);
    let extent = length(one.half)
        + length(other.half)
        + length(one.middle)
        + length(other.middle)
        + length(b.at.translation - a.at.translation);
    if !(UNSCALED_EXTENT.0..=UNSCALED_EXTENT.1).contains(&extent) || distance == 0.0 {
        return None;
    }
    let normal = from_a_to_b / distance;
    // Least of n . (b - a): each segment sticks out by |n . h|.
    let least = normal.dot(&between) - normal.dot(&one.half).abs() - normal.dot(&other.half).abs();
    let error = SUPPORT_ERROR_ULPS * UNIT_ROUNDOFF * extent + a.placement_error + b.placement_error;
    let target = Target::new(goal, a.swept_radius + b.swept_radius, 1.0);
    let (lower, upper) = (least - error, distance + error);
    let bracket = target.bracket(lower, upper);
    let at_floor = distance - least <= 2.0 * error;
    if !(target.is_decided(&bracket) || target.is_met(&bracket) || at_floor) {
        return None;
    }
    let signed_distance = (distance - target.radii).clamp(bracket.lower, bracket.upper);
    let point_on_a = a.at.translation + (one.middle + one.half * s + normal * a.swept_radius);
    let normal_error = witness::normal_error(lower, upper);
    let rounding = WITNESS_ERROR_ULPS * UNIT_ROUNDOFF * (target.radii + length(a.at.translation));
    let from_nearest = if lower > 0.0 { witness::gap(lower, upper) } else { 0.0 };
    let point_error = from_nearest + 2.0 * error + target.radii * normal_error.min(2.0) + rounding;
    Some(Separation {
        bracket,
        signed_distance,
        normal,
        point_on_a,
        point_on_b: point_on_a + normal * signed_distance,
        point_error,
        normal_error,
        termination: Termination::ClosedForm,
        subshape_a: 0,
        subshape_b: 0,
        cost: Cost { pairs: 1, supports: 1, ..Cost::default() },
    })
}

/// Where on two segments `s p` and `between + t q`, s and t in -1..=1, they are nearest.
#[inline]
fn nearest(between: Vec3, p: Vec3, q: Vec3) -> (f64, f64) {
    let (pp, qq, pq) = (p.dot(&p), q.dot(&q), p.dot(&q));
    let (along_p, along_q) = (between.dot(&p), between.dot(&q));
    let cut = |numerator: f64, denominator: f64| {
        if denominator > 0.0 { (numerator / denominator).clamp(-1.0, 1.0) } else { 0.0 }
    };
    let s = cut(along_p * qq - along_q * pq, pp * qq - pq * pq);
    let t = cut(s * pq - along_q, qq);
    (cut(t * pq + along_p, pp), t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_points_of_segments_by_hand() {
        let (x, y, z) = (Vec3::x(), Vec3::y(), Vec3::z());
        assert_eq!(nearest(z, x, y), (0.0, 0.0), "crossing above one another");
        assert_eq!(nearest(x * 3.0, x, x), (1.0, -1.0), "one behind the other");
        assert_eq!(nearest(x * 3.0, x, -x), (1.0, 1.0), "the other way round");
        assert_eq!(nearest(x * 2.0 + z, x, y), (1.0, 0.0), "beside the end");
        assert_eq!(nearest(z, Vec3::zeros(), Vec3::zeros()), (0.0, 0.0), "two points");
        assert_eq!(nearest(y * 0.5 + z, Vec3::zeros(), y), (0.0, -0.5), "a point beside a segment");
    }
}
