//! The point of a simplex nearest the origin: the step GJK repeats.
//!
//! By projection, feature by feature (the signed volumes of Montanari, Petrinic and Barbieri, ACM ToG 2017, give the
//! idea): inside a face when all its sub-areas have the sign of the whole, else on the best of the edges that the
//! origin is beyond. The sub-areas are taken from the projected origin, so that small faces far away lose no digits.

use super::minkowski::Vertex;
use crate::geometry::Vec3;

/// One to three vertices and the weights that mix the nearest point from them: all positive, sum 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Feature {
    pub vertices: [Vertex; 3],
    pub weights: [f64; 3],
    pub len: usize,
}

/// What the origin is to a simplex.
pub(super) enum Nearest {
    /// Outside, or on its boundary; the feature that holds the nearest point.
    Outside(Feature),
    /// Strictly inside a tetrahedron, by an exact test.
    Enclosed,
}

impl Feature {
    pub fn point(v: Vertex) -> Self {
        Self { vertices: [v; 3], weights: [1.0, 0.0, 0.0], len: 1 }
    }

    /// The vertices in use.
    pub fn vertices(&self) -> &[Vertex] {
        &self.vertices[..self.len]
    }

    fn mix(&self, of: impl Fn(&Vertex) -> Vec3) -> Vec3 {
        let mut sum = of(&self.vertices[0]) * self.weights[0];
        for i in 1..self.len {
            sum += of(&self.vertices[i]) * self.weights[i];
        }
        sum
    }

    /// The nearest point, and the points of A and B it is the difference of.
    pub fn nearest(&self) -> Vertex {
        Vertex { w: self.mix(|v| v.w), on_a: self.mix(|v| v.on_a), on_b: self.mix(|v| v.on_b) }
    }

    /// Direction from the origin to the feature, perpendicular to it: of any length, zero when it cannot be told.
    ///
    /// In exact arithmetic it is the nearest point x itself. In rounded arithmetic x is off by about u S, and turns by
    /// u S / |x|, which for near contacts is far more than the features' own directions are off: so a face gives its
    /// normal, an edge what is left of x after the edge's direction is taken out. The better of the two is returned.
    pub fn direction(&self, x: Vec3) -> Vec3 {
        match self.len {
            3 => {
                let [a, b, c] = self.vertices.map(|v| v.w);
                let (ab, ac) = (b - a, c - a);
                let normal = ab.cross(&ac);
                // Turn of the normal is about u S |e| / |ab x ac|, turn of x is about u S / |x|.
                let edge = ab.norm_squared().max(ac.norm_squared());
                if normal.norm_squared() <= x.norm_squared() * edge {
                    return x;
                }
                if normal.dot(&a) < 0.0 { -normal } else { normal }
            }
            2 => {
                let along = self.vertices[1].w - self.vertices[0].w;
                let square = along.norm_squared();
                if square == 0.0 { x } else { x - along * (x.dot(&along) / square) }
            }
            _ => x,
        }
    }
}

/// The feature of a segment nearest the origin.
pub(super) fn segment(a: Vertex, b: Vertex) -> Feature {
    let ab = b.w - a.w;
    let square = ab.norm_squared();
    let t = -a.w.dot(&ab) / square;
    // Beyond a, or a and b are one point (t is NaN).
    if !(t > 0.0) {
        return if square == 0.0 || a.w.norm_squared() <= b.w.norm_squared() {
            Feature::point(a)
        } else {
            Feature::point(b)
        };
    }
    if t >= 1.0 {
        return Feature::point(b);
    }
    // Measured from the nearer end, which keeps small weights exact.
    let s = b.w.dot(&ab) / square;
    let (wa, wb) = if t < 0.5 { (1.0 - t, t) } else { (s, 1.0 - s) };
    if !(wa > 0.0 && wb > 0.0) {
        return if wa > wb { Feature::point(a) } else { Feature::point(b) };
    }
    Feature { vertices: [a, b, b], weights: [wa, wb, 0.0], len: 2 }
}

/// The feature of a triangle nearest the origin.
pub(super) fn triangle(a: Vertex, b: Vertex, c: Vertex) -> Feature {
    let normal = (b.w - a.w).cross(&(c.w - a.w));
    let square = normal.norm_squared();
    if square > 0.0 {
        // The origin, dropped onto the plane; from the vertex nearest it, where the product rounds least.
        let near = [a, b, c].into_iter().map(|v| v.w).min_by(|p, q| p.norm_squared().total_cmp(&q.norm_squared()));
        let foot = normal * (near.unwrap_or(a.w).dot(&normal) / square);
        // Areas in the coordinate plane the triangle is least foreshortened in.
        let drop = normal.iamax();
        let (i, j) = ((drop + 1) % 3, (drop + 2) % 3);
        let [pa, pb, pc] = [a, b, c].map(|v| v.w - foot);
        let area = |p: Vec3, q: Vec3| p[i] * q[j] - p[j] * q[i];
        let sign = normal[drop].signum();
        let [wa, wb, wc] = [area(pb, pc) * sign, area(pc, pa) * sign, area(pa, pb) * sign];
        let sum = wa + wb + wc;
        if wa > 0.0 && wb > 0.0 && wc > 0.0 {
            return Feature { vertices: [a, b, c], weights: [wa / sum, wb / sum, wc / sum], len: 3 };
        }
    }
    // On an edge. All three are looked at: in a needle the signs of the areas are not to be trusted.
    nearer(segment(a, b), nearer(segment(b, c), segment(c, a)))
}

