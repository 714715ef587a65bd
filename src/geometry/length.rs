//! Lengths of vectors whose squares do not fit into an `f64`.

use super::Vec3;
use super::vector::greatest_size;

/// |v|, also where the squares of its components would over- or underflow. Zero only for the zero vector.
#[must_use]
#[inline]
pub fn length(v: Vec3) -> f64 {
    let square = v.norm_squared();
    if (1e-280..=1e280).contains(&square) { square.sqrt() } else { extreme_length(v) }
}

#[cold]
fn extreme_length(v: Vec3) -> f64 {
    let largest = greatest_size(v);
    if largest == 0.0 || !largest.is_finite() {
        return largest;
    }
    largest * (v / largest).norm()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiny_and_huge_vectors_have_lengths() {
        let v = Vec3::new(3.0, 0.0, -4.0);
        for scale in [1e-300, 1e-200, 1.0, 1e200, 1e300] {
            assert!((length(v * scale) / scale - 5.0).abs() < 1e-14);
        }
        assert_eq!(length(Vec3::new(5e-324, 0.0, 0.0)), 5e-324);
        assert_eq!(length(Vec3::zeros()), 0.0);
    }
}
