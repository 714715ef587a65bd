//! What is asked of derivatives, and what they are.

use std::ops::AddAssign;

use nalgebra::SMatrix;

use super::super::patch::NoPatch;
use super::super::separation::NoSeparation;

/// A change per twist of a body: three rows of a vector. Columns: velocity of the body along x, y, z (metres), then its turn about x, y, z
/// (radians), about its own origin, in the axes of both placements.
pub type TwistMatrix = SMatrix<f64, 3, 6>;

/// How derivatives are made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum DerivativeMethod {
    /// By formula. Of two smooth, strictly convex shapes (spheres, ellipsoids, both grown by a radius) they hold in a neighbourhood, through
    /// contact into a shallow overlap, after the normal is made as exact as rounding lets it be. Of others it is [`Self::ExactCell`], and the
    /// answer says so.
    #[default]
    Exact,
    /// By formula, from the features that face each other (corners, edges, faces, rims, smooth patches). They hold as long as the same
    /// features do, and say nothing of others.
    ExactCell,
    /// Central differences of separations in 24 moved places. The step follows from how exact the separations are.
    FiniteDifference,
    /// Randomised smoothing of order zero: both bodies are moved at random, `samples` times there and back; what the separations say then is
    /// correlated with how they were moved. Derivatives of the mean over moves of this size.
    Smoothed0,
    /// Of order one, by the implicit function theorem with a smoothed Hessian of the support functions: its mean over directions turned at
    /// random, `samples` times there and back.
    Smoothed1Gaussian,
    /// The same with Gumbel noise on the heights of corners, in closed form: corners weigh as much as a softmax of their heights says. Sides
    /// without corners: their own Hessian if they are strictly convex, else as [`Self::Smoothed1Gaussian`].
    Smoothed1Gumbel,
}

/// What is asked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DerivativeGoal {
    /// How they are made.
    pub method: DerivativeMethod,
    /// How far smoothing reaches, as a part of the size of what is smoothed: order zero moves bodies by so much of the smaller one's radius, and
    /// turns them by as many radians; Gaussian noise turns directions by so many radians; Gumbel noise on heights is so much of the radius of
    /// each piece's core. A radius is half the longest side of the box in the shape's own frame. Finite, not negative; zero: chosen from the pair. The answer has what was used.
    pub epsilon: f64,
    /// Pairs of samples (there and back) of random methods, at least one.
    pub samples: u32,
    /// Seed of random methods: equal seeds give equal bytes.
    pub seed: u64,
    /// Which of many pairs this is: pairs of one seed and different numbers have independent samples.
    pub stream: u64,
}

impl Default for DerivativeGoal {
    fn default() -> Self {
        Self { method: DerivativeMethod::Exact, epsilon: 0.0, samples: 64, seed: 0, stream: 0 }
    }
}

/// Pairs of samples at most: the standard error falls with their square root, and more are as many questions as a batch has.
pub const MOST_SAMPLES: u32 = 1 << 16;

impl DerivativeGoal {
    /// Whether what the method uses makes sense: no samples are no matter to a formula.
    ///
    /// # Errors
    /// [`NoDerivatives::Goal`], naming the field.
    pub fn check(&self) -> Result<(), NoDerivatives> {
        match self.method {
            DerivativeMethod::Exact | DerivativeMethod::ExactCell | DerivativeMethod::FiniteDifference => return Ok(()),
            DerivativeMethod::Smoothed0 | DerivativeMethod::Smoothed1Gaussian | DerivativeMethod::Smoothed1Gumbel => {}
        }
        if !(self.epsilon.is_finite() && self.epsilon >= 0.0) {
            return Err(NoDerivatives::Goal { field: "epsilon", reason: "is not a finite number from zero up" });
        }
        if !(1..=MOST_SAMPLES).contains(&self.samples) {
            return Err(NoDerivatives::Goal { field: "samples", reason: "is not from 1 to 65536" });
        }
        Ok(())
    }
}

/// What derivatives cost. Counters only, as in [`Cost`](crate::narrow_phase::Cost).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DerivativeCost {
    /// Separations that were asked again: of both shapes in moved places, and of other pieces that may be as near.
    pub separations: u64,
    /// Support points of one shape.
    pub supports: u64,
    /// Corners that a face was looked for among, or that a softmax weighed.
    pub corners: u64,
}

impl AddAssign for DerivativeCost {
    fn add_assign(&mut self, other: Self) {
        self.separations += other.separations;
        self.supports += other.supports;
        self.corners += other.corners;
    }
}

/// How a pair changes when its bodies move: of each array the first is for moves of A, the second for those of B.
#[derive(Clone, Debug, PartialEq)]
pub struct Derivatives {
    /// Of the signed distance; metres per metre and per radian.
    pub signed_distance: [[f64; 6]; 2],
    /// Of the unit normal; per metre and per radian.
    pub normal: [TwistMatrix; 2],
    /// Of the witness on A: of the place in space, not of a point that is held fast in the body.
    pub point_on_a: [TwistMatrix; 2],
    /// Of the witness on B.
    pub point_on_b: [TwistMatrix; 2],
    /// How they were made: where [`DerivativeMethod::Exact`] was asked and a side is not smooth, [`DerivativeMethod::ExactCell`].
    pub method: DerivativeMethod,
    /// How well the pair is conditioned: the least eigenvalue of distance plus radii of curvature across the normal, metres, by which a change
    /// of the normal is divided. Infinite where a face or two edges hold the normal. Not positive: in an overlap so deep that the
    /// least depth is along another normal. Not known (NaN) of differences and of order zero.
    pub conditioning: f64,
    /// What is wrong at most with the derivatives' own equation, metres: exact methods: how far the vector between the witnesses is off the normal, of
    /// smooth pairs after Newton's method; by conditioning that is the error of the normal. Differences: the step's square plus the error of a
    /// separation by the step, both as parts of the size (without unit). Order zero: the largest standard error of an entry. Order one: the same of
    /// the smoothed Hessians, or how far they are off at most because of corners that were left out, metres; by conditioning it is the
    /// relative error of a change of the normal. Infinite: one pair of samples does not tell.
    pub residual: f64,
    /// What was used; zero where nothing is smoothed. Of differences: the step, as a part of the smaller piece's size (half the longest side of
    /// its box), and radians; fewer of them about an origin that is farther from the witness than that.
    pub epsilon: f64,
    /// Pairs of samples that were used; zero where nothing is random.
    pub samples: u32,
    /// The seed that was used; zero where nothing is random.
    pub seed: u64,
    /// Whether they are what they are said to be: false where there is no one witness point, or where the conditioning is not positive.
    pub is_valid: bool,
    /// Whether the witness is where several features meet, so that a move may lead to another one. Only exact methods and differences tell.
    pub on_border: bool,
    /// Whether another pair of pieces may be as near, with witness points of its own: a move may make it the deciding one.
    pub is_contested: bool,
    /// What they cost.
    pub cost: DerivativeCost,
}

/// Why a pair has no derivatives.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoDerivatives {
    /// As with contact patches: two walls, or no one convex piece.
    #[error("no derivatives: {0}")]
    Piece(#[from] NoPatch),
    /// A number of the goal makes no sense.
    #[error("no derivatives: {field} {reason}")]
    Goal {
        /// Its name.
        field: &'static str,
        /// What is wrong with it.
        reason: &'static str,
    },
    /// In moved places the pair cannot be asked: the solver that is to do it does not take the shapes.
    #[error("no derivatives: {0}")]
    Separation(#[from] NoSeparation),
    /// The caller's time ran out.
    #[error("no derivatives: the caller's time ran out")]
    Stopped,
}
