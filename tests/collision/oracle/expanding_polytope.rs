//! Overlap and contact: an expanding polytope in double-doubles.
//!
//! A polytope inside D is grown at the face nearest the origin. It is kept around an inner point c of D, not around the
//! origin, so that a contact is no special case: a face's offset `n . v` is negative where the origin is beyond it.
//!
//! Upper bound: if the surface is closed and every face has the origin on its inner side, then it goes around the origin, so
//! the ball of radius min(n . v) lies in the hull of its vertices, and so in D. Closed it is by construction (a disc of
//! faces is replaced by a fan over its rim; anything else is given up); the sides are tested with a margin far above
//! rounding. Convexity is not needed, which is why a coplanar point that is taken for the wrong side does no harm.
//! Lower bound: `-max over D of n . x` for every face normal n.

use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

use super::difference::{Bounds, Difference, ROUNDING};
use super::double_double::Dd;
use super::vector::{DdVector, Vector};

/// A point this near a face's plane is on it; scaled lengths. Above rounding, far below any gap that is asked for.
const COPLANAR: f64 = 1e-28;

struct Face {
    corners: [usize; 3],
    /// Across the edges from each corner to the next.
    adjacent: [usize; 3],
    normal: DdVector,
    alive: bool,
}

struct Queued {
    offset: Dd,
    face: usize,
}

impl PartialEq for Queued {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Queued {}

impl PartialOrd for Queued {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Queued {
    fn cmp(&self, other: &Self) -> Ordering {
        let (one, two) = (self.offset, other.offset);
        one.hi.total_cmp(&two.hi).then(one.lo.total_cmp(&two.lo)).then(self.face.cmp(&other.face))
    }
}

struct Polytope {
    inner: DdVector,
    vertices: Vec<DdVector>,
    faces: Vec<Face>,
    queue: BinaryHeap<Reverse<Queued>>,
}

/// Narrows `bounds` until they are no wider than `wanted`, with at most `most` vertices.
pub fn expand(difference: &Difference, mut bounds: Bounds, wanted: f64, most: usize) -> Bounds {
    let corners = match first_corners(difference) {
        Ok(corners) => corners,
        Err(across) => {
            // D is flat: what matters is how far the origin is from its plane.
            for d in [across, -across] {
                bounds.separates(&d, &difference.lowest(&d));
            }
            return bounds;
        }
    };
    let Some(mut polytope) = Polytope::tetrahedron(corners) else { return bounds };
    while let Some(Reverse(Queued { offset, face })) = polytope.queue.pop() {
        if !polytope.faces[face].alive {
            continue;
        }
        if offset > Dd::from(ROUNDING) {
            bounds.is_at_most(-offset);
        }
        let outward = polytope.faces[face].normal;
        let vertex = difference.lowest(&-outward);
        bounds.separates(&-outward, &vertex);
        let gain = outward.dot(&vertex) - offset;
        // A face that cannot be pushed out is on the boundary of D, and it is the nearest one.
        let settled = gain <= Dd::from(8.0 * ROUNDING);
        if settled || bounds.width() <= wanted || polytope.vertices.len() >= most || !polytope.insert(vertex, face) {
            break;
        }
    }
    bounds
}

/// Four points of D that span a volume, or the direction across D where it is flat.
fn first_corners(difference: &Difference) -> Result<[DdVector; 4], DdVector> {
    let axis = |i: usize| Vector([0, 1, 2].map(|j| if i == j { Dd::ONE } else { Dd::ZERO }));
    let mut seen: Vec<DdVector> = (0..3).flat_map(|i| [axis(i), -axis(i)]).map(|d| difference.lowest(&d)).collect();
    let farthest = |from: &[DdVector], measure: &dyn Fn(&DdVector) -> Dd| {
        let mut best = (Dd::from(-1.0), from[0]);
        for p in from {
            let value = measure(p);
            if value > best.0 {
                best = (value, *p);
            }
        }
        best.1
    };
    let a = seen[0];
    let b = farthest(&seen, &|p| (*p - a).square());
    let Some(along) = (b - a).unit() else { return Err(axis(0)) };
    // Away from the line, then away from the plane; in each step D is asked again, for thin shapes need not show in the axes.
    let off_line = |p: &DdVector| (*p - a).cross(&along).square();
    let side = along.cross(&axis(smallest(&along))).unit().ok_or(axis(0))?;
    let other = along.cross(&side);
    seen.extend([side, -side, other, -other].iter().map(|d| difference.lowest(d)));
    let c = farthest(&seen, &off_line);
    let Some(across) = (c - a).cross(&along).unit().filter(|_| off_line(&c) > Dd::from(COPLANAR * COPLANAR)) else {
        return Err(side);
    };
    seen.extend([across, -across].iter().map(|d| difference.lowest(d)));
    let height = |p: &DdVector| across.dot(&(*p - a)).abs();
    let d = farthest(&seen, &height);
    // The narrower D is, the less its normal is known.
    let doubt = Dd::from(COPLANAR) / off_line(&c).sqrt();
    if height(&d) <= doubt + doubt { Err(across) } else { Ok([a, b, c, d]) }
}

fn smallest(v: &DdVector) -> usize {
    let size = |i: usize| v.0[i].hi.abs();
    (0..3).min_by(|&i, &j| size(i).total_cmp(&size(j))).unwrap_or(0)
}

impl Polytope {
    fn tetrahedron(corners: [DdVector; 4]) -> Option<Self> {
        let [a, b, c, d] = corners;
        let below = (b - a).cross(&(c - a)).dot(&(d - a)) < Dd::ZERO;
        let vertices = if below { vec![a, b, c, d] } else { vec![b, a, c, d] };
        let quarter = Dd::from(0.25);
        let inner = (a + b + c + d).times(&quarter);
        let mut polytope = Self { inner, vertices, faces: Vec::new(), queue: BinaryHeap::new() };
        for (corners, adjacent) in
            [([0, 1, 2], [1, 3, 2]), ([0, 3, 1], [2, 3, 0]), ([0, 2, 3], [0, 3, 1]), ([1, 3, 2], [1, 2, 0])]
        {
            polytope.add_face(corners, adjacent)?;
        }
        Some(polytope)
    }