/// Where the origin is with respect to a tetrahedron.
pub(super) fn tetrahedron(a: Vertex, b: Vertex, c: Vertex, d: Vertex) -> Nearest {
    let whole = orientation(a.w, b.w, c.w, d.w);
    let beyond = |p: Vertex, q: Vertex, r: Vertex, opposite: f64| {
        // The origin and the fourth vertex on one side of the face: not beyond it. A flat tetrahedron has no inside.
        let origin = orientation(p.w, q.w, r.w, Vec3::zeros());
        opposite == 0.0 || origin == 0.0 || (origin > 0.0) != (opposite > 0.0)
    };
    // Signs of the four faces' opposite vertices, by swapping rows of the same determinant.
    let faces = [(a, b, c, whole), (a, d, b, whole), (a, c, d, whole), (b, d, c, whole)];
    let mut best: Option<Feature> = None;
    for (p, q, r, opposite) in faces {
        if beyond(p, q, r, opposite) {
            let feature = triangle(p, q, r);
            best = Some(best.map_or(feature, |found| nearer(found, feature)));
        }
    }
    best.map_or(Nearest::Enclosed, Nearest::Outside)
}

fn nearer(one: Feature, other: Feature) -> Feature {
    if one.nearest().w.norm_squared() <= other.nearest().w.norm_squared() { one } else { other }
}

/// Six times the volume of the tetrahedron (a, b, c, d), exactly of the right sign: positive when d is below the plane
/// in which a, b, c turn counter-clockwise seen from above. Shewchuk's adaptive predicate.
pub(super) fn orientation(a: Vec3, b: Vec3, c: Vec3, d: Vec3) -> f64 {
    let coord = |v: Vec3| robust::Coord3D { x: v.x, y: v.y, z: v.z };
    robust::orient3d(coord(a), coord(b), coord(c), coord(d))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vertex(x: f64, y: f64, z: f64) -> Vertex {
        let w = Vec3::new(x, y, z);
        Vertex { w, on_a: w, on_b: Vec3::zeros() }
    }

    #[test]
    fn closest_features_of_a_triangle() {
        let (a, b, c) = (vertex(-1.0, -1.0, 1.0), vertex(2.0, -1.0, 1.0), vertex(-1.0, 2.0, 1.0));
        let face = triangle(a, b, c);
        assert_eq!(face.len, 3);
        assert!((face.nearest().w - Vec3::z()).norm() < 1e-15);
        let edge = triangle(vertex(1.0, -1.0, 0.0), vertex(1.0, 1.0, 0.0), vertex(3.0, 0.0, 0.0));
        assert_eq!(edge.len, 2);
        assert!((edge.nearest().w - Vec3::x()).norm() < 1e-15);
        let corner = triangle(vertex(1.0, 1.0, 0.0), vertex(2.0, 1.5, 0.0), vertex(1.5, 2.0, 0.0));
        assert_eq!((corner.len, corner.nearest().w), (1, Vec3::new(1.0, 1.0, 0.0)));
    }

    #[test]
    fn a_tetrahedron_encloses_only_what_is_strictly_inside() {
        let corners = |lift: f64| {
            [(0.0, 0.0, -1.0), (3.0, 0.0, 0.5), (-2.0, 2.0, 0.5), (-2.0, -2.0, 0.5)]
                .map(|(x, y, z)| vertex(x, y, z + lift))
        };
        let enclosed = |[a, b, c, d]: [Vertex; 4]| matches!(tetrahedron(a, b, c, d), Nearest::Enclosed);
        let [a, b, c, d] = corners(0.0);
        assert!(enclosed([a, b, c, d]) && enclosed([b, a, c, d]), "either orientation");
        assert!(!enclosed(corners(1.0)), "the origin is on a vertex");
        assert!(!enclosed(corners(-0.5)), "the origin is on a face");
        assert!(!enclosed([a, a, c, d]), "flat");
    }

    #[test]
    fn coinciding_and_collinear_vertices_are_no_trouble() {
        let p = vertex(1.0, 2.0, 2.0);
        assert_eq!(segment(p, p).len, 1);
        assert_eq!(triangle(p, p, p).len, 1);
        let line = triangle(vertex(1.0, -1.0, 0.0), vertex(1.0, 1.0, 0.0), vertex(1.0, 3.0, 0.0));
        assert!((line.nearest().w - Vec3::x()).norm() < 1e-15);
    }
}
