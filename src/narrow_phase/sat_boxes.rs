//! Two boxes by their fifteen separating axes: three face normals each, and nine products of edges.
//!
//! With A centred at the origin, and B's centre t and axes M_j (the columns of its rotation) in A's frame, the signed
//! distance along a unit axis n is `|n . t|` less what the boxes reach along n. The largest of the fifteen is the signed
//! distance of boxes that overlap, and positive for boxes that are apart (Gottschalk 1996). `docs/derivations/sat.md` proves
//! how far rounding can take it from the truth.
//!
//! Products of edges are not normalised until one of them wins: values are compared as signed squares of fractions, so that
//! the loop has neither roots nor divisions. A product `e_i x M_j` only moves components of M, so it is exact, however near to
//! parallel the edges are; none is left out for that, and parallel edges, whose product is zero, have no face to lose.

use crate::geometry::vector::opposite;
use crate::geometry::{Placement, Vec3};

/// The axis along which two boxes are farthest apart, or least deep in one another.
#[derive(Clone, Copy, Debug)]
pub(super) struct BoxAxis {
    /// Unit vector from A to B, in A's frame.
    pub normal: Vec3,
    /// The greatest of the signed distances along the axes, metres: that along the normal, or no more than the slack above.
    pub value: f64,
    feature: Feature,
}

/// What touches along the axis.
#[derive(Clone, Copy, Debug)]
enum Feature {
    FaceOfA(usize),
    FaceOfB(usize),
    /// Edges along axis i of A and axis j of B.
    Edges(usize, usize),
}

/// Axes other than i, in cyclic order.
const OTHERS: [[usize; 2]; 3] = [[1, 2], [2, 0], [0, 1]];

/// The best axis of boxes of half extents `a` and `b`, whose faces have been looked along. Ends early with any axis along which
/// they are more than `enough` apart.
///
/// Ends among the edges, too, with any along which they are more than `parted` apart.
///
/// Edges have to win by more than `slack`, metres: of edges that are parallel but for rounding, the product may happen to be the
/// normal of a face, and then it is the face that touches.
pub(super) fn best_axis(
    a: Vec3,
    b: Vec3,
    b_in_a: &Placement,
    faces: Faces,
    [enough, parted]: [f64; 2],
    slack: f64,
) -> BoxAxis {
    let (m, t) = (&b_in_a.rotation, &b_in_a.translation);
    let Faces { value: face, feature } = faces;
    // The best value as a fraction: v |v| / |n|^2 grows with v / |n|.
    let (mut best, mut square, mut winner) = (face * face.abs(), 1.0, feature);
    if face <= enough {
        let parted = parted * parted;
        'edges: for i in 0..3 {
            let [p, q] = OTHERS[i];
            for j in 0..3 {
                // n = e_i x M_j has the components -M_qj and M_pj along p and q.
                let (np, nq) = (-m[(q, j)], m[(p, j)]);
                let [k, l] = OTHERS[j];
                let reach_of_a = a[p] * np.abs() + a[q] * nq.abs();
                // Not the shorter |n . M_k| = |M_il|: that holds for rotations, and M is one only to rounding.
                let across = |k: usize| b[k] * (np * m[(p, k)] + nq * m[(q, k)]).abs();
                let value = (np * t[p] + nq * t[q]).abs() - reach_of_a - across(k) - across(l);
                let (candidate, length) = (value * value.abs(), np * np + nq * nq);
                // Strictly: products of parallel edges are 0 / 0 and never win.
                if candidate * square > best * length {
                    (best, square, winner) = (candidate, length, Feature::Edges(i, j));
                    if candidate > parted * length {
                        break 'edges;
                    }
                }
            }
        }
    }
    let value = best.signum() * (best.abs() / square).sqrt();
    if value - face <= slack {
        winner = feature;
    }
    let toward_b = |n: Vec3| if n.dot(t) < 0.0 { opposite(n) } else { n };
    let normal = match winner {
        Feature::FaceOfA(_) | Feature::FaceOfB(_) => faces.normal(b_in_a),
        Feature::Edges(i, j) => {
            let [p, q] = OTHERS[i];
            let length = square.sqrt();
            let mut n = Vec3::zeros();
            (n[p], n[q]) = (-m[(q, j)] / length, m[(p, j)] / length);
            n
        }
    };
    BoxAxis { normal: toward_b(normal), value, feature: winner }
}

/// The normal of a face along which boxes are farthest apart, or least deep in one another.
#[derive(Clone, Copy, Debug)]
pub(super) struct Faces {
    /// The signed distance along it, metres.
    pub value: f64,
    feature: Feature,
}

