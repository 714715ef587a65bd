//! How far can a link move while the joints move on a straight line? A bound of its speed, from where it is seen to be.
//!
//! A motion is the line `start + t (goal - start)` of joint positions, t from 0 to 1, as exact numbers; joints without
//! limits are not wrapped. A point that joint k turns moves at most `|dq_k| * R` per unit of t, R being its distance from
//! the joint's axis; one that joint k slides moves `|dq_k|`. Summed over the joints on the way to the point this bounds
//! the length of its path (Schwarzer, Saha, Latombe 2005). R changes along the motion, by no more than the joints beyond k
//! move the point, which the same sum tells: it is taken from the tip inwards.
//!
//! `docs/derivations/motion.md` has the proof, the rounding of forward kinematics included.

use super::RobotModel;
use super::kinematics::{Motion, Step};
use crate::geometry::tolerance::UNIT_ROUNDOFF;
use crate::geometry::{Ball, Pose, Vec3, length};

/// Error of the rotation of one step of forward kinematics, radians in units of roundoff: 58 for a turning joint.
const TURN_ERROR_ULPS: f64 = 128.0;

/// Error of the translation of one step, in units of roundoff of the step's length and of the distance to the origin:
/// 86 for a joint that moves freely.
const SHIFT_ERROR_ULPS: f64 = 128.0;

/// A position on the line that is computed in doubles, by whatever formula, is within this many roundoffs of the larger
/// of its ends: `start + t (goal - start)` is within 5.
const POSITION_ERROR_ULPS: f64 = 8.0;

/// Sums of up to thousands of rounded terms, all positive, are rounded up by this factor.
const ROUNDING_UP: f64 = 1.0 + 1e-11;

/// No mover: the link hangs from the root by fixed joints.
const NONE: u32 = u32::MAX;

/// The joints of a model that move, as the ways to its links.
#[derive(Clone, Debug)]
pub struct MovingJoints {
    /// Each after the one before it on the way from the root.
    movers: Vec<Mover>,
    /// The last mover on the way to each link.
    last: Vec<u32>,
}

/// A joint that moves.
#[derive(Clone, Debug)]
struct Mover {
    /// The link it moves; a turning joint's axis goes through that link's origin.
    link: u32,
    /// The mover before it on the way from the root.
    before: u32,
    /// How many movers are before it.
    depth: usize,
    /// Of a joint that turns: its axis in the frame of the link it moves, of unit length to rounding.
    axis: Option<Vec3>,
}

/// Where a joint's axis is, world frame.
#[derive(Clone, Copy, Debug)]
pub struct Axis {
    origin: Vec3,
    /// None for a joint that slides.
    direction: Option<Vec3>,
}

/// Why a straight line between two position vectors is not taken as a motion.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NotALine {
    /// The quaternion of a floating joint changes.
    #[error(
        "positions {index} to {} (joint {joint:?}) turn a floating joint: between two quaternions a straight line is no \
         steady turn; keep them equal, and turn by joints with an axis", index + 3
    )]
    TurnsFreely {
        /// Of the first of the four, in the vector.
        index: usize,
        /// The joint it belongs to.
        joint: String,
    },
    /// The two positions are farther apart than a double can say.
    #[error("position {index} (joint {joint:?}) moves beyond all reach")]
    TooFar {
        /// In the vector.
        index: usize,
        /// The joint it belongs to.
        joint: String,
    },
}

impl MovingJoints {
    /// Of a model.
    #[must_use]
    pub fn of(model: &RobotModel) -> Self {
        let mut movers: Vec<Mover> = Vec::new();
        let mut last = vec![NONE; model.links().len()];
        for step in &model.kinematics().steps {
            let before = last[step.parent as usize];
            let axis = match step.motion {
                Motion::Fixed => {
                    last[step.link as usize] = before;
                    continue;
                }
                Motion::Turn { axis, .. } => Some(axis),
                Motion::Slide { .. } | Motion::Free { .. } => None,
            };
            let depth = if before == NONE { 0 } else { movers[before as usize].depth + 1 };
            last[step.link as usize] = movers.len() as u32;
            movers.push(Mover { link: step.link, before, depth, axis });
        }
        Self { movers, last }
    }

    /// How many joints move the link.
    #[must_use]
    pub fn depth(&self, link: u32) -> usize {
        let last = self.last[link as usize];
        if last == NONE { 0 } else { self.movers[last as usize].depth + 1 }
    }

    /// How many joints, from the root on, move both links alike.
    #[must_use]
    pub fn common(&self, one: u32, two: u32) -> usize {
        let (mut a, mut b) = (self.last[one as usize], self.last[two as usize]);
        // Movers are numbered from the root outwards, so the greater number is not on the other way.
        while a != b {
            let step_a = b == NONE || (a != NONE && a > b);
            let from = if step_a { &mut a } else { &mut b };
            *from = self.movers[*from as usize].before;
        }
        if a == NONE { 0 } else { self.movers[a as usize].depth + 1 }
    }

