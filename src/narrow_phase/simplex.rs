//! The point of a simplex nearest the origin: the step GJK repeats.
//!
//! The nearest point x of a set of vertices is known when it is seen: no vertex v has `v . x < x . x` (the condition of
//! Karush, Kuhn and Tucker for min |x|^2). So the step guesses the feature that holds it (a face of which the origin's
//! foot is inside, an edge, the newest vertex), nearly always rightly, and checks the guess by that condition. When no
//! guess passes, which happens with simplices as flat as rounding, every feature is looked at and the nearest one taken. Which
//! of the faces at a new vertex it is cannot be foretold, so they are compared without branches.
//!
//! Sub-areas and lengths decide by their signs, as in the signed volumes of Montanari, Petrinic and Barbieri, ACM ToG 2017.

use arrayvec::ArrayVec;

use super::minkowski::Vertex;
use crate::geometry::Vec3;
use crate::geometry::tolerance::UNIT_ROUNDOFF;
use crate::geometry::vector::{ORIGIN, is_same, opposite, sum_of_sizes};

/// One to three vertices, and the point they hold that is nearest the origin.
#[derive(Clone, Debug)]
pub(super) struct Simplex {
    /// Points of the difference, apart from where they come from: the step looks at nothing else.
    w: [Vec3; 4],
    from: [Origin; 4],
    /// They mix the nearest point: positive, sum 1.
    weights: [f64; 3],
    len: usize,
    /// Of an edge the way along it, of a face the product of two edges.
    span: Vec3,
    /// The nearest point; metres.
    pub x: Vec3,
    /// Its square.
    pub square: f64,
}

/// Where a vertex comes from: see [`Vertex`].
#[derive(Clone, Copy, Debug)]
struct Origin {
    on_a: Vec3,
    corners: [u32; 2],
}

/// What became of a simplex when a vertex was added.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Step {
    /// It shrank to the feature that holds the nearest point.
    Reduced,
    /// It stayed as it was: with the vertex it comes no nearer.
    NoNearer,
    /// The origin is strictly inside of it and the vertex, which is now its fourth, by an exact test.
    Enclosed,
}

/// Where the nearest point is: on up to three of the vertices, in increasing order.
#[derive(Clone, Copy)]
struct Place {
    slots: [usize; 3],
    weights: [f64; 3],
    len: usize,
    span: Vec3,
    x: Vec3,
}

impl Simplex {
    #[inline]
    pub fn point(v: Vertex) -> Self {
        let from = Origin { on_a: v.on_a, corners: v.corners };
        Self {
            w: [v.w; 4],
            from: [from; 4],
            weights: [1.0, 0.0, 0.0],
            len: 1,
            span: ORIGIN,
            x: v.w,
            square: v.w.norm_squared(),
        }
    }

    /// The vertices of the feature that holds the nearest point.
    pub fn vertices(&self) -> ArrayVec<Vertex, 4> {
        (0..self.len).map(|slot| self.vertex(slot)).collect()
    }

    /// All four, once they enclose the origin.
    pub fn enclosing(&self) -> [Vertex; 4] {
        [0, 1, 2, 3].map(|slot| self.vertex(slot))
    }

    /// How many vertices the feature has.
    pub fn len(&self) -> usize {
        self.len
    }

    /// The corners that the vertices come from; what is beyond `len` is left from before.
    pub fn corners(&self) -> [[u32; 2]; 4] {
        [self.from[0].corners, self.from[1].corners, self.from[2].corners, self.from[3].corners]
    }

    /// Whether it has this point as a vertex.
    #[inline]
    pub fn has(&self, w: Vec3) -> bool {
        is_same(self.w[0], w) | (self.len > 1 && is_same(self.w[1], w)) | (self.len > 2 && is_same(self.w[2], w))
    }

    fn vertex(&self, slot: usize) -> Vertex {
        let Origin { on_a, corners } = self.from[slot];
        Vertex { w: self.w[slot], on_a, corners }
    }

    /// The nearest point with the point of A it comes from.
    #[inline]
    pub fn nearest(&self) -> Vertex {
        let (from, weights) = (&self.from, self.weights);
        let mut on_a = from[0].on_a * weights[0];
        for i in 1..self.len {
            on_a += from[i].on_a * weights[i];
        }
        Vertex { w: self.x, on_a, corners: from[0].corners }
    }

