//! parry's own queries, as it ships them. It has no settings, so there is one configuration for each kind of pair.
//!
//! It has no ellipsoid: there its functions for support maps run on a support function of ours. Tracks are followed
//! cold and warm with its GJK, whose simplex starts from the direction that the step before ended with.

use std::f64::consts::FRAC_PI_2;
use std::panic::{self, AssertUnwindSafe};

use clearance_peers::contender::{Answer, Contender, Pass};
use clearance_peers::pairs::{Kind, PairSet, Pairs, PoseRecord, ShapeRecord};

use super::parry::math::{Pose, Real, Rotation, Vector};
use super::parry::query::details;
use super::parry::query::gjk::{self, CsoPoint, GJKResult, VoronoiSimplex};
use super::parry::query::{contact, distance, intersection_test};
use super::parry::shape::{Capsule, ConvexPolyhedron, SharedShape, SupportMap, TriMesh};

pub struct Parry<'a> {
    pairs: &'a Pairs,
    shapes: Vec<Option<SharedShape>>,
    ellipsoids: Vec<Ellipsoid>,
}

impl<'a> Parry<'a> {
    pub fn new(pairs: &'a Pairs) -> Self {
        // It panics in some overlaps; those pairs are without an answer, and the report counts them.
        panic::set_hook(Box::new(|_| {}));
        let ellipsoid =
            |record: &ShapeRecord| Ellipsoid(vector([record.params[0], record.params[1], record.params[2]]));
        Self {
            pairs,
            shapes: pairs.shapes.iter().map(shape).collect(),
            ellipsoids: pairs.shapes.iter().map(ellipsoid).collect(),
        }
    }

    fn shape(&self, index: usize) -> &SharedShape {
        self.shapes[index].as_ref().expect("every kind but the ellipsoid was built")
    }

    fn hull(&self, index: usize) -> &ConvexPolyhedron {
        self.shape(index).as_convex_polyhedron().expect("a set of tracks holds hulls")
    }

    fn ask_shapes(&self, operation: &str, placed: &[Placed], pass: &mut Pass) {
        match operation {
            "distance" => pass.run(
                |i| {
                    let p = &placed[i];
                    distance(&p.at_a, &**self.shape(p.a), &p.at_b, &**self.shape(p.b))
                },
                |found| Answer::from(found.map_or(f64::NAN, |found| as_double(found.distance))),
            ),
            "collide" => pass.run(
                |i| {
                    let p = &placed[i];
                    intersection_test(&p.at_a, &**self.shape(p.a), &p.at_b, &**self.shape(p.b))
                },
                |found| Answer::from(found.map_or(f64::NAN, |found| f64::from(u8::from(found.intersecting)))),
            ),
            _ => pass.run(
                |i| {
                    let p = &placed[i];
                    let ask = || contact(&p.at_a, &**self.shape(p.a), &p.at_b, &**self.shape(p.b), BEYOND_ALL);
                    panic::catch_unwind(AssertUnwindSafe(ask))
                },
                |found| {
                    let contact = found.ok().and_then(Result::ok).flatten();
                    Answer::from(contact.map_or(f64::NAN, |contact| as_double(contact.dist)))
                },
            ),
        }
    }

    fn ask_ellipsoids(&self, operation: &str, placed: &[Placed], pass: &mut Pass) {
        let of = |p: &Placed| (p.at_a.inv_mul(&p.at_b), &self.ellipsoids[p.a], &self.ellipsoids[p.b]);
        match operation {
            "distance" => pass.run(
                |i| {
                    let (b_in_a, a, b) = of(&placed[i]);
                    details::distance_support_map_support_map(&b_in_a, a, b)
                },
                |found| Answer::from(as_double(found)),
            ),
            "collide" => pass.run(
                |i| {
                    let (b_in_a, a, b) = of(&placed[i]);
                    details::intersection_test_support_map_support_map(&b_in_a, a, b)
                },
                |touching| Answer::from(f64::from(u8::from(touching))),
            ),
            _ => pass.run(
                |i| {
                    let (b_in_a, a, b) = of(&placed[i]);
                    details::contact_support_map_support_map(&b_in_a, a, b, BEYOND_ALL)
                },
                |found| Answer::from(found.map_or(f64::NAN, |contact| as_double(contact.dist))),
            ),
        }
    }

