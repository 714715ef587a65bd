//! A straight line of sight: where it starts, which way it goes and how far.

use super::tolerance::LARGEST_LENGTH;
use super::{Vec3, length};

/// A ray. Its parameter is the distance from the origin in metres, whatever the length of the direction it was given by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    origin: Vec3,
    direction: Vec3,
    length: f64,
}

/// Why numbers were refused as a ray.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum InvalidRay {
    /// A component of the origin is NaN, infinite, or beyond all lengths.
    #[error("origin has a component that is not finite or beyond {LARGEST_LENGTH:e} m")]
    Origin,
    /// A component of the direction is NaN or infinite.
    #[error("direction has a component that is not finite")]
    DirectionNotFinite,
    /// The zero vector is no direction.
    #[error("direction is zero")]
    ZeroDirection,
    /// NaN, negative, or beyond all lengths.
    #[error("length is {0}, not between 0 and {LARGEST_LENGTH:e} m")]
    Length(f64),
}

impl Ray {
    /// `direction` of any finite length but zero; `length`, how far the ray goes, metres.
    ///
    /// # Errors
    /// Numbers that are not finite or out of reach, a direction of zero, a negative length.
    pub fn new(origin: Vec3, direction: Vec3, length: f64) -> Result<Self, InvalidRay> {
        // Comparison order matters: NaN is refused, too.
        if !origin.iter().all(|c| c.abs() <= LARGEST_LENGTH) {
            return Err(InvalidRay::Origin);
        }
        if !direction.iter().all(|c| c.is_finite()) {
            return Err(InvalidRay::DirectionNotFinite);
        }
        if direction == Vec3::zeros() {
            return Err(InvalidRay::ZeroDirection);
        }
        if !(0.0..=LARGEST_LENGTH).contains(&length) {
            return Err(InvalidRay::Length(length));
        }
        Ok(Self { origin, direction: unit(direction), length })
    }

    /// Where it starts, metres.
    #[must_use]
    pub fn origin(&self) -> Vec3 {
        self.origin
    }

    /// Which way it goes: the unit vector, rounded.
    #[must_use]
    pub fn direction(&self) -> Vec3 {
        self.direction
    }

    /// How far it goes, metres.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Its point at a distance from the origin, metres.
    #[must_use]
    pub fn point(&self, distance: f64) -> Vec3 {
        self.origin + self.direction * distance
    }
}

fn unit(v: Vec3) -> Vec3 {
    // By the largest component first: neither squares nor their sum leave the range of numbers.
    let scaled = v / v.amax();
    scaled / length(scaled)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_direction_of_any_length_is_the_same_ray() {
        let direction = Vec3::new(1.0, -2.0, 0.5);
        for scale in [1e-300, 1.0, 1e300] {
            let ray = Ray::new(Vec3::zeros(), direction * scale, 3.0).unwrap();
            assert!((ray.point(2.0) - direction.normalize() * 2.0).norm() < 1e-15);
        }
    }

    #[test]
    fn what_is_no_ray_is_refused_by_name() {
        let ray = |origin: f64, direction: Vec3, length| Ray::new(Vec3::repeat(origin), direction, length).unwrap_err();
        assert_eq!(ray(f64::NAN, Vec3::x(), 1.0), InvalidRay::Origin);
        assert_eq!(ray(0.0, Vec3::x() * f64::INFINITY, 1.0), InvalidRay::DirectionNotFinite);
        assert_eq!(ray(0.0, Vec3::zeros(), 1.0), InvalidRay::ZeroDirection);
        assert_eq!(ray(0.0, Vec3::x(), -1.0), InvalidRay::Length(-1.0));
        assert!(matches!(ray(0.0, Vec3::x(), f64::NAN), InvalidRay::Length(_)));
    }
}
