//! The point of a simplex nearest the origin, in double-doubles.

use arrayvec::ArrayVec;

use super::number::{DoubleDouble, ROUNDOFF};
use super::vector::Vector;

/// A vertex of the scaled difference, and the point of A it came from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Vertex {
    pub w: Vector,
    pub on_a: Vector,
}

/// One to three vertices and the weights that mix the nearest point from them: positive, of sum 1 to rounding.
#[derive(Clone, Debug)]
pub(super) struct Feature {
    pub vertices: ArrayVec<Vertex, 3>,
    weights: ArrayVec<DoubleDouble, 3>,
}

/// What the origin is to a simplex.
pub(super) enum Nearest {
    Outside(Feature),
    /// In or on the tetrahedron, as far as can be told.
    Inside([Vertex; 4]),
}

impl Feature {
    pub fn point(v: Vertex) -> Self {
        Self::of(&[v], &[DoubleDouble::ONE])
    }

    fn of(vertices: &[Vertex], weights: &[DoubleDouble]) -> Self {
        Self { vertices: vertices.iter().copied().collect(), weights: weights.iter().copied().collect() }
    }

    fn mix(&self, of: impl Fn(&Vertex) -> Vector) -> Vector {
        self.vertices.iter().zip(&self.weights).fold(Vector::default(), |sum, (v, weight)| sum + of(v) * *weight)
    }

    /// The nearest point, and the point of A it came from.
    pub fn nearest(&self) -> Vertex {
        Vertex { w: self.mix(|v| v.w), on_a: self.mix(|v| v.on_a) }
    }

    /// From the origin to the feature and perpendicular to it, of length 1; none where that is lost in rounding.
    ///
    /// The nearest point itself would do in exact arithmetic. Rounded it turns by E / |x|, so a face gives its normal, and an
    /// edge what is perpendicular to it in the plane of edge and origin.
    pub fn direction(&self) -> Option<Vector> {
        match self.vertices.as_slice() {
            [a, b, c] => {
                let normal = (b.w - a.w).cross(c.w - a.w).unit()?;
                Some(if normal.dot(self.nearest().w) < DoubleDouble::ZERO { -normal } else { normal })
            }
            [a, b] => {
                let along = (b.w - a.w).unit()?;
                along.cross(a.w.cross(along)).unit()
            }
            _ => self.nearest().w.unit(),
        }
    }

    /// The nearest feature of this one and one more vertex.
    pub fn joined(&self, new: Vertex) -> Nearest {
        match *self.vertices.as_slice() {
            [a] => Nearest::Outside(segment(a, new)),
            [a, b] => Nearest::Outside(triangle(a, b, new)),
            [a, b, c] => tetrahedron([a, b, c, new]),
            _ => Nearest::Outside(Self::point(new)), // A feature has one to three vertices.
        }
    }
}

fn segment(a: Vertex, b: Vertex) -> Feature {
    let along = b.w - a.w;
    let (from_a, from_b) = (-a.w.dot(along), b.w.dot(along));
    let zero = DoubleDouble::ZERO;
    if !(from_a > zero) {
        return Feature::point(a);
    }
    if !(from_b > zero) {
        return Feature::point(b);
    }
    let length = from_a + from_b;
    Feature::of(&[a, b], &[from_b / length, from_a / length])
}

fn triangle(a: Vertex, b: Vertex, c: Vertex) -> Feature {
    let normal = (b.w - a.w).cross(c.w - a.w);
    // Areas between the edges and the foot of the origin.
    let areas = [(b, c), (c, a), (a, b)].map(|(p, q)| normal.dot(p.w.cross(q.w)));
    if areas.iter().all(|area| *area > DoubleDouble::ZERO) {
        let sum = areas[0] + areas[1] + areas[2];
        return Feature::of(&[a, b, c], &areas.map(|area| area / sum));
    }
    nearer(segment(a, b), nearer(segment(b, c), segment(c, a)))
}

fn tetrahedron([a, b, c, d]: [Vertex; 4]) -> Nearest {
    let mut best: Option<Feature> = None;
    for [p, q, r, opposite] in [[a, b, c, d], [a, b, d, c], [a, c, d, b], [b, c, d, a]] {
        let normal = (q.w - p.w).cross(r.w - p.w);
        let origin = -normal.dot(p.w);
        let inner = normal.dot(opposite.w - p.w);
        if origin == DoubleDouble::ZERO || (origin > DoubleDouble::ZERO) != (inner > DoubleDouble::ZERO) {
            let feature = triangle(p, q, r);
            best = Some(match best {
                Some(found) => nearer(found, feature),
                None => feature,
            });
        }
    }
    best.map_or(Nearest::Inside([a, b, c, d]), Nearest::Outside)
}

