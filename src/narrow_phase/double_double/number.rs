//! Numbers of about 106 bits: the unevaluated sum of two doubles.
//!
//! Error-free transformations (Dekker 1971, Knuth) in the composition of Hida, Li and Bailey 2001, in the variants for which
//! Joldes, Muller and Popescu 2017 prove error bounds: with u = 2^-53 a sum is within 3 u^2 of itself, a product within
//! 5 u^2, a quotient within 15 u^2 (and a root within 4 u^2, Lefevre and others 2022), to first order. So every operation
//! is within [`ROUNDOFF`] = 16 u^2 of its result. Products split their factors instead of asking for a fused
//! multiplication, which not every machine has: the bytes are the same everywhere.

use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// `high + low`, where `low` is at most half a unit in the last place of `high`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct DoubleDouble {
    high: f64,
    low: f64,
}

/// Largest relative error of one operation: 2^-102.
pub(super) const ROUNDOFF: f64 = 16.0 / ((1u64 << 53) as f64) / ((1u64 << 53) as f64);

/// The sum and what rounding took off it.
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let of_b = sum - a;
    (sum, (a - (sum - of_b)) + (b - of_b))
}

/// The same where `|a| >= |b|`, or `a` is zero.
fn quick_two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    (sum, b - (sum - a))
}

/// The product and what rounding took off it; sizes within 1e-140 to 1e140, or zero.
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let split = |x: f64| {
        let shifted = 134_217_729.0 * x; // 2^27 + 1
        let high = shifted - (shifted - x);
        (high, x - high)
    };
    let ((ah, al), (bh, bl)) = (split(a), split(b));
    let product = a * b;
    (product, ((ah * bh - product) + ah * bl + al * bh) + al * bl)
}

impl DoubleDouble {
    pub const ZERO: Self = Self { high: 0.0, low: 0.0 };
    pub const ONE: Self = Self { high: 1.0, low: 0.0 };

    /// `a - b` without rounding.
    pub fn difference(a: f64, b: f64) -> Self {
        let (high, low) = two_sum(a, -b);
        Self { high, low }
    }

    pub fn to_f64(self) -> f64 {
        self.high
    }

    /// A double that is not above, next to or equal to the number.
    pub fn floor(self) -> f64 {
        if self.low < 0.0 { self.high.next_down() } else { self.high }
    }

    /// A double that is not below, next to or equal to the number.
    pub fn ceil(self) -> f64 {
        if self.low > 0.0 { self.high.next_up() } else { self.high }
    }

    pub fn abs(self) -> Self {
        if self.high < 0.0 { -self } else { self }
    }

    /// By one Newton step on the root of the double; zero for what is not positive.
    pub fn sqrt(self) -> Self {
        if !(self.high > 0.0) {
            return Self::ZERO;
        }
        let root = self.high.sqrt();
        let (square, rest) = two_product(root, root);
        let left = self - Self { high: square, low: rest };
        let (high, low) = quick_two_sum(root, left.high / (2.0 * root));
        Self { high, low }
    }

    /// Times a power of two.
    pub fn scaled(self, power_of_two: f64) -> Self {
        Self { high: self.high * power_of_two, low: self.low * power_of_two }
    }

    pub fn max(self, other: Self) -> Self {
        if self < other { other } else { self }
    }
}

impl From<f64> for DoubleDouble {
    fn from(high: f64) -> Self {
        Self { high, low: 0.0 }
    }
}

impl Neg for DoubleDouble {
    type Output = Self;
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Add for DoubleDouble {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let (high, low) = two_sum(self.high, other.high);
        let (rest, rest_low) = two_sum(self.low, other.low);
        let (high, low) = quick_two_sum(high, low + rest);
        let (high, low) = quick_two_sum(high, low + rest_low);
        Self { high, low }
    }
}

