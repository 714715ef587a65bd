//! How far apart two shapes are, as a proved bracket.
//!
//! [`separation`] is the door. Behind it, top down: `union` and `pieces` take compounds apart, `walk` goes down the `trees` of
//! meshes, clouds and terrain (`course`, `box_gaps`, `leaves`, `triangles`; `wall` for half-spaces and planes), `solid` and `inside` see to what is within a
//! closed mesh, `convex` takes a pair of cores, `unbounded` has the formula for half-spaces and planes.
//!
//! For a pair of cores `ladder` chooses the solver: a closed form (`segments`), `gjk` with or without `momentum` and then `epa`,
//! separating axes (`sat`), Newton's method (`smooth`), or one for comparison (`frank_wolfe`, `qp`); `line_of_centers` and
//! `far_apart` answer some verdicts before. What doubles leave open `escalation` hands to `revolution`, `double_double` and
//! `exact`. Below lie the Minkowski difference, its simplices and polytope, and the support functions. [`touching_pairs`] is a
//! second door, for all touching triangles; [`separations`] is the first one for many pairs at once, and [`fit`] asks how well
//! a decomposition fits its mesh.
//!
//! `impact` is the door for bodies that move: `approach` says where both are at a time, `element` what their convex parts are,
//! `forecast` for how long a plane parts two of them, and `advancement` goes on from time to time until they touch.
//! [`cast_ray`] is the one for rays: `ray_forms` has formulas with their proofs, `ray_trees` goes down the tree of a mesh.
//! [`contact_patch`] tells where the faces of a pair touch, given its separation: `patch` has it all.

mod advancement;
mod approach;
mod batch;
mod box_gaps;
mod bracketing;
mod convex;
mod course;
mod derivative;
mod double_double;
mod element;
mod epa;
mod escalation;
mod exact;
mod far_apart;
mod fit;
mod forecast;
mod frank_wolfe;
mod given;
mod gjk;
mod goal;
mod impact;
#[cfg(feature = "effect-motion")]
mod impact_search;
mod inside;
mod ladder;
mod least;
mod leaves;
mod line_of_centers;
mod minkowski;
mod momentum;
mod outcome;
mod pair_cache;
mod patch;
mod pieces;
mod polytope;
mod qp;
mod ray;
mod ray_forms;
mod ray_trees;
mod revolution;
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
mod touching;
mod trees;
mod triangles;
mod unbounded;
mod union;
mod walk;
mod wall;
mod witness;

pub use batch::{PairQuestion, separations};
pub use derivative::{
    DerivativeCost, DerivativeGoal, DerivativeMethod, Derivatives, MOST_SAMPLES, NoDerivatives, TwistMatrix,
};
#[cfg(feature = "effect-derivatives")]
pub use derivative::{EpsilonSchedule, derivatives};
pub use fit::{Fit, FitGoal, fit};
pub use goal::{Accuracy, Depth, Goal};
pub use impact::{Impact, ImpactGoal, NoImpact, Outcome, Place};
#[cfg(feature = "effect-motion")]
pub use impact_search::impact;
pub use outcome::{Bracket, Cost, Separation, Termination};
pub use pair_cache::PairCache;
#[cfg(feature = "effect-patch")]
pub use patch::contact_patch;
pub use patch::{ContactPatch, ContactPoint, MOST_POINTS, NoPatch, PatchCost, PatchGoal};
pub use ray::{RayGoal, RayImpact, cast_ray};
pub use separation::{NoSeparation, separation, separation_again};
pub use solver::{Solver, Unclaimed};
pub use touching::{NoTriangles, Touching, TouchingPair, Within, touching_pairs};