fn nearer(one: Feature, other: Feature) -> Feature {
    let square = |feature: &Feature| {
        let x = feature.nearest().w;
        x.dot(x)
    };
    if square(&other) < square(&one) { other } else { one }
}

/// Radius of a ball around the origin that is surely in the tetrahedron; none where the origin is not surely inside.
///
/// Inside: the four volumes with the origin in place of a corner have one sign. A volume of three vectors rounds by less
/// than 32 roundings of the product of their lengths. Then no ball that a plane parts from each face can leave the
/// tetrahedron, whatever direction the plane has: the faces' normals may be as inexact as they like.
pub(super) fn inner_ball(vertices: &[Vertex; 4]) -> Option<DoubleDouble> {
    let w = vertices.map(|v| v.w);
    let norms = w.map(|w| w.norm().to_f64());
    let side = |[i, j, k]: [usize; 3]| {
        let volume = w[i].dot(w[j].cross(w[k]));
        let sure = volume.abs().to_f64() > 64.0 * ROUNDOFF * norms[i] * norms[j] * norms[k];
        sure.then_some(volume > DoubleDouble::ZERO)
    };
    let faces = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]];
    let first = side(faces[0])?;
    for face in &faces[1..] {
        if side(*face)? != first {
            return None;
        }
    }
    let mut radius: Option<DoubleDouble> = None;
    for [i, j, k] in faces {
        let normal = (w[j] - w[i]).cross(w[k] - w[i]).unit()?;
        let normal = if first { normal } else { -normal };
        let least =
            [i, j, k].map(|corner| normal.dot(w[corner])).into_iter().reduce(|a, b| if b < a { b } else { a })?;
        radius = Some(radius.map_or(least, |radius| if least < radius { least } else { radius }));
    }
    radius.filter(|radius| *radius > DoubleDouble::ZERO)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Vec3;

    fn vertex(x: f64, y: f64, z: f64) -> Vertex {
        let w = Vector::from(Vec3::new(x, y, z));
        Vertex { w, on_a: w }
    }

    #[test]
    fn the_ball_in_a_tetrahedron_touches_its_nearest_face() {
        // The plane x + y + z = 1 is the nearest to (0.1, 0.1, 0.1) shifted into the origin: 0.7 / sqrt(3)... the others are 0.1.
        let corners =
            |s: f64| [vertex(-s, -s, -s), vertex(1.0 - s, -s, -s), vertex(-s, 1.0 - s, -s), vertex(-s, -s, 1.0 - s)];
        let ball = inner_ball(&corners(0.1)).unwrap().to_f64();
        assert!((ball - 0.1).abs() < 1e-16);
        let [a, b, c, d] = corners(0.25);
        let near = inner_ball(&[b, a, c, d]).unwrap().to_f64();
        assert!((near - 0.25 / 3f64.sqrt()).abs() < 1e-15, "either orientation: {near}");
        assert!(inner_ball(&corners(0.0)).is_none(), "a corner is the origin");
        assert!(inner_ball(&corners(1.0 / 3.0 + 1e-3)).is_none() && inner_ball(&[a, a, c, d]).is_none());
    }

    #[test]
    fn features_of_a_growing_simplex_are_the_nearest() {
        let feature = Feature::point(vertex(2.0, -1.0, 1.0));
        let Nearest::Outside(edge) = feature.joined(vertex(-1.0, -1.0, 1.0)) else { panic!() };
        assert_eq!(edge.nearest().w.rounded(), Vec3::new(0.0, -1.0, 1.0));
        let Nearest::Outside(face) = edge.joined(vertex(-1.0, 2.0, 1.0)) else { panic!() };
        assert!((face.nearest().w.rounded() - Vec3::z()).norm() < 1e-30);
        assert!((face.direction().unwrap().rounded() - Vec3::z()).norm() < 1e-30);
        assert!(matches!(face.joined(vertex(0.0, 0.0, -1.0)), Nearest::Inside(_)));
    }
}
