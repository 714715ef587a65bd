//! Fixed shapes and poses: the same bytes in every run and on every machine.

use std::sync::Arc;

use clearance::geometry::{ConvexHull, Placement, Pose, Quaternion, Shape, TriangleMesh, Vec3};
use clearance::narrow_phase::{Goal, separation};
use clearance::scene::{Edit, Epoch, NewBody, Scene, Snapshot};

/// Numbers in 0..1 from a linear congruential generator (Knuth's MMIX constants).
pub struct Random(pub u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// In the cube from -1 to 1.
    pub fn vector(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next()) * 2.0 - Vec3::repeat(1.0)
    }

    fn size(&mut self) -> Vec3 {
        (self.vector() + Vec3::repeat(2.0)) * 0.3
    }

    fn placement(&mut self, translation: Vec3) -> Placement {
        let v = self.vector();
        let rotation = Quaternion { w: 2.0 * self.next() - 1.0, x: v.x, y: v.y, z: v.z };
        Pose::new(translation, rotation).expect("numbers are finite").placement()
    }
}

/// How the pairs of a set lie.
#[derive(Clone, Copy)]
pub enum Lie {
    /// 0.5 to 2 m apart by their supports in a random direction, so a little farther in truth.
    Apart,
    /// 1 to 10 mm apart in the same way.
    Near,
    /// As far in as their centres being half as far apart.
    Overlapping,
}

/// Two placed shapes.
pub struct Pair {
    pub a: Shape,
    pub b: Shape,
    pub at_a: Placement,
    pub at_b: Placement,
}

pub fn pairs(count: usize, lie: Lie, shape: impl Fn(&mut Random) -> Shape) -> Vec<Pair> {
    let mut random = Random(1);
    (0..count)
        .map(|_| {
            let (a, b) = (shape(&mut random), shape(&mut random));
            let direction = random.vector().normalize();
            let at_a = random.placement(Vec3::zeros());
            let gap = match lie {
                Lie::Apart => 0.5 + 1.5 * random.next(),
                Lie::Near | Lie::Overlapping => 0.001 + 0.009 * random.next(),
            };
            let mut at_b = random.placement(direction * 10.0);
            // Ten metres off they are apart; the plane between them then moves with b until it touches a.
            let far = separation(&a, &b, &at_a, &at_b, &Goal::penetration()).expect("both have bounds");
            at_b.translation -= far.normal * (far.signed_distance - gap);
            if matches!(lie, Lie::Overlapping) {
                at_b.translation *= 0.5;
            }
            Pair { a, b, at_a, at_b }
        })
        .collect()
}

pub fn cuboid(random: &mut Random) -> Shape {
    Shape::cuboid(random.size()).expect("sizes are positive")
}

pub fn ellipsoid(random: &mut Random) -> Shape {
    Shape::ellipsoid(random.size()).expect("sizes are positive")
}

/// Points on an ellipsoid, all of them corners.
pub fn hull(random: &mut Random, count: usize) -> Arc<ConvexHull> {
    let radii = random.size();
    let points: Vec<Vec3> = (0..count).map(|_| random.vector().normalize().component_mul(&radii)).collect();
    Arc::new(ConvexHull::new(&points).expect("points are finite"))
}

/// A sphere with bumps, of `2 * around * (rows - 1)` triangles.
pub fn mesh(random: &mut Random, around: u32, rows: u32) -> Shape {
    let waves = random.vector() * 6.0;
    let on_sphere = |row: u32, column: u32| {
        let (sin_polar, cos_polar) = libm::sincos(std::f64::consts::PI * f64::from(row) / f64::from(rows));
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(column) / f64::from(around));
        let out = Vec3::new(sin_polar * cos, sin_polar * sin, cos_polar);
        out * (0.7 + 0.07 * libm::sin(waves.dot(&out)))
    };
    // The poles are the first and the last vertex, the rings between them.
    let mut vertices = vec![on_sphere(0, 0)];
    vertices
        .extend((1..rows).flat_map(|row| (0..around).map(move |column| (row, column))).map(|(r, c)| on_sphere(r, c)));
    vertices.push(on_sphere(rows, 0));
    let (last, at) = (vertices.len() as u32 - 1, |ring: u32, column: u32| 1 + ring * around + column % around);
    let mut triangles = Vec::new();
    for i in 0..around {
        triangles.push([0, at(0, i), at(0, i + 1)]);
        triangles.push([last, at(rows - 2, i + 1), at(rows - 2, i)]);
        for ring in 0..rows - 2 {
            triangles.push([at(ring, i), at(ring + 1, i), at(ring + 1, i + 1)]);
            triangles.push([at(ring, i), at(ring + 1, i + 1), at(ring, i + 1)]);
        }
    }
    Shape::mesh(Arc::new(TriangleMesh::surface(vertices, triangles).expect("indices are in range")))
}

/// A scene of boxes and hulls in a loose heap, some of which touch.
pub fn heap(bodies: usize) -> Arc<Snapshot> {
    let mut random = Random(3);
    let body = |i: usize| {
        let shape = if i.is_multiple_of(2) { cuboid(&mut random) } else { Shape::hull(hull(&mut random, 40)) };
        let v = random.vector() * 3.0;
        let pose = Pose::new(v, Quaternion { w: 1.0, x: v.y, y: v.z, z: v.x }).expect("numbers are finite");
        Edit::AddBody(NewBody::new(format!("body {i}"), Arc::new(shape), pose))
    };
    let mut scene = Scene::new(Epoch(1));
    let edits: Vec<Edit> = (0..bodies).map(body).collect();
    scene.apply(&edits, None).expect("every body may be added");
    scene.snapshot()
}
