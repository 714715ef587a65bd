//! Numbers and vectors side by side, one for each of two siblings of a tree.
//!
//! A walk that opens a node asks the same question of both of its children. Written in lanes of two, the compiler
//! turns the arithmetic into instructions on pairs; each lane is computed as a plain `f64` would be, to the last bit.

use std::ops::{Add, Mul, Sub};

use super::{Mat3, Vec3};

/// Two numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twin(pub [f64; 2]);

impl Twin {
    /// The same number twice.
    #[inline(always)]
    #[must_use]
    pub fn splat(value: f64) -> Self {
        Self([value, value])
    }

    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        Self([f(self.0[0], other.0[0]), f(self.0[1], other.0[1])])
    }

    /// Sizes without signs.
    #[inline(always)]
    #[must_use]
    pub fn abs(self) -> Self {
        Self([self.0[0].abs(), self.0[1].abs()])
    }

    /// The larger ones; of a NaN and a number that of `other`.
    #[inline(always)]
    #[must_use]
    pub fn max(self, other: Self) -> Self {
        self.zip(other, |a, b| if a > b { a } else { b })
    }

    /// The smaller ones; of a NaN and a number that of `other`.
    #[inline(always)]
    #[must_use]
    pub fn min(self, other: Self) -> Self {
        self.zip(other, |a, b| if a < b { a } else { b })
    }

    /// Quotients.
    #[inline(always)]
    #[must_use]
    pub fn over(self, other: Self) -> Self {
        self.zip(other, |a, b| a / b)
    }
}

impl Add for Twin {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
}

impl Sub for Twin {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
}

impl Mul for Twin {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }
}

impl Mul<f64> for Twin {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        self * Self::splat(factor)
    }
}

/// Two vectors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwinVec3 {
    /// The x of both.
    pub x: Twin,
    /// The y of both.
    pub y: Twin,
    /// The z of both.
    pub z: Twin,
}

impl TwinVec3 {
    /// Two vectors, side by side.
    #[must_use]
    pub fn new(v: [Vec3; 2]) -> Self {
        let row = |k: usize| Twin([v[0][k], v[1][k]]);
        Self { x: row(0), y: row(1), z: row(2) }
    }

    /// The same vector twice.
    #[inline(always)]
    #[must_use]
    pub fn splat(v: Vec3) -> Self {
        Self { x: Twin::splat(v.x), y: Twin::splat(v.y), z: Twin::splat(v.z) }
    }

    /// One of the two.
    #[inline(always)]
    #[must_use]
    pub fn lane(&self, lane: usize) -> Vec3 {
        Vec3::new(self.x.0[lane], self.y.0[lane], self.z.0[lane])
    }

    /// Dot products.
    #[inline(always)]
    #[must_use]
    pub fn dot(self, other: Self) -> Twin {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// `matrix * v`.
    #[inline(always)]
    #[must_use]
    pub fn turned(self, matrix: &Mat3) -> Self {
        let row = |i| self.x * matrix[(i, 0)] + self.y * matrix[(i, 1)] + self.z * matrix[(i, 2)];
        Self { x: row(0), y: row(1), z: row(2) }
    }

    /// `matrix^T * v`.
    #[inline(always)]
    #[must_use]
    pub fn turned_back(self, matrix: &Mat3) -> Self {
        let column = |i| self.x * matrix[(0, i)] + self.y * matrix[(1, i)] + self.z * matrix[(2, i)];
        Self { x: column(0), y: column(1), z: column(2) }
    }

    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(Twin, Twin) -> Twin) -> Self {
        Self { x: f(self.x, other.x), y: f(self.y, other.y), z: f(self.z, other.z) }
    }

    /// Component by component, held within `-limit ..= limit`.
    #[inline(always)]
    #[must_use]
    pub fn clamped(self, limit: Self) -> Self {
        self.zip(limit, |v, h| v.min(h).max(h * -1.0))
    }

    /// Sizes of the components.
    #[inline(always)]
    #[must_use]
    pub fn abs(self) -> Self {
        Self { x: self.x.abs(), y: self.y.abs(), z: self.z.abs() }
    }

    /// The largest component of each.
    #[inline(always)]
    #[must_use]
    pub fn largest(self) -> Twin {
        self.x.max(self.y).max(self.z)
    }
}

impl Add for TwinVec3 {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
}

impl Sub for TwinVec3 {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
}

impl Mul<Twin> for TwinVec3 {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: Twin) -> Self {
        Self { x: self.x * factor, y: self.y * factor, z: self.z * factor }
    }
}
