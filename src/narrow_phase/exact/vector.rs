//! Vectors and matrices of integers.

use dashu_int::IBig;
use dashu_int::ops::BitTest;

use super::integers::approximate;
use crate::geometry::Vec3;

/// Three integers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Vector(pub [IBig; 3]);

impl Vector {
    pub fn zero() -> Self {
        Self([IBig::ZERO, IBig::ZERO, IBig::ZERO])
    }

    /// A unit vector along an axis.
    pub fn axis(i: usize) -> Self {
        let mut v = Self::zero();
        v.0[i] = IBig::ONE;
        v
    }

    pub fn dot(&self, other: &Self) -> IBig {
        let ([a, b, c], [x, y, z]) = (&self.0, &other.0);
        a * x + b * y + c * z
    }

    pub fn square(&self) -> IBig {
        self.dot(self)
    }

    pub fn cross(&self, other: &Self) -> Self {
        let ([a, b, c], [x, y, z]) = (&self.0, &other.0);
        Self([b * z - c * y, c * x - a * z, a * y - b * x])
    }

    pub fn minus(&self, other: &Self) -> Self {
        Self(std::array::from_fn(|i| &self.0[i] - &other.0[i]))
    }

    pub fn plus(&self, other: &Self) -> Self {
        Self(std::array::from_fn(|i| &self.0[i] + &other.0[i]))
    }

    pub fn times(&self, factor: &IBig) -> Self {
        Self(std::array::from_fn(|i| &self.0[i] * factor))
    }

    pub fn negated(&self) -> Self {
        Self(std::array::from_fn(|i| -&self.0[i]))
    }

    pub fn is_zero(&self) -> bool {
        self.0.iter().all(IBig::is_zero)
    }

    /// Bits of the largest component.
    pub fn bits(&self) -> usize {
        self.0.iter().map(BitTest::bit_len).max().unwrap_or(0)
    }

    /// The vector times a power of two that brings its largest component into [1/2, 1], and the exponent of that power. The
    /// components are within 2^-52 of their own size.
    pub fn normalised(&self) -> (Vec3, i32) {
        let exponent = -i32::try_from(self.bits()).unwrap_or(i32::MAX);
        let [x, y, z] = [0, 1, 2].map(|i| approximate(&self.0[i], exponent));
        (Vec3::new(x, y, z), exponent)
    }

    /// The unit vector, to a few units in the last place; zero for zero.
    pub fn unit(&self) -> Vec3 {
        let (v, _) = self.normalised();
        if v == Vec3::zeros() { v } else { v / v.norm() }
    }

    /// A vector of integers with the direction of `v`, to about 2^-52 of its size.
    pub fn along(v: Vec3) -> Self {
        let largest = v.amax();
        let component = |c: f64| IBig::from(libm::rint(c / largest * 4_503_599_627_370_496.0) as i64); // 2^52
        if largest > 0.0 { Self([component(v.x), component(v.y), component(v.z)]) } else { Self::zero() }
    }
}

/// Three rows.
#[derive(Clone, Debug)]
pub(super) struct Matrix(pub [Vector; 3]);

impl Matrix {
    pub fn apply(&self, v: &Vector) -> Vector {
        Vector(std::array::from_fn(|i| self.0[i].dot(v)))
    }

    pub fn apply_transposed(&self, v: &Vector) -> Vector {
        let column = |j: usize| &self.0[0].0[j] * &v.0[0] + &self.0[1].0[j] * &v.0[1] + &self.0[2].0[j] * &v.0[2];
        Vector([column(0), column(1), column(2)])
    }

    pub fn times(&self, factor: &IBig) -> Self {
        Self(std::array::from_fn(|i| self.0[i].times(factor)))
    }
}
