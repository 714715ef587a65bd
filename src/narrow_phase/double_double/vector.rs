//! Vectors of double-doubles.

use std::ops::{Add, Mul, Neg, Sub};

use super::number::DoubleDouble;
use crate::geometry::Vec3;

/// Three double-doubles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Vector(pub [DoubleDouble; 3]);

impl Vector {
    /// `a - b` without rounding.
    pub fn difference(a: Vec3, b: Vec3) -> Self {
        Self(std::array::from_fn(|i| DoubleDouble::difference(a[i], b[i])))
    }

    pub fn dot(self, other: Self) -> DoubleDouble {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        a * x + b * y + c * z
    }

    pub fn cross(self, other: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Self([b * z - c * y, c * x - a * z, a * y - b * x])
    }

    pub fn norm(self) -> DoubleDouble {
        self.dot(self).sqrt()
    }

    /// Of length 1 to rounding; none for zero, and for what is so short that its square underflows.
    pub fn unit(self) -> Option<Self> {
        let norm = self.norm();
        (norm.to_f64() > 1e-140).then(|| Self(self.0.map(|c| c / norm)))
    }

    pub fn rounded(self) -> Vec3 {
        let [x, y, z] = self.0;
        Vec3::new(x.to_f64(), y.to_f64(), z.to_f64())
    }

    /// Times a power of two.
    pub fn scaled(self, power_of_two: f64) -> Self {
        Self(self.0.map(|c| c.scaled(power_of_two)))
    }
}

impl From<Vec3> for Vector {
    fn from(v: Vec3) -> Self {
        Self([v.x, v.y, v.z].map(DoubleDouble::from))
    }
}

impl Neg for Vector {
    type Output = Self;
    fn neg(self) -> Self {
        Self(self.0.map(|c| -c))
    }
}

impl Add for Vector {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + other.0[i]))
    }
}

impl Sub for Vector {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] - other.0[i]))
    }
}

impl Mul<DoubleDouble> for Vector {
    type Output = Self;
    fn mul(self, factor: DoubleDouble) -> Self {
        Self(self.0.map(|c| c * factor))
    }
}

/// Three rows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Matrix(pub [Vector; 3]);

impl Matrix {
    pub fn apply(&self, v: Vector) -> Vector {
        Vector(std::array::from_fn(|i| self.0[i].dot(v)))
    }

    pub fn apply_transposed(&self, v: Vector) -> Vector {
        let [x, y, z] = v.0;
        self.0[0] * x + self.0[1] * y + self.0[2] * z
    }

    /// First `inner`, then `self`.
    pub fn after(&self, inner: &Self) -> Self {
        Self(self.0.map(|row| inner.apply_transposed(row)))
    }

    pub fn transposed(&self) -> Self {
        Self(std::array::from_fn(|i| Vector(std::array::from_fn(|j| self.0[j].0[i]))))
    }
}
