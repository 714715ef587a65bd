//! The convex polytope EPA grows: a closed surface of triangles around vertices of the Minkowski difference.
//!
//! Which faces a new vertex sees is decided by an exact predicate on the stored vertices; a face in whose plane it lies is
//! not seen. So the surface is the exact convex hull of its vertices at every step: closed, its horizon one loop, and no
//! new face is flat (the vertex is strictly beyond the seen face on each edge of the horizon, so it is not on the edge's
//! line). Rounding enters only in the normals and offsets, and there with a bound.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::minkowski::Vertex;
use super::simplex::{orientation, triangle};
use super::support::unit;
use crate::geometry::Vec3;
use crate::geometry::tolerance::UNIT_ROUNDOFF;

/// A triangle of the surface, counter-clockwise from outside.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    /// Indices of the corners.
    pub corners: [usize; 3],
    /// Face across the edge from corner i to corner i + 1.
    adjacent: [usize; 3],
    /// Outward unit normal, within rounding.
    pub normal: Vec3,
    /// No point of the triangle is nearer the origin plane across `normal` than this: proved, whatever the normal's
    /// error is. Negative when the origin is outside. Metres.
    pub offset: f64,
    alive: bool,
}

/// The surface, and its faces in order of their offset.
pub(super) struct Polytope {
    vertices: Vec<Vertex>,
    faces: Vec<Face>,
    queue: BinaryHeap<Queued>,
    /// While a horizon is covered: the new face on the edge that starts, and that ends, at a vertex.
    starting: Vec<usize>,
    ending: Vec<usize>,
}

#[derive(PartialEq)]
struct Queued {
    offset: f64,
    face: usize,
}

impl Eq for Queued {}

impl Ord for Queued {
    /// Least offset first; equals in the order they were made.
    fn cmp(&self, other: &Self) -> Ordering {
        other.offset.total_cmp(&self.offset).then(other.face.cmp(&self.face))
    }
}

impl PartialOrd for Queued {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// An edge between a face that is seen and one that is not, as the seen face runs along it.
struct HorizonEdge {
    from: usize,
    to: usize,
    beyond: usize,
}

impl Polytope {
    /// A tetrahedron; none when it is flat.
    pub fn tetrahedron([a, b, c, d]: [Vertex; 4]) -> Option<Self> {
        let volume = orientation(a.w, b.w, c.w, d.w);
        if volume == 0.0 {
            return None;
        }
        // d is below the face abc when the orientation is positive, as it should be.
        let vertices = if volume > 0.0 { vec![a, b, c, d] } else { vec![b, a, c, d] };
        let mut polytope = Self {
            vertices,
            faces: Vec::with_capacity(64),
            queue: BinaryHeap::with_capacity(64),
            starting: Vec::new(),
            ending: Vec::new(),
        };
        for (corners, adjacent) in
            [([0, 1, 2], [1, 3, 2]), ([0, 3, 1], [2, 3, 0]), ([0, 2, 3], [0, 3, 1]), ([1, 3, 2], [1, 2, 0])]
        {
            polytope.add_face(corners, adjacent);
        }
        Some(polytope)
    }

    /// Takes out of the queue and returns the face of least offset.
    pub fn nearest_face(&mut self) -> Option<usize> {
        while let Some(Queued { face, .. }) = self.queue.pop() {
            if self.faces[face].alive {
                return Some(face);
            }
        }
        None
    }

    /// The face of least offset among those at the newest vertex; they stay in the queue.
    pub fn nearest_newest_face(&self) -> Option<usize> {
        let apex = self.vertices.len() - 1;
        let at_apex = |f: &usize| self.faces[*f].alive && self.faces[*f].corners.contains(&apex);
        let newest = (0..self.faces.len()).rev().take_while(|f| self.faces[*f].corners.contains(&apex)).filter(at_apex);
        newest.min_by(|&f, &g| self.faces[f].offset.total_cmp(&self.faces[g].offset))
    }

    pub fn face(&self, face: usize) -> &Face {
        &self.faces[face]
    }

    /// The three vertices of a face.
    pub fn corners(&self, face: usize) -> [Vertex; 3] {
        self.faces[face].corners.map(|i| self.vertices[i])
    }

    /// Whether the vertex is strictly outside the plane of the face. Exact.
    pub fn is_outside(&self, face: usize, vertex: &Vertex) -> bool {
        self.side(face, vertex.w) < 0.0
    }

    /// Whether the origin is strictly inside. Exact.
    pub fn encloses_origin(&self) -> bool {
        (0..self.faces.len()).all(|f| !self.faces[f].alive || self.side(f, Vec3::zeros()) > 0.0)
    }

    /// A live face that the vertex is strictly outside of.
    pub fn visible_face(&self, vertex: &Vertex) -> Option<usize> {
        (0..self.faces.len()).find(|&f| self.faces[f].alive && self.is_outside(f, vertex))
    }