    /// None for a face that has no normal, or that the inner point is not clearly inside of.
    fn add_face(&mut self, corners: [usize; 3], adjacent: [usize; 3]) -> Option<usize> {
        let [a, b, c] = corners.map(|i| self.vertices[i]);
        let normal = (b - a).cross(&(c - a)).unit()?;
        let offset = normal.dot(&a).min(normal.dot(&b)).min(normal.dot(&c));
        if !(offset - normal.dot(&self.inner) > Dd::from(ROUNDING)) {
            return None;
        }
        let face = self.faces.len();
        self.faces.push(Face { corners, adjacent, normal, alive: true });
        self.queue.push(Reverse(Queued { offset, face }));
        Some(face)
    }

    /// Replaces the faces that see the vertex by a fan. False when they are not a disc.
    fn insert(&mut self, vertex: DdVector, seen: usize) -> bool {
        let rounded = vertex.to_doubles();
        let mut open = vec![seen];
        let mut rim: Vec<[usize; 3]> = Vec::new();
        self.faces[seen].alive = false;
        while let Some(f) = open.pop() {
            for i in 0..3 {
                let (from, to) = (self.faces[f].corners[i], self.faces[f].corners[(i + 1) % 3]);
                let beyond = self.faces[f].adjacent[i];
                if !self.faces[beyond].alive {
                    continue;
                }
                if self.sees(beyond, &vertex, rounded) {
                    self.faces[beyond].alive = false;
                    open.push(beyond);
                } else {
                    rim.push([from, to, beyond]);
                }
            }
        }
        // One loop: each edge starts where the one before ends, and all are used.
        let apex = self.vertices.len();
        self.vertices.push(vertex);
        let Some(ordered) = one_loop(&rim) else { return false };
        let (first, count) = (self.faces.len(), ordered.len());
        for (i, [from, to, beyond]) in ordered.into_iter().enumerate() {
            let (next, previous) = (first + (i + 1) % count, first + (i + count - 1) % count);
            let Some(face) = self.add_face([from, to, apex], [beyond, next, previous]) else { return false };
            let across = (0..3).find(|&j| self.faces[beyond].corners[j] == to).expect("neighbours share an edge");
            self.faces[beyond].adjacent[across] = face;
        }
        true
    }

    /// Whether the vertex is outside of the face, or on its plane.
    fn sees(&self, face: usize, vertex: &DdVector, rounded: [f64; 3]) -> bool {
        let face = &self.faces[face];
        let from = self.vertices[face.corners[0]];
        let (n, v) = (face.normal.to_doubles(), from.to_doubles());
        let rough: f64 = (0..3).map(|i| n[i] * (rounded[i] - v[i])).sum();
        if rough.abs() > 1e-14 {
            return rough > 0.0;
        }
        face.normal.dot(&(*vertex - from)) > Dd::from(-COPLANAR)
    }
}

fn one_loop(rim: &[[usize; 3]]) -> Option<Vec<[usize; 3]>> {
    let mut ordered = vec![*rim.first()?];
    while ordered.len() < rim.len() {
        let end = ordered[ordered.len() - 1][1];
        let mut starting = rim.iter().filter(|edge| edge[0] == end);
        let next = starting.next()?;
        if starting.next().is_some() || next[0] == ordered[0][0] {
            return None;
        }
        ordered.push(*next);
    }
    (rim.len() >= 3 && ordered[ordered.len() - 1][1] == ordered[0][0]).then_some(ordered)
}
