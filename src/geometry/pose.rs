//! Where a body is: translation and rotation of one frame in another.

use super::tolerance::LARGEST_LENGTH;
use super::{Mat3, Vec3};

/// A rotation as a quaternion with named components.
///
/// Any finite norm but zero is accepted and means the rotation `R(q/|q|)`: callers need not normalise,
/// and no rounding is spent on doing it for them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quaternion {
    /// Scalar part.
    pub w: f64,
    /// Coefficient of i.
    pub x: f64,
    /// Coefficient of j.
    pub y: f64,
    /// Coefficient of k.
    pub z: f64,
}

impl Quaternion {
    /// The rotation that changes nothing.
    pub const IDENTITY: Self = Self { w: 1.0, x: 0.0, y: 0.0, z: 0.0 };

    /// Rotation by `angle` radians about the unit vector `axis`. Sine and cosine come from `libm`, so the
    /// components are the same bytes on every machine.
    #[must_use]
    pub fn about_axis(axis: Vec3, angle: f64) -> Self {
        let (sin, cos) = libm::sincos(0.5 * angle);
        Self { w: cos, x: sin * axis.x, y: sin * axis.y, z: sin * axis.z }
    }

    /// Rotation given as roll, pitch, yaw about the fixed axes x, y, z, radians (the convention of URDF).
    #[must_use]
    pub fn from_roll_pitch_yaw(roll: f64, pitch: f64, yaw: f64) -> Self {
        let (sr, cr) = libm::sincos(0.5 * roll);
        let (sp, cp) = libm::sincos(0.5 * pitch);
        let (sy, cy) = libm::sincos(0.5 * yaw);
        Self {
            w: cr * cp * cy + sr * sp * sy,
            x: sr * cp * cy - cr * sp * sy,
            y: cr * sp * cy + sr * cp * sy,
            z: cr * cp * sy - sr * sp * cy,
        }
    }

    /// The rotation that first applies `inner`, then `self` (Hamilton product).
    #[must_use]
    pub fn compose(self, inner: Self) -> Self {
        let (a, b) = (self, inner);
        Self {
            w: a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
            x: a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
            y: a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
            z: a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w,
        }
    }

    /// Largest component by size; zero only for the zero quaternion.
    fn largest(self) -> f64 {
        self.w.abs().max(self.x.abs()).max(self.y.abs()).max(self.z.abs())
    }

    /// R(q/|q|) written out. No square root is taken: the entries of R are quotients of quadratic forms,
    /// R = I + (2/|q|^2)(w [v]x + [v]x^2), so each is within a few units in the last place of 1.
    #[must_use]
    pub fn matrix(self) -> Mat3 {
        // Norms beyond 1e100 or below 1e-100 would overflow or underflow when squared.
        let largest = self.largest();
        let q = if (1e-100..=1e100).contains(&largest) {
            self
        } else {
            Self { w: self.w / largest, x: self.x / largest, y: self.y / largest, z: self.z / largest }
        };
        let Self { w, x, y, z } = q;
        let s = 2.0 / (w * w + x * x + y * y + z * z);
        Mat3::new(
            1.0 - s * (y * y + z * z),
            s * (x * y - w * z),
            s * (x * z + w * y),
            s * (x * y + w * z),
            1.0 - s * (x * x + z * z),
            s * (y * z - w * x),
            s * (x * z - w * y),
            s * (y * z + w * x),
            1.0 - s * (x * x + y * y),
        )
    }
}

/// Why numbers were refused as a pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum InvalidPose {
    /// A component of the translation is NaN or infinite.
    #[error("translation has a component that is not finite")]
    TranslationNotFinite,
    /// A component of the translation is larger than any length may be.
    #[error("translation has a component beyond {LARGEST_LENGTH:e} m")]
    TranslationTooLarge,
    /// A component of the quaternion is NaN or infinite.
    #[error("rotation has a component that is not finite")]
    RotationNotFinite,
    /// The quaternion is zero and means no rotation.
    #[error("rotation is the zero quaternion")]
    ZeroQuaternion,
}