    /// Grows the surface to the hull of itself and `vertex`, which is strictly outside of `seen`.
    pub fn insert(&mut self, vertex: Vertex, seen: usize) {
        let mut horizon = Vec::with_capacity(16);
        let mut open = vec![seen];
        self.faces[seen].alive = false;
        while let Some(f) = open.pop() {
            let Face { corners, adjacent, .. } = self.faces[f];
            for i in 0..3 {
                let beyond = adjacent[i];
                if !self.faces[beyond].alive {
                    continue; // Seen already.
                }
                let (from, to) = (corners[i], corners[(i + 1) % 3]);
                if self.is_outside(beyond, &vertex) {
                    self.faces[beyond].alive = false;
                    open.push(beyond);
                } else {
                    horizon.push(HorizonEdge { from, to, beyond });
                }
            }
        }
        self.cover(&horizon, vertex);
    }

    /// Joins the horizon to the vertex by a fan of faces.
    fn cover(&mut self, horizon: &[HorizonEdge], vertex: Vertex) {
        let apex = self.vertices.len();
        self.vertices.push(vertex);
        let first = self.faces.len();
        // The horizon is one loop, so each of its vertices starts one edge and ends another.
        self.starting.resize(apex + 1, 0);
        self.ending.resize(apex + 1, 0);
        for (face, edge) in (first..).zip(horizon) {
            self.starting[edge.from] = face;
            self.ending[edge.to] = face;
        }
        for edge in horizon {
            let (next, previous) = (self.starting[edge.to], self.ending[edge.from]);
            let face = self.add_face([edge.from, edge.to, apex], [edge.beyond, next, previous]);
            let beyond = &mut self.faces[edge.beyond];
            let across = beyond.corners.iter().position(|&c| c == edge.to).expect("neighbours share the edge");
            beyond.adjacent[across] = face;
        }
    }

    fn add_face(&mut self, corners: [usize; 3], adjacent: [usize; 3]) -> usize {
        let [a, b, c] = corners.map(|i| self.vertices[i]);
        let normal = unit((b.w - a.w).cross(&(c.w - a.w)))
            // A needle whose cross product vanishes in f64: the direction of its nearest point will do.
            .or_else(|| unit(triangle(a, b, c).nearest().w))
            .unwrap_or_else(Vec3::x);
        let least = normal.dot(&a.w).min(normal.dot(&b.w)).min(normal.dot(&c.w));
        let size = a.w.norm_squared().max(b.w.norm_squared()).max(c.w.norm_squared()).sqrt();
        // Three products and two sums, and the length of the normal: at most 8 roundings of the size.
        let offset = least - 8.0 * UNIT_ROUNDOFF * size;
        let face = self.faces.len();
        self.faces.push(Face { corners, adjacent, normal, offset, alive: true });
        self.queue.push(Queued { offset, face });
        face
    }

    /// Positive inside, negative outside, zero on the plane of the face. Exact.
    fn side(&self, face: usize, point: Vec3) -> f64 {
        let [a, b, c] = self.corners(face);
        orientation(a.w, b.w, c.w, point)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vertex(x: f64, y: f64, z: f64) -> Vertex {
        let w = Vec3::new(x, y, z);
        Vertex { w, on_a: w, on_b: Vec3::zeros() }
    }

    /// Every edge has its opposite in the face across it, and no vertex is outside of any face.
    fn validate(p: &Polytope) {
        for (f, face) in p.faces.iter().enumerate().filter(|(_, face)| face.alive) {
            for i in 0..3 {
                let across = &p.faces[face.adjacent[i]];
                assert!(across.alive);
                let j = across.corners.iter().position(|&c| c == face.corners[(i + 1) % 3]).unwrap();
                assert_eq!(across.corners[(j + 1) % 3], face.corners[i]);
                assert_eq!(across.adjacent[j], f);
            }
            assert!(p.vertices.iter().all(|v| p.side(f, v.w) >= 0.0));
        }
    }

    #[test]
    fn points_of_a_lattice_grow_an_exact_hull_whatever_their_order() {
        for seed in 1u64..40 {
            let mut state = seed;
            let mut next = || {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                f64::from((state >> 33) as u32 % 4)
            };
            let start = [vertex(1.0, 1.0, 1.0), vertex(2.0, 1.0, 1.0), vertex(1.0, 2.0, 1.0), vertex(1.0, 1.0, 2.0)];
            let mut p = Polytope::tetrahedron(start).unwrap();
            validate(&p);
            for _ in 0..60 {
                let v = vertex(next(), next(), next());
                if let Some(face) = p.visible_face(&v) {
                    p.insert(v, face);
                    validate(&p);
                }
            }
            // Most of the 4 x 4 x 4 lattice came up.
            let volume = |[a, b, c]: [Vec3; 3]| a.dot(&b.cross(&c)) / 6.0;
            let alive = p.faces.iter().filter(|f| f.alive);
            let total: f64 = alive.map(|f| volume(f.corners.map(|c| p.vertices[c].w))).sum();
            assert!(total <= 27.0 + 1e-12 && total > 15.0, "{total}");
        }
    }
}
