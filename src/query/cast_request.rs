//! Questions about rays, motions, regions and neighbours. Plain data, as decoded once by a transport.

use super::request::{Context, Subject};
use crate::geometry::{Aabb, Pose, Shape, Vec3};
use crate::scene::BodyId;

/// Which of the bodies that are met are told.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CastMode {
    /// The one that is met first.
    #[default]
    First,
    /// Every one, once, where it is first met.
    All,
    /// None by name: whether there is one at all. The quickest.
    Any,
}

/// What does each ray meet?
#[derive(Clone, Debug, PartialEq)]
pub struct CastRays {
    /// Three numbers a ray, metres, world.
    pub origins: Vec<f64>,
    /// Three numbers a ray, of any length but zero.
    pub directions: Vec<f64>,
    /// How far each ray goes, metres; one number for all, or one for each.
    pub lengths: Vec<f64>,
    /// Which hits are told.
    pub mode: CastMode,
    /// The rest. The margin makes rays thick; `max_pairs` limits the hits listed for a ray.
    pub context: Context,
}

/// What moves.
#[derive(Clone, Debug)]
pub enum Moved {
    /// A shape that is not in the scene.
    Shape(Shape),
    /// A body of the scene; at its own place it is not met by itself.
    Body(BodyId),
}

impl Moved {
    /// The body, if it is one of the scene.
    #[must_use]
    pub fn body(&self) -> Option<BodyId> {
        match self {
            Self::Body(id) => Some(*id),
            Self::Shape(_) => None,
        }
    }
}

/// How it moves, over the time 0 to 1: its origin along a straight line, turning about an axis that keeps its direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Way {
    /// Not at all.
    Still,
    /// To a pose in the world, the shorter way around.
    To(Pose),
    /// By so much, in the world's axes.
    By {
        /// Metres.
        displacement: Vec3,
        /// Along the axis, as long as the angle in radians.
        turn: Vec3,
    },
}

/// A shape or body on its way.
#[derive(Clone, Debug)]
pub struct Mover {
    /// What moves.
    pub moved: Moved,
    /// Where it begins, world; `None`: a shape in the world's frame, a body where it is.
    pub start: Option<Pose>,
    /// How it goes on from there.
    pub way: Way,
}

/// What does each moving shape or body meet, among bodies that stay where they are?
#[derive(Clone, Debug)]
pub struct CastShapes {
    /// Answered one by one, in order.
    pub items: Vec<Mover>,
    /// Which hits are told.
    pub mode: CastMode,
    /// Times nearer than this to one another need not be told apart; a part of the motion, in `0..=1`.
    pub resolution: f64,
    /// The rest. A pair is met when it is within its margin.
    pub context: Context,
}

/// When does each pair of moving shapes or bodies meet?
#[derive(Clone, Debug)]
pub struct CheckMovingPairs {
    /// Answered one by one, in order.
    pub items: Vec<[Mover; 2]>,
    /// As of [`CastShapes`].
    pub resolution: f64,
    /// The rest.
    pub context: Context,
}

/// The resolution where none is asked for: a billionth of the motion.
pub const DEFAULT_RESOLUTION: f64 = 1e-9;

/// A part of the world.
#[derive(Clone, Debug)]
pub enum Region {
    /// A box along the axes of the world.
    Box(Aabb),
    /// A ball.
    Ball {
        /// World, metres.
        center: Vec3,
        /// Metres.
        radius: f64,
    },
    /// Any shape.
    Shape {
        /// The shape.
        shape: Shape,
        /// Its frame in the world.
        pose: Pose,
    },
}

/// Which bodies have a point in each region?
#[derive(Clone, Debug)]
pub struct Overlap {
    /// Answered one by one, in order.
    pub items: Vec<Region>,
    /// Tell the bodies whose bounding boxes meet the region's, and do not look at them: a superset, for little.
    pub bounds_only: bool,
    /// The rest. Bodies within the margin are told, too; `max_pairs` limits how many.
    pub context: Context,
}

/// Which bodies are nearest?
#[derive(Clone, Debug)]
pub struct NearestBodies {
    /// Bodies or shapes, answered one by one, in order.
    pub items: Vec<Subject>,
    /// How many of the nearest are told; at least one.
    pub count: usize,
    /// The rest. Bodies beyond the cut-off are not told.
    pub context: Context,
}