/// Pose of a frame B in a frame A: the point p of B is `translation + R(q/|q|) p` in A. Metres.
///
/// A value of this type is finite and its quaternion is not zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    translation: Vec3,
    rotation: Quaternion,
}

impl Pose {
    /// The frame itself.
    #[must_use]
    pub fn identity() -> Self {
        Self { translation: Vec3::zeros(), rotation: Quaternion::IDENTITY }
    }

    /// Checks the numbers of a pose.
    ///
    /// # Errors
    /// Numbers that are not finite or out of reach, or the zero quaternion.
    pub fn new(translation: Vec3, rotation: Quaternion) -> Result<Self, InvalidPose> {
        if !translation.iter().all(|c| c.is_finite()) {
            return Err(InvalidPose::TranslationNotFinite);
        }
        if translation.amax() > LARGEST_LENGTH {
            return Err(InvalidPose::TranslationTooLarge);
        }
        let q = rotation;
        if ![q.w, q.x, q.y, q.z].iter().all(|c| c.is_finite()) {
            return Err(InvalidPose::RotationNotFinite);
        }
        if q.largest() == 0.0 {
            return Err(InvalidPose::ZeroQuaternion);
        }
        Ok(Self { translation, rotation })
    }

    /// Position of B's origin in A, metres.
    #[must_use]
    pub fn translation(&self) -> Vec3 {
        self.translation
    }

    /// Rotation from B's axes to A's, of any norm.
    #[must_use]
    pub fn rotation(&self) -> Quaternion {
        self.rotation
    }

    /// The same pose with its rotation as a matrix, for work on many points.
    #[must_use]
    pub fn placement(&self) -> Placement {
        Placement { rotation: self.rotation.matrix(), translation: self.translation, quaternion: Some(self.rotation) }
    }

    /// Pose of C in A, given `self` = B in A and `inner` = C in B. A unit quaternion stays one to rounding;
    /// other norms multiply, and are reduced to 1 when they leave [1/2, 2].
    #[must_use]
    pub fn compose(&self, inner: &Self) -> Self {
        let translation = self.placement().point(inner.translation);
        let q = self.rotation.reduced().compose(inner.rotation.reduced());
        Self { translation, rotation: q.reduced() }
    }
}

impl Quaternion {
    /// The quaternion itself when its norm is near 1, else the unit one of the same rotation.
    fn reduced(self) -> Self {
        let square = self.w * self.w + self.x * self.x + self.y * self.y + self.z * self.z;
        if (0.25..=4.0).contains(&square) {
            return self;
        }
        let largest = self.largest();
        let q = Self { w: self.w / largest, x: self.x / largest, y: self.y / largest, z: self.z / largest };
        let norm = (q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z).sqrt();
        Self { w: q.w / norm, x: q.x / norm, y: q.y / norm, z: q.z / norm }
    }
}

/// A pose with its rotation written out as a matrix: what loops over points use.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Rotation from B's axes to A's.
    pub rotation: Mat3,
    /// Position of B's origin in A, metres.
    pub translation: Vec3,
    /// What `rotation` is rounded from, for exact arithmetic; none where it was computed from other matrices.
    pub quaternion: Option<Quaternion>,
}

impl Placement {
    /// A placement that was computed, and so stands for no pose exactly.
    #[must_use]
    pub fn computed(rotation: Mat3, translation: Vec3) -> Self {
        Self { rotation, translation, quaternion: None }
    }

    /// The frame itself.
    #[must_use]
    pub fn identity() -> Self {
        Self { rotation: Mat3::identity(), translation: Vec3::zeros(), quaternion: Some(Quaternion::IDENTITY) }
    }

    /// The point `p` of B, in A.
    #[must_use]
    #[inline]
    pub fn point(&self, p: Vec3) -> Vec3 {
        self.direction(p) + self.translation
    }

    /// The direction `d` of B, in A.
    #[must_use]
    #[inline]
    pub fn direction(&self, d: Vec3) -> Vec3 {
        product(&self.rotation, d)
    }

    /// The direction `d` of A, in B.
    #[must_use]
    #[inline]
    pub fn direction_into(&self, d: Vec3) -> Vec3 {
        transposed_product(&self.rotation, d)
    }

