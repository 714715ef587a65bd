//! The Minkowski difference C = A - B of two cores: the set GJK and EPA walk on.
//!
//! A and B meet where C holds the origin, and the signed distance of A and B is that of the origin to C. Everything
//! is in A's frame, so that nothing depends on where the pair is in the world.

use arrayvec::ArrayVec;

use crate::geometry::tolerance::{PROVED, SUPPORT_ERROR_ULPS, UNIT_ROUNDOFF};
use crate::geometry::vector::{ORIGIN, is_same, opposite};
use crate::geometry::{Core, Placement, Vec3};

use super::pair_cache::PairCache;
use super::support::{NO_HINT, center, corner, farthest};

/// A vertex of the difference with the point of A it came from. Metres, frame of A.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Vertex {
    /// A point of A less one of B.
    pub w: Vec3,
    /// The point of A.
    pub on_a: Vec3,
    /// Which of the corners of A and of B, where they have corners.
    pub corners: [u32; 2],
}

/// The difference of two convex, bounded cores.
pub(super) struct Difference<'a> {
    pub a: &'a Core,
    pub b: &'a Core,
    pub b_in_a: &'a Placement,
    /// No vertex is farther than this from the origin, metres.
    pub extent: f64,
    /// E = 112 u S, S the extent, plus what the placement of the cores is off by: a vertex is within this distance of a
    /// point of the true difference, and the least value of `d . c` over the true difference is within this of the value
    /// at the vertex found, for a unit d. Metres. Derived in `docs/derivations/bracket.md`.
    pub error: f64,
    /// The corners found last, and the direction, where a search along edges may start.
    hints: [u32; 2],
    last: Vec3,
    last_square: f64,
    /// Where the last query of the pair ended, and then where this one did.
    pub memory: &'a mut PairCache,
}

impl<'a> Difference<'a> {
    /// `extent`: S, no less than the sum of both cores' radii and the distance of their origins, metres.
    /// `placement_error`: how far a point of B may be from its stored place in A's frame by roundings before, metres.
    #[inline]
    pub fn new(
        a: &'a Core,
        b: &'a Core,
        b_in_a: &'a Placement,
        extent: f64,
        placement_error: f64,
        memory: &'a mut PairCache,
    ) -> Self {
        let error = if PROVED { SUPPORT_ERROR_ULPS * UNIT_ROUNDOFF * extent + placement_error } else { 0.0 };
        Self { a, b, b_in_a, extent, error, hints: [NO_HINT; 2], last: ORIGIN, last_square: 0.0, memory }
    }

    /// The vertex where `direction . c` is least, for a direction of any length whose square is a normal number.
    #[inline(always)]
    pub fn lowest(&mut self, direction: Vec3) -> Vertex {
        // Far from the last direction, by more than some 26 degrees, a fresh start is nearer than the last corner.
        let (cosine, square) = (direction.dot(&self.last), direction.norm_squared());
        let is_near = cosine > 0.0 && cosine * cosine > 0.81 * square * self.last_square;
        let [hint_a, hint_b] = if is_near { self.hints } else { [NO_HINT; 2] };
        let (on_a, corner_a) = farthest(self.a, opposite(direction), hint_a);
        let (on_b, corner_b) = farthest(self.b, self.b_in_a.direction_into(direction), hint_b);
        (self.hints, self.last, self.last_square) = ([corner_a, corner_b], direction, square);
        Vertex { w: on_a - self.b_in_a.point(on_b), on_a, corners: [corner_a, corner_b] }
    }

    /// The vertices that are remembered, where the cores have corners.
    pub fn remembered(&self) -> ArrayVec<Vertex, 4> {
        let vertex = |&[of_a, of_b]: &[u32; 2]| {
            let (on_a, on_b) = (corner(self.a, of_a)?, corner(self.b, of_b)?);
            Some(Vertex { w: on_a - self.b_in_a.point(on_b), on_a, corners: [of_a, of_b] })
        };
        self.memory.corners[..self.memory.len].iter().map_while(vertex).collect()
    }

    /// The direction that is remembered, if any, else the first guess.
    #[inline]
    pub fn start(&self) -> Vec3 {
        if is_same(self.memory.direction, ORIGIN) { self.centers() } else { self.memory.direction }
    }

    /// A first guess of the direction from the origin to the difference: between the centres of the bounds.
    pub fn centers(&self) -> Vec3 {
        center(self.a) - self.b_in_a.point(center(self.b))
    }
}
