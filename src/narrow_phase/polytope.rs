//! The convex polytope EPA grows: a closed surface of triangles around vertices of the Minkowski difference.
//!
//! Which faces a new vertex sees is decided by an exact predicate on the stored vertices; a face in whose plane it lies is
//! not seen. So the surface is the exact convex hull of its vertices at every step: closed, its horizon one loop, and no
//! new face is flat (the vertex is strictly beyond the seen face on each edge of the horizon, so it is not on the edge's
//! line). Rounding enters only in the normals and offsets, and there with a bound.
//!
//! Everything lives on the stack, in lists of fixed capacity.

use arrayvec::ArrayVec;

use super::minkowski::Vertex;
use super::simplex::orientation;
use super::support::with_length;
use crate::geometry::Vec3;
use crate::geometry::tolerance::UNIT_ROUNDOFF;
use crate::geometry::vector::ORIGIN;

/// Vertices at most.
const VERTICES: usize = 520;

/// Faces at most: a closed surface of triangles has 2 V - 4.
const FACES: usize = 2 * VERTICES;

/// Offsets that are compared side by side.
const LANES: usize = 8;

/// The index after each of three, round and round.
const NEXT: [usize; 3] = [1, 2, 0];

/// A triangle of the surface, counter-clockwise from outside.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    /// Indices of the corners.
    corners: [u16; 3],
    /// Face across the edge from corner i to corner i + 1.
    adjacent: [u16; 3],
    /// Outward, perpendicular to the face within rounding, and its length.
    pub outward: Vec3,
    pub length: f64,
    /// No point of the triangle is nearer the origin plane across `outward` than this: proved, whatever that direction's
    /// error is. Negative when the origin is outside. Metres.
    pub offset: f64,
    /// Product of two edges: perpendicular to the face, outward.
    product: Vec3,
    /// Whether the origin is strictly on the inner side.
    holds_origin: bool,
    alive: bool,
}

/// The surface.
pub(super) struct Polytope {
    vertices: ArrayVec<Vertex, VERTICES>,
    faces: ArrayVec<Face, FACES>,
    /// Offset of each face that may still be pushed out; infinite for the others.
    queue: ArrayVec<f64, FACES>,
    /// Slots of faces that are gone.
    free: ArrayVec<u16, FACES>,
    /// The faces at the newest vertex.
    fan: ArrayVec<u16, FACES>,
    /// Live faces that the origin is not strictly inside of.
    not_holding: usize,
    /// The rounded side of a point is right beyond this.
    doubt: f64,
    /// Rounding of an offset, metres.
    slack: f64,
}

/// An edge between a face that is seen and one that is not, as the seen face runs along it.
#[derive(Clone, Copy)]
struct HorizonEdge {
    from: u16,
    to: u16,
    beyond: u16,
    /// Which edge of `beyond` it is.
    edge: u8,
}

impl Polytope {
    /// Nothing yet. `extent`: no vertex will be farther from the origin, metres.
    #[inline(always)]
    pub fn new(extent: f64) -> Self {
        // The side of a point is a product of three differences of up to 2 S; each of its 6 terms takes part in 10 roundings.
        let doubt = 512.0 * UNIT_ROUNDOFF * extent * extent * extent;
        Self {
            vertices: ArrayVec::new(),
            faces: ArrayVec::new(),
            queue: ArrayVec::new(),
            free: ArrayVec::new(),
            fan: ArrayVec::new(),
            not_holding: 0,
            doubt,
            // Three products and two sums, and the length of the normal: at most 8 roundings of the size.
            slack: 8.0 * UNIT_ROUNDOFF * extent,
        }
    }

    /// Becomes a tetrahedron; false when that is flat.
    pub fn start(&mut self, [a, b, c, d]: [Vertex; 4]) -> bool {
        let volume = orientation(a.w, b.w, c.w, d.w);
        if volume == 0.0 {
            return false;
        }
        // d is below the face abc when the orientation is positive, as it should be.
        self.vertices.extend(if volume > 0.0 { [a, b, c, d] } else { [b, a, c, d] });
        for (corners, adjacent) in
            [([0, 1, 2], [1, 3, 2]), ([0, 3, 1], [2, 3, 0]), ([0, 2, 3], [0, 3, 1]), ([1, 3, 2], [1, 2, 0])]
        {
            self.add_face(corners, adjacent);
        }
        true
    }

