//! Small polytopes, by trying every direction that can be the best one.
//!
//! The signed distance is the greatest `m(n) = (min n . a - max n . b) / |n|` over all directions n, and it is attained where
//! the polytope A - B is nearest the origin: at a face (n a normal of three corners of A, of three of B, or of two
//! and two), at an edge (n from the origin straight to the line through a difference of corners along a pair of corners), or at a
//! corner. All triples and pairs are tried, whether they are faces and edges or not: a direction too many is only a bound
//! too low. Over big integers nothing is rounded until the one quotient and root at the end.

use num_bigint::{BigInt, BigUint, Sign};

use super::body::Body;
use super::double_double::Dd;
use super::vector::Vector;

/// `m(n) |n|` and `|n|^2` of the best direction.
struct Best {
    value: BigInt,
    square: BigInt,
}

/// The best direction for two sets of corners in one frame; none when all corners coincide.
fn best_direction(a: &[Vector<BigInt>], b: &[Vector<BigInt>]) -> Option<Best> {
    let mut best: Option<Best> = None;
    let mut attempt = |n: &Vector<BigInt>| {
        let square = n.square();
        if square == BigInt::ZERO {
            return;
        }
        let along = |points: &[Vector<BigInt>]| points.iter().map(|p| n.dot(p)).collect::<Vec<BigInt>>();
        let (of_a, of_b) = (along(a), along(b));
        let least = |of: &[BigInt]| of.iter().fold(of[0].clone(), |m, x| if *x < m { x.clone() } else { m });
        let most = |of: &[BigInt]| of.iter().fold(of[0].clone(), |m, x| if *x > m { x.clone() } else { m });
        // n and -n at once.
        for value in [least(&of_a) - most(&of_b), least(&of_b) - most(&of_a)] {
            if best.as_ref().is_none_or(|best| is_more(&value, &square, best)) {
                best = Some(Best { value, square: square.clone() });
            }
        }
    };
    let edges = |points: &[Vector<BigInt>]| {
        let mut found = Vec::new();
        for (i, p) in points.iter().enumerate() {
            found.extend(points[..i].iter().map(|q| p.clone() - q.clone()));
        }
        found
    };
    let (edges_a, edges_b) = (edges(a), edges(b));
    for one in [a, b] {
        for (i, p) in one.iter().enumerate() {
            for (j, q) in one[..i].iter().enumerate() {
                for r in &one[..j] {
                    attempt(&(q.clone() - p.clone()).cross(&(r.clone() - p.clone())));
                }
            }
        }
    }
    for one in &edges_a {
        edges_b.iter().for_each(|other| attempt(&one.cross(other)));
    }
    // Across a difference that is a segment with the origin on its line, for which none of the others is across.
    let axes = [0, 1, 2].map(|i| Vector([0, 1, 2].map(|j| BigInt::from(i32::from(i == j)))));
    for edge in edges_a.iter().chain(&edges_b) {
        axes.iter().for_each(|axis| attempt(&edge.cross(axis)));
    }
    for p in a {
        for q in b {
            let corner = p.clone() - q.clone();
            attempt(&corner);
            for edge in edges_a.iter().chain(&edges_b) {
                attempt(&(corner.times(&edge.square()) - edge.times(&corner.dot(edge))));
            }
        }
    }
    best
}

/// Whether value / sqrt(square) is more than the best so far, without a root.
fn is_more(value: &BigInt, square: &BigInt, best: &Best) -> bool {
    let positive = (*value >= BigInt::ZERO, best.value >= BigInt::ZERO);
    let one = value * value * &best.square;
    let other = &best.value * &best.value * square;
    match positive {
        (true, false) => true,
        (false, true) => false,
        (true, true) => one > other,
        (false, false) => one < other,
    }
}

