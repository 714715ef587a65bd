//! Numbers of twice the digits, for truths about ellipsoids: unevaluated sums of two doubles (Dekker 1971).

use std::ops::{Add, Mul, Sub};

/// `high + low`, `low` at most half a unit in the last place of `high`. A result is off by some 1e-31 of its size.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Double2 {
    pub high: f64,
    pub low: f64,
}

fn two_sum(a: f64, b: f64) -> Double2 {
    let high = a + b;
    let part = high - a;
    Double2 { high, low: (a - (high - part)) + (b - part) }
}

fn quick(high: f64, low: f64) -> Double2 {
    let sum = high + low;
    Double2 { high: sum, low: low - (sum - high) }
}

impl Double2 {
    pub fn of(value: f64) -> Self {
        Self { high: value, low: 0.0 }
    }

    /// Of a number that is not negative, by one Newton step.
    pub fn sqrt(self) -> Self {
        if self.high <= 0.0 {
            return Self::default();
        }
        let root = self.high.sqrt();
        let rest = self - Self::of(root) * Self::of(root);
        quick(root, rest.high / (2.0 * root))
    }

    pub fn over(self, by: Self) -> Self {
        let first = self.high / by.high;
        let rest = self - by * Self::of(first);
        let second = rest.high / by.high;
        let rest = rest - by * Self::of(second);
        quick(first, second) + Self::of(rest.high / by.high)
    }
}

impl Add for Double2 {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let (high, low) = (two_sum(self.high, other.high), two_sum(self.low, other.low));
        let sum = quick(high.high, high.low + low.high);
        quick(sum.high, sum.low + low.low)
    }
}

impl Sub for Double2 {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        let (high, low) = (two_sum(self.high, -other.high), two_sum(self.low, -other.low));
        let sum = quick(high.high, high.low + low.high);
        quick(sum.high, sum.low + low.low)
    }
}

impl Mul for Double2 {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let high = self.high * other.high;
        let rest = self.high.mul_add(other.high, -high);
        quick(high, rest + (self.high * other.low + self.low * other.high))
    }
}

/// A vector of such numbers.
pub(super) type Vector = [Double2; 3];

pub(super) fn dot(a: Vector, b: Vector) -> Double2 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn length(a: Vector) -> Double2 {
    dot(a, a).sqrt()
}

pub(super) fn scaled(a: Vector, by: Double2) -> Vector {
    a.map(|x| x * by)
}

pub(super) fn sum(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|k| a[k] + b[k])
}

pub(super) fn difference(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|k| a[k] - b[k])
}

pub(super) fn product(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|k| a[k] * b[k])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thirty_digits_are_kept() {
        // 1/3 and the root of 2 multiplied back: oracle is the integer they came from.
        let third = Double2::of(1.0).over(Double2::of(3.0));
        let one = third * Double2::of(3.0) - Double2::of(1.0);
        assert!(one.high.abs() < 1e-31, "{one:?}");
        assert!(third.low != 0.0);
        let root = Double2::of(2.0).sqrt();
        let two = root * root - Double2::of(2.0);
        assert!(two.high.abs() < 1e-30, "{two:?}");
        // (1 + 2^-80) - 1, which a double loses.
        let tiny = libm::exp2(-80.0);
        assert_eq!((Double2::of(1.0) + Double2::of(tiny) - Double2::of(1.0)).high, tiny);
    }
}
