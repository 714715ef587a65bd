//! What is asked of a contact patch, and what it is.

use std::ops::AddAssign;

use arrayvec::ArrayVec;

use crate::geometry::Vec3;
use crate::geometry::tolerance::PATCH_TILT;

/// Points that a patch has at most. Two round faces make no more; only hulls with faces of more corners than that are cut short.
pub const MOST_POINTS: usize = 32;

/// What is asked of a patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchGoal {
    /// A face, an edge or a corner faces the other shape when it is farthest in a direction that is turned by no more than this from the
    /// normal; radians, up to 0.5. Directions within the plane that differ by less are one, too. Zero: only what rounding cannot
    /// tell from the normal. Default: [`PATCH_TILT`].
    pub tilt: f64,
    /// Where the shapes are farther apart along the normal than this, the patch ends; metres. Zero: where they overlap. Default: infinite.
    pub cut_off: f64,
    /// Points at most, at least one: the deepest, then those that span the largest area. Default: [`MOST_POINTS`].
    pub most: usize,
}

impl Default for PatchGoal {
    fn default() -> Self {
        Self { tilt: PATCH_TILT, cut_off: f64::INFINITY, most: MOST_POINTS }
    }
}

/// A point of a patch. Metres, in the frame of both placements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint {
    /// On A's face.
    pub point_on_a: Vec3,
    /// On B's face: `point_on_b - point_on_a = signed_distance * normal`.
    pub point_on_b: Vec3,
    /// How far the faces are apart here, along the normal; negative: how far they overlap.
    pub signed_distance: f64,
}

impl ContactPoint {
    /// Half way between the two faces.
    #[must_use]
    pub fn middle(&self) -> Vec3 {
        (self.point_on_a + self.point_on_b) * 0.5
    }
}

/// What a patch cost. Counters only, as in [`Cost`](crate::narrow_phase::Cost).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PatchCost {
    /// Corners of the two shapes that were looked at.
    pub corners: u64,
    /// Corners of the patch that were held against an edge of a face, or against the cut-off.
    pub cuts: u64,
}

impl AddAssign for PatchCost {
    fn add_assign(&mut self, other: Self) {
        self.corners += other.corners;
        self.cuts += other.cuts;
    }
}

/// Where two shapes touch, or are nearest: what of their facing sides lies above one another along the normal.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactPatch {
    /// Unit vector from A to B: that of the separation.
    pub normal: Vec3,
    /// Whether the patch has fewer corners than it should: because of `most`, or because a face has more corners than there is room for.
    pub truncated: bool,
    /// What it cost.
    pub cost: PatchCost,
    pub(super) points: ArrayVec<ContactPoint, MOST_POINTS>,
    pub(super) corners: usize,
}

impl ContactPatch {
    /// A patch as somebody else found it: its points, the first `corners` of them those of its polygon. What it cost is not told.
    /// None for more points than there are at most, or more corners than points.
    #[must_use]
    pub fn told(normal: Vec3, points: &[ContactPoint], corners: usize, truncated: bool) -> Option<Self> {
        let points =
            ArrayVec::try_from(points).ok().filter(|points: &ArrayVec<_, MOST_POINTS>| corners <= points.len())?;
        Some(Self { normal, truncated, cost: PatchCost::default(), points, corners })
    }

    /// No point at all: the shapes are proved farther apart than the cut-off.
    #[cfg(feature = "effect-patch")]
    pub(super) fn empty(normal: Vec3) -> Self {
        Self { normal, truncated: false, cost: PatchCost::default(), points: ArrayVec::new(), corners: 0 }
    }

    /// All points: the corners of [`Self::polygon`], and after them the witness, where it is deeper than every corner (and its
    /// `point_error` says that it is on both shapes). Empty only for a pair that is proved farther apart than the cut-off.
    #[must_use]
    pub fn points(&self) -> &[ContactPoint] {
        &self.points
    }

    /// The corners of a convex polygon, counter-clockwise as seen from the tip of the normal, the deepest first; two: the ends of a line.
    #[must_use]
    pub fn polygon(&self) -> &[ContactPoint] {
        &self.points[..self.corners]
    }

    /// Area of the polygon across the normal, square metres.
    #[must_use]
    pub fn area(&self) -> f64 {
        let [first, rest @ ..] = self.polygon() else { return 0.0 };
        let from_first = |p: &ContactPoint| p.point_on_a - first.point_on_a;
        let triangle = |pair: &[ContactPoint]| from_first(&pair[0]).cross(&from_first(&pair[1])).dot(&self.normal);
        rest.windows(2).map(triangle).sum::<f64>() * 0.5
    }
}

/// Why a pair has no patch.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoPatch {
    /// Two shapes without bounds.
    #[error("a {a} and a {b} are both unbounded, so they have no contact patch")]
    Unbounded {
        /// Kind of the first shape.
        a: &'static str,
        /// Kind of the second.
        b: &'static str,
    },
    /// The separation does not tell which convex piece touches: of a mesh within a compound, or of another shape than this.
    #[error("piece {subshape} of a {kind} is not one convex piece, so it has no contact patch")]
    NotOnePiece {
        /// Kind of the shape.
        kind: &'static str,
        /// The number in the separation.
        subshape: u32,
    },
}
