//! Which random numbers? The same ones on every machine.

use crate::geometry::{Quaternion, Vec3};

/// A linear congruential generator (Knuth's MMIX constants).
#[derive(Clone, Debug)]
pub(super) struct Random(pub u64);

impl Random {
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * ((self.0 >> 11) as f64 / (1_u64 << 53) as f64)
    }

    /// Below `count`, which is not zero.
    pub fn below(&mut self, count: usize) -> usize {
        (self.between(0.0, count as f64) as usize).min(count - 1)
    }

    pub fn within(&mut self, low: Vec3, high: Vec3) -> Vec3 {
        Vec3::from_fn(|k, _| self.between(low[k], high[k]))
    }

    /// A unit vector.
    pub fn direction(&mut self) -> Vec3 {
        loop {
            let v = self.within(Vec3::repeat(-1.0), Vec3::repeat(1.0));
            if v.norm() > 0.1 && v.norm() < 1.0 {
                return v.normalize();
            }
        }
    }

    /// Any rotation.
    pub fn rotation(&mut self) -> Quaternion {
        loop {
            let [w, x, y, z] = [(); 4].map(|()| self.between(-1.0, 1.0));
            let square = w * w + x * x + y * y + z * z;
            if square > 0.01 && square < 1.0 {
                return Quaternion { w, x, y, z };
            }
        }
    }

    /// Semi-axes of a body of 0.6 to 2 m.
    pub fn radii(&mut self) -> Vec3 {
        self.within(Vec3::repeat(0.3), Vec3::repeat(1.0))
    }
}