    /// Takes out of the queue and returns the face of least offset.
    pub fn nearest_face(&mut self) -> Option<usize> {
        // Lane by lane, so that no minimum waits for the one before.
        let (blocks, rest) = self.queue.as_chunks::<LANES>();
        let mut of_lanes = [f64::INFINITY; LANES];
        let lesser = |a: f64, b: f64| if b < a { b } else { a };
        for block in blocks {
            for lane in 0..LANES {
                of_lanes[lane] = lesser(of_lanes[lane], block[lane]);
            }
        }
        let least = of_lanes.into_iter().chain(rest.iter().copied()).fold(f64::INFINITY, lesser);
        if least == f64::INFINITY {
            return None;
        }
        let in_blocks =
            blocks.iter().position(|block| block.iter().fold(false, |found, &offset| found | (offset == least)));
        let from = in_blocks.unwrap_or(blocks.len()) * LANES;
        let face = from + self.queue[from..].iter().position(|&offset| offset == least)?;
        self.queue[face] = f64::INFINITY;
        Some(face)
    }

    /// The face of least offset among those at the newest vertex; they stay in the queue.
    pub fn nearest_newest_face(&self) -> Option<usize> {
        let offset = |face: u16| self.faces[usize::from(face)].offset;
        self.fan.iter().copied().min_by(|&f, &g| offset(f).total_cmp(&offset(g))).map(usize::from)
    }

    pub fn face(&self, face: usize) -> &Face {
        &self.faces[face]
    }

    /// The three vertices of a face.
    pub fn corners(&self, face: usize) -> [Vertex; 3] {
        let [a, b, c] = self.faces[face].corners;
        [self.vertices[usize::from(a)], self.vertices[usize::from(b)], self.vertices[usize::from(c)]]
    }

    /// The corners of every live face.
    pub fn triangles(&self) -> impl Iterator<Item = [Vertex; 3]> {
        (0..self.faces.len()).filter(|&face| self.faces[face].alive).map(|face| self.corners(face))
    }

    /// Whether the vertex is strictly outside the plane of the face. Exact.
    pub fn is_outside(&self, face: usize, vertex: &Vertex) -> bool {
        self.side(&self.faces[face], vertex.w) < 0.0
    }

    /// Whether the origin is strictly inside. Exact.
    pub fn encloses_origin(&self) -> bool {
        self.not_holding == 0
    }

    /// Whether there is no room for another vertex.
    pub fn is_full(&self) -> bool {
        self.vertices.is_full()
    }

    /// A live face that the vertex is strictly outside of.
    pub fn visible_face(&self, vertex: &Vertex) -> Option<usize> {
        (0..self.faces.len()).find(|&f| self.faces[f].alive && self.is_outside(f, vertex))
    }

    /// Grows the surface to the hull of itself and `vertex`, which is strictly outside of `seen`.
    pub fn insert(&mut self, vertex: Vertex, seen: usize) {
        // Depth first, each face's edges counter-clockwise from the one it was entered by: so the edges of the horizon
        // come in the order in which it runs.
        let mut horizon = ArrayVec::<HorizonEdge, FACES>::new();
        let mut open = ArrayVec::<(u16, u8), { 2 * FACES }>::new();
        self.remove(seen);
        for edge in [2, 1, 0] {
            open.push((seen as u16, edge));
        }
        while let Some((f, edge)) = open.pop() {
            let i = usize::from(edge);
            let face = &self.faces[usize::from(f)];
            let neighbour = face.adjacent[i];
            let (from, to) = (face.corners[i], face.corners[NEXT[i]]);
            let beyond = &self.faces[usize::from(neighbour)];
            if !beyond.alive {
                continue; // Seen already.
            }
            let across = if beyond.corners[0] == to { 0 } else { 1 + u8::from(beyond.corners[2] == to) };
            if self.side(beyond, vertex.w) < 0.0 {
                self.remove(usize::from(neighbour));
                let next = NEXT[usize::from(across)];
                open.push((neighbour, NEXT[next] as u8));
                open.push((neighbour, next as u8));
            } else {
                horizon.push(HorizonEdge { from, to, beyond: neighbour, edge: across });
            }
        }
        self.cover(&horizon, vertex);
    }

