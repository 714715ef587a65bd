//! The truth about a pair of convex shapes, found without any of the library's code, as a bracket of its own.
//!
//! The signed distance is about the numbers as given: R(q/|q|) is exact in the definition, and so are differences of
//! positions. Three ways lead to it; `tests` holds them against one another and against the digits in `tests/data/hard.jsonl`.
//!
//! | oracle | for | how far it is trusted |
//! | --- | --- | --- |
//! | [`exhaustive`], in big integers | polytopes with few corners | fully: finite, exact, one root at the end |
//! | [`nearest_point`] | anything apart | its bracket holds if 2^-95 of the extent covers the rounding of double-doubles: derived in [`difference`] to first order, with a factor of seven to spare; not interval arithmetic |
//! | [`expanding_polytope`] | contact and overlap | as the line before. Its bracket stays open where a whole curve of directions is deepest (coaxial bodies of revolution), and is then only as good as it is narrow |
//!
//! A half-space against anything is one support value ([`truth`] itself).

pub mod body;
mod difference;
pub mod double_double;
pub mod exhaustive;
mod expanding_polytope;
mod nearest_point;
#[cfg(test)]
mod tests;
mod truth;
pub mod vector;

pub use body::{Body, Core};
pub use truth::{Truth, truth};
