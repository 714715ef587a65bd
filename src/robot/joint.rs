//! Joints that move, and the vector of their positions.

/// How a joint moves, and what its part of a position vector means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointKind {
    /// Turns about its axis within limits; one angle, radians.
    Revolute,
    /// Turns about its axis without end; one angle, radians.
    Continuous,
    /// Slides along its axis within limits; one length, metres.
    Prismatic,
    /// Moves freely; seven numbers: x, y, z in metres, then a quaternion x, y, z, w of any norm but zero (note the
    /// order: w is last, as in ROS messages).
    Floating,
}

impl JointKind {
    /// How many numbers of a position vector belong to such a joint.
    #[must_use]
    pub fn width(self) -> usize {
        match self {
            Self::Revolute | Self::Continuous | Self::Prismatic => 1,
            Self::Floating => 7,
        }
    }

    /// The word URDF has for it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Revolute => "revolute",
            Self::Continuous => "continuous",
            Self::Prismatic => "prismatic",
            Self::Floating => "floating",
        }
    }
}

/// The interval a joint's position is meant to stay in, ends included; radians or metres. Ends may be infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Least position.
    pub lower: f64,
    /// Greatest position.
    pub upper: f64,
}

/// A joint with positions of its own: neither fixed nor a mimic.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// Unique among the robot's joints.
    pub name: String,
    /// How it moves.
    pub kind: JointKind,
    /// Of revolute and prismatic joints.
    pub limits: Option<Limits>,
    /// Where its numbers begin in a position vector; there are `kind.width()` of them.
    pub first: usize,
    /// Index of the link it hangs from.
    pub parent: u32,
    /// Index of the link it moves.
    pub child: u32,
}

/// Why a position vector was refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BadPositions {
    /// Too few or too many numbers.
    #[error("{found} joint positions were given, the robot has {expected}")]
    WrongCount {
        /// Given.
        found: usize,
        /// Needed.
        expected: usize,
    },
    /// NaN or an infinity.
    #[error("position {index} (joint {joint:?}) is not finite")]
    NotFinite {
        /// In the vector.
        index: usize,
        /// The joint it belongs to.
        joint: String,
    },
    /// A length, or the position of a joint that mimics this one, beyond all reach.
    #[error("position {index} (joint {joint:?}) is beyond reach: {value:e}")]
    TooLarge {
        /// In the vector.
        index: usize,
        /// The joint it belongs to.
        joint: String,
        /// What was given.
        value: f64,
    },
    /// The orientation of a floating joint is no orientation.
    #[error("positions {index} to {} (joint {joint:?}) are the zero quaternion", index + 3)]
    ZeroQuaternion {
        /// Of the first of the four, in the vector.
        index: usize,
        /// The joint it belongs to.
        joint: String,
    },
}

/// A position that is not within its joint's limits. Worth knowing, but not an error: such a state has a geometry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutsideLimits {
    /// Of the joint, among the robot's joints.
    pub joint: usize,
    /// Of the number, in the position vector.
    pub index: usize,
    /// Radians or metres.
    pub position: f64,
    /// What it is outside of.
    pub limits: Limits,
}
