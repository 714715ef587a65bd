//! When do two moving shapes first come within a margin of one another? What is asked and answered; `impact_search` finds it.

use super::outcome::{Cost, Termination};
use crate::geometry::{InvalidShape, Vec3};

/// What is asked of two moving shapes.
#[derive(Clone, Copy)]
pub struct ImpactGoal<'a> {
    /// They meet when they are as near as this; metres, not negative. Zero: when they touch.
    pub margin: f64,
    /// Times nearer than this to one another need not be told apart; a part of the motion, not negative.
    pub resolution: f64,
    /// Nothing needs to be known of what comes later than this; a part of the motion.
    pub until: f64,
    /// Asked between rounds; true ends the work.
    pub stop: &'a dyn Fn() -> bool,
}

impl std::fmt::Debug for ImpactGoal<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ImpactGoal")
            .field("margin", &self.margin)
            .field("resolution", &self.resolution)
            .field("until", &self.until)
            .finish_non_exhaustive()
    }
}

impl ImpactGoal<'_> {
    /// The first touch of the whole motion, to a billionth of it, without a limit on time.
    #[must_use]
    pub fn touch() -> Self {
        Self { margin: 0.0, resolution: 1e-9, until: 1.0, stop: &|| false }
    }
}

/// Why there is no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoImpact {
    /// Two shapes without bounds.
    #[error("a {a} and a {b} are both unbounded, so they have no time of impact")]
    Unbounded {
        /// Kind of the first shape.
        a: &'static str,
        /// Kind of the second.
        b: &'static str,
    },
    /// The margin makes the shape too large.
    #[error(transparent)]
    Margin(#[from] InvalidShape),
}

/// What became of a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Proved to stay farther apart than the margin, for the whole motion (or until the time asked).
    Clear,
    /// Proved to come within the margin.
    Hit,
    /// Neither was proved.
    Undecided,
}

/// Where two shapes meet, or are about to, in the frame of the motions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// On A, metres.
    pub point_on_a: Vec3,
    /// On B, metres.
    pub point_on_b: Vec3,
    /// Unit vector from A to B.
    pub normal: Vec3,
    /// How far at most either point is from its shape at `free_until`, metres.
    pub point_error: f64,
    /// Signed distance at `free_until`, metres: best estimate.
    pub signed_distance: f64,
}

/// When two moving shapes meet. Times are parts of the motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Impact {
    /// What was proved.
    pub outcome: Outcome,
    /// Proved apart, by more than the margin, in `0..free_until`; 1 for [`Outcome::Clear`].
    pub free_until: f64,
    /// Proved within the margin at this time; none unless [`Outcome::Hit`].
    pub touching_at: Option<f64>,
    /// Of [`Outcome::Undecided`]: apart again from this time on as far as is known, or 1.
    pub open_until: Option<f64>,
    /// They are within the margin from the beginning.
    pub starts_touching: bool,
    /// Where, at `free_until`; none for [`Outcome::Clear`].
    pub place: Option<Place>,
    /// Triangle of a mesh or part of a compound on A; 0 for a single convex shape.
    pub subshape_a: u32,
    /// The same on B.
    pub subshape_b: u32,
    /// How the work stopped.
    pub termination: Termination,
    /// What it cost.
    pub cost: Cost,
}
