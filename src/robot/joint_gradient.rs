//! How does a number that hangs on where links are change with the joints' positions? The transposed Jacobian, without the Jacobian.
//!
//! Let f be the number's gradient with respect to the velocity of a link and t that with respect to its turn about the link's origin o: a twist
//! (v, w) about o changes the number by f . v + t . w. A joint on the way to the link turns it about an axis u through the origin c of the link that
//! it moves, by the twist w = u, v = u x (o - c), and so changes the number by
//!
//! ```text
//! f . (u x (o - c)) + t . u  =  u . (t + (o - c) x f),
//! ```
//!
//! the moment about c along u; one that slides along d changes it by f . d. So (f, t) is taken along like a force and its moment, from the link
//! to the root, and each joint on the way reads off what it needs. Of two links the joints that move both alike are left out: a common
//! motion of a pair changes nothing.
//!
//! A floating joint with the rotation R(q/|q|), q = (w, v), turns by `2 vec(dq q*) / |q|^2` in the joint's frame when q changes by dq: along dx_i by
//! `2 (w e_i + v x e_i) / |q|^2`, along dw by `-2 v / |q|^2`. Along q itself that is nothing, as it has to be.

use super::RobotModel;
use super::kinematics::{Motion, Step};
use crate::geometry::{Pose, Vec3};

/// The gradient of a number with respect to a twist of a link about its own origin, world axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkGradient {
    /// Index of the link.
    pub link: u32,
    /// Columns vx vy vz wx wy wz; per metre and per radian.
    pub twist: [f64; 6],
}

/// A gradient on its way to the root.
struct Carried {
    link: u32,
    /// World frame, metres.
    origin: Vec3,
    along: Vec3,
    turning: Vec3,
}

impl Carried {
    fn new(of: &LinkGradient, poses: &[Pose]) -> Self {
        let [x, y, z, a, b, c] = of.twist;
        let origin = poses[of.link as usize].translation();
        Self { link: of.link, origin, along: Vec3::new(x, y, z), turning: Vec3::new(a, b, c) }
    }

    /// With respect to a turn about a point of the world.
    fn turning_about(&self, point: Vec3) -> Vec3 {
        self.turning + (self.origin - point).cross(&self.along)
    }

    /// Adds what the joint of a step on the way does.
    fn read(&self, step: &Step, positions: &[f64], poses: &[Pose], gradient: &mut [f64]) {
        let child = poses[step.link as usize].placement();
        let parent = || poses[step.parent as usize].placement();
        match step.motion {
            Motion::Fixed => {}
            // A turn leaves its own axis where it is.
            Motion::Turn { axis, coordinate } => {
                let turning = child.direction(axis).dot(&self.turning_about(child.translation));
                gradient[coordinate.index] += coordinate.multiplier * turning;
            }
            Motion::Slide { direction, coordinate } => {
                gradient[coordinate.index] += coordinate.multiplier * parent().direction(direction).dot(&self.along);
            }
            Motion::Free { first } => {
                let joint = parent().rotation * step.origin.placement().rotation;
                let along = joint.tr_mul(&self.along);
                let turning = joint.tr_mul(&self.turning_about(child.translation));
                free(&positions[first + 3..first + 7], along, turning, &mut gradient[first..first + 7]);
            }
        }
    }
}

/// Of a floating joint, from what moves and turns it in its own frame. Quaternion: x, y, z, w.
fn free(quaternion: &[f64], along: Vec3, turning: Vec3, gradient: &mut [f64]) {
    // Divided by its largest component first, so that no square over- or underflows.
    let largest = quaternion.iter().fold(0.0_f64, |most, component| most.max(component.abs()));
    let [x, y, z, w] = [0, 1, 2, 3].map(|i| quaternion[i] / largest);
    let v = Vec3::new(x, y, z);
    let scale = 2.0 / (v.norm_squared() + w * w) / largest;
    // (v x e_i) . t = (t x v) . e_i
    let of_vector = (turning * w + turning.cross(&v)) * scale;
    for i in 0..3 {
        gradient[i] += along[i];
        gradient[3 + i] += of_vector[i];
    }
    gradient[6] -= scale * v.dot(&turning);
}

impl RobotModel {
    /// The gradient, with respect to every number of a position vector, of a number that hangs on where one or two links are, as the signed
    /// distance of a pair does. `poses` are the links' at these positions ([`RobotModel::link_poses`]). Joints that move both links alike add
    /// nothing.
    ///
    /// # Panics
    /// On positions that [`RobotModel::check_positions`] refuses, and on poses of another model.
    #[must_use]
    pub fn joint_gradient(
        &self,
        positions: &[f64],
        poses: &[Pose],
        one: &LinkGradient,
        other: Option<&LinkGradient>,
    ) -> Vec<f64> {
        let mut gradient = vec![0.0; self.degrees_of_freedom()];
        let mut one = Carried::new(one, poses);
        let mut other = other.map(|other| Carried::new(other, poses));
        // Each link comes after the one it hangs from, so backwards both ways to the root are met in order.
        for step in self.kinematics().steps.iter().rev() {
            if other.as_ref().is_some_and(|other| other.link == one.link) {
                break;
            }
            for side in std::iter::once(&mut one).chain(&mut other) {
                if side.link == step.link {
                    side.read(step, positions, poses, &mut gradient);
                    side.link = step.parent;
                }
            }
        }
        gradient
    }
}