impl Sub for DoubleDouble {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for DoubleDouble {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let (high, low) = two_product(self.high, other.high);
        let (high, low) = quick_two_sum(high, low + (self.high * other.low + self.low * other.high));
        Self { high, low }
    }
}

impl Div for DoubleDouble {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        let (product, rest) = two_product(first, other.high);
        let (product, rest) = quick_two_sum(product, rest + first * other.low);
        let left = self - Self { high: product, low: rest };
        let (high, low) = quick_two_sum(first, left.high / other.high);
        Self { high, low }
    }
}

impl PartialOrd for DoubleDouble {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        match self.high.partial_cmp(&other.high) {
            Some(Ordering::Equal) => self.low.partial_cmp(&other.low),
            order => order,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dashu_int::IBig;
    use dashu_int::ops::{Abs, BitTest};

    /// The number as an integer times 2^-400; its parts must not go below that.
    fn exact(x: DoubleDouble) -> IBig {
        let part = |x: f64| {
            let bits = x.abs().to_bits();
            let (exponent, fraction) = ((bits >> 52) as i64, bits & ((1 << 52) - 1));
            if exponent == 0 {
                assert_eq!(fraction, 0, "subnormal");
                return IBig::ZERO;
            }
            let shift = exponent - 1075 + 400;
            let n = IBig::from(fraction | 1 << 52);
            let n = if shift >= 0 { n << shift as usize } else { n >> (-shift) as usize };
            if x < 0.0 { -n } else { n }
        };
        part(x.high) + part(x.low)
    }

    fn samples() -> Vec<DoubleDouble> {
        let mut state = 12345u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        (0..300)
            .map(|i| {
                let scale = [1.0, 1e-8, 1e6, 3e-15][i % 4];
                let (high, low) = two_sum(next() * scale, next() * scale * [1e-17, 1e-25, 0.0][i % 3]);
                DoubleDouble { high, low }
            })
            .collect()
    }

    #[test]
    fn every_operation_is_within_its_roundoff() {
        let off = |result: DoubleDouble, truth: IBig, what: &str| {
            // 2^-102 of the truth, and what cutting at 2^-400 takes.
            let allowed = (truth.clone().abs() >> 102) + IBig::from(4);
            assert!((exact(result) - truth).abs() <= allowed, "{what}: {result:?}");
        };
        let one = IBig::ONE << 400;
        let samples = samples();
        for pair in samples.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            let (ea, eb) = (exact(a), exact(b));
            off(a + b, &ea + &eb, "sum");
            off(a - b, &ea - &eb, "difference");
            off(a * b, (&ea * &eb) >> 400, "product");
            if b.abs() > DoubleDouble::from(1e-20) {
                off(a / b, (&ea << 400) / &eb, "quotient");
            }
            let root = a.abs().sqrt();
            let square = (exact(root) * exact(root)) >> 400;
            let allowed = (exact(a.abs()) >> 101) + IBig::from(4);
            assert!((square - exact(a.abs())).abs() <= allowed, "root of {a:?}");
        }
        assert_eq!(exact(DoubleDouble::ONE), one);
        assert!(one.bit_len() == 401);
    }

    #[test]
    fn differences_of_doubles_are_exact_and_rounding_is_directed() {
        let d = DoubleDouble::difference(1.0, 1e-20);
        assert_eq!((d.floor(), d.ceil(), d.to_f64()), (1.0f64.next_down(), 1.0, 1.0));
        assert_eq!((DoubleDouble::from(0.3).floor(), DoubleDouble::from(0.3).ceil()), (0.3, 0.3));
        assert!(DoubleDouble::difference(1e-20, 1.0) < DoubleDouble::from(-1.0).scaled(0.999));
        assert!(
            (DoubleDouble::from(2.0).sqrt() * DoubleDouble::from(2.0).sqrt() - DoubleDouble::from(2.0)).abs().to_f64()
                < 1e-31
        );
        assert_eq!(DoubleDouble::from(-1.0).sqrt(), DoubleDouble::ZERO);
    }
}
