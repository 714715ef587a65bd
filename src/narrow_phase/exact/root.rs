//! A square root of a quotient of integers less some radii, between two doubles that are next to each other.

use dashu_int::ops::{BitTest, SquareRoot, UnsignedAbs};
use dashu_int::{IBig, UBig};

use super::integers::{Span, ceil, floor, integer};
use crate::narrow_phase::outcome::Bracket;

/// `sqrt(numerator / denominator) * 2^exponent`, or minus that. The denominator is positive.
#[derive(Clone, Debug)]
pub(super) struct Root {
    pub negative: bool,
    pub numerator: IBig,
    pub denominator: IBig,
    pub exponent: i32,
}

/// Bits of the root that are worked out at first. What is left after the radii needs 64, or twice as many are worked out.
const FIRST_BITS: usize = 128;

impl Root {
    pub fn zero() -> Self {
        Self { negative: false, numerator: IBig::ZERO, denominator: IBig::ONE, exponent: 0 }
    }

    /// The root less the sum of the radii (metres, as is the root): both ends are the value where that is a double.
    pub fn less(&self, radii: &[f64]) -> Bracket {
        let span = Span::of(radii.iter().copied());
        let sum = |unit: i32| radii.iter().fold(IBig::ZERO, |sum, r| sum + integer(*r, unit));
        let mut wanted = FIRST_BITS;
        loop {
            let bits_of_quotient = self.numerator.bit_len().saturating_sub(self.denominator.bit_len());
            // The unit 2^(exponent - fraction) resolves the radii and gives the root as many bits as are wanted.
            let for_radii = if span == Span::EMPTY { 0 } else { (self.exponent - span.lowest).max(0) };
            let short = self.denominator.bit_len().saturating_sub(self.numerator.bit_len()) / 2;
            let fraction = (wanted + short).saturating_sub(bits_of_quotient / 2);
            let fraction = fraction.max(usize::try_from(for_radii).unwrap_or(0));
            let unit = self.exponent.saturating_sub(i32::try_from(fraction).unwrap_or(i32::MAX));
            let (root, is_exact) = self.floor_of_root(fraction);
            let root = IBig::from(root);
            let sum = sum(unit);
            let nearer = if self.negative { -&root - &sum } else { &root - &sum };
            let farther = match (is_exact, self.negative) {
                (true, _) => nearer.clone(),
                (false, true) => &nearer - IBig::ONE,
                (false, false) => &nearer + IBig::ONE,
            };
            if is_exact || nearer.bit_len() >= 64 && nearer.sign() == farther.sign() {
                let (low, high) = if self.negative { (farther, nearer) } else { (nearer, farther) };
                return Bracket { lower: floor(&low, unit), upper: ceil(&high, unit) };
            }
            wanted *= 2;
        }
    }

    /// `floor(sqrt(numerator / denominator) * 2^fraction)`, and whether nothing was cut off.
    fn floor_of_root(&self, fraction: usize) -> (UBig, bool) {
        let shifted = (&self.numerator << (2 * fraction)).unsigned_abs();
        let denominator = (&self.denominator).unsigned_abs();
        let quotient = &shifted / &denominator;
        let root = quotient.sqrt();
        let is_exact = &root * &root * denominator == shifted;
        (root, is_exact)
    }
}

/// Which of two roots (their exponents equal) is less.
pub(super) fn compare(one: &Root, other: &Root) -> std::cmp::Ordering {
    let size = |root: &Root, times: &IBig| {
        let size = &root.numerator * times;
        if root.negative { -size } else { size }
    };
    size(one, &other.denominator).cmp(&size(other, &one.denominator))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn root(numerator: i64, denominator: i64, exponent: i32) -> Root {
        Root { negative: false, numerator: numerator.into(), denominator: denominator.into(), exponent }
    }

    #[test]
    fn rational_roots_are_met_exactly_and_others_between_neighbours() {
        assert_eq!(root(9, 4, 0).less(&[0.0]), Bracket { lower: 1.5, upper: 1.5 });
        assert_eq!(root(9, 4, -3).less(&[0.125]), Bracket { lower: 0.0625, upper: 0.0625 });
        assert_eq!(root(25, 1, 0).less(&[2.0, 3.0]), Bracket { lower: 0.0, upper: 0.0 });
        let two = root(2, 1, 0).less(&[]);
        assert_eq!(two, Bracket { lower: std::f64::consts::SQRT_2.next_down(), upper: std::f64::consts::SQRT_2 });
        let depth = Root { negative: true, ..root(2, 1, 0) }.less(&[1.0]);
        assert!(
            depth.lower < depth.upper
                && depth.upper == depth.lower.next_up()
                && (depth.upper + 2.41421356237).abs() < 1e-10
        );
        assert_eq!(Root::zero().less(&[0.25, 0.5]), Bracket { lower: -0.75, upper: -0.75 });
        let third = root(1, 9, 0).less(&[1.0 / 3.0]);
        assert!(
            third.lower > 0.0 && third.upper == third.lower.next_up(),
            "a third is above its nearest double: {third:?}"
        );
    }

    #[test]
    fn what_cancels_is_worked_out_to_its_last_bit() {
        // sqrt(1 + 2^-400) - 1 = 2^-401 and a little less.
        let one = IBig::ONE << 400;
        let near = Root { numerator: &one + IBig::ONE, denominator: one, ..root(0, 1, 0) };
        let left = near.less(&[1.0]);
        let expected = libm::exp2(-401.0);
        assert_eq!((left.lower, left.upper), (expected.next_down(), expected));
        // The same on a scale where subnormal numbers begin.
        let tiny = Root { exponent: -1000, ..near }.less(&[libm::exp2(-1000.0)]);
        assert_eq!((tiny.lower, tiny.upper), (0.0, f64::from_bits(1)));
    }

    #[test]
    fn roots_compare_with_their_signs() {
        let minus = |n, d| Root { negative: true, ..root(n, d, 0) };
        assert!(compare(&root(1, 3, 0), &root(1, 2, 0)).is_lt());
        assert!(compare(&minus(1, 3), &minus(1, 2)).is_gt());
        assert!(compare(&minus(1, 3), &root(0, 5, 0)).is_lt());
        assert!(compare(&root(2, 4, 0), &root(1, 2, 0)).is_eq());
    }
}
