//! Numbers from a linear congruential generator (Knuth's MMIX constants), the same in every run.

use clearance::geometry::Vec3;

pub struct Random(pub u64);

impl Random {
    /// In 0..1.
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// In 0..count.
    pub fn below(&mut self, count: usize) -> usize {
        ((self.next() * count as f64) as usize).min(count - 1)
    }

    pub fn vector(&mut self, side: f64) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next()) * side
    }
}
