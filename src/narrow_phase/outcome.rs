//! What is known about a pair when the work on it ends.

use std::ops::AddAssign;

use crate::geometry::Vec3;

/// A proved interval: the signed distance, in the truth, is in `lower..=upper`. Metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bracket {
    /// Apart: from a separating direction. In an overlap: minus a proved upper bound of the depth.
    pub lower: f64,
    /// Apart: from a pair of witness points. In an overlap: minus a proved lower bound of the depth.
    pub upper: f64,
}

impl Bracket {
    /// What is in both: they are about the same truth.
    #[must_use]
    pub(super) fn intersection(&self, other: &Self) -> Self {
        Self { lower: self.lower.max(other.lower), upper: self.upper.min(other.upper) }
    }

    /// Width, metres.
    #[must_use]
    pub fn width(&self) -> f64 {
        self.upper - self.lower
    }
}

/// How the work on a pair stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Termination {
    /// A formula gave the answer at once.
    ClosedForm,
    /// The bracket is as narrow as was asked.
    Converged,
    /// The bracket decided what was asked before it was narrow.
    Decided,
    /// The bracket is as narrow as the rounding of the numbers lets it be.
    RoundingFloor,
    /// The cap on iterations was reached; the bracket is valid, and wider than was asked.
    IterationLimit,
    /// The caller's time ran out; the bracket is valid, and wider than was asked.
    TimeLimit,
    /// Doubles could not decide, exact arithmetic did: the ends of the bracket are next to each other, or what was asked is
    /// decided.
    Exact,
}

/// What the work cost. Counters only, so that equal work has equal bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// Support points of a Minkowski difference (two shapes each).
    pub supports: u64,
    /// Rounds of GJK.
    pub gjk_iterations: u64,
    /// Rounds of EPA.
    pub epa_iterations: u64,
    /// Nodes of trees that were opened.
    pub nodes: u64,
    /// Pairs of convex shapes that the narrow phase looked at.
    pub pairs: u64,
    /// Pairs that doubles left open and a higher precision took over.
    pub escalations: u64,
    /// Corners that contact patches looked at.
    pub patch_corners: u64,
    /// Corners of contact patches that were held against an edge of a face, or against the cut-off.
    pub patch_cuts: u64,
    /// Separations that derivatives asked again, in moved places and of other pieces.
    pub derivative_separations: u64,
    /// Support points that derivatives asked one shape for.
    pub derivative_supports: u64,
    /// Corners that derivatives looked at.
    pub derivative_corners: u64,
}

impl AddAssign for Cost {
    fn add_assign(&mut self, other: Self) {
        self.supports += other.supports;
        self.gjk_iterations += other.gjk_iterations;
        self.epa_iterations += other.epa_iterations;
        self.nodes += other.nodes;
        self.pairs += other.pairs;
        self.escalations += other.escalations;
        self.patch_corners += other.patch_corners;
        self.patch_cuts += other.patch_cuts;
        self.derivative_separations += other.derivative_separations;
        self.derivative_supports += other.derivative_supports;
        self.derivative_corners += other.derivative_corners;
    }
}

/// What is known about one pair of shapes A and B.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Separation {
    /// The proof.
    pub bracket: Bracket,
    /// The best estimate inside the bracket, metres; negative: minus the depth.
    pub signed_distance: f64,
    /// Unit vector from A to B.
    pub normal: Vec3,
    /// Witness on A; `point_on_b - point_on_a = signed_distance * normal`. Metres, in the frame of both placements.
    pub point_on_a: Vec3,
    /// Witness on B.
    pub point_on_b: Vec3,
    /// How far at most either witness point is from its shape; and, apart, the vector from the one to the other from the true
    /// nearest vector. Metres. Of bodies of several pieces: of the two pieces that are named.
    pub point_error: f64,
    /// By how much at most the normal is turned from that of the true nearest vector; radians. Pi: nothing is known, as in an
    /// overlap, where the normal of the least depth may be another one. Of several pieces: as above.
    pub normal_error: f64,
    /// How the work stopped.
    pub termination: Termination,
    /// Which triangle of a mesh or part of a compound decided, on A; 0 for a single convex shape. A mesh within a
    /// compound: the part.
    pub subshape_a: u32,
    /// The same on B.
    pub subshape_b: u32,
    /// What it cost.
    pub cost: Cost,
}

impl Separation {
    /// The same with a bracket that is known to be narrower; the estimate goes along.
    #[must_use]
    pub(super) fn within(self, bracket: Bracket) -> Self {
        let signed_distance = self.signed_distance.clamp(bracket.lower, bracket.upper);
        let point_on_b = self.point_on_a + self.normal * signed_distance;
        let point_error = self.point_error + (signed_distance - self.signed_distance).abs();
        Self { bracket, signed_distance, point_on_b, point_error, ..self }
    }
}
