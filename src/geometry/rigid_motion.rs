//! How a body gets from one place to another: where it is at any time between, and how far off the numbers may be.
//!
//! Time runs from 0 to 1. The body's origin moves along a straight line at constant speed, and the body turns about an axis
//! that keeps its direction, at constant rate: R(t) = exp(t [turn]x) R(0). There is no screw: the line and the axis have
//! nothing to do with one another.

use super::tolerance::{LARGEST_LENGTH, UNIT_ROUNDOFF};
use super::{Placement, Pose, Quaternion, Vec3, length};

/// The most that a body may turn within one motion, radians: some 1600 times around. The error of its rotation grows with
/// the angle, and is 1e-11 radians there.
pub const LARGEST_TURN: f64 = 1e4;

/// How far a rotation that was computed for some time may be from the true one, radians, in units of the roundoff: so many,
/// and so many more for each radian of the turn. Derived in `docs/derivations/advancement.md`.
const TURN_ERROR_ULPS: (f64, f64) = (256.0, 16.0);

/// Why numbers were refused as a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum InvalidMotion {
    /// A component of the displacement is NaN or infinite.
    #[error("displacement has a component that is not finite")]
    DisplacementNotFinite,
    /// A component of the displacement is larger than any length may be.
    #[error("displacement has a component beyond {LARGEST_LENGTH:e} m")]
    DisplacementTooLarge,
    /// A component of the turn is NaN or infinite.
    #[error("turn has a component that is not finite")]
    TurnNotFinite,
    /// More than [`LARGEST_TURN`].
    #[error("turn is more than {LARGEST_TURN} radians")]
    TurnTooLarge,
}

/// A rigid motion over the time 0..=1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidMotion {
    start: Pose,
    /// Where it ends, if that was given; else it follows from the rest.
    end: Option<Pose>,
    displacement: Vec3,
    turn: Vec3,
}

impl RigidMotion {
    /// A body that stays where it is.
    #[must_use]
    pub fn still(at: Pose) -> Self {
        Self { start: at, end: Some(at), displacement: Vec3::zeros(), turn: Vec3::zeros() }
    }

    /// From one pose to another, the shorter way around. Of half a turn, which has two ways, the one that the quaternions show:
    /// from q to r if their dot product, as doubles have it, is not negative, else from q to -r.
    #[must_use]
    pub fn between(start: Pose, end: Pose) -> Self {
        let displacement = end.translation() - start.translation();
        Self { start, end: Some(end), displacement, turn: turn_between(start.rotation(), end.rotation()) }
    }

    /// From a pose, by a displacement of the body's origin (metres) and a turn: a vector along the axis, as long as the angle
    /// in radians; both in the axes of the frame that the pose is in. The angle may be more than a full turn.
    ///
    /// # Errors
    /// Numbers that are not finite or out of reach.
    pub fn by(start: Pose, displacement: Vec3, turn: Vec3) -> Result<Self, InvalidMotion> {
        if !displacement.iter().all(|c| c.is_finite()) {
            return Err(InvalidMotion::DisplacementNotFinite);
        }
        if displacement.amax() > LARGEST_LENGTH {
            return Err(InvalidMotion::DisplacementTooLarge);
        }
        if !turn.iter().all(|c| c.is_finite()) {
            return Err(InvalidMotion::TurnNotFinite);
        }
        if turn.amax() > LARGEST_TURN || turn.norm() > LARGEST_TURN {
            return Err(InvalidMotion::TurnTooLarge);
        }
        Ok(Self { start, end: None, displacement, turn })
    }

    /// Where it begins.
    #[must_use]
    pub fn start(&self) -> &Pose {
        &self.start
    }

    /// Where it ends, if that was given.
    #[must_use]
    pub fn end(&self) -> Option<&Pose> {
        self.end.as_ref()
    }

    /// How far the body's origin moves from the beginning to the end, metres.
    #[must_use]
    pub fn displacement(&self) -> Vec3 {
        self.displacement
    }

    /// By how much it turns from the beginning to the end: along the axis, as long as the angle; radians.
    #[must_use]
    pub fn turn(&self) -> Vec3 {
        self.turn
    }

    /// Whether it turns at all.
    #[must_use]
    pub fn turns(&self) -> bool {
        self.turn != Vec3::zeros()
    }

    /// Where the body is at a time in `0..=1`, rounded; exactly at the beginning, and at an end that was given.
    #[must_use]
    pub fn placement(&self, time: f64) -> Placement {
        if time == 0.0 {
            return self.start.placement();
        }
        if let Some(end) = self.end.filter(|_| time == 1.0) {
            return end.placement();
        }
        let at = self.start.translation() + self.displacement * time;
        Placement { translation: at, ..self.turned(time) }
    }

    /// How the body is turned at a time in `0..=1`, at the origin.
    #[must_use]
    pub fn turned(&self, time: f64) -> Placement {
        let rotation = if self.turns() && time != 0.0 {
            let angle = length(self.turn);
            let by = Quaternion::about_axis(self.turn / angle, angle * time);
            by.compose(unit(self.start.rotation()))
        } else {
            self.start.rotation()
        };
        Placement { rotation: rotation.matrix(), translation: Vec3::zeros(), quaternion: Some(rotation) }
    }

