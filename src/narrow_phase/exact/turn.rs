//! A rotation without rounding: R(q/|q|) has entries that are quotients of quadratic forms in q, so for a quaternion of
//! integers it is a matrix of integers over one integer.

use dashu_int::IBig;
use dashu_int::ops::{Gcd, UnsignedAbs};

use super::integers::{Span, integer};
use super::vector::{Matrix, Vector};
use crate::geometry::Quaternion;

/// A quaternion of integers that have no common divisor; only its direction means anything.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Turn {
    w: IBig,
    v: Vector,
}

impl Turn {
    /// None when the components differ so much in size that an integer for them all needs more than `most_bits`.
    pub fn new(q: Quaternion, most_bits: usize) -> Option<Self> {
        let span = Span::of([q.w, q.x, q.y, q.z]);
        if span.bits() > most_bits {
            return None;
        }
        let [w, x, y, z] = [q.w, q.x, q.y, q.z].map(|c| integer(c, span.lowest));
        Some(Self { w, v: Vector([x, y, z]) }.reduced())
    }

    fn reduced(self) -> Self {
        let [x, y, z] = &self.v.0;
        let divisor = [x, y, z].into_iter().fold(self.w.clone().unsigned_abs(), |divisor, c| {
            if c.is_zero() || divisor.is_one() { divisor } else { nonzero_gcd(divisor, c) }
        });
        if divisor.is_one() || divisor.is_zero() {
            return self;
        }
        let divisor = IBig::from(divisor);
        Self { w: &self.w / &divisor, v: Vector(self.v.0.map(|c| c / &divisor)) }
    }

    /// First `inner`, then `self`.
    pub fn compose(&self, inner: &Self) -> Self {
        let (a, b) = (self, inner);
        let w = &a.w * &b.w - a.v.dot(&b.v);
        let v = b.v.times(&a.w).plus(&a.v.times(&b.w)).plus(&a.v.cross(&b.v));
        Self { w, v }.reduced()
    }

    pub fn inverse(&self) -> Self {
        Self { w: self.w.clone(), v: self.v.negated() }
    }

    /// The matrix of the rotation times the integer that comes with it.
    pub fn matrix(&self) -> (Matrix, IBig) {
        let Self { w, v: Vector([x, y, z]) } = self;
        let [ww, xx, yy, zz] = [w * w, x * x, y * y, z * z];
        let [xy, xz, yz] = [x * y * 2, x * z * 2, y * z * 2];
        let [wx, wy, wz] = [w * x * 2, w * y * 2, w * z * 2];
        let rows = [
            Vector([&ww + &xx - &yy - &zz, &xy - &wz, &xz + &wy]),
            Vector([&xy + &wz, &ww - &xx + &yy - &zz, &yz - &wx]),
            Vector([&xz - &wy, &yz + &wx, &ww - &xx - &yy + &zz]),
        ];
        (Matrix(rows), ww + xx + yy + zz)
    }
}

fn nonzero_gcd(divisor: dashu_int::UBig, c: &IBig) -> dashu_int::UBig {
    let c = c.unsigned_abs();
    if divisor.is_zero() { c } else { divisor.gcd(c) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn common_divisors_and_norms_do_not_matter() {
        let turn = |w, x, y, z| Turn::new(Quaternion { w, x, y, z }, 4096).unwrap();
        let quarter = turn(0.1, 0.0, 0.0, 0.1);
        assert_eq!(quarter, turn(1e200, 0.0, 0.0, 1e200));
        let (matrix, scale) = quarter.matrix();
        assert_eq!(scale, IBig::from(2));
        assert_eq!(matrix.apply(&Vector::axis(0)), Vector::axis(1).times(&scale));
        assert_eq!(matrix.apply_transposed(&Vector::axis(1)), Vector::axis(0).times(&scale));
        assert_eq!(quarter.compose(&quarter), turn(0.0, 0.0, 0.0, 3.0));
        assert_eq!(turn(0.3, 0.4, -0.7, 0.2).inverse().compose(&turn(0.3, 0.4, -0.7, 0.2)), turn(1.0, 0.0, 0.0, 0.0));
        assert!(Turn::new(Quaternion { w: 1.0, x: 1e-300, y: 0.0, z: 0.0 }, 512).is_none());
    }

    #[test]
    fn a_matrix_is_a_rotation_times_its_integer() {
        let (m, scale) = Turn::new(Quaternion { w: 0.3, x: -0.41, y: 0.7, z: 1e-3 }, 512).unwrap().matrix();
        for i in 0..3 {
            for j in 0..3 {
                let expected = if i == j { &scale * &scale } else { IBig::ZERO };
                assert_eq!(m.0[i].dot(&m.0[j]), expected);
            }
        }
        assert_eq!(m.0[0].cross(&m.0[1]), m.0[2].times(&scale), "right-handed");
    }
}
