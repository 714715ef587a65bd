//! The Minkowski difference D = A - B of two bounded cores, in world axes about A's origin, and the bounds collected on it.
//!
//! Lengths are scaled by a power of two so that the extent S = r_A + r_B + |t| is between 1 and 2, and errors are absolute.

use super::body::{Body, Turned};
use super::double_double::Dd;
use super::vector::{DdVector, Vector};

/// Bound of what rounding does to a support value, a point of D or its norm, in scaled lengths, where u^2 = 2^-106: the rotation
/// is off by some 40 u^2, the turned point by 20 more, the round supports by 40, sums and products with unit directions by
/// 30. That is below 150 u^2 S, S < 2; 2^-95 = 2048 u^2 leaves a factor of seven.
pub const ROUNDING: f64 = 1.0 / (1u128 << 95) as f64;

pub struct Difference {
    a: Turned,
    b: Turned,
    /// B's origin from A's.
    offset: DdVector,
    /// What lengths in metres are multiplied by.
    pub scale: f64,
}

impl Difference {
    pub fn new(a: &Body, b: &Body) -> Self {
        let offset = [0, 1, 2].map(|i| Dd::difference(b.translation[i], a.translation[i]));
        let extent = a.core.reach() + b.core.reach() + offset.iter().map(|c| c.hi.abs()).sum::<f64>();
        let scale = if extent > 0.0 { libm::exp2(-libm::log2(extent).floor().clamp(-1000.0, 1000.0)) } else { 1.0 };
        Self {
            a: Turned::new(&a.core, a.rotation, scale),
            b: Turned::new(&b.core, b.rotation, scale),
            offset: Vector(offset.map(|c| c.times_power_of_two(scale))),
            scale,
        }
    }

    /// A point of D where `d . x` is least.
    pub fn lowest(&self, d: &DdVector) -> DdVector {
        self.a.support(&-*d) - self.b.support(d) - self.offset
    }
}

/// What is known of the signed distance of D from the origin, in scaled lengths.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    pub lower: Dd,
    pub upper: Dd,
    /// The unit direction of `lower`, from the origin to D.
    pub direction: DdVector,
}

impl Bounds {
    pub fn unknown() -> Self {
        // Far beyond the extent, which is below 2; not infinite, because a difference of infinities is no number.
        let far = Dd::from(1024.0);
        Self { lower: -far, upper: far, direction: Vector([Dd::ONE, Dd::ZERO, Dd::ZERO]) }
    }

    pub fn width(&self) -> f64 {
        (self.upper - self.lower).hi
    }

    /// `sd >= min over D of d . x`, which `point` of D attains, for every unit d.
    pub fn separates(&mut self, d: &DdVector, point: &DdVector) {
        let bound = d.dot(point) - Dd::from(ROUNDING);
        if bound > self.lower {
            (self.lower, self.direction) = (bound, *d);
        }
    }

    /// The signed distance is at most this: |x| for a point x of D, minus the radius of a ball in D.
    pub fn is_at_most(&mut self, value: Dd) {
        self.upper = self.upper.min(value + Dd::from(ROUNDING));
    }
}