    /// By how much the rotation that [`Self::turned`] gives may be off at any time, radians.
    #[must_use]
    pub fn turn_error(&self) -> f64 {
        let (fixed, per_radian) = TURN_ERROR_ULPS;
        // Rotations that differ by less than rounding are no turn that could be told.
        let may_turn = self.turns() || self.end.is_some_and(|end| end.rotation() != self.start.rotation());
        if may_turn { UNIT_ROUNDOFF * (fixed + per_radian * length(self.turn)) } else { 0.0 }
    }
}

/// The unit quaternion of the same rotation.
fn unit(q: Quaternion) -> Quaternion {
    let largest = q.w.abs().max(q.x.abs()).max(q.y.abs()).max(q.z.abs());
    let [w, x, y, z] = [q.w, q.x, q.y, q.z].map(|c| c / largest);
    let norm = (w * w + x * x + y * y + z * z).sqrt();
    Quaternion { w: w / norm, x: x / norm, y: y / norm, z: z / norm }
}

/// The turn that takes one rotation to another, in the axes of the outer frame; at most half a turn. Rotations that are the same
/// number by number are no turn.
fn turn_between(from: Quaternion, to: Quaternion) -> Vec3 {
    if from == to {
        return Vec3::zeros();
    }
    let (from, to) = (unit(from), unit(to));
    let back = Quaternion { w: from.w, x: -from.x, y: -from.y, z: -from.z };
    let by = to.compose(back);
    // The scalar part is the dot product of the two.
    let sign = if by.w < 0.0 { -1.0 } else { 1.0 };
    let along = Vec3::new(by.x, by.y, by.z) * sign;
    let sine = length(along);
    if sine == 0.0 {
        return Vec3::zeros();
    }
    along * (2.0 * libm::atan2(sine, by.w * sign) / sine)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pose(x: f64, q: [f64; 4]) -> Pose {
        let [w, qx, y, z] = q;
        Pose::new(Vec3::new(x, -0.5 * x, 2.0), Quaternion { w, x: qx, y, z }).unwrap()
    }

    #[test]
    fn a_motion_between_two_poses_begins_and_ends_there_and_is_continuous_at_the_ends() {
        let ends = [
            (pose(0.0, [1.0, 0.2, 0.3, -0.1]), pose(3.0, [-0.4, 0.2, 0.9, 0.7])),
            (pose(1e6, [1e-9, 2e-9, 0.0, 0.0]), pose(1e6, [5.0, 10.0, 1e-12, 0.0])),
            (pose(0.0, [1.0, 0.0, 0.0, 0.0]), pose(1.0, [0.0, 0.0, 0.0, -3.0])),
        ];
        for (start, end) in ends {
            let motion = RigidMotion::between(start, end);
            assert_eq!(motion.placement(0.0), start.placement());
            assert_eq!(motion.placement(1.0), end.placement());
            let last = motion.turned(1.0).rotation - end.placement().rotation;
            assert!(last.amax() <= motion.turn_error(), "{last}");
            let nearly = motion.turned(1.0 - 1e-9).rotation - end.placement().rotation;
            assert!(nearly.amax() < 1e-8);
            assert!(motion.turn().norm() <= std::f64::consts::PI + 1e-12);
        }
    }

    #[test]
    fn a_turn_goes_about_its_axis_at_constant_rate_and_may_be_more_than_a_full_one() {
        let turn = Vec3::new(0.0, 0.0, 7.0);
        let motion = RigidMotion::by(Pose::identity(), Vec3::x(), turn).unwrap();
        for i in 0..=10 {
            let t = 0.1 * f64::from(i);
            let (sin, cos) = libm::sincos(7.0 * t);
            let at = motion.placement(t);
            assert!((at.point(Vec3::x()) - Vec3::new(t + cos, sin, 0.0)).norm() < 1e-14);
        }
        let back = RigidMotion::between(Pose::identity(), *RigidMotion::still(pose(1.0, [0.1, 0.5, 0.0, 0.0])).start());
        let point = Vec3::new(0.3, 0.4, 0.5);
        let distance = |t: f64| (back.turned(t).point(point) - back.turned(0.0).point(point)).norm();
        assert!(distance(0.25) < distance(0.5) && distance(0.5) < distance(1.0));
    }

    #[test]
    fn what_cannot_be_a_motion_is_refused_by_name() {
        let by = |displacement, turn| RigidMotion::by(Pose::identity(), displacement, turn);
        let zero = Vec3::zeros();
        assert_eq!(by(Vec3::new(f64::NAN, 0.0, 0.0), zero), Err(InvalidMotion::DisplacementNotFinite));
        assert_eq!(by(Vec3::new(1e153, 0.0, 0.0), zero), Err(InvalidMotion::DisplacementTooLarge));
        assert_eq!(by(zero, Vec3::new(0.0, f64::INFINITY, 0.0)), Err(InvalidMotion::TurnNotFinite));
        assert_eq!(by(zero, Vec3::new(0.0, 1e5, 0.0)), Err(InvalidMotion::TurnTooLarge));
    }
}
