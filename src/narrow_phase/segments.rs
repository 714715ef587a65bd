//! Points and segments, swept or not: spheres, capsules. Their nearest points have a formula.
//!
//! Two segments c + s h, s in -1..=1: the nearest pair of their lines, cut to the ends one after the other (Lumelsky 1985;
//! Ericson, Real-Time Collision Detection, 5.1.9). The formula is a guess as far as the proof goes: its points bound the
//! distance from above, the direction between them bounds it from below, and where the two do not meet, as with
//! segments that cross or nearly so, the general way is taken.

use super::bracketing::Target;
use super::convex::Convex;
use super::escalation;
use super::goal::Goal;
use super::outcome::{Cost, Separation, Termination};
use super::witness::{self, WITNESS_ERROR_ULPS};
use crate::geometry::tolerance::{PROVED, SUPPORT_ERROR_ULPS, UNIT_ROUNDOFF, UNSCALED_EXTENT};
use crate::geometry::vector::{ORIGIN, sum_of_sizes};
use crate::geometry::{Core, Vec3, length};

/// A segment in its place: its middle as an offset from the body's origin, and half its length; metres, common axes.
struct Half {
    middle: Vec3,
    half: Vec3,
    /// The square of the half's length.
    square: f64,
    /// No point is farther from the body's origin than this.
    reach: f64,
}

#[inline(always)]
fn placed(body: &Convex) -> Option<Half> {
    let (middle, half) = match body.core {
        Core::Point => (ORIGIN, ORIGIN),
        Core::AxialSegment { half_length } => {
            let axis = Vec3::new(body.at.rotation[(0, 2)], body.at.rotation[(1, 2)], body.at.rotation[(2, 2)]);
            // The square need not be exact: nothing is proved with it.
            let square = half_length * half_length;
            return Some(Half { middle: ORIGIN, half: axis * *half_length, square, reach: *half_length });
        }
        Core::Segment([p, q]) => (body.at.direction((p + q) * 0.5), body.at.direction((q - p) * 0.5)),
        Core::Cuboid { .. }
        | Core::Cylinder { .. }
        | Core::Cone { .. }
        | Core::Ellipsoid { .. }
        | Core::Convex(_)
        | Core::Triangle(_)
        | Core::HalfSpace { .. }
        | Core::Plane { .. }
        | Core::Mesh(_)
        | Core::Compound(_)
        | Core::HeightField(_)
        | Core::PointCloud(_)
        | Core::Voxels(_)
        | Core::Column(_)
        | Core::Block(_) => return None,
    };
    Some(Half { middle, half, square: half.norm_squared(), reach: length(middle) + length(half) })
}

/// Two bodies whose cores are points or segments.
pub(super) struct Segments<'a> {
    a: &'a Convex<'a>,
    b: &'a Convex<'a>,
    one: Half,
    other: Half,
}

impl<'a> Segments<'a> {
    /// None for other kinds.
    #[inline(always)]
    pub fn of(a: &'a Convex<'a>, b: &'a Convex<'a>) -> Option<Self> {
        Some(Self { a, b, one: placed(a)?, other: placed(b)? })
    }

