//! Many independent pairs, answered kind by kind.

use arrayvec::ArrayVec;

use super::goal::Goal;
use super::outcome::Separation;
use super::separation::{NoSeparation, separation};
use crate::geometry::{Core, Placement, Shape};

/// Two placed shapes, and what is asked of them: the arguments of [`separation`].
#[derive(Clone, Copy, Debug)]
pub struct PairQuestion<'a> {
    /// Side A.
    pub a: &'a Shape,
    /// Side B.
    pub b: &'a Shape,
    /// Where A is, metres.
    pub at_a: &'a Placement,
    /// Where B is in the same frame, metres.
    pub at_b: &'a Placement,
    /// How far the work on this pair goes.
    pub goal: Goal<'a>,
}

/// Pairs that are put in the order of their kinds at a time: as many as a byte can number. The order of a whole large batch would
/// leap through memory.
const WINDOW: usize = 256;

/// Calls `answer` once for every pair, with its index and its [`separation`]: the same bytes as if it were asked alone.
///
/// The calls come in the order of the work: 256 pairs at a time, kind by kind, pairs of equal kinds in the order of
/// `pairs`, so that one kind's code runs many times in a row. On the machine that was measured this saves next to nothing, and
/// costs time where pairs lie in memory in their order: `docs/queries.md` has the figures. Where the answer of one pair says
/// how much has to be known of the next, ask one by one.
///
/// # Errors
/// Each pair has its own, given to `answer`; they leave the others alone.
pub fn separations(pairs: &[PairQuestion], mut answer: impl FnMut(usize, Result<Separation, NoSeparation>)) {
    for (window, first) in pairs.chunks(WINDOW).zip((0..).step_by(WINDOW)) {
        // Kinds in the high byte, the place in the window in the low one: one comparison of integers for both.
        let mut order: ArrayVec<u16, WINDOW> =
            (0..).zip(window).map(|(place, pair)| kinds(pair) << 8 | place).collect();
        order.sort_unstable();
        for place in order.into_iter().map(|both| usize::from(both & 0xff)) {
            let PairQuestion { a, b, at_a, at_b, goal } = &window[place];
            answer(first + place, separation(a, b, at_a, at_b, goal));
        }
    }
}

/// Equal for pairs of equal kinds only; below 256.
fn kinds(pair: &PairQuestion) -> u16 {
    kind(pair.a) << 4 | kind(pair.b)
}

/// What tells the kinds of cores apart, below 16; a swept radius changes little of the work.
fn kind(shape: &Shape) -> u16 {
    match shape.core() {
        Core::Point => 0,
        Core::Segment(_) => 1,
        Core::AxialSegment { .. } => 2,
        Core::Cuboid { .. } | Core::Block(_) => 3,
        Core::Triangle(_) => 4,
        Core::Convex(_) | Core::Column(_) => 5,
        Core::Cylinder { .. } => 6,
        Core::Cone { .. } => 7,
        Core::Ellipsoid { .. } => 8,
        Core::HalfSpace { .. } => 9,
        Core::Plane { .. } => 10,
        Core::Mesh(_) => 11,
        Core::Compound(_) => 12,
        Core::HeightField(_) => 13,
        Core::PointCloud(_) => 14,
        Core::Voxels(_) => 15,
    }
}
