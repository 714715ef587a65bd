//! How do pairs change when their bodies move? For who wants it, of pairs that are told and have a witness, once the search for them is over.

use super::answer::{PairAnswer, PairDerivatives};
use super::request::{Context, Wants};
use super::stage::Stage;
use crate::narrow_phase::Cost;

/// Makes the derivatives of a pair. None where it has no witness, where the pair names no two convex pieces, and where the time is over.
///
/// Called by its address, so that what is around the call is compiled alike whether there is such code or not.
pub(super) type DerivativesOf =
    fn(&PairAnswer, &Stage, &Context, &dyn Fn() -> bool, &mut Cost) -> Option<Box<PairDerivatives>>;

/// What makes derivatives, where they are wanted. None in a build without the code: it refuses a context that wants derivatives.
pub(super) fn derivatives_of(wants: Wants) -> Option<DerivativesOf> {
    if wants.derivatives { MAKER } else { None }
}

#[cfg(not(feature = "effect-derivatives"))]
const MAKER: Option<DerivativesOf> = None;

#[cfg(feature = "effect-derivatives")]
const MAKER: Option<DerivativesOf> = Some(super::pair_derivatives::of_pair);
