//! A few operations on vectors, written out component by component.
//!
//! nalgebra goes through general iterators for these (negation, absolute values, equality), which the compiler does not
//! unroll: seven times the instructions, in the inner loops of the narrow phase. Its sums and products are fine.

use super::Vec3;

/// The zero vector, as a constant: `Vec3::zeros()` is a call.
pub const ORIGIN: Vec3 = Vec3::new(0.0, 0.0, 0.0);

/// -v
#[inline(always)]
#[must_use]
pub fn opposite(v: Vec3) -> Vec3 {
    Vec3::new(-v.x, -v.y, -v.z)
}

/// The absolute value of each component.
#[inline(always)]
#[must_use]
pub fn sizes(v: Vec3) -> Vec3 {
    Vec3::new(v.x.abs(), v.y.abs(), v.z.abs())
}

/// Sum of the absolute values of the components: at least |v|, at most √3 |v|, and cheaper.
#[inline(always)]
#[must_use]
pub fn sum_of_sizes(v: Vec3) -> f64 {
    v.x.abs() + v.y.abs() + v.z.abs()
}

/// Greatest absolute value of a component.
#[inline(always)]
#[must_use]
pub fn greatest_size(v: Vec3) -> f64 {
    v.x.abs().max(v.y.abs()).max(v.z.abs())
}

/// Which component is greatest in absolute value; the first among equals.
#[inline(always)]
#[must_use]
pub fn main_axis(v: Vec3) -> usize {
    let size = sizes(v);
    if size.x >= size.y && size.x >= size.z { 0 } else { 1 + usize::from(size.z > size.y) }
}

/// Whether all components are equal.
#[inline(always)]
#[must_use]
pub fn is_same(v: Vec3, w: Vec3) -> bool {
    (v.x == w.x) & (v.y == w.y) & (v.z == w.z)
}