    /// Direction from the origin to the feature, perpendicular to it: of any length, zero when it cannot be told.
    ///
    /// In exact arithmetic it is the nearest point x itself. In rounded arithmetic x is off by about u S, and turns by
    /// u S / |x|, which for near contacts is far more than the features' own directions are off: so a face gives its
    /// normal, an edge what is left of x after the edge's direction is taken out. The better of the two is returned.
    #[inline]
    pub fn direction(&self) -> Vec3 {
        match self.len {
            3 => {
                let ([a, b, c, _], normal) = (&self.w, self.span);
                // Turn of the normal is about u S |e| / |ac x bc|, turn of x is about u S / |x|.
                let edge = (a - c).norm_squared().max((b - c).norm_squared());
                if normal.norm_squared() <= self.square * edge {
                    return self.x;
                }
                if normal.dot(c) < 0.0 { opposite(normal) } else { normal }
            }
            2 => {
                let along = self.span;
                let square = along.norm_squared();
                if square == 0.0 { self.x } else { self.x - along * (self.x.dot(&along) / square) }
            }
            _ => self.x,
        }
    }

    /// Takes in a vertex and shrinks to what holds the nearest point. `extent`: no vertex is farther from the origin.
    #[inline]
    pub fn add(&mut self, vertex: &Vertex, extent: f64) -> Step {
        let (old, count) = (self.len, self.len + 1);
        self.w[old] = vertex.w;
        self.from[old] = Origin { on_a: vertex.on_a, corners: vertex.corners };
        let w = &self.w;
        let guess = match count {
            2 => edge(w, 0, 1).unwrap_or_else(|| corner(w, 1)),
            3 => of_three(w),
            _ => of_four(w),
        };
        let slack = 64.0 * UNIT_ROUNDOFF * extent;
        let place = if is_nearest(&guess, w, count, slack) {
            guess
        } else if count == 4 && is_clearly_enclosed(w, extent) {
            return Step::Enclosed;
        } else {
            match exhaustive(&w[..count]) {
                Some(place) => place,
                None => return Step::Enclosed,
            }
        };
        // Comparison order matters: a NaN is no progress.
        let square = place.x.norm_squared();
        if !(square < self.square) {
            return Step::NoNearer;
        }
        for i in 0..place.len {
            // In increasing order, so that nothing is overwritten before it is moved.
            let slot = place.slots[i];
            if slot != i {
                (self.w[i], self.from[i]) = (self.w[slot], self.from[slot]);
            }
        }
        (self.weights, self.len, self.span) = (place.weights, place.len, place.span);
        (self.x, self.square) = (place.x, square);
        Step::Reduced
    }

    /// Radius of a ball around the origin that is in the enclosing tetrahedron: proved, metres; not positive when that is too thin
    /// to tell. `extent` as for [`Simplex::add`].
    ///
    /// The plane of a face (p, q, r) is at p . (q x r) over the length of (q - p) x (r - p) = p x q + q x r + r x p. The first is
    /// off by less than 8 u S^3, the second by less than 32 u S^2 (`docs/derivations/search.md`).
    pub fn inner_ball(&self, extent: f64) -> f64 {
        let [a, b, c, d] = &self.w;
        let (ab, bc, ca) = (a.cross(b), b.cross(c), c.cross(a));
        let (ad, bd, cd) = (a.cross(d), b.cross(d), c.cross(d));
        let (volume_error, area_error) = (DOUBT * extent * extent * extent, 32.0 * UNIT_ROUNDOFF * extent * extent);
        let offset = |volume: f64, area: Vec3| (volume.abs() - volume_error) / (area.norm() + area_error);
        let of_old = offset(a.dot(&bc), ab + bc + ca);
        let of_new = offset(d.dot(&ab), ab + bd - ad)
            .min(offset(d.dot(&bc), bc + cd - bd))
            .min(offset(d.dot(&ca), ca + ad - cd));
        // A quotient and a product: a few units in the last place.
        of_old.min(of_new) * (1.0 - 8.0 * UNIT_ROUNDOFF)
    }
}

/// The point of a triangle nearest the origin, with the point of A it comes from. `extent` as for [`Simplex::add`].
pub(super) fn nearest_of_triangle([a, b, c]: [Vertex; 3], extent: f64) -> Vertex {
    let mut simplex = Simplex::point(a);
    simplex.w[1] = b.w;
    simplex.from[1] = Origin { on_a: b.on_a, corners: b.corners };
    simplex.len = 2;
    simplex.square = f64::INFINITY; // Any point is nearer.
    simplex.add(&c, extent);
    simplex.nearest()
}

