//! Where do the faces of a pair touch? For who wants it, of pairs that are not proved apart by more than their margin.

use super::request::Context;
use crate::geometry::{Placement, Shape};
use crate::narrow_phase::{ContactPatch, Cost, Separation};

/// The patch of a pair, as far as the faces are within `margin` metres of each other, or within what the pair is apart. None
/// where the separation names no single convex piece.
#[cfg(feature = "effect-patch")]
pub(super) fn patch(
    [a, b]: [(&Shape, &Placement); 2],
    found: &Separation,
    margin: f64,
    context: &Context,
    cost: &mut Cost,
) -> Option<Box<ContactPatch>> {
    use crate::narrow_phase::{PatchGoal, contact_patch};
    let goal = PatchGoal { cut_off: margin, most: context.max_patch_points, ..PatchGoal::default() };
    let patch = contact_patch(a.0, b.0, a.1, b.1, found, &goal).ok()?;
    cost.patch_corners += patch.cost.corners;
    cost.patch_cuts += patch.cost.cuts;
    Some(Box::new(patch))
}

/// Never called: a context that wants patches is refused by such a build.
#[cfg(not(feature = "effect-patch"))]
pub(super) fn patch(
    _: [(&Shape, &Placement); 2],
    _: &Separation,
    _: f64,
    _: &Context,
    _: &mut Cost,
) -> Option<Box<ContactPatch>> {
    None
}
