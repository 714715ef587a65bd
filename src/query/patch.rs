//! Where do the faces of a pair touch? For who wants it, of pairs that are not proved apart by more than their margin.

use super::request::{Context, Wants};
use crate::geometry::{Placement, Shape};
use crate::narrow_phase::{ContactPatch, Cost, Separation};

/// Makes the patch of a pair, as far as the faces are within `margin` metres of each other, or within what the pair is apart.
/// None where the separation names no single convex piece.
///
/// Called by its address, so that what is around the call is compiled alike whether there is such code or not.
pub(super) type PatchOf =
    fn([(&Shape, &Placement); 2], &Separation, f64, &Context, &mut Cost) -> Option<Box<ContactPatch>>;

/// What makes patches, where they are wanted. None in a build without the code: it refuses a context that wants patches.
pub(super) fn patch_of(wants: Wants) -> Option<PatchOf> {
    if wants.patch { MAKER } else { None }
}

#[cfg(not(feature = "effect-patch"))]
const MAKER: Option<PatchOf> = None;

#[cfg(feature = "effect-patch")]
const MAKER: Option<PatchOf> = Some(patch);

#[cfg(feature = "effect-patch")]
fn patch(
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