/// A volume p . (q x r) of vertices no farther than S from the origin is off by less than this times S^3: each of the six
/// products takes part in five roundings, and together they are no more than 6 / sqrt(27) S^3.
const DOUBT: f64 = 8.0 * UNIT_ROUNDOFF;

/// Whether no vertex left out lies before the plane through x across x, within rounding: then x is too far by no more than the
/// slack, half of what a vertex may be off.
#[inline(always)]
fn is_nearest(place: &Place, w: &[Vec3; 4], count: usize, slack: f64) -> bool {
    let x = place.x;
    let least = x.norm_squared() - slack * sum_of_sizes(x);
    // Slots beyond `len` repeat one before. No early end: the branches would cost more than the products.
    let [p, q, r] = place.slots;
    let is_in_front = |i: usize| i < count && i != p && i != q && i != r && w[i].dot(&x) < least;
    !(is_in_front(0) | is_in_front(1) | is_in_front(2) | is_in_front(3))
}

#[inline]
fn corner(w: &[Vec3; 4], i: usize) -> Place {
    Place { slots: [i; 3], weights: [1.0, 0.0, 0.0], len: 1, span: ORIGIN, x: w[i] }
}

/// The nearest point of an edge when it is strictly between the ends.
#[inline(always)]
fn edge(w: &[Vec3; 4], i: usize, j: usize) -> Option<Place> {
    let (a, b) = (w[i], w[j]);
    let along = b - a;
    // How far the foot is from either end: each is exact to rounding where it is small.
    let (from_a, from_b) = (-a.dot(&along), b.dot(&along));
    if !(from_a > 0.0 && from_b > 0.0) {
        return None;
    }
    let whole = from_a + from_b;
    let (of_a, of_b) = (from_b / whole, from_a / whole);
    Some(Place { slots: [i, j, j], weights: [of_a, of_b, 0.0], len: 2, span: along, x: a * of_a + b * of_b })
}

/// The nearest point of a face when it is strictly inside.
///
/// The weight of a corner is the area of the triangle that the others make with the origin's foot, over the whole: with n
/// the product of two edges, `n . ((a - c) x -c)` for b. Edges from one corner keep the error at u |e| |c|, so that
/// small faces lose few digits.
#[inline(always)]
fn face(w: &[Vec3; 4], i: usize, j: usize, k: usize) -> Option<Place> {
    let (a, b, c) = (w[i], w[j], w[k]);
    let (ca, cb) = (a - c, b - c);
    let normal = ca.cross(&cb);
    let whole = normal.norm_squared();
    let of_a = normal.dot(&cb.cross(&c));
    let of_b = normal.dot(&c.cross(&ca));
    let of_c = whole - of_a - of_b;
    // Comparison order matters: a face without area has weights that are not numbers.
    if !((of_a > 0.0) & (of_b > 0.0) & (of_c > 0.0)) {
        return None;
    }
    let share = 1.0 / whole;
    let (of_a, of_b) = (of_a * share, of_b * share);
    let of_c = 1.0 - of_a - of_b;
    let x = c + ca * of_a + cb * of_b;
    Some(Place { slots: [i, j, k], weights: [of_a, of_b, of_c], len: 3, span: normal, x })
}

/// A guess for two old vertices and a new one: the feature has the new one in it.
#[inline]
fn of_three(w: &[Vec3; 4]) -> Place {
    face(w, 0, 1, 2).or_else(|| nearer(edge(w, 0, 2), edge(w, 1, 2))).unwrap_or_else(|| corner(w, 2))
}

/// The nearer of two places.
#[inline]
fn nearer(one: Option<Place>, other: Option<Place>) -> Option<Place> {
    match (one, other) {
        (Some(p), Some(q)) => Some(if p.x.norm_squared() <= q.x.norm_squared() { p } else { q }),
        (one, other) => one.or(other),
    }
}

/// A face at the newest vertex, d, as seen from the origin.
#[derive(Clone, Copy)]
struct Seen {
    /// The product of two edges.
    normal: Vec3,
    /// Its square, and that of its product with d: their quotient is the square of the plane's distance.
    whole: f64,
    height: f64,
    /// Shares of the old corners in the origin's foot, times `whole`.
    shares: [f64; 2],
    is_inside: bool,
}

