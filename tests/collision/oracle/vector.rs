//! Vectors over a ring: doubles-doubles where a result is rounded, big integers where it is exact.

use std::ops::{Add, Mul, Neg, Sub};

use super::double_double::Dd;

/// What sums, products and comparisons can be taken of.
pub trait Number:
    Clone + PartialOrd + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self>
{
}

impl<T> Number for T where T: Clone + PartialOrd + Add<Output = T> + Sub<Output = T> + Mul<Output = T> + Neg<Output = T> {}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vector<T>(pub [T; 3]);

/// A vector of double-doubles.
pub type DdVector = Vector<Dd>;

impl<T: Number> Vector<T> {
    #[inline]
    pub fn dot(&self, other: &Self) -> T {
        let ([a, b, c], [x, y, z]) = (self.0.clone(), other.0.clone());
        a * x + b * y + c * z
    }

    #[inline]
    pub fn cross(&self, other: &Self) -> Self {
        let ([a, b, c], [x, y, z]) = (&self.0, &other.0);
        let minor = |p: &T, q: &T, r: &T, s: &T| p.clone() * s.clone() - q.clone() * r.clone();
        Self([minor(b, c, y, z), minor(c, a, z, x), minor(a, b, x, y)])
    }

    pub fn times(&self, factor: &T) -> Self {
        Self(self.0.clone().map(|c| c * factor.clone()))
    }

    pub fn square(&self) -> T {
        self.dot(self)
    }
}

impl<T: Number> Add for Vector<T> {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Self([a + x, b + y, c + z])
    }
}

impl<T: Number> Sub for Vector<T> {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Self([a - x, b - y, c - z])
    }
}

impl<T: Number> Neg for Vector<T> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self(self.0.map(|c| -c))
    }
}

impl DdVector {
    pub const ZERO: Self = Self([Dd::ZERO; 3]);

    pub fn from_doubles(v: [f64; 3]) -> Self {
        Self(v.map(Dd::from))
    }

    pub fn to_doubles(self) -> [f64; 3] {
        self.0.map(|c| c.hi)
    }

    pub fn norm(&self) -> Dd {
        self.square().sqrt()
    }

    /// The vector divided by its length; none when the length is zero or too small to be told from it.
    pub fn unit(&self) -> Option<Self> {
        // Doubles' exponents reach far below, but double-double products of numbers below 1e-130 begin to lose digits.
        let largest = self.0.iter().fold(0.0, |m: f64, c| m.max(c.hi.abs()));
        if !(largest > 1e-280) {
            return None;
        }
        let scale = libm::exp2(-libm::log2(largest).floor());
        let scaled = Self(self.0.map(|c| c.times_power_of_two(scale)));
        let norm = scaled.norm();
        Some(Self(scaled.0.map(|c| c / norm)))
    }
}
