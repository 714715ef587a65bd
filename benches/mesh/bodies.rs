//! Two bumpy balls, and the poses in which they are held against one another.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use clearance::geometry::{Placement, Pose, Quaternion, Shape, TriangleMesh, Vec3};

/// Numbers from a linear congruential generator (Knuth's MMIX constants), the same in every run.
struct Random(u64);

impl Random {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * ((self.0 >> 11) as f64 / (1_u64 << 53) as f64)
    }

    fn vector(&mut self, size: f64) -> Vec3 {
        Vec3::new(self.between(-size, size), self.between(-size, size), self.between(-size, size))
    }
}

/// One question's poses.
pub struct Pair {
    pub at_a: Placement,
    pub at_b: Placement,
}

impl Pair {
    pub fn b_in_a(&self) -> Placement {
        Placement::relative(&self.at_a, &self.at_b)
    }
}

pub struct Bodies {
    pub triangles: [Vec<[Vec3; 3]>; 2],
    pub shapes: [Shape; 2],
    pub sets: Vec<(&'static str, Vec<Pair>)>,
}

const PAIRS: usize = 50;

impl Bodies {
    pub fn new(rings: u32) -> Self {
        let mut random = Random(u64::from(rings));
        let meshes = [bumpy_ball(rings, &mut random), bumpy_ball(rings, &mut random)];
        let (points_a, points_b) = (meshes[0].vertices(), meshes[1].vertices());
        let mut set = |near: f64, far: f64| {
            let pair = |_| {
                let [at_a, mut at_b] = [turned(&mut random), turned(&mut random)];
                let along = random.vector(1.0).normalize();
                let reach = |points: &[Vec3], at: &Placement, d: Vec3| {
                    points.iter().map(|p| at.point(*p).dot(&d)).fold(0.0, f64::max)
                };
                let contact = reach(points_a, &at_a, along) + reach(points_b, &at_b, -along);
                at_b.translation = along * (contact + random.between(near, far));
                Pair { at_a, at_b }
            };
            (0..PAIRS).map(pair).collect()
        };
        let sets = vec![("sep", set(0.5, 2.0)), ("near", set(1e-3, 1e-2)), ("over", set(-0.5, -0.1))];
        let triangles = meshes.each_ref().map(|m| (0..m.triangles().len()).map(|i| m.triangle(i)).collect());
        Self { triangles, shapes: meshes.map(|mesh| Shape::mesh(Arc::new(mesh))), sets }
    }
}

fn turned(random: &mut Random) -> Placement {
    let mut component = || random.between(-1.0, 1.0);
    let rotation = Quaternion { w: component(), x: component(), y: component(), z: component() };
    Pose::new(Vec3::zeros(), rotation).expect("not the zero quaternion").placement()
}

/// A ball of radius about 1 with six waves on it, `rings` rings of as many quads.
fn bumpy_ball(rings: u32, random: &mut Random) -> TriangleMesh {
    let waves: Vec<(Vec3, f64)> = (0..6).map(|_| (random.vector(4.0), random.between(0.0, TAU))).collect();
    let mut vertices = Vec::new();
    for i in 0..=rings {
        let (ring, z) = libm::sincos(PI * f64::from(i) / f64::from(rings));
        for j in 0..rings {
            let (y, x) = libm::sincos(TAU * f64::from(j) / f64::from(rings));
            let d = Vec3::new(ring * x, ring * y, z);
            let height: f64 = waves.iter().map(|(wave, phase)| libm::sin(wave.dot(&d) + phase)).sum();
            // The corners of a pole lie on one another.
            vertices.push(d * (1.0 + 0.08 * height));
        }
    }
    let at = |i: u32, j: u32| i * rings + j % rings;
    let quads = (0..rings).flat_map(|i| (0..rings).map(move |j| (i, j)));
    let faces = quads.flat_map(|(i, j)| {
        let upper = (i > 0).then(|| [at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        let lower = (i + 1 < rings).then(|| [at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
        [upper, lower]
    });
    TriangleMesh::surface(vertices, faces.flatten().collect()).expect("finite corners and good indices")
}
