//! Numbers of about 106 bits: the unevaluated sum of two doubles.
//!
//! Sums, products and quotients of two such numbers are off by at most 3, 5 and 15 u^2 of the result, u = 2^-53 (Joldes,
//! Muller, Popescu, "Tight and rigorous error bounds for basic building blocks of double-word arithmetic", ACM TOMS
//! 2017), as long as nothing over- or underflows. Error-free products are Dekker's, so no fused instruction is needed.

use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// `hi + lo`, where `hi` is the double nearest to the sum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dd {
    pub hi: f64,
    pub lo: f64,
}

/// The sum, and exactly what rounding left out of it. Knuth.
#[inline]
fn two_sum(a: f64, b: f64) -> Dd {
    let hi = a + b;
    let rounded_b = hi - a;
    Dd { hi, lo: (a - (hi - rounded_b)) + (b - rounded_b) }
}

/// The same where |a| >= |b|. Dekker.
#[inline]
fn quick_two_sum(a: f64, b: f64) -> Dd {
    let hi = a + b;
    Dd { hi, lo: b - (hi - a) }
}

/// The product, and exactly what rounding left out of it. Dekker, with Veltkamp's splitting.
#[inline]
fn two_product(a: f64, b: f64) -> Dd {
    let split = |x: f64| {
        let big = 134_217_729.0 * x; // 2^27 + 1
        let high = big - (big - x);
        (high, x - high)
    };
    let hi = a * b;
    let ((a1, a2), (b1, b2)) = (split(a), split(b));
    Dd { hi, lo: ((a1 * b1 - hi) + a1 * b2 + a2 * b1) + a2 * b2 }
}

impl Dd {
    pub const ZERO: Self = Self { hi: 0.0, lo: 0.0 };
    pub const ONE: Self = Self { hi: 1.0, lo: 0.0 };

    /// a - b, exactly.
    pub fn difference(a: f64, b: f64) -> Self {
        two_sum(a, -b)
    }

    pub fn sqrt(self) -> Self {
        if self.hi <= 0.0 {
            return Self::ZERO;
        }
        // Two Newton steps from the double's root: the first gives 106 bits, the second mends the last of them.
        let root = Self::from(self.hi.sqrt());
        let root = root + (self - root * root) / (root + root);
        root + (self - root * root) / (root + root)
    }

    pub fn abs(self) -> Self {
        if self < Self::ZERO { -self } else { self }
    }

    pub fn max(self, other: Self) -> Self {
        if self < other { other } else { self }
    }

    pub fn min(self, other: Self) -> Self {
        if other < self { other } else { self }
    }

    /// Times a power of two: exact unless it underflows.
    pub fn times_power_of_two(self, factor: f64) -> Self {
        Self { hi: self.hi * factor, lo: self.lo * factor }
    }
}

impl From<f64> for Dd {
    fn from(x: f64) -> Self {
        Self { hi: x, lo: 0.0 }
    }
}

impl Add for Dd {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        let (high, low) = (two_sum(self.hi, other.hi), two_sum(self.lo, other.lo));
        let sum = quick_two_sum(high.hi, high.lo + low.hi);
        quick_two_sum(sum.hi, sum.lo + low.lo)
    }
}

impl Neg for Dd {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self { hi: -self.hi, lo: -self.lo }
    }
}

impl Sub for Dd {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Dd {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        let product = two_product(self.hi, other.hi);
        quick_two_sum(product.hi, product.lo + (self.hi * other.lo + self.lo * other.hi))
    }
}

impl Div for Dd {
    type Output = Self;
    /// Long division: three digits of 53 bits, so that the last one mends the roundings of the others.
    fn div(self, other: Self) -> Self {
        let first = self.hi / other.hi;
        let rest = self - other * Self::from(first);
        let second = rest.hi / other.hi;
        let rest = rest - other * Self::from(second);
        quick_two_sum(first, second) + Self::from(rest.hi / other.hi)
    }
}

impl PartialOrd for Dd {
    #[inline]
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        let high = self.hi.partial_cmp(&other.hi)?;
        Some(if high == Ordering::Equal { self.lo.partial_cmp(&other.lo)? } else { high })
    }
}
