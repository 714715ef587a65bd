//! What was given of a convex piece, before anything was rounded: what exact arithmetic starts from.

use crate::geometry::{Part, Placement, Shape};

/// The numbers behind a piece's rounded placement and radius.
#[derive(Clone, Copy)]
pub(super) struct Given<'a> {
    /// Where the whole shape is, in the frame of both.
    pub at: &'a Placement,
    /// The shape, of which the piece may be a part or a triangle.
    pub whole: &'a Shape,
    /// The part of the compound `whole` that the piece is.
    pub part: Option<&'a Part>,
}

impl<'a> Given<'a> {
    /// A shape that is not a compound.
    pub fn alone(shape: &'a Shape, at: &'a Placement) -> Self {
        Self { at, whole: shape, part: None }
    }

    /// The radii that are swept over the core: their sum, without rounding, is the piece's. Metres.
    pub fn radii(&self) -> [f64; 6] {
        let [a, b, c] = self.whole.swept_radius_unrounded();
        let [d, e, f] = self.part.map_or([0.0; 3], |part| part.shape.swept_radius_unrounded());
        [a, b, c, d, e, f]
    }
}
