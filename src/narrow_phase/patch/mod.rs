//! Where two shapes touch, as a polygon: what a pair's witness and normal leave out, paid for only by who asks.
//!
//! [`contact_patch`] is the door; `docs/derivations/patch.md` says what is promised. `contact_patch` has what is asked and answered,
//! `touching_piece` finds the convex pieces that a separation names, `face` (and `round_face`) what of a piece faces the other, `flat_region`
//! and `common_region` are the geometry in the plane across the normal, `face_height` that above it, `reduction` chooses a few of many corners, and `clipping` puts them together.

#[cfg(feature = "effect-patch")]
mod clipping;
#[cfg(feature = "effect-patch")]
mod common_region;
mod contact_patch;
#[cfg(any(feature = "effect-patch", feature = "effect-derivatives"))]
mod face;
#[cfg(feature = "effect-patch")]
mod face_height;
#[cfg(any(feature = "effect-patch", feature = "effect-derivatives"))]
mod flat_region;
#[cfg(feature = "effect-patch")]
mod reduction;
#[cfg(any(feature = "effect-patch", feature = "effect-derivatives"))]
mod round_face;
#[cfg(any(feature = "effect-patch", feature = "effect-derivatives"))]
mod touching_piece;

#[cfg(feature = "effect-patch")]
pub use clipping::contact_patch;
pub use contact_patch::{ContactPatch, ContactPoint, MOST_POINTS, NoPatch, PatchCost, PatchGoal};

#[cfg(feature = "effect-derivatives")]
pub(super) use face::{Face, View, across, face};
#[cfg(feature = "effect-derivatives")]
pub(super) use touching_piece::{TouchingPiece, is_wall};
