//! What a query remembers of a pair for the next one, when bodies move in small steps.

use super::minkowski::Vertex;
use super::simplex::{Simplex, Step};
use crate::geometry::Vec3;
use crate::geometry::vector::ORIGIN;

/// The simplex and the direction that the last query of a pair ended with, kept by the caller between queries.
///
/// It only tells the search where to start, so any content is harmless: a cache of another pair costs time, not truth. The
/// bracket of a cached query is proved like any other and overlaps that of an uncached one; its last digits may differ,
/// because another way led there. What must be the same bytes is therefore asked without a cache.
#[derive(Clone, Copy, Debug)]
pub struct PairCache {
    /// Corners on A and B of the vertices of the simplex; four of them enclosed the origin.
    pub(super) corners: [[u32; 2]; 4],
    pub(super) len: usize,
    /// Unit vector from B to A in A's frame, or zero: nothing is known.
    pub(super) direction: Vec3,
}

impl PairCache {
    /// Nothing is remembered.
    #[must_use]
    pub fn new() -> Self {
        Self { corners: [[0; 2]; 4], len: 0, direction: ORIGIN }
    }

    /// Whether nothing is remembered of a simplex.
    #[inline]
    pub(super) fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Whether the cores were apart, or not known to meet, when a search last ended.
    #[inline]
    pub(super) fn was_apart(&self) -> bool {
        (1..4).contains(&self.len)
    }

    /// Notes where a search ended.
    #[inline]
    pub(super) fn note(&mut self, simplex: &Simplex, encloses: bool, direction: Vec3) {
        self.corners = simplex.corners();
        (self.len, self.direction) = (if encloses { 4 } else { simplex.len() }, direction);
    }
}

impl Default for PairCache {
    fn default() -> Self {
        Self::new()
    }
}

/// The simplex that some vertices reduce to, one after the other; and whether four of them enclose the origin.
pub(super) fn rebuilt(vertices: &[Vertex], extent: f64) -> Option<(Simplex, bool)> {
    let (first, rest) = vertices.split_first()?;
    let mut simplex = Simplex::point(*first);
    for vertex in rest {
        if simplex.add(vertex, extent) == Step::Enclosed {
            return Some((simplex, true));
        }
    }
    Some((simplex, false))
}