    /// Axes of all moving joints where the links stand at `poses`.
    pub fn axes(&self, poses: &[Pose], axes: &mut Vec<Axis>) {
        axes.clear();
        axes.extend(self.movers.iter().map(|mover| {
            let pose = &poses[mover.link as usize];
            let direction = mover.axis.map(|axis| pose.placement().direction(axis));
            Axis { origin: pose.translation(), direction }
        }));
    }
}

/// A straight line of joint positions.
#[derive(Clone, Debug)]
pub struct JointLine<'a> {
    joints: &'a MovingJoints,
    start: &'a [f64],
    goal: &'a [f64],
    /// By mover: radians or metres per unit of t, rounded up.
    speeds: Vec<f64>,
    /// By link.
    reaches: Vec<Reach>,
}

/// What holds of a link all along a line.
#[derive(Clone, Copy, Debug)]
struct Reach {
    /// Sum of the lengths of all steps from the root to the link's origin, at most; metres.
    length: f64,
    /// How far the computed pose is from the exact one.
    error: PoseError,
}

/// How far a computed pose is from the exact one, at most.
#[derive(Clone, Copy, Debug)]
struct PoseError {
    /// Of the origin, metres.
    shift: f64,
    /// Radians.
    turn: f64,
}

/// A shape of a link, as far as a motion needs to know it.
#[derive(Clone, Copy, Debug)]
pub struct MovedBall {
    /// The link.
    pub link: u32,
    /// The shape's frame in the link's.
    pub in_link: Pose,
    /// Holds the shape, in the shape's frame.
    pub ball: Ball,
}

impl<'a> JointLine<'a> {
    /// The line from one position vector to another, for a robot whose root link is at `base`.
    ///
    /// # Errors
    /// A floating joint that turns, or a joint that moves beyond all reach.
    ///
    /// # Panics
    /// On positions that [`RobotModel::check_positions`] refuses.
    pub fn new(
        model: &RobotModel,
        joints: &'a MovingJoints,
        base: &Pose,
        start: &'a [f64],
        goal: &'a [f64],
    ) -> Result<Self, NotALine> {
        let owner = |index: usize| model.joint_of(index).to_owned();
        let mut speeds = Vec::with_capacity(joints.movers.len());
        let still = Reach { length: 0.0, error: PoseError { shift: 0.0, turn: 0.0 } };
        let mut reaches = vec![still; model.links().len()];
        for step in &model.kinematics().steps {
            let way = Way::of(step, start, goal);
            if let Motion::Free { first } = step.motion {
                let index = first + 3;
                if start[index..index + 4] != goal[index..index + 4] {
                    return Err(NotALine::TurnsFreely { index, joint: owner(index) });
                }
            }
            if !way.speed.is_finite() {
                let index = match step.motion {
                    Motion::Turn { coordinate, .. } | Motion::Slide { coordinate, .. } => coordinate.index,
                    Motion::Free { first } => first,
                    Motion::Fixed => 0,
                };
                return Err(NotALine::TooFar { index, joint: owner(index) });
            }
            if !matches!(step.motion, Motion::Fixed) {
                speeds.push(way.speed * ROUNDING_UP);
            }
            let parent = reaches[step.parent as usize];
            let length = (parent.length + way.length) * (1.0 + 4.0 * f64::EPSILON);
            let error = parent.error.after(&way, length + self::length(base.translation()));
            reaches[step.link as usize] = Reach { length, error };
        }
        Ok(Self { joints, start, goal, speeds, reaches })
    }

    /// The position vector at `t`: the ends themselves at 0 and 1, `start + t (goal - start)` between.
    pub fn positions(&self, t: f64, positions: &mut Vec<f64>) {
        positions.clear();
        if t >= 1.0 {
            positions.extend(self.goal);
        } else {
            positions.extend(self.start.iter().zip(self.goal).map(|(start, goal)| start + t * (goal - start)));
        }
    }

    /// How far any point of a shape may be, at any time, from where the exact motion has it, when its pose is computed
    /// (link poses, then the shape's in the link) from positions computed on the line; metres, at most.
    #[must_use]
    pub fn error(&self, shape: &MovedBall, base: &Pose) -> f64 {
        let reach = self.reaches[shape.link as usize];
        let in_link = length(shape.in_link.translation());
        let way = Way { speed: 0.0, length: in_link, turn_error: 0.0, shift_error: 0.0 };
        let error = reach.error.after(&way, reach.length + in_link + length(base.translation()));
        (error.shift + error.turn * (length(shape.ball.center) + shape.ball.radius)) * ROUNDING_UP
    }

