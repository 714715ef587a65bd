//! How do a pair's signed distance, normal and witness points change when its bodies move?
//!
//! [`derivatives`] is the door; `docs/derivations/derivatives.md` has the formulae and what is promised. `derivatives` has what is asked and
//! answered, `maker` chooses by method. `exact` is by formula: `side` tells what of a shape bends how near the witness, `response` solves for the
//! change of the normal and the points, `polish` makes the normal of smooth pairs as exact as rounding lets it be. `runner_up` looks for another pair of pieces that is as near.

mod derivatives;
#[cfg(feature = "effect-derivatives")]
mod exact;
#[cfg(feature = "effect-derivatives")]
mod maker;
#[cfg(feature = "effect-derivatives")]
mod polish;
#[cfg(feature = "effect-derivatives")]
mod response;
#[cfg(feature = "effect-derivatives")]
mod runner_up;
#[cfg(feature = "effect-derivatives")]
mod side;

pub use derivatives::{DerivativeCost, DerivativeGoal, DerivativeMethod, Derivatives, NoDerivatives, TwistMatrix};
#[cfg(feature = "effect-derivatives")]
pub use maker::derivatives;