impl Faces {
    /// Looks along the six normals of two boxes: cheap, and enough to part most.
    #[inline(always)]
    pub fn of(a: Vec3, b: Vec3, b_in_a: &Placement) -> Self {
        let (m, t) = (&b_in_a.rotation, &b_in_a.translation);
        let size = |i: usize, j: usize| m[(i, j)].abs();
        let along_b = b_in_a.direction_into(*t);
        let of_a = |i: usize| t[i].abs() - a[i] - (size(i, 0) * b.x + size(i, 1) * b.y + size(i, 2) * b.z);
        let of_b = |j: usize| along_b[j].abs() - b[j] - (size(0, j) * a.x + size(1, j) * a.y + size(2, j) * a.z);
        let (of_a, of_b) = (Vec3::new(of_a(0), of_a(1), of_a(2)), Vec3::new(of_b(0), of_b(1), of_b(2)));
        let (i, j) = (greatest(&of_a), greatest(&of_b));
        if of_a[i] >= of_b[j] {
            Self { value: of_a[i], feature: Feature::FaceOfA(i) }
        } else {
            Self { value: of_b[j], feature: Feature::FaceOfB(j) }
        }
    }

    /// The unit normal, one way or the other.
    #[inline]
    fn normal(&self, b_in_a: &Placement) -> Vec3 {
        let m = &b_in_a.rotation;
        match self.feature {
            Feature::FaceOfA(0) => Vec3::new(1.0, 0.0, 0.0),
            Feature::FaceOfA(1) => Vec3::new(0.0, 1.0, 0.0),
            Feature::FaceOfA(_) => Vec3::new(0.0, 0.0, 1.0),
            Feature::FaceOfB(j) | Feature::Edges(_, j) => Vec3::new(m[(0, j)], m[(1, j)], m[(2, j)]).normalize(),
        }
    }

    /// The unit normal from A to B.
    #[inline]
    pub fn toward_b(&self, b_in_a: &Placement) -> Vec3 {
        let normal = self.normal(b_in_a);
        if normal.dot(&b_in_a.translation) < 0.0 { opposite(normal) } else { normal }
    }
}

fn greatest(v: &Vec3) -> usize {
    let first = usize::from(v[1] > v[0]);
    if v[2] > v[first] { 2 } else { first }
}

impl BoxAxis {
    /// Points of A and B, in A's frame, whose difference is `-value * normal` where the boxes overlap: where the depth is
    /// measured. `slack`: features that differ in height by no more than this, in metres, count as level.
    pub fn contact(&self, a: Vec3, b: Vec3, b_in_a: &Placement, slack: f64) -> (Vec3, Vec3) {
        let (m, t) = (&b_in_a.rotation, &b_in_a.translation);
        match self.feature {
            Feature::FaceOfA(i) => {
                let on_b = lowest_within(a, i, self.normal, b, b_in_a, slack);
                (clamped(on_b - self.normal * self.value, a), on_b)
            }
            Feature::FaceOfB(j) => {
                // The same with the roles exchanged, in B's frame.
                let a_in_b = Placement::computed(m.transpose(), -m.tr_mul(t));
                let outward = m.tr_mul(&-self.normal);
                let on_a = lowest_within(b, j, outward, a, &a_in_b, slack);
                (b_in_a.point(on_a), b_in_a.point(clamped(on_a - outward * self.value, b)))
            }
            Feature::Edges(i, j) => {
                // Corners in the middle of either edge, and from there along it.
                let mut on_a = a.zip_map(&self.normal, f64::copysign);
                on_a[i] = 0.0;
                let mut in_b = -b.zip_map(&m.tr_mul(&self.normal), f64::copysign);
                in_b[j] = 0.0;
                let between = b_in_a.point(in_b) - on_a;
                let cosine = m[(i, j)];
                let [p, q] = OTHERS[i];
                let sine_square = m[(p, j)] * m[(p, j)] + m[(q, j)] * m[(q, j)];
                let (of_a, of_b) = (between[i], between.dot(&m.column(j)));
                // Of lines that are nearly parallel any points will do that lie abreast: so each in turn is put abreast of
                // the other, within its edge.
                on_a[i] = ((of_a - cosine * of_b) / sine_square).clamp(-a[i], a[i]);
                for _ in 0..2 {
                    in_b[j] = (cosine * on_a[i] - of_b).clamp(-b[j], b[j]);
                    on_a[i] = (of_a + cosine * in_b[j]).clamp(-a[i], a[i]);
                }
                (on_a, b_in_a.point(in_b))
            }
        }
    }
}

fn clamped(p: Vec3, half: Vec3) -> Vec3 {
    p.zip_map(&half, |x, h| x.clamp(-h, h))
}

