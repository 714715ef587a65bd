//! The farthest vertex of a large hull by climbing along its edges.
//!
//! On a convex surface a vertex from which no edge leads higher is the highest. Rounded heights could hide an edge that
//! leads higher by less than their error, and behind it, many short edges on, a vertex that is higher by more. So the climb
//! does not stop there: from the vertex it ends at, it floods all vertices that are not clearly lower and takes the best
//! of them. In exact arithmetic the vertices above any height hang together, so the highest is among those flooded, and
//! the one returned is lower by two roundings of a product at most, as in a scan of all points.
//!
//! Sources: Dobkin and Kirkpatrick 1983 for the climb; Gino van den Bergen's SOLID for neighbour lists. Flooding is ours.

use arrayvec::ArrayVec;

use super::Vec3;
use super::hull_surface::HullSurface;
use super::tolerance::UNIT_ROUNDOFF;
use super::vector::{main_axis, sum_of_sizes};

/// Where to start: for each cell of a cube around the origin the highest vertex in the direction of its middle.
#[derive(Clone, Debug)]
pub(super) struct StartTable {
    /// Six sides of `CELLS` x `CELLS`.
    vertices: Vec<u32>,
}

/// Cells along an edge of the cube. The middle of a cell is within 9 degrees of any direction in it.
const CELLS: usize = 9;

/// Vertices that are flooded at most, before all points are looked at instead: faces with more corners are rare.
const FLOODED: usize = 32;

impl StartTable {
    /// Bytes on the heap.
    pub fn memory(&self) -> usize {
        size_of_val(&*self.vertices)
    }

    pub fn new(points: &[Vec3], surface: &HullSurface) -> Self {
        let mut vertices = Vec::with_capacity(6 * CELLS * CELLS);
        let mut vertex = 0;
        for side in 0..6 {
            for row in 0..CELLS {
                for column in 0..CELLS {
                    let middle = |cell: usize| (2 * cell + 1) as f64 / CELLS as f64 - 1.0;
                    let axis = side / 2;
                    let mut d = Vec3::zeros();
                    d[axis] = if side % 2 == 0 { 1.0 } else { -1.0 };
                    d[(axis + 1) % 3] = middle(column);
                    d[(axis + 2) % 3] = middle(row);
                    vertex = climb(points, surface, vertex, d).0;
                    vertices.push(vertex);
                }
            }
        }
        Self { vertices }
    }

    /// A vertex that is high along `d`; any, if `d` is zero or not finite.
    pub fn start(&self, d: Vec3) -> u32 {
        let axis = main_axis(d);
        let (u, v) = match axis {
            0 => (d.y, d.z),
            1 => (d.z, d.x),
            _ => (d.x, d.y),
        };
        let to_cell = 0.5 * CELLS as f64 / d[axis].abs();
        // The conversion saturates, and turns NaN into zero.
        let cell = |c: f64| ((c * to_cell + 0.5 * CELLS as f64) as usize).min(CELLS - 1);
        let side = 2 * axis + usize::from(d[axis] < 0.0);
        self.vertices[(side * CELLS + cell(v)) * CELLS + cell(u)]
    }
}

/// Height of a vertex.
#[inline(always)]
fn height(points: &[Vec3], vertex: u32, d: Vec3) -> f64 {
    let p = points[vertex as usize];
    p.x * d.x + p.y * d.y + p.z * d.z
}

/// From `start` up to a vertex without a higher neighbour: it, its height, and that of its highest neighbour.
#[inline]
fn climb(points: &[Vec3], surface: &HullSurface, start: u32, d: Vec3) -> (u32, f64, f64) {
    let (mut vertex, mut top) = (start, height(points, start, d));
    loop {
        let (mut next, mut best) = (vertex, f64::NEG_INFINITY);
        for &neighbour in surface.neighbours(vertex) {
            let h = height(points, neighbour, d);
            if h > best {
                (next, best) = (neighbour, h);
            }
        }
        // The negation also ends the climb along a direction that is not a number.
        if !(best > top) {
            return (vertex, top, best);
        }
        (vertex, top) = (next, best);
    }
}

/// The highest vertex along `d`, from a good start; none when more vertices than expected are as high.
/// `radius`: no vertex is farther from the origin, metres.
pub(super) fn highest(points: &[Vec3], surface: &HullSurface, radius: f64, start: u32, d: Vec3) -> Option<u32> {
    let (vertex, top, second) = climb(points, surface, start, d);
    // A height is off by 3 u |p| |d|, a difference of two by twice that.
    let unclear = top - 8.0 * UNIT_ROUNDOFF * radius * sum_of_sizes(d);
    if second < unclear {
        return Some(vertex);
    }
    flood(points, surface, vertex, unclear, d)
}

/// The first of the highest among the vertices that hang together with `vertex` above the height `unclear`.
#[cold]
fn flood(points: &[Vec3], surface: &HullSurface, vertex: u32, unclear: f64, d: Vec3) -> Option<u32> {
    let mut reached = ArrayVec::<u32, FLOODED>::from_iter([vertex]);
    let (mut best, mut top) = (vertex, height(points, vertex, d));
    let mut looked_at = 0;
    while let Some(&from) = reached.get(looked_at) {
        looked_at += 1;
        for &neighbour in surface.neighbours(from) {
            let h = height(points, neighbour, d);
            if h < unclear || reached.contains(&neighbour) {
                continue;
            }
            reached.try_push(neighbour).ok()?;
            if h > top || (h == top && neighbour < best) {
                (best, top) = (neighbour, h);
            }
        }
    }
    Some(best)
}
