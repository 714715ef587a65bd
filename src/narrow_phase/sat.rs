//! Depth by separating axes: of all unit vectors n, a few are the normals of the faces of C = A - B, and the deepest overlap
//! lies along one of them.
//!
//! The signed distance of overlapping polytopes is the largest, over those normals, of the signed distance along n. So looking at
//! all of them is a proof from above that no iteration gives, once what rounding may have done is added
//! (`docs/derivations/sat.md`); the proof from below is the support value along the best one, as everywhere.
//!
//! Of polytopes that are apart the best axis only parts them: it is where GJK starts.

use super::bracketing::Target;
use super::epa::Epa;
use super::minkowski::{Difference, Vertex};
use super::outcome::{Cost, Termination};
use super::sat_boxes::{Faces, best_axis};
use super::sat_polytopes::Axes;
use super::small_polytope::SmallPolytope;
use crate::geometry::tolerance::SUPPORT_ERROR_ULPS;
use crate::geometry::vector::{ORIGIN, opposite};
use crate::geometry::{Core, Vec3, length};

/// What the axes tell.
pub(super) enum Sat {
    /// All that was asked.
    Answer(Epa),
    /// Not enough: the unit direction, from the origin to the difference, of the best axis.
    Start(Vec3),
}

/// How far rounding may take the best of fifteen axes from the signed distance of boxes that overlap, in units of the error of a
/// support value.
const BOX_AXIS_ERRORS: f64 = 3.0;

// 336 u S by the derivation.
const _: () = assert!(BOX_AXIS_ERRORS * SUPPORT_ERROR_ULPS >= 336.0);

/// Looks along all axes of two small polytopes; nothing is known of other shapes.
pub(super) fn sat(difference: &mut Difference, target: &Target, cost: &mut Cost) -> Option<Sat> {
    if let (Core::Cuboid { half_extents: a }, Core::Cuboid { half_extents: b }) = (difference.a, difference.b) {
        let (a, b) = (*a, *b);
        return Some(boxes(a, b, Faces::of(a, b, difference.b_in_a), f64::INFINITY, difference, target, cost));
    }
    let a = SmallPolytope::of(difference.a)?;
    let b = SmallPolytope::of(difference.b)?.placed(difference.b_in_a);
    let axes = Axes::new(&a, &b, difference.extent)?;
    let upper = axes.upper + difference.error;
    Some(concluded(axes.normal, upper, &|slack| axes.contact(slack), difference, target, cost))
}

/// The answer of a face that parts two boxes, where no more is asked for than that. The points are the middles of both.
#[inline]
pub(super) fn parted(faces: &Faces, difference: &Difference, target: &Target) -> Option<Epa> {
    // Looked along the normal of a face the value is off by less than 132 u S (`docs/derivations/sat.md`).
    let lower = faces.value - 2.0 * difference.error;
    let upper = length(difference.b_in_a.translation) + difference.error;
    if !(lower > 0.0 && target.is_decided(&target.bracket(lower, upper))) {
        return None;
    }
    let direction = opposite(faces.toward_b(difference.b_in_a));
    let nearest = Vertex { w: opposite(difference.b_in_a.translation), on_a: ORIGIN, corners: [0; 2] };
    Some(Epa { lower, upper, direction, nearest, termination: Termination::Decided })
}

/// Two boxes of these half extents, whose faces have been looked along. With any edges that part them by more than `parted` no more is
/// asked.
pub(super) fn boxes(
    a: Vec3,
    b: Vec3,
    faces: Faces,
    parted: f64,
    difference: &mut Difference,
    target: &Target,
    cost: &mut Cost,
) -> Sat {
    let (error, b_in_a) = (difference.error, difference.b_in_a);
    let axis = best_axis(a, b, b_in_a, faces, [target.enough() + 2.0 * error, parted], error);
    if axis.value > parted {
        return Sat::Start(opposite(axis.normal));
    }
    let upper = axis.value + BOX_AXIS_ERRORS * error;
    let contact = |slack| axis.contact(a, b, b_in_a, slack);
    concluded(axis.normal, upper, &contact, difference, target, cost)
}

/// The answer from the best axis, a unit vector from A to B, and `upper`, which the signed distance does not exceed if it is
/// negative. `contact` gives the points that touch, of all that are level within a slack in metres.
#[inline]
fn concluded(
    normal: Vec3,
    upper: f64,
    contact: &dyn Fn(f64) -> (Vec3, Vec3),
    difference: &mut Difference,
    target: &Target,
    cost: &mut Cost,
) -> Sat {
    let error = difference.error;
    let direction = opposite(normal);
    let vertex = difference.lowest(direction);
    cost.supports += 1;
    let lower = direction.dot(&vertex.w) - error;
    let known = |upper, nearest, termination| Epa { lower, upper, direction, nearest, termination };
    if upper >= 0.0 {
        // Apart, or touching for all that is known.
        let upper = vertex.w.norm() + error;
        let decided = target.is_decided(&target.bracket(lower, upper));
        return if decided { Sat::Answer(known(upper, vertex, Termination::Decided)) } else { Sat::Start(direction) };
    }
    let bracket = target.bracket(lower, upper);
    if target.is_decided(&bracket) {
        return Sat::Answer(known(upper, vertex, Termination::Decided));
    }
    let termination = if target.is_met(&bracket) {
        Termination::Converged
    } else if upper - lower <= 8.0 * error {
        Termination::RoundingFloor
    } else {
        // Some normal is too uncertain.
        return Sat::Start(direction);
    };
    let (on_a, on_b) = contact(4.0 * error);
    Sat::Answer(known(upper, Vertex { w: on_a - on_b, on_a, ..vertex }, termination))
}
