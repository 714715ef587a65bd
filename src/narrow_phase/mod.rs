//! How far apart two shapes are, as a proved bracket.
//!
//! [`separation`] is the door. Behind it, top down: `union`, `pieces` and `walk` take meshes and compounds apart, `convex` runs GJK and EPA on
//! a pair of cores, `unbounded` has the formula for half-spaces and planes. Below lie the Minkowski difference, its
//! simplices and polytope, and the support functions.

mod bracketing;
mod convex;
mod epa;
mod gjk;
mod goal;
mod minkowski;
mod outcome;
mod pieces;
mod polytope;
mod separation;
mod simplex;
mod solid;
mod support;
mod unbounded;
mod union;
mod walk;

pub use goal::{Accuracy, Depth, Goal};
pub use outcome::{Bracket, Cost, Separation, Termination};
pub use separation::{UnboundedPair, separation};
