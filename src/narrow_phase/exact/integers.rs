//! Doubles as integers times a power of two, and back with the rounding that is asked for.

use dashu_int::ops::{BitTest, UnsignedAbs};
use dashu_int::{IBig, Sign, UBig};

/// `x = mantissa * 2^exponent` without rounding, the mantissa odd; none for zero.
fn decoded(x: f64) -> Option<(i64, i32)> {
    let bits = x.to_bits();
    let fraction = (bits & ((1 << 52) - 1)).cast_signed();
    let biased = (bits >> 52 & 0x7ff) as i32; // 11 bits
    let (mantissa, exponent) = if biased == 0 { (fraction, -1074) } else { (fraction | 1 << 52, biased - 1075) };
    if mantissa == 0 {
        return None;
    }
    let zeros = mantissa.trailing_zeros();
    let mantissa = mantissa >> zeros;
    Some((if x < 0.0 { -mantissa } else { mantissa }, exponent + zeros.cast_signed()))
}

/// Exponents of the lowest and, plus one, of the highest bit that is set in any of the doubles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Span {
    pub lowest: i32,
    pub highest: i32,
}

impl Span {
    /// Of no numbers but zeros: anything is lower than it and higher than it.
    pub const EMPTY: Self = Self { lowest: i32::MAX, highest: i32::MIN };

    pub fn of(numbers: impl IntoIterator<Item = f64>) -> Self {
        numbers.into_iter().filter_map(decoded).fold(Self::EMPTY, |span, (mantissa, exponent)| Self {
            lowest: span.lowest.min(exponent),
            highest: span.highest.max(exponent + 64 - mantissa.unsigned_abs().leading_zeros().cast_signed()),
        })
    }

    pub fn union(self, other: Self) -> Self {
        Self { lowest: self.lowest.min(other.lowest), highest: self.highest.max(other.highest) }
    }

    /// How many bits an integer needs that holds any of the numbers.
    pub fn bits(self) -> usize {
        usize::try_from(self.highest.saturating_sub(self.lowest)).unwrap_or(0)
    }
}

/// `x / 2^exponent`, where no bit of x is below that.
pub(super) fn integer(x: f64, exponent: i32) -> IBig {
    decoded(x)
        .map_or(IBig::ZERO, |(mantissa, own)| IBig::from(mantissa) << usize::try_from(own - exponent).unwrap_or(0))
}

/// `n * 2^exponent` to about 2^-52 of itself; 0 and infinity beyond the doubles.
pub(super) fn approximate(n: &IBig, exponent: i32) -> f64 {
    let bits = n.bit_len();
    if bits <= 1000 {
        return libm::scalbn(n.to_f64().value(), exponent);
    }
    let dropped = bits - 64;
    libm::scalbn((n >> dropped).to_f64().value(), exponent.saturating_add(i32::try_from(dropped).unwrap_or(i32::MAX)))
}

/// The greatest double that is not above `n * 2^exponent`. Finite: the largest double stands for all above it.
pub(super) fn floor(n: &IBig, exponent: i32) -> f64 {
    directed(n, exponent, n.sign() == Sign::Negative)
}

/// The least double that is not below `n * 2^exponent`.
pub(super) fn ceil(n: &IBig, exponent: i32) -> f64 {
    directed(n, exponent, n.sign() == Sign::Positive)
}

fn directed(n: &IBig, exponent: i32, away_from_zero: bool) -> f64 {
    let size: UBig = n.unsigned_abs();
    // Bits beyond the 53 of a double, or below its least exponent.
    let beyond = i32::try_from(size.bit_len()).unwrap_or(i32::MAX).saturating_sub(53);
    let dropped = beyond.max((-1074i32).saturating_sub(exponent)).max(0);
    let drop = usize::try_from(dropped).unwrap_or(0);
    let inexact = size.trailing_zeros().is_some_and(|zeros| zeros < drop);
    let mut kept = size >> drop;
    if inexact && away_from_zero {
        kept += UBig::ONE;
    }
    // At most 2^53, and no bit is lost below the least exponent.
    let magnitude = libm::scalbn(kept.to_f64().value(), exponent.saturating_add(dropped)).min(f64::MAX);
    if n.sign() == Sign::Negative { -magnitude } else { magnitude }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn doubles_are_integers_at_their_lowest_bit_and_come_back() {
        let tiny = f64::from_bits(1);
        for x in [1.0, -0.1, 6.0, 1e300, -1e-300, tiny, -f64::MIN_POSITIVE, f64::MAX, std::f64::consts::PI] {
            let span = Span::of([x, 0.0]);
            let n = integer(x, span.lowest);
            assert!(n.trailing_zeros() == Some(0) && n.bit_len() == span.bits(), "{x}");
            let back = [floor(&n, span.lowest), ceil(&n, span.lowest), approximate(&n, span.lowest)];
            assert_eq!(back, [x; 3]);
        }
        assert_eq!(Span::of([0.0, -0.0]).bits(), 0);
        assert_eq!(integer(-6.0, -1), IBig::from(-12));
    }

    #[test]
    fn rounding_goes_to_the_neighbours_on_either_side() {
        let third = (IBig::ONE << 2000) / IBig::from(3);
        let (below, above) = (floor(&third, -2000), ceil(&third, -2000));
        assert_eq!((below, above), (1.0 / 3.0, (1.0f64 / 3.0).next_up()));
        assert_eq!((floor(&-&third, -2000), ceil(&-&third, -2000)), (-above, -below));
        assert!((approximate(&third, -2000) - 1.0 / 3.0).abs() < 1e-16);
        // Below the least double and above the largest.
        assert_eq!((floor(&IBig::ONE, -1080), ceil(&IBig::ONE, -1080)), (0.0, f64::from_bits(1)));
        assert_eq!((floor(&-IBig::ONE, -1080), ceil(&-IBig::ONE, -1080)), (-f64::from_bits(1), 0.0));
        assert_eq!(ceil(&IBig::ONE, 5000), f64::MAX);
        assert_eq!(ceil(&IBig::from(3), -1075), f64::from_bits(2), "a subnormal keeps fewer bits");
    }
}
