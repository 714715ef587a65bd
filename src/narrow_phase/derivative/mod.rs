//! How do a pair's signed distance, normal and witness points change when its bodies move?
//!
//! [`derivatives`] is the door; `docs/derivations/derivatives.md` has the formulae and what is promised. `side` tells what of a shape bends how
//! near the witness, `response` solves for the change of the normal and the points, `polish` makes the normal of smooth pairs as exact as
//! rounding lets it be.

mod exact;
mod polish;
mod response;
mod side;

pub use exact::{DerivativeMethod, Derivatives, TwistMatrix, derivatives};