/// The face (p, q, d): `p_d` and `q_d` lead there from d, and `p_x`, `q_x` are their products with d.
#[inline(always)]
fn seen(p_d: Vec3, q_d: Vec3, p_x: Vec3, q_x: Vec3, d: Vec3) -> Seen {
    let normal = p_d.cross(&q_d);
    let (whole, height) = (normal.norm_squared(), normal.dot(&d));
    let (of_p, of_q) = (normal.dot(&q_x), -normal.dot(&p_x));
    // Comparison order matters: a face without area has shares that are not numbers.
    let is_inside = (of_p > 0.0) & (of_q > 0.0) & (whole - of_p - of_q > 0.0);
    Seen { normal, whole, height: height * height, shares: [of_p, of_q], is_inside }
}

/// A guess for an old face and a new vertex: on the nearest of the faces at the new vertex that have the origin's foot inside.
/// No branches but the last, for which face it is nobody could foretell.
#[inline(always)]
fn of_four(w: &[Vec3; 4]) -> Place {
    let [a, b, c, d] = *w;
    let (a_d, b_d, c_d) = (a - d, b - d, c - d);
    let (a_x, b_x, c_x) = (a_d.cross(&d), b_d.cross(&d), c_d.cross(&d));
    let faces = [seen(a_d, b_d, a_x, b_x, d), seen(b_d, c_d, b_x, c_x, d), seen(a_d, c_d, a_x, c_x, d)];
    let mut which = 0;
    for i in 1..3 {
        let [best, one] = [&faces[which], &faces[i]];
        let is_nearer = !best.is_inside | (one.height * best.whole < best.height * one.whole);
        which = if one.is_inside & is_nearer { i } else { which };
    }
    let Seen { normal, whole, shares: [of_p, of_q], is_inside, .. } = faces[which];
    if !is_inside {
        let edges = nearer(nearer(edge(w, 0, 3), edge(w, 1, 3)), edge(w, 2, 3));
        return edges.unwrap_or_else(|| corner(w, 3));
    }
    let (p, q) = [(0, 1), (1, 2), (0, 2)][which];
    let share = 1.0 / whole;
    let (of_p, of_q) = (of_p * share, of_q * share);
    let x = d + (w[p] - d) * of_p + (w[q] - d) * of_q;
    Place { slots: [p, q, 3], weights: [of_p, of_q, 1.0 - of_p - of_q], len: 3, span: normal, x }
}

/// Whether the origin is inside of the tetrahedron, by signs that are beyond doubt.
#[inline]
fn is_clearly_enclosed(w: &[Vec3; 4], extent: f64) -> bool {
    let [a, b, c, d] = w;
    let (ab, bc, ca) = (a.cross(b), b.cross(c), c.cross(a));
    // Six times the volumes with the origin in the place of a vertex.
    let volumes = [a.dot(&bc), -d.dot(&ab), -d.dot(&bc), -d.dot(&ca)];
    let doubt = DOUBT * extent * extent * extent;
    volumes.iter().all(|volume| *volume > doubt) || volumes.iter().all(|volume| *volume < -doubt)
}

/// The nearest of all features; none when four vertices strictly enclose the origin, by an exact test.
#[cold]
fn exhaustive(vertices: &[Vec3]) -> Option<Place> {
    let mut w = [vertices[0]; 4];
    w[..vertices.len()].copy_from_slice(vertices);
    let last = vertices.len();
    if last == 4 && is_enclosed(&w) {
        return None;
    }
    let mut best = corner(&w, 0);
    let mut offer = |place: Option<Place>| {
        if let Some(place) = place
            && place.x.norm_squared() < best.x.norm_squared()
        {
            best = place;
        }
    };
    for i in 0..last {
        offer(Some(corner(&w, i)));
        for j in i + 1..last {
            offer(edge(&w, i, j));
            for k in j + 1..last {
                offer(face(&w, i, j, k));
            }
        }
    }
    Some(best)
}

