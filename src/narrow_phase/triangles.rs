//! Two triangles: their distance from the features that can be nearest, and whether they surely cross.
//!
//! Both are in the first mesh's frame, where each corner is within the error E of a point of the true difference
//! (`docs/derivations/mesh.md`). Apart, the nearest points are on two edges, or on a corner and a face: fifteen candidates.
//! Whichever is taken, its two points bound the distance from above, and the gap of all six corners along the line between them from
//! below, so a candidate wrongly passed over widens the bracket and makes no wrong answer. Triangles cross when an edge of one pierces
//! the other, which orientations of tetrahedra tell (Moeller 1997, Guigue and Devillers 2003); here a sign counts only if no
//! displacement of the corners by E can change it. What neither decides is left to GJK and EPA.

use super::support::unit;
use crate::geometry::Vec3;
use crate::geometry::vector::opposite;

/// A pair of triangles in one frame. Metres.
pub(super) struct TrianglePair {
    pub a: [Vec3; 3],
    pub b: [Vec3; 3],
    /// E: a corner is within this of where it is in the truth.
    pub error: f64,
}

/// A gap of two triangles along a unit direction from A to B, as computed; metres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gap {
    pub gap: f64,
    pub direction: Vec3,
}

/// Nearest points of two triangles, as far as `f64` tells.
#[derive(Clone, Copy, Debug)]
pub(super) struct NearPoints {
    pub on_a: Vec3,
    pub on_b: Vec3,
    square: f64,
}

impl TrianglePair {
    /// Gap along a direction of any length, as computed, in units of that length.
    #[inline(always)]
    pub fn gap(&self, n: Vec3) -> f64 {
        let [low, high] = [self.b.map(|p| p.dot(&n)), self.a.map(|p| p.dot(&n))];
        low[0].min(low[1]).min(low[2]) - high[0].max(high[1]).max(high[2])
    }

    /// The best gap along the normals of both faces, either way; minus infinity for triangles without normals.
    pub fn gap_along_faces(&self) -> Gap {
        let none = Gap { gap: f64::NEG_INFINITY, direction: Vec3::x() };
        [&self.a, &self.b].into_iter().fold(none, |best, t| self.better(best, normal(t)))
    }

    /// The best gap along all normals of the faces of their Minkowski difference: those of both triangles, which are in `best`,
    /// and the products of edges.
    pub fn gap_along_all(&self, best: Gap) -> Gap {
        let products = edges(&self.a).into_iter().flat_map(|u| edges(&self.b).map(|v| u.cross(&v)));
        products.fold(best, |best, n| self.better(best, n))
    }

    /// The better of a gap and those along `n`, either way.
    fn better(&self, best: Gap, n: Vec3) -> Gap {
        let Some(n) = unit(n) else { return best };
        let either = [n, opposite(n)].map(|direction| Gap { gap: self.gap(direction), direction });
        either.into_iter().fold(best, |best, next| if next.gap > best.gap { next } else { best })
    }

    /// Whether the triangles have a point in common, whatever the errors of their corners. False says nothing.
    pub fn surely_cross(&self) -> bool {
        let reach = self.a.iter().chain(&self.b).map(|p| (p - self.a[0]).norm_squared()).fold(0.0, f64::max);
        // No side of a tetrahedron of these corners is longer than L = 2 sqrt(reach). Its orientation changes by less than
        // 6 E L^2 when corners move by E, and rounds by less than E L^2 more.
        let doubt = 8.0 * 4.0 * self.error * reach;
        let sign = |p: Vec3, q: Vec3, r: Vec3, s: Vec3| {
            let volume = (q - p).cross(&(r - p)).dot(&(s - p));
            if volume > doubt {
                1
            } else if volume < -doubt {
                -1
            } else {
                0
            }
        };
        let pierces = |edge: [Vec3; 2], t: &[Vec3; 3]| {
            let [p, q] = edge;
            let sides = [sign(p, q, t[0], t[1]), sign(p, q, t[1], t[2]), sign(p, q, t[2], t[0])];
            sides == [1, 1, 1] || sides == [-1, -1, -1]
        };
        let crosses = |from: &[Vec3; 3], t: &[Vec3; 3]| {
            let sides = from.map(|p| sign(t[0], t[1], t[2], p));
            (0..3).any(|i| sides[i] * sides[(i + 1) % 3] == -1 && pierces([from[i], from[(i + 1) % 3]], t))
        };
        crosses(&self.a, &self.b) || crosses(&self.b, &self.a)
    }

