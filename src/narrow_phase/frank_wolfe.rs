//! Frank-Wolfe with line search: the bottom of the ladder, for comparison.
//!
//! One point x of the difference C is kept, and each round moves it toward the vertex that lies farthest against it, to where
//! the segment is nearest the origin (Frank and Wolfe 1956). GJK differs in one thing only: it corrects over all vertices it
//! still holds. On a face the plain step zigzags and closes the gap as slowly as 1/k, which is what the ladder shows.
//!
//! It cannot prove an overlap. What it has not parted within its cap goes on to EPA.

use super::bracketing::Target;
use super::epa::Epa;
use super::minkowski::{Difference, Vertex};
use super::outcome::{Cost, Termination};
use super::support::unit;
use crate::geometry::Vec3;
use crate::geometry::tolerance::UNIT_ROUNDOFF;

/// Rounds at most. Smooth pairs a centimetre apart need some hundred for six digits, faces far more than anyone would wait for.
const MAX_ITERATIONS: u32 = 1000;

/// Narrows a bracket until it is as asked, or the cap on rounds.
pub(super) fn frank_wolfe(difference: &mut Difference, target: &Target, cost: &mut Cost) -> Epa {
    let error = difference.error;
    let direction = unit(difference.centers()).unwrap_or_else(Vec3::x);
    let mut x = difference.lowest(direction);
    cost.supports += 1;
    // By how much the mixing has moved x off the hull of the vertices it is mixed from, metres.
    let mut drift = 0.0;
    let mut found = Epa {
        lower: direction.dot(&x.w) - error,
        upper: x.w.norm() + error,
        direction,
        nearest: x,
        termination: Termination::IterationLimit,
    };
    for _ in 0..MAX_ITERATIONS {
        let bracket = target.bracket(found.lower, found.upper);
        if target.is_decided(&bracket) {
            return Epa { termination: Termination::Decided, ..found };
        }
        if target.is_met(&bracket) {
            return Epa { termination: Termination::Converged, ..found };
        }
        if target.must_stop() {
            return Epa { termination: Termination::TimeLimit, ..found };
        }
        let Some(direction) = unit(x.w) else { return found };
        let vertex = difference.lowest(direction);
        cost.supports += 1;
        cost.gjk_iterations += 1;
        let value = direction.dot(&vertex.w) - error;
        if value > found.lower {
            (found.lower, found.direction) = (value, direction);
        }
        let step = vertex.w - x.w;
        let share = -x.w.dot(&step) / step.norm_squared();
        // Nothing lies farther against x than x itself. Comparison order matters: a step of no length gives NaN.
        if !(share > 0.0) {
            if found.upper - found.lower <= 4.0 * error + drift {
                found.termination = Termination::RoundingFloor;
            }
            return found;
        }
        let share = share.min(1.0);
        let mixed = |of_x: Vec3, of_vertex: Vec3| of_x * (1.0 - share) + of_vertex * share;
        x = Vertex { w: mixed(x.w, vertex.w), on_a: mixed(x.on_a, vertex.on_a), ..vertex };
        // Two products and a sum, and the rounding of the share: below 8 units of the extent.
        drift = drift * (1.0 - share) + 8.0 * UNIT_ROUNDOFF * difference.extent;
        let upper = x.w.norm() + error + drift;
        if upper < found.upper {
            (found.upper, found.nearest) = (upper, x);
        }
    }
    found
}