    /// B in A, for `a` and `b` placed in one common frame. The difference of positions is taken before
    /// rotating, so that a pair far from the origin is as accurate as one near it.
    #[must_use]
    #[inline]
    pub fn relative(a: &Self, b: &Self) -> Self {
        let column = |j: usize| {
            let m = &b.rotation;
            transposed_product(&a.rotation, Vec3::new(m[(0, j)], m[(1, j)], m[(2, j)]))
        };
        let [x, y, z] = [column(0), column(1), column(2)];
        let rotation = Mat3::new(x.x, y.x, z.x, x.y, y.y, z.y, x.z, y.z, z.z);
        Self::computed(rotation, transposed_product(&a.rotation, b.translation - a.translation))
    }
}

/// m v, written out: the general product is not always inlined, and this one is at the bottom of every inner loop.
#[inline(always)]
fn product(m: &Mat3, v: Vec3) -> Vec3 {
    Vec3::new(
        m[(0, 0)] * v.x + m[(0, 1)] * v.y + m[(0, 2)] * v.z,
        m[(1, 0)] * v.x + m[(1, 1)] * v.y + m[(1, 2)] * v.z,
        m[(2, 0)] * v.x + m[(2, 1)] * v.y + m[(2, 2)] * v.z,
    )
}

/// mᵀ v.
#[inline(always)]
fn transposed_product(m: &Mat3, v: Vec3) -> Vec3 {
    Vec3::new(
        m[(0, 0)] * v.x + m[(1, 0)] * v.y + m[(2, 0)] * v.z,
        m[(0, 1)] * v.x + m[(1, 1)] * v.y + m[(2, 1)] * v.z,
        m[(0, 2)] * v.x + m[(1, 2)] * v.y + m[(2, 2)] * v.z,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quaternions_of_any_norm_mean_the_same_rotation() {
        let unit = Quaternion { w: 0.5, x: 0.5, y: -0.5, z: 0.5 };
        for scale in [1e-200, 1e-3, 7.0, 1e200] {
            let q = Quaternion { w: unit.w * scale, x: unit.x * scale, y: unit.y * scale, z: unit.z * scale };
            assert!((q.matrix() - unit.matrix()).amax() < 1e-15);
        }
    }

    #[test]
    fn composing_agrees_with_moving_points_one_after_the_other() {
        let a = Pose::new(Vec3::new(1.0, -2.0, 0.5), Quaternion { w: 3.0, x: 1.0, y: -2.0, z: 0.5 }).unwrap();
        let b = Pose::new(Vec3::new(0.1, 4.0, -1.0), Quaternion { w: -0.01, x: 0.02, y: 0.0, z: 0.03 }).unwrap();
        let p = Vec3::new(0.3, 0.2, -0.9);
        let one_by_one = a.placement().point(b.placement().point(p));
        assert!((a.compose(&b).placement().point(p) - one_by_one).norm() < 1e-14);
    }

    #[test]
    fn zero_and_non_finite_numbers_are_refused_by_name() {
        let zero = Quaternion { w: 0.0, x: 0.0, y: -0.0, z: 0.0 };
        assert_eq!(Pose::new(Vec3::zeros(), zero), Err(InvalidPose::ZeroQuaternion));
        let nan = Vec3::new(f64::NAN, 0.0, 0.0);
        assert_eq!(Pose::new(nan, Quaternion::IDENTITY), Err(InvalidPose::TranslationNotFinite));
        let infinite = Quaternion { w: f64::INFINITY, ..zero };
        assert_eq!(Pose::new(Vec3::zeros(), infinite), Err(InvalidPose::RotationNotFinite));
    }

    #[test]
    fn roll_pitch_yaw_turns_about_fixed_axes_in_that_order() {
        let half_turn = std::f64::consts::FRAC_PI_2;
        let q = Quaternion::from_roll_pitch_yaw(half_turn, 0.0, half_turn);
        // x -> (roll) x -> (yaw) y; y -> (roll) z -> (yaw) z.
        assert!((q.matrix() * Vec3::x() - Vec3::y()).norm() < 1e-15);
        assert!((q.matrix() * Vec3::y() - Vec3::z()).norm() < 1e-15);
    }
}
