//! How do a pair's signed distance, normal and witness points change when its bodies move?
//!
//! [`derivatives`] is the door; `docs/derivations/derivatives.md` has the formulae and what is promised. `derivatives` has what is asked and
//! answered, `maker` chooses by method. `exact` is by formula: `side` tells what of a shape bends how near the witness, `response` solves for the
//! change of the normal and the points, `smooth_pair` makes the normal of smooth pairs as exact as
//! rounding lets it be.

#[cfg(feature = "effect-derivatives")]
mod adaptive_epsilon;
mod derivatives;
#[cfg(feature = "effect-derivatives")]
mod exact;
#[cfg(feature = "effect-derivatives")]
mod maker;
#[cfg(feature = "effect-derivatives")]
mod response;
#[cfg(feature = "effect-derivatives")]
mod side;
#[cfg(feature = "effect-derivatives")]
mod smooth_pair;

#[cfg(feature = "effect-derivatives")]
pub use adaptive_epsilon::EpsilonSchedule;
pub use derivatives::{DerivativeCost, DerivativeGoal, DerivativeMethod, Derivatives, NoDerivatives, TwistMatrix};
#[cfg(feature = "effect-derivatives")]
pub use maker::derivatives;