/// The signed distance of two polytopes, rounded once, to about 1e-30 of itself; none when one is not a polytope.
pub fn exact(a: &Body, b: &Body) -> Option<Dd> {
    let (corners_a, corners_b) = (a.core.corners()?, b.core.corners()?);
    // One unit of length for all numbers: the last place of the finest of them.
    let lengths = || corners_a.iter().chain(&corners_b).chain([&a.translation, &b.translation]).flatten();
    let exponent = lengths().filter(|c| **c != 0.0).map(|c| last_place(*c)).min().unwrap_or(0);
    let whole = |v: &[f64; 3]| Vector(v.map(|c| integer(c, exponent)));
    let ((turn_a, norm_a), (turn_b, norm_b)) = (rotation(a.rotation), rotation(b.rotation));
    let turned = |rows: &[Vector<BigInt>; 3], p: &[f64; 3], norm: &BigInt| {
        let p = whole(p);
        Vector([0, 1, 2].map(|i| rows[i].dot(&p) * norm))
    };
    // Everything times |q_a|^2 |q_b|^2, which clears the denominators of both rotations; about A's origin.
    let unit = &norm_a * &norm_b;
    let shift = (whole(&b.translation) - whole(&a.translation)).times(&unit);
    let points_a: Vec<_> = corners_a.iter().map(|p| turned(&turn_a, p, &norm_b)).collect();
    let points_b: Vec<_> = corners_b.iter().map(|p| turned(&turn_b, p, &norm_a) + shift.clone()).collect();
    let radii = a.swept_radius + b.swept_radius;
    let Some(best) = best_direction(&points_a, &points_b) else { return Some(-radii) };
    let denominator = best.square * &unit * &unit;
    let root = root_of_quotient((&best.value * &best.value).magnitude(), denominator.magnitude(), exponent);
    Some(if best.value.sign() == Sign::Minus { -root } else { root } - radii)
}

/// R(q) = |q|^2 R(q/|q|) by rows and |q|^2, both in some power of two of their own that cancels.
fn rotation(q: [f64; 4]) -> ([Vector<BigInt>; 3], BigInt) {
    let exponent = q.iter().filter(|c| **c != 0.0).map(|c| last_place(*c)).min().unwrap_or(0);
    let [w, x, y, z] = q.map(|c| integer(c, exponent));
    let twice = |p: &BigInt, q: &BigInt| BigInt::from(2) * p * q;
    let [ww, xx, yy, zz] = [&w * &w, &x * &x, &y * &y, &z * &z];
    let rows = [
        Vector([&ww + &xx - &yy - &zz, twice(&x, &y) - twice(&w, &z), twice(&x, &z) + twice(&w, &y)]),
        Vector([twice(&x, &y) + twice(&w, &z), &ww - &xx + &yy - &zz, twice(&y, &z) - twice(&w, &x)]),
        Vector([twice(&x, &z) - twice(&w, &y), twice(&y, &z) + twice(&w, &x), &ww - &xx - &yy + &zz]),
    ];
    (rows, ww + xx + yy + zz)
}

/// Mantissa and exponent: x = mantissa 2^exponent.
fn parts(x: f64) -> (i64, i32) {
    let bits = x.to_bits();
    let biased = ((bits >> 52) & 0x7ff) as i32;
    let fraction = (bits & ((1 << 52) - 1)) as i64;
    let (mantissa, exponent) = if biased == 0 { (fraction, -1074) } else { (fraction | 1 << 52, biased - 1075) };
    (if x < 0.0 { -mantissa } else { mantissa }, exponent)
}

/// Exponent of the lowest bit that is set.
fn last_place(x: f64) -> i32 {
    let (mantissa, exponent) = parts(x);
    exponent + mantissa.trailing_zeros() as i32
}

/// x / 2^exponent, which is a whole number.
fn integer(x: f64, exponent: i32) -> BigInt {
    let (mantissa, own) = parts(x);
    if mantissa == 0 {
        return BigInt::ZERO;
    }
    let zeros = mantissa.trailing_zeros() as i32;
    BigInt::from(mantissa >> zeros) << (own + zeros - exponent)
}

/// sqrt(numerator / denominator) 2^exponent.
fn root_of_quotient(numerator: &BigUint, denominator: &BigUint, exponent: i32) -> Dd {
    // Shifted so that the quotient has at least 256 bits and its root 128.
    let lack = 256 + denominator.bits() as i64 - numerator.bits() as i64;
    let shift = 2 * (lack.max(0) as u64).div_ceil(2);
    let root = ((numerator << shift) / denominator).sqrt();
    let mut sum = Dd::ZERO;
    // The leading 192 bits are more than enough.
    let dropped = root.bits().saturating_sub(192);
    let digits = (&root >> dropped).to_u32_digits();
    for digit in digits.iter().rev() {
        sum = sum * Dd::from(4_294_967_296.0) + Dd::from(f64::from(*digit));
    }
    let power = exponent + dropped as i32 - (shift / 2) as i32;
    // In two steps, because the power may be beyond the doubles.
    let half = power / 2;
    sum.times_power_of_two(libm::exp2(f64::from(half))).times_power_of_two(libm::exp2(f64::from(power - half)))
}
