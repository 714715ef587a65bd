//! Shapes and poses for tests: one of every kind, and a small generator whose seed is in the test.

use clearance::geometry::{Placement, Pose, Quaternion, Shape, Vec3};

/// A linear congruential generator (Knuth's MMIX constants): the same numbers on every machine.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(1))
    }

    /// Uniform in `low..high`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * ((self.0 >> 11) as f64 / (1u64 << 53) as f64)
    }

    /// A power of ten with an exponent uniform in `low..high`.
    pub fn magnitude(&mut self, low: f64, high: f64) -> f64 {
        libm::pow(10.0, self.between(low, high))
    }

    /// Uniform in `0..count`.
    pub fn index(&mut self, count: usize) -> usize {
        self.between(0.0, count as f64) as usize
    }

    /// True once in `count` times.
    pub fn one_in(&mut self, count: usize) -> bool {
        self.index(count) == 0
    }

    pub fn vector(&mut self, size: f64) -> Vec3 {
        Vec3::new(self.between(-size, size), self.between(-size, size), self.between(-size, size))
    }

    pub fn pose(&mut self, size: f64) -> Pose {
        let mut component = || self.between(-1.0, 1.0);
        let rotation = Quaternion { w: component(), x: component(), y: component(), z: component() };
        Pose::new(self.vector(size), rotation).unwrap()
    }

    pub fn direction(&mut self) -> Vec3 {
        loop {
            let v = self.vector(1.0);
            if v.norm() > 0.1 && v.norm() < 1.0 {
                return v.normalize();
            }
        }
    }
}

/// One shape of every convex, bounded kind, some of them swept; about half a metre in size.
pub fn convex_shapes() -> Vec<Shape> {
    let v = Vec3::new;
    let mut random = Random::new(7);
    let cloud: Vec<Vec3> = (0..40).map(|_| random.direction().component_mul(&v(0.5, 0.3, 0.4))).collect();
    vec![
        Shape::sphere(0.4).unwrap(),
        Shape::point(),
        Shape::cuboid(v(0.3, 0.4, 0.5)).unwrap(),
        Shape::cuboid(v(0.3, 0.0, 0.5)).unwrap(),
        Shape::cuboid(v(0.2, 0.3, 0.1)).unwrap().swept(0.1).unwrap(),
        Shape::capsule(0.2, 0.4).unwrap(),
        Shape::cylinder(0.3, 0.4).unwrap(),
        Shape::cone(0.4, 0.5).unwrap(),
        Shape::cone(0.2, 0.3).unwrap().swept(0.05).unwrap(),
        Shape::ellipsoid(v(0.2, 0.5, 0.3)).unwrap(),
        Shape::convex(&cloud).unwrap(),
        Shape::triangle(v(0.4, 0.0, 0.1), v(-0.2, 0.5, 0.0), v(-0.3, -0.3, -0.2)).unwrap(),
        Shape::segment(v(-0.5, 0.1, 0.0), v(0.4, 0.2, 0.3)).unwrap(),
    ]
}

/// Translation alone.
pub fn at(x: f64, y: f64, z: f64) -> Placement {
    Pose::new(Vec3::new(x, y, z), Quaternion::IDENTITY).unwrap().placement()
}
