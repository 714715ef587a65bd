//! When does a moving box meet another one? What trees ask of rays and of moving shapes; a ray is a box without extent.

use super::{Aabb, Vec3};

/// Fractions are rounded outwards by this much, relatively: a difference and a quotient go into each, two roundings.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Fractions below this count as zero: they may have lost digits to underflow.
const LEAST_FRACTION: f64 = 1e-290;

/// A closed box that moves along a straight line without turning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoxCast {
    /// Where it begins, metres.
    pub start: Aabb,
    /// From its beginning to its end, metres.
    pub motion: Vec3,
}

impl BoxCast {
    /// At most the fraction of the motion, in `0..=1`, at which the moving box first has a point in common with `other`;
    /// nothing only if it has none on its whole way.
    #[must_use]
    pub fn first_touch(&self, other: &Aabb) -> Option<f64> {
        let (mut enters, mut leaves) = (0.0_f64, 1.0_f64);
        for axis in 0..3 {
            let motion = self.motion[axis];
            let (before, beyond) = (other.min[axis] - self.start.max[axis], other.max[axis] - self.start.min[axis]);
            if motion == 0.0 {
                if before > 0.0 || beyond < 0.0 {
                    return None;
                }
                continue;
            }
            let (near, far) = if motion > 0.0 { (before, beyond) } else { (beyond, before) };
            enters = enters.max(rounded(near / motion, -1.0));
            leaves = leaves.min(rounded(far / motion, 1.0));
        }
        (enters <= leaves).then_some(if enters < LEAST_FRACTION { 0.0 } else { enters })
    }
}

/// A fraction moved by the rounding towards `direction`, which is 1 or -1.
fn rounded(fraction: f64, direction: f64) -> f64 {
    fraction + direction * (ROUNDING * fraction.abs() + LEAST_FRACTION)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit(x: f64, y: f64) -> Aabb {
        Aabb::centred(Vec3::new(x, y, 0.0), Vec3::repeat(0.5))
    }

    #[test]
    fn a_box_meets_what_is_on_its_way_and_nothing_else() {
        let cast = BoxCast { start: unit(0.0, 0.0), motion: Vec3::new(10.0, 0.0, 0.0) };
        let at = |x, y| cast.first_touch(&unit(x, y));
        assert!(at(6.0, 0.0).is_some_and(|t| (0.5 - 1e-14..=0.5).contains(&t)));
        assert_eq!(at(0.3, 0.3), Some(0.0), "they overlap at the beginning");
        assert!(at(11.0, 0.0).is_some_and(|t| t <= 1.0), "they touch at the end");
        assert_eq!(at(11.1, 0.0), None);
        assert_eq!(at(-1.1, 0.0), None);
        assert!(at(5.0, 1.0).is_some(), "they slide along each other");
        assert_eq!(at(5.0, 1.1), None);
    }

    #[test]
    fn a_box_at_rest_meets_what_it_overlaps() {
        let cast = BoxCast { start: unit(0.0, 0.0), motion: Vec3::zeros() };
        assert_eq!(cast.first_touch(&unit(1.0, 1.0)), Some(0.0));
        assert_eq!(cast.first_touch(&unit(1.0, 1.5)), None);
    }

    #[test]
    fn a_point_and_a_diagonal_meet_in_the_corner_they_share() {
        let start = Aabb::around([Vec3::new(-1.0, -1.0, -1.0)]);
        let cast = BoxCast { start, motion: Vec3::new(0.1, 0.1, 0.1) * 30.0 };
        let touched = cast.first_touch(&Aabb::around([Vec3::zeros(), Vec3::repeat(5.0)]));
        assert!(touched.is_some_and(|t| t <= 1.0 / 3.0 && t > 0.333));
    }
}