/// The point of the box of half extents `b`, placed by `place`, that lies lowest along `outward`, the normal of face i of the
/// box of half extents `a`. Of all that lie equally low within `slack`, one that is above the face.
fn lowest_within(a: Vec3, i: usize, outward: Vec3, b: Vec3, place: &Placement, slack: f64) -> Vec3 {
    let heights = place.rotation.tr_mul(&outward);
    let corner = -b.zip_map(&heights, f64::copysign);
    let lowest = place.point(corner);
    let [p, q] = OTHERS[i];
    if lowest[p].abs() <= a[p] && lowest[q].abs() <= a[q] {
        return lowest;
    }
    // How far along each edge at the corner the height stays within the slack; the steepest edge is left out.
    let steepest = heights.iamax();
    let [k, l] = OTHERS[steepest];
    let along = |k: usize| {
        let share = (slack / (2.0 * b[k] * heights[k].abs())).min(1.0);
        let edge = place.rotation.column(k) * (-2.0 * corner[k]);
        // A box without extent along k: 0 / 0.
        if share > 0.0 { edge * share } else { Vec3::zeros() }
    };
    let (first, second) = (along(k), along(l));
    let mut level = Polygon::new([lowest, lowest + first, lowest + first + second, lowest + second]);
    for axis in [p, q] {
        level.clip(axis, 1.0, a[axis]);
        level.clip(axis, -1.0, a[axis]);
    }
    level.center().unwrap_or(lowest)
}

/// A convex polygon in space.
struct Polygon {
    corners: [Vec3; 8],
    len: usize,
}

impl Polygon {
    fn new([a, b, c, d]: [Vec3; 4]) -> Self {
        Self { corners: [a, b, c, d, a, a, a, a], len: 4 }
    }

    /// Keeps what has `sign * x[axis] <= limit` (Sutherland and Hodgman 1974); four such cuts of four corners leave eight.
    fn clip(&mut self, axis: usize, sign: f64, limit: f64) {
        let old = self.corners;
        let old = &old[..self.len];
        self.len = 0;
        let mut push = |p: Vec3| {
            // A polygon that rounding made concave could be cut into more pieces; the first eight will do.
            if self.len < self.corners.len() {
                self.corners[self.len] = p;
                self.len += 1;
            }
        };
        for (n, &from) in old.iter().enumerate() {
            let to = old[(n + 1) % old.len()];
            let (over_from, over_to) = (sign * from[axis] - limit, sign * to[axis] - limit);
            if over_from <= 0.0 {
                push(from);
            }
            if (over_from <= 0.0) != (over_to <= 0.0) {
                push(from + (to - from) * (over_from / (over_from - over_to)));
            }
        }
    }

    /// The mean of the corners; none when nothing is left.
    fn center(&self) -> Option<Vec3> {
        let sum: Vec3 = self.corners[..self.len].iter().sum();
        (self.len > 0).then(|| sum / self.len as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Pose, Quaternion};

    /// Oracle: the same loop that looks at all axes. One that ends with the first edges that part the boxes has to part them, by no more
    /// than the best does, and has to be the best where nothing parts them.
    #[test]
    fn the_first_edges_that_part_boxes_part_them() {
        let mut state = 3_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64 * 2.0 - 1.0
        };
        let (mut early, mut meeting) = (0, 0);
        for _ in 0..20_000 {
            let q = Quaternion { w: next(), x: next(), y: next(), z: next() };
            let at = Pose::new(Vec3::new(next(), next(), next()) * 1.6, q).unwrap().placement();
            let mut half = || Vec3::new(0.5 + 0.4 * next(), 0.5 + 0.4 * next(), 0.5 + 0.4 * next());
            let (a, b) = (half(), half());
            let faces = Faces::of(a, b, &at);
            if faces.value > 0.0 {
                continue;
            }
            let best = best_axis(a, b, &at, faces, [f64::INFINITY; 2], 1e-14);
            let first = best_axis(a, b, &at, faces, [f64::INFINITY, 1e-14], 1e-14);
            if best.value <= 1e-14 {
                assert_eq!((first.value, first.normal), (best.value, best.normal));
                meeting += 1;
                continue;
            }
            let along_b = at.direction_into(first.normal);
            let gap = first.normal.dot(&at.translation) - a.dot(&first.normal.abs()) - b.dot(&along_b.abs());
            assert!((gap - first.value).abs() < 1e-13 && gap > 0.0, "{gap} {}", first.value);
            assert!(first.value <= best.value + 1e-14);
            early += usize::from(first.value < best.value - 1e-9);
        }
        assert!(early > 20 && meeting > 1000, "{early} {meeting}");
    }
}