    fn follow_tracks(&self, length: usize, warm: bool, placed: &[Placed], pass: &mut Pass) {
        let mut simplex = VoronoiSimplex::new();
        let mut direction = Vector::X;
        pass.run(
            |i| {
                let (a, b) = (self.hull(placed[i].a), self.hull(placed[i].b));
                let b_in_a = placed[i].at_a.inv_mul(&placed[i].at_b);
                if !warm || i % length == 0 {
                    direction = -b_in_a.translation.normalize();
                }
                simplex.reset(CsoPoint::from_shapes(&b_in_a, a, b, direction));
                match gjk::closest_points(&b_in_a, a, b, Real::MAX, true, &mut simplex) {
                    GJKResult::ClosestPoints(on_a, on_b, last) => {
                        direction = last;
                        (on_a - on_b).length()
                    }
                    GJKResult::Intersection | GJKResult::Proximity(_) | GJKResult::NoIntersection(_) => 0.0,
                }
            },
            |found| Answer::from(as_double(found)),
        );
    }
}

impl Contender for Parry<'_> {
    fn configs(&self, set: &PairSet, operation: &str) -> Vec<String> {
        let names: &[&str] = match operation {
            "penetration" if set.name.starts_with("mesh") => &[],
            "distance" if set.track_length > 0 => &["cold", "warm"],
            _ if set.track_length > 0 => &[],
            _ if set.name.contains("ellell") => &["own_support"],
            _ => &["default"],
        };
        names.iter().map(|name| (*name).to_owned()).collect()
    }

    fn ask(&mut self, set: &PairSet, operation: &str, config: &str, pass: &mut Pass) {
        let kind = |shape: usize| self.pairs.shapes[shape].kind;
        let placed: Vec<Placed> = (self.pairs.of(set).iter())
            .map(|p| Placed { a: p.a, b: p.b, at_a: pose(&p.at_a, kind(p.a)), at_b: pose(&p.at_b, kind(p.b)) })
            .collect();
        match config {
            "own_support" => self.ask_ellipsoids(operation, &placed, pass),
            "default" => self.ask_shapes(operation, &placed, pass),
            other => self.follow_tracks(set.track_length, other == "warm", &placed, pass),
        }
    }
}

/// A contact is asked for however far apart the shapes are; metres.
const BEYOND_ALL: Real = 1e9;

struct Placed {
    a: usize,
    b: usize,
    at_a: Pose,
    at_b: Pose,
}

/// Semi-axes.
struct Ellipsoid(Vector);

impl SupportMap for Ellipsoid {
    fn local_support_point(&self, direction: Vector) -> Vector {
        let stretched = direction * self.0;
        let length = stretched.length();
        if length > 0.0 { stretched * self.0 / length } else { Vector::new(self.0.x, 0.0, 0.0) }
    }
}

#[expect(clippy::useless_conversion, reason = "it is one in the contender of the other precision")]
fn as_double(value: Real) -> f64 {
    f64::from(value)
}

fn vector(v: [f64; 3]) -> Vector {
    Vector::new(v[0] as Real, v[1] as Real, v[2] as Real)
}

fn shape(record: &ShapeRecord) -> Option<SharedShape> {
    let [p, q, r, _] = record.params.map(|size| size as Real);
    let vertices = || record.vertices.iter().copied().map(vector).collect();
    Some(match record.kind {
        Kind::Hull => SharedShape::new(ConvexPolyhedron::from_convex_mesh(vertices(), &record.triangles)?),
        Kind::Sphere => SharedShape::ball(p),
        Kind::Box => SharedShape::cuboid(p, q, r),
        Kind::Capsule => SharedShape::new(Capsule::new_z(q, p)),
        Kind::Cylinder => SharedShape::cylinder(q, p),
        Kind::Cone => SharedShape::cone(q, p),
        Kind::Ellipsoid => return None,
        Kind::Mesh => SharedShape::new(TriMesh::new(vertices(), record.triangles.clone()).ok()?),
    })
}

/// Its cylinders and cones stand along y, those of the pairs along z.
fn pose(pose: &PoseRecord, kind: Kind) -> Pose {
    let [x, y, z, w] = pose.rotation.map(|component| component as Real);
    let rotation = Rotation::from_xyzw(x, y, z, w).normalize();
    let upright = match kind {
        Kind::Cylinder | Kind::Cone => rotation * Rotation::from_rotation_x(FRAC_PI_2 as Real),
        Kind::Hull | Kind::Sphere | Kind::Box | Kind::Capsule | Kind::Ellipsoid | Kind::Mesh => rotation,
    };
    Pose::from_parts(vector(pose.translation), upright)
}
