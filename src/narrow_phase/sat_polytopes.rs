//! Two small polytopes by their separating axes: normals of faces, and products of those pairs of edges that can make a face.
//!
//! On the sphere of directions each face of a polytope is a point, its outward normal, and each edge an arc between two of them.
//! The difference A - B has a face over an edge of A and an edge of B just where the arc of the one crosses the reversed arc of
//! the other (Gregorius, "The separating axis test between convex polyhedra", GDC 2013), so most pairs of edges are passed over after
//! four products of a normal and an edge. A pair is passed over only if it misses by more than rounding: one too many costs time,
//! one too few the proof (`docs/derivations/sat.md`).

use super::minkowski::Vertex;
use super::simplex::{Simplex, Step};
use super::small_polytope::{Face, SmallPolytope};
use crate::geometry::Vec3;
use crate::geometry::tolerance::UNIT_ROUNDOFF;

/// Edges whose directions differ by less than this, in radians, are parallel: what face they might make is a sliver, and its width
/// is added to the bound instead.
const PARALLEL: f64 = 1e-14;

/// What the axes tell of two polytopes, in one frame.
pub(super) struct Axes<'a> {
    a: &'a SmallPolytope,
    b: &'a SmallPolytope,
    /// No vertex of the difference is farther from the origin, metres.
    extent: f64,
    /// Unit vector from A to B along which the signed distance is greatest.
    pub normal: Vec3,
    /// That distance, metres.
    pub value: f64,
    /// The signed distance of polytopes that overlap is no more than this, but for the rounding of values.
    pub upper: f64,
    /// Widths of the slivers that were passed over.
    slivers: f64,
}

impl<'a> Axes<'a> {
    /// Looks along all axes that can matter; none when neither polytope has a face.
    pub fn new(a: &'a SmallPolytope, b: &'a SmallPolytope, extent: f64) -> Option<Self> {
        let (value, upper) = (f64::NEG_INFINITY, f64::NEG_INFINITY);
        let mut axes = Self { a, b, extent, normal: Vec3::x(), value, upper, slivers: 0.0 };
        a.faces().iter().for_each(|face| axes.look_along(face.normal, face.turn));
        b.faces().iter().for_each(|face| axes.look_along(-face.normal, face.turn));
        for (ends_a, faces_a) in a.edges() {
            for (ends_b, faces_b) in b.edges() {
                axes.look_across(ends_a, faces_a, ends_b, faces_b);
            }
        }
        axes.upper += axes.slivers;
        (axes.value > f64::NEG_INFINITY).then_some(axes)
    }

    /// Takes note of the signed distance along `normal`, which is turned by up to `turn` from the one that is meant.
    fn look_along(&mut self, normal: Vec3, turn: f64) {
        let value = lowest(self.b, normal) + lowest(self.a, -normal);
        if value > self.value {
            (self.value, self.normal) = (value, normal);
        }
        // The chord of an angle is no longer than the angle.
        self.upper = self.upper.max(value + turn * self.extent);
    }

    fn look_across(&mut self, ends_a: [Vec3; 2], faces_a: [Face; 2], ends_b: [Vec3; 2], faces_b: [Face; 2]) {
        let (along_a, along_b) = (ends_a[1] - ends_a[0], ends_b[1] - ends_b[0]);
        if on_one_side(along_a, faces_b) || on_one_side(along_b, faces_a) {
            return;
        }
        let normal = along_a.cross(&along_b);
        let (length_a, length_b) = (along_a.norm(), along_b.norm());
        let area = normal.norm();
        let sine = area / (length_a * length_b);
        // 7 u of either edge, 4 u of the products, on each of three components.
        let turn = 20.0 * UNIT_ROUNDOFF / sine;
        if !(sine >= PARALLEL) {
            self.slivers += (PARALLEL + 20.0 * UNIT_ROUNDOFF) * length_a.min(length_b);
            return;
        }
        let normal = normal / area;
        for outward in [normal, -normal] {
            // Outward on the arc of A, inward on that of B.
            let side = |faces: [Face; 2]| outward.dot(&(faces[0].normal + faces[1].normal));
            let doubt = 2.0 * turn + 4.0 * (faces_a[0].turn + faces_a[1].turn + faces_b[0].turn + faces_b[1].turn);
            if side(faces_a) < -doubt || side(faces_b) > doubt {
                continue;
            }
            // Along the edges' own product they are no nearer than the shapes are.
            let between = outward.dot(&(ends_b[0] - ends_a[0]));
            if between + (turn + 8.0 * UNIT_ROUNDOFF) * self.extent > self.upper {
                self.look_along(outward, turn);
            }
        }
    }

    /// Points of A and B whose difference is `-value * normal` as nearly as can be, from all corners that are outermost along
    /// the normal within `slack`, metres.
    pub fn contact(&self, slack: f64) -> (Vec3, Vec3) {
        let normal = self.normal;
        let (height_a, height_b) = (-lowest(self.a, -normal), lowest(self.b, normal));
        let top = |p: &&Vec3| normal.dot(p) >= height_a - slack;
        let bottom = |p: &&Vec3| normal.dot(p) <= height_b + slack;
        // The difference of the two features, laid flat: the point of it that lies farthest along a direction.
        let support = |direction: Vec3| {
            let order = |p: &&Vec3, q: &&Vec3| direction.dot(p).total_cmp(&direction.dot(q));
            let on_a = self.a.vertices().iter().filter(top).max_by(order).copied().unwrap_or_default();
            let on_b = self.b.vertices().iter().filter(bottom).min_by(order).copied().unwrap_or_default();
            let apart = on_a - on_b;
            Vertex { w: apart - normal * normal.dot(&apart), on_a, corners: [0; 2] }
        };
        let mut simplex = Simplex::point(support(Vec3::x()));
        // A polygon of two features has at most 128 corners, and every round drops one for good.
        for _ in 0..128 {
            let x = simplex.x;
            if x.norm() <= slack {
                break;
            }
            if simplex.add(&support(-x), self.extent) != Step::Reduced {
                break;
            }
        }
        // The rest of the way is along the normal, and what the features are short of one another.
        let nearest = simplex.nearest();
        (nearest.on_a, nearest.on_a + normal * self.value - nearest.w)
    }
}

/// Least `direction . p` over the corners.
fn lowest(polytope: &SmallPolytope, direction: Vec3) -> f64 {
    polytope.vertices().iter().map(|p| direction.dot(p)).fold(f64::INFINITY, f64::min)
}

/// Whether both normals are, beyond doubt, on one side of the plane across `edge`: then the arc between them does not meet the
/// arc of the edge.
fn on_one_side(edge: Vec3, faces: [Face; 2]) -> bool {
    let [one, other] = faces.map(|face| (edge.dot(&face.normal), (face.turn + 16.0 * UNIT_ROUNDOFF) * edge.norm()));
    (one.0 > one.1 && other.0 > other.1) || (one.0 < -one.1 && other.0 < -other.1)
}