    /// How fast any point of a shape moves at most, metres per unit of t, as long as t is within `half` of the state
    /// that `axes` and the shape's `center` (world frame) belong to.
    ///
    /// `speeds[c]` becomes the speed relative to the link that the first c joints on the way have moved: `speeds[0]` in the world, the
    /// last one zero. There is one more than the link has joints on its way.
    pub fn speeds(&self, shape: &MovedBall, center: Vec3, axes: &[Axis], half: f64, slack: f64, speeds: &mut [f64]) {
        let reach = self.reaches[shape.link as usize];
        let radius = shape.ball.radius + slack;
        // No point is farther from the link's origin than this.
        let beyond = length(shape.in_link.translation()) + length(shape.ball.center) + radius;
        let mut moved = 0.0;
        let mut next = self.joints.last[shape.link as usize];
        while next != NONE {
            let mover = &self.joints.movers[next as usize];
            speeds[mover.depth + 1] = moved;
            let axis = &axes[next as usize];
            let speed = self.speeds[next as usize];
            moved += match axis.direction {
                Some(direction) => {
                    let seen = distance_from_line(center - axis.origin, direction) + radius + half * moved;
                    let stretched = reach.length - self.reaches[mover.link as usize].length + beyond;
                    speed * (seen.min(stretched) * ROUNDING_UP)
                }
                None => speed,
            };
            next = mover.before;
        }
        speeds[0] = moved;
    }

    /// What to add to a radius, metres, so that distances between the computed centre of a shape and computed axes are
    /// no less than the exact ones.
    #[must_use]
    pub fn slack(&self, shape: &MovedBall, base: &Pose) -> f64 {
        let reach = self.reaches[shape.link as usize];
        let extent = reach.length + length(shape.in_link.translation()) + length(shape.ball.center) + shape.ball.radius;
        let extent = extent + length(base.translation());
        4.0 * self.error(shape, base) + (4.0 * reach.error.turn + 128.0 * UNIT_ROUNDOFF) * extent
    }
}

/// |d x r| for a direction of unit length.
fn distance_from_line(r: Vec3, d: Vec3) -> f64 {
    length(r.cross(&d))
}

/// How one step of the tree takes part in a line.
struct Way {
    /// Radians or metres per unit of t.
    speed: f64,
    /// Of the translation, at most, metres.
    length: f64,
    /// Of the angle that computed positions give, radians.
    turn_error: f64,
    /// Of the translation that computed positions give, metres.
    shift_error: f64,
}

impl Way {
    fn of(step: &Step, start: &[f64], goal: &[f64]) -> Self {
        let origin = length(step.origin.translation());
        let single = |coordinate: &super::kinematics::Coordinate| {
            let (from, to) = (start[coordinate.index], goal[coordinate.index]);
            let largest = from.abs().max(to.abs());
            let size = coordinate.multiplier.abs();
            let error = POSITION_ERROR_ULPS * size * largest + 4.0 * (size * largest + coordinate.offset.abs());
            (size * (to - from).abs(), error * UNIT_ROUNDOFF, size * largest + coordinate.offset.abs())
        };
        match &step.motion {
            Motion::Fixed => Self { speed: 0.0, length: origin, turn_error: 0.0, shift_error: 0.0 },
            Motion::Turn { coordinate, .. } => {
                let (speed, turn_error, _) = single(coordinate);
                Self { speed, length: origin, turn_error, shift_error: 0.0 }
            }
            Motion::Slide { coordinate, .. } => {
                let (speed, shift_error, farthest) = single(coordinate);
                Self { speed, length: origin + farthest, turn_error: 0.0, shift_error }
            }
            Motion::Free { first } => {
                let at = |positions: &[f64]| Vec3::from_column_slice(&positions[*first..first + 3]);
                let (from, to) = (at(start), at(goal));
                let farthest = length(from).max(length(to));
                let shift_error = 3.0 * POSITION_ERROR_ULPS * UNIT_ROUNDOFF * farthest;
                Self { speed: length(to - from), length: origin + farthest, turn_error: 0.0, shift_error }
            }
        }
    }
}

impl PoseError {
    /// The error after one more step. `distance`: how far the origin is from the world's, at most.
    fn after(self, way: &Way, distance: f64) -> Self {
        let rounding = SHIFT_ERROR_ULPS * UNIT_ROUNDOFF * (way.length + distance);
        Self {
            shift: (self.shift + self.turn * way.length + way.shift_error + rounding) * ROUNDING_UP,
            turn: (self.turn + way.turn_error + TURN_ERROR_ULPS * UNIT_ROUNDOFF) * ROUNDING_UP,
        }
    }
}