    fn remove(&mut self, face: usize) {
        let gone = &mut self.faces[face];
        gone.alive = false;
        self.not_holding -= usize::from(!gone.holds_origin);
        self.queue[face] = f64::INFINITY;
        self.free.push(face as u16);
    }

    /// Joins the horizon to the vertex by a fan of faces.
    fn cover(&mut self, horizon: &[HorizonEdge], vertex: Vertex) {
        let apex = self.vertices.len() as u16;
        self.vertices.push(vertex);
        self.fan.clear();
        for edge in horizon {
            // Which faces are next in the fan is filled in when all of them have a slot.
            let face = self.add_face([edge.from, edge.to, apex], [edge.beyond, 0, 0]);
            self.faces[usize::from(edge.beyond)].adjacent[usize::from(edge.edge)] = face;
            self.fan.push(face);
        }
        let count = horizon.len();
        let mut previous = count - 1;
        for i in 0..count {
            debug_assert_eq!(horizon[previous].to, horizon[i].from, "the horizon is one loop");
            let (before, face) = (self.fan[previous], self.fan[i]);
            self.faces[usize::from(face)].adjacent[2] = before;
            self.faces[usize::from(before)].adjacent[1] = face;
            previous = i;
        }
    }

    #[inline]
    fn add_face(&mut self, corners: [u16; 3], adjacent: [u16; 3]) -> u16 {
        let at = |i: usize| self.vertices[usize::from(corners[i])].w;
        let (a, b, c) = (at(0), at(1), at(2));
        let product = (b - a).cross(&(c - a));
        // A needle whose product vanishes in f64: any direction gives a valid offset.
        let (outward, length) =
            with_length(product).or_else(|| with_length(a + b + c)).unwrap_or((Vec3::new(1.0, 0.0, 0.0), 1.0));
        // The least first, so that the root is worked out beside.
        let offset = outward.dot(&a).min(outward.dot(&b)).min(outward.dot(&c)) / length - self.slack;
        let side_of_origin = product.dot(&a);
        let holds_origin =
            if side_of_origin.abs() > self.doubt { side_of_origin > 0.0 } else { orientation(a, b, c, ORIGIN) > 0.0 };
        self.not_holding += usize::from(!holds_origin);
        let face = Face { corners, adjacent, outward, length, offset, product, holds_origin, alive: true };
        if let Some(slot) = self.free.pop() {
            self.faces[usize::from(slot)] = face;
            self.queue[usize::from(slot)] = offset;
            slot
        } else {
            self.faces.push(face);
            self.queue.push(offset);
            self.faces.len() as u16 - 1
        }
    }

    /// Positive inside, negative outside, zero on the plane of the face. Exact in its sign.
    #[inline]
    fn side(&self, face: &Face, point: Vec3) -> f64 {
        let corner = |i: usize| self.vertices[usize::from(face.corners[i])].w;
        let rounded = -face.product.dot(&(point - corner(0)));
        if rounded.abs() > self.doubt {
            return rounded;
        }
        orientation(corner(0), corner(1), corner(2), point)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vertex(x: f64, y: f64, z: f64) -> Vertex {
        let w = Vec3::new(x, y, z);
        Vertex { w, on_a: w, corners: [0; 2] }
    }

    /// Every edge has its opposite in the face across it, and no vertex is outside of any face.
    fn validate(p: &Polytope) {
        for (f, face) in p.faces.iter().enumerate().filter(|(_, face)| face.alive) {
            for i in 0..3 {
                let across = &p.faces[usize::from(face.adjacent[i])];
                assert!(across.alive);
                let j = across.corners.iter().position(|&c| c == face.corners[(i + 1) % 3]).unwrap();
                assert_eq!(across.corners[(j + 1) % 3], face.corners[i]);
                assert_eq!(usize::from(across.adjacent[j]), f);
            }
            assert!(p.vertices.iter().all(|v| p.side(face, v.w) >= 0.0));
            assert_eq!(face.holds_origin, p.side(face, Vec3::zeros()) > 0.0);
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
            let mut p = Polytope::new(8.0);
            assert!(p.start(start));
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
            let total: f64 = alive.map(|f| volume(f.corners.map(|c| p.vertices[usize::from(c)].w))).sum();
            assert!(total <= 27.0 + 1e-12 && total > 15.0, "{total}");
        }
    }
}
