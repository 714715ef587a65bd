//! Lengths of vectors whose squares do not fit into an `f64`.

use super::Vec3;

/// |v|, also where the squares of its components would over- or underflow. Zero only for the zero vector.
#[must_use]
pub fn length(v: Vec3) -> f64 {
    let largest = v.amax();
    if (1e-140..=1e140).contains(&largest) {
        return v.norm();
    }
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
