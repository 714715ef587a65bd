//! How do a pair's signed distance, normal and witness points change when its bodies move?
//!
//! [`derivatives`] is the door; `docs/derivations/derivatives.md` has the formulae and what is promised. `derivatives` has what is asked and
//! answered, `maker` chooses by method. `exact` is by formula: `side` tells what of a shape bends how near the witness, `response` solves for the
//! change of the normal and the points, `smooth_pair` makes the normal of smooth pairs as exact as rounding lets it be. `differences` and
//! `smoothed_places` (order zero) ask a `moved_pair` again. `smoothed_supports` (order one) puts sides of `smoothed_hessian` into the same
//! `response`: by sampling, or by the `softmax` of corners. Random numbers are those of `counter_random`, summed up in `moments`;
//! `adaptive_epsilon` says how far smoothing reaches. `runner_up` looks for another pair of pieces that is as near.

#[cfg(feature = "effect-derivatives")]
mod adaptive_epsilon;
#[cfg(feature = "effect-derivatives")]
mod counter_random;
mod derivatives;
#[cfg(feature = "effect-derivatives")]
mod differences;
#[cfg(feature = "effect-derivatives")]
mod exact;
#[cfg(feature = "effect-derivatives")]
mod maker;
#[cfg(feature = "effect-derivatives")]
mod moments;
#[cfg(feature = "effect-derivatives")]
mod moved_pair;
#[cfg(feature = "effect-derivatives")]
mod response;
#[cfg(feature = "effect-derivatives")]
mod runner_up;
#[cfg(feature = "effect-derivatives")]
mod side;
#[cfg(feature = "effect-derivatives")]
mod smooth_pair;
#[cfg(feature = "effect-derivatives")]
mod smoothed_hessian;
#[cfg(feature = "effect-derivatives")]
mod smoothed_places;
#[cfg(feature = "effect-derivatives")]
mod smoothed_supports;
#[cfg(feature = "effect-derivatives")]
mod softmax;

#[cfg(feature = "effect-derivatives")]
pub use adaptive_epsilon::EpsilonSchedule;
pub use derivatives::{
    DerivativeCost, DerivativeGoal, DerivativeMethod, Derivatives, MOST_SAMPLES, NoDerivatives, TwistMatrix,
};
#[cfg(feature = "effect-derivatives")]
pub use maker::derivatives;