    /// The answer; where the formula's bracket is not as narrow as the goal needs it, that of `otherwise`.
    #[inline(always)]
    pub fn separation(&self, goal: &Goal, otherwise: impl FnOnce() -> Separation) -> Separation {
        let Self { a, b, one, other } = self;
        let from_origin_to_origin = b.at.translation - a.at.translation;
        let between = from_origin_to_origin + (other.middle - one.middle);
        let (s, t) = nearest(between, one, other);
        let from_a_to_b = between + other.half * t - one.half * s;
        let extent = one.reach + other.reach + length(from_origin_to_origin);
        let square = from_a_to_b.norm_squared();
        if !((UNSCALED_EXTENT.0..=UNSCALED_EXTENT.1).contains(&extent) && square > SMALLEST_SQUARE) {
            return otherwise();
        }
        let distance = square.sqrt();
        // Least of n . (b - a): each segment sticks out by |n . h|. Divided last, so that the root is worked out meanwhile.
        let product = from_a_to_b.dot(&between) - from_a_to_b.dot(&one.half).abs() - from_a_to_b.dot(&other.half).abs();
        let least = product / distance;
        let normal = from_a_to_b / distance;
        let rounding = SUPPORT_ERROR_ULPS * UNIT_ROUNDOFF * extent + a.placement_error + b.placement_error;
        let error = if PROVED { rounding } else { 0.0 };
        let target = Target::new(goal, a.swept_radius + b.swept_radius, 1.0);
        let (lower, upper) = (least - error, distance + error);
        let bracket = target.bracket(lower, upper);
        let at_floor = distance - least <= 2.0 * error;
        let is_enough = at_floor || target.is_decided(&bracket) || target.is_met(&bracket);
        if !is_enough || escalation::is_undecided(goal, &bracket) {
            return otherwise();
        }
        let signed_distance = (distance - target.radii).max(bracket.lower).min(bracket.upper);
        let point_on_a = a.at.translation + (one.middle + one.half * s + normal * a.swept_radius);
        // The root of U^2 - L^2 for U = d + e and L = p / d - e is no more than this, which does not wait for d.
        let gap = (2.0 * (square - product).max(0.0) + 4.0 * error * sum_of_sizes(from_a_to_b)).sqrt();
        let gap = if PROVED && lower > 0.0 { gap } else { 0.0 };
        let normal_error = if PROVED { witness::normal_error(lower, gap) } else { 0.0 };
        let rounding = WITNESS_ERROR_ULPS * UNIT_ROUNDOFF * (target.radii + length(a.at.translation));
        let point_error =
            if PROVED { gap + 2.0 * error + target.radii * normal_error.min(2.0) + rounding } else { 0.0 };
        Separation {
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
        }
    }
}

/// Nearer than the root of this, in metres, the general way is taken, which scales.
const SMALLEST_SQUARE: f64 = 1e-200;

/// Where on two segments `s p` and `between + t q`, s and t in -1..=1, they are nearest.
#[inline(always)]
fn nearest(between: Vec3, one: &Half, other: &Half) -> (f64, f64) {
    let (p, q) = (one.half, other.half);
    let (pp, qq, pq) = (one.square, other.square, p.dot(&q));
    // The inverses first, all at once: what follows is one step after the other.
    let inverse = |x: f64| if x > 0.0 { 1.0 / x } else { 0.0 };
    let (of_pp, of_qq, of_both) = (inverse(pp), inverse(qq), inverse(pp * qq - pq * pq));
    let (along_p, along_q) = (between.dot(&p), between.dot(&q));
    let cut = |x: f64| x.clamp(-1.0, 1.0);
    let s = cut((along_p * qq - along_q * pq) * of_both);
    let t = cut((s * pq - along_q) * of_qq);
    (cut((t * pq + along_p) * of_pp), t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_points_of_segments_by_hand() {
        let (x, y, z) = (Vec3::x(), Vec3::y(), Vec3::z());
        let of = |between: Vec3, p: Vec3, q: Vec3| {
            let placed =
                |half: Vec3| Half { middle: Vec3::zeros(), half, square: half.norm_squared(), reach: half.norm() };
            nearest(between, &placed(p), &placed(q))
        };
        assert_eq!(of(z, x, y), (0.0, 0.0), "crossing above one another");
        assert_eq!(of(x * 3.0, x, x), (1.0, -1.0), "one behind the other");
        assert_eq!(of(x * 3.0, x, -x), (1.0, 1.0), "the other way round");
        assert_eq!(of(x * 2.0 + z, x, y), (1.0, 0.0), "beside the end");
        assert_eq!(of(z, Vec3::zeros(), Vec3::zeros()), (0.0, 0.0), "two points");
        assert_eq!(of(y * 0.5 + z, Vec3::zeros(), y), (0.0, -0.5), "a point beside a segment");
    }
}