    /// Nearest points of triangles that are apart; of others some points.
    pub fn near_points(&self) -> NearPoints {
        let mut best = NearPoints { on_a: self.a[0], on_b: self.b[0], square: f64::INFINITY };
        let (along_a, along_b) = (edges(&self.a), edges(&self.b));
        for (p, u) in self.a.iter().zip(&along_a) {
            for (q, v) in self.b.iter().zip(&along_b) {
                if best.improve(of_edges(p, u, q, v)) && self.is_proved(&best) {
                    return best;
                }
            }
        }
        // A corner over a face.
        for q in self.b {
            if let Some(foot) = foot(q, &self.a) {
                best.improve((foot, q));
            }
        }
        for p in self.a {
            if let Some(foot) = foot(p, &self.b) {
                best.improve((p, foot));
            }
        }
        best
    }

    /// Whether a plane across the line between the points has the triangles on its two sides, so that there is nothing nearer.
    fn is_proved(&self, near: &NearPoints) -> bool {
        let across = near.on_b - near.on_a;
        self.gap(across) >= near.square - self.error * across.norm()
    }
}

impl NearPoints {
    fn improve(&mut self, (on_a, on_b): (Vec3, Vec3)) -> bool {
        let square = (on_b - on_a).norm_squared();
        let nearer = square < self.square;
        if nearer {
            *self = Self { on_a, on_b, square };
        }
        nearer
    }
}

fn edges([a, b, c]: &[Vec3; 3]) -> [Vec3; 3] {
    [b - a, c - b, a - c]
}

fn normal([a, b, c]: &[Vec3; 3]) -> Vec3 {
    (b - a).cross(&(c - a))
}

/// Nearest points of the segments p + s u and q + t v, s and t in 0..=1. (Ericson, Real-Time Collision Detection, 5.1.9.)
fn of_edges(p: &Vec3, u: &Vec3, q: &Vec3, v: &Vec3) -> (Vec3, Vec3) {
    // Least |r + t v - s u|^2 with r = q - p: s a - t b = d and s b - t c = e.
    let r = q - p;
    let (a, b, c) = (u.dot(u), u.dot(v), v.dot(v));
    let (d, e) = (u.dot(&r), v.dot(&r));
    let determinant = a * c - b * b;
    // Parallel segments: any s will do to begin with.
    let mut s = if determinant > 0.0 { ((d * c - b * e) / determinant).clamp(0.0, 1.0) } else { 0.0 };
    let mut t = if c > 0.0 { (s * b - e) / c } else { 0.0 };
    if !(0.0..=1.0).contains(&t) {
        t = t.clamp(0.0, 1.0);
        s = if a > 0.0 { ((t * b + d) / a).clamp(0.0, 1.0) } else { 0.0 };
    }
    (p + u * s, q + v * t)
}

/// The point of the face right under `p`, if there is one: a convex combination of the corners, so it is on the triangle.
fn foot(p: Vec3, t: &[Vec3; 3]) -> Option<Vec3> {
    let (u, v, r) = (t[1] - t[0], t[2] - t[0], p - t[0]);
    let (a, b, c) = (u.dot(&u), u.dot(&v), v.dot(&v));
    let (d, e) = (u.dot(&r), v.dot(&r));
    let determinant = a * c - b * b;
    let (x, y) = (d * c - e * b, e * a - d * b);
    // The negations also turn NaN away.
    if !(determinant > 0.0 && x >= 0.0 && y >= 0.0 && x + y <= determinant) {
        return None;
    }
    Some(t[0] + u * (x / determinant) + v * (y / determinant))
}