/// Whether the origin is strictly inside of the tetrahedron. Exact.
fn is_enclosed(&[a, b, c, d]: &[Vec3; 4]) -> bool {
    let origin = ORIGIN;
    let whole = orientation(a, b, c, d);
    let same_side = |p, q, r| orientation(p, q, r, origin) * whole.signum() > 0.0;
    whole != 0.0 && same_side(a, b, c) && same_side(a, d, b) && same_side(a, c, d) && same_side(b, d, c)
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
        Vertex { w, on_a: w, corners: [0; 2] }
    }

    fn of(vertices: &[Vertex]) -> Option<Simplex> {
        let mut simplex = Simplex::point(vertices[0]);
        for (slot, v) in vertices.iter().enumerate() {
            (simplex.w[slot], simplex.from[slot]) = (v.w, Origin { on_a: v.on_a, corners: v.corners });
        }
        simplex.len = vertices.len() - 1;
        simplex.span = match simplex.len {
            3 => (simplex.w[0] - simplex.w[2]).cross(&(simplex.w[1] - simplex.w[2])),
            _ => simplex.w[1] - simplex.w[0],
        };
        simplex.square = f64::INFINITY;
        (simplex.add(&vertices[vertices.len() - 1], 4.0) == Step::Reduced).then_some(simplex)
    }

    #[test]
    fn closest_features_of_a_triangle() {
        let face = of(&[vertex(-1.0, -1.0, 1.0), vertex(2.0, -1.0, 1.0), vertex(-1.0, 2.0, 1.0)]).unwrap();
        assert_eq!(face.len, 3);
        assert!((face.x - Vec3::z()).norm() < 1e-15 && (face.nearest().on_a - Vec3::z()).norm() < 1e-15);
        let edge = of(&[vertex(1.0, -1.0, 0.0), vertex(1.0, 1.0, 0.0), vertex(3.0, 0.0, 0.0)]).unwrap();
        assert_eq!(edge.len, 2);
        assert!((edge.x - Vec3::x()).norm() < 1e-15);
        let corner = of(&[vertex(1.0, 1.0, 0.0), vertex(2.0, 1.5, 0.0), vertex(1.5, 2.0, 0.0)]).unwrap();
        assert_eq!((corner.len, corner.x), (1, Vec3::new(1.0, 1.0, 0.0)));
    }

    #[test]
    fn a_tetrahedron_encloses_only_what_is_strictly_inside() {
        let corners = |lift: f64| {
            [(0.0, 0.0, -1.0), (3.0, 0.0, 0.5), (-2.0, 2.0, 0.5), (-2.0, -2.0, 0.5)]
                .map(|(x, y, z)| vertex(x, y, z + lift))
        };
        let enclosed = |vertices: [Vertex; 4]| of(&vertices).is_none();
        let [a, b, c, d] = corners(0.0);
        assert!(enclosed([a, b, c, d]) && enclosed([b, a, c, d]), "either orientation");
        assert!(!enclosed(corners(1.0)), "the origin is on a vertex");
        assert!(!enclosed(corners(-0.5)), "the origin is on a face");
        assert!(!enclosed([a, a, c, d]), "flat");
    }

    #[test]
    fn coinciding_and_collinear_vertices_are_no_trouble() {
        let p = vertex(1.0, 2.0, 2.0);
        assert_eq!(of(&[p, p]).unwrap().len, 1);
        assert_eq!(of(&[p, p, p]).unwrap().len, 1);
        let line = of(&[vertex(1.0, -1.0, 0.0), vertex(1.0, 1.0, 0.0), vertex(1.0, 3.0, 0.0)]).unwrap();
        assert!((line.x - Vec3::x()).norm() < 1e-15);
    }

    /// Oracle: the least distance over all features, each by projection.
    #[test]
    fn guesses_agree_with_looking_at_every_feature() {
        let mut seed = 1u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        let mut enclosed = 0;
        for round in 0..4000 {
            let count = 2 + round % 3;
            let lift = random();
            let vertices: Vec<Vertex> = (0..count).map(|_| vertex(random(), random(), random() + lift)).collect();
            let w: Vec<Vec3> = vertices.iter().map(|v| v.w).collect();
            match (of(&vertices), exhaustive(&w)) {
                (Some(found), Some(place)) => assert!((found.x - place.x).norm() < 1e-12, "{vertices:?}"),
                (None, None) => enclosed += 1,
                (found, place) => panic!("{found:?}, {:?}", place.map(|place| place.x)),
            }
        }
        assert!(enclosed > 50, "{enclosed}");
    }
}
