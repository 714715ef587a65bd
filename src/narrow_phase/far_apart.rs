//! Whether two bodies touch, where their bounding boxes lie far enough apart: before any tree is gone down.

use super::bracketing::Target;
use super::convex::{Convex, place};
use super::epa::Epa;
use super::given::Given;
use super::goal::{Depth, Goal};
use super::minkowski::Vertex;
use super::outcome::{Cost, Separation, Termination};
use super::sat_boxes::Faces;
use super::trees::any_point;
use crate::geometry::tolerance::{SUPPORT_ERROR_ULPS, UNIT_ROUNDOFF, UNSCALED_EXTENT};
use crate::geometry::vector::opposite;
use crate::geometry::{Aabb, Placement, Shape, length};

/// The answer, where the normal of a face of one of the boxes parts them and no more is asked for; none otherwise, and for
/// compounds, whose parts have boxes of their own. The witness is any pair of points.
pub(super) fn parted(a: &Shape, b: &Shape, at_a: &Placement, at_b: &Placement, goal: &Goal) -> Option<Separation> {
    if goal.depth != Depth::Verdict {
        return None;
    }
    let (bounds_a, bounds_b) = (a.bounds()?, b.bounds()?);
    let (on_a, on_b) = (any_point(a.core())?, any_point(b.core())?);
    let Placement { rotation, translation, .. } = Placement::relative(at_a, at_b);
    let between = rotation * bounds_b.center() + translation - bounds_a.center();
    let of_centers = Placement::computed(rotation, between);
    let faces = Faces::of(bounds_a.half_extents(), bounds_b.half_extents(), &of_centers);
    let extent = reach(&bounds_a) + reach(&bounds_b) + length(translation);
    // 220 u S (`docs/derivations/sat.md`).
    let error = 2.0 * SUPPORT_ERROR_ULPS * UNIT_ROUNDOFF * extent;
    let across = on_a - (rotation * on_b + translation);
    let (lower, upper) = (faces.value - error, across.norm() + error);
    // Swept radii are in the boxes.
    let target = Target::new(goal, 0.0, 1.0);
    let bracket = target.bracket(lower, upper);
    if !(lower > 0.0 && UNSCALED_EXTENT.1 > extent && extent > UNSCALED_EXTENT.0 && target.is_decided(&bracket)) {
        return None;
    }
    let direction = opposite(faces.toward_b(&of_centers));
    let nearest = Vertex { w: across, on_a, corners: [0; 2] };
    let found = Epa { lower, upper, direction, nearest, termination: Termination::Decided };
    let cost = Cost { pairs: 1, ..Cost::default() };
    let a = Convex { core: a.core(), swept_radius: 0.0, at: at_a, placement_error: 0.0, given: Given::alone(a, at_a) };
    Some(place(&found, bracket, &a, &target, error, cost))
}

/// No point of the box is farther from the origin, metres.
fn reach(bounds: &Aabb) -> f64 {
    length(bounds.center()) + length(bounds.half_extents())
}
