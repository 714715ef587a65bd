//! How far apart two shapes are, as a proved bracket.
//!
//! [`separation`] is the door. Behind it, top down: `union`, `pieces` and `walk` take meshes and compounds apart, `convex` runs GJK and EPA on
//! a pair of cores, `unbounded` has the formula for half-spaces and planes. Below lie the Minkowski difference, its
//! simplices and polytope, and the support functions.

mod bracketing;
mod convex;
mod epa;
mod frank_wolfe;
mod gjk;
mod goal;
mod ladder;
mod minkowski;
mod momentum;
mod outcome;
mod pieces;
mod polytope;
mod qp;
mod sat;
mod sat_boxes;
mod sat_polytopes;
mod segments;
mod separation;
mod simplex;
mod small_polytope;
mod smooth;
mod solid;
mod solver;
mod support;
mod unbounded;
mod union;
mod walk;
mod witness;

pub use goal::{Accuracy, Depth, Goal};
pub use outcome::{Bracket, Cost, Separation, Termination};
pub use separation::{NoSeparation, separation};
pub use solver::{Solver, Unclaimed};
