//! A convex, bounded shape against a half-space or a plane: one or two support values.

use std::f64::consts::PI;

use super::convex::Convex;
use super::escalation;
use super::given::Given;
use super::goal::Goal;
use super::outcome::{Bracket, Cost, Separation, Termination};
use super::support::{radius, support};
use super::witness::WITNESS_ERROR_ULPS;
use crate::geometry::tolerance::{SUPPORT_ERROR_ULPS, UNIT_ROUNDOFF};
use crate::geometry::{Placement, Vec3, length};

/// `{ x : normal . x <= offset }`, or its boundary alone when `thin`; swept by a ball, in its place.
#[derive(Clone, Copy)]
pub(super) struct Unbounded<'a> {
    pub normal: Vec3,
    pub offset: f64,
    pub thin: bool,
    pub swept_radius: f64,
    pub at: &'a Placement,
    /// How far a point may be from where `at` says, metres.
    pub placement_error: f64,
    /// What `at` and the radius were rounded from.
    pub given: Given<'a>,
}

/// How far a body is above a wall, as a higher precision finds it.
pub(super) struct Height {
    /// Of the signed distance, metres.
    pub bracket: Bracket,
    /// The point of the body's core that is lowest, in its own frame; metres.
    pub point: Vec3,
    /// 1 where the body is on the side the wall's normal points to, -1 on the other side of a plane.
    pub side: f64,
}

impl Unbounded<'_> {
    /// The unit normal, and the offset in metres along it.
    pub fn upright(&self) -> (Vec3, f64) {
        // Both are divided by the largest component first, so that normals of extreme length neither over- nor underflow.
        let largest = self.normal.amax();
        let direction = self.normal / largest;
        let normal = direction.normalize();
        (normal, self.offset / largest / direction.dot(&normal))
    }
}

/// How far A is from `b`. Signed distance: n . a - offset/|normal| at the lowest point a of A, less the swept radii;
/// from a plane, on whichever side A sticks out less.
pub(super) fn separation(a: Convex, b: Unbounded, goal: &Goal) -> Separation {
    let (normal, offset) = b.upright();
    let b_in_a = Placement::relative(a.at, b.at);
    let up = b_in_a.direction(normal);
    let height = |p: Vec3| up.dot(&(p - b_in_a.translation)) - offset;
    let lowest = support(a.core, -up);
    let mut cost = Cost { pairs: 1, supports: 1, ..Cost::default() };

    let (mut point, mut side, mut of_cores) = (lowest, 1.0, height(lowest));
    let highest = if b.thin { support(a.core, up) } else { lowest };
    if b.thin {
        cost.supports += 1;
        if -height(highest) > of_cores {
            (point, side, of_cores) = (highest, -1.0, -height(highest));
        }
    }
    let extent = radius(a.core) + length(b_in_a.translation) + offset.abs();
    let radii = a.swept_radius + b.swept_radius;
    let error = UNIT_ROUNDOFF * (SUPPORT_ERROR_ULPS * extent + 4.0 * radii) + a.placement_error + b.placement_error;
    let signed_distance = of_cores - radii;
    // From A towards B: down to the half-space.
    let towards_b = a.at.direction(up) * -side;
    let point_on_a = a.at.point(point) + towards_b * a.swept_radius;
    // The direction is known but for its own rounding; of a plane which side counts may not be.
    let sides_alike = b.thin && (height(lowest) + height(highest)).abs() <= 4.0 * error;
    let normal_error = if sides_alike { PI } else { WITNESS_ERROR_ULPS * f64::EPSILON };
    let rounding = WITNESS_ERROR_ULPS * UNIT_ROUNDOFF * (signed_distance.abs() + length(a.at.translation));
    let point_error = 2.0 * error + rounding;
    let found = Separation {
        bracket: Bracket { lower: signed_distance - error, upper: signed_distance + error },
        signed_distance,
        normal: towards_b,
        point_on_a,
        point_on_b: point_on_a + towards_b * signed_distance,
        point_error,
        normal_error,
        termination: Termination::ClosedForm,
        subshape_a: 0,
        subshape_b: 0,
        cost,
    };
    escalation::settle_wall(&a, &b, goal, found)
}
