//! Whom does an entry for pairs speak of? One body or link, all of a group or robot, or everything.

use std::fmt;

use super::BodyId;
use super::edit::BodyRef;

/// One side of an entry of the allowed-collision matrix, of the table of margins or of the declared effects, as a caller names it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Party {
    /// One body.
    Body(BodyRef),
    /// One link of a robot that stands in the scene.
    Link {
        /// The robot's name in the scene.
        robot: String,
        /// The link's name in its description.
        link: String,
    },
    /// All bodies of a group, now and later. The group need not have members yet.
    Group(String),
    /// All links of a robot that stands in the scene.
    Robot(String),
    /// Every body and every link.
    Everything,
}

impl fmt::Display for Party {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Body(BodyRef::Id(id)) => write!(f, "body {id}"),
            Self::Body(BodyRef::Name(name)) => write!(f, "body {name:?}"),
            Self::Link { robot, link } => write!(f, "link {robot}/{link}"),
            Self::Group(name) => write!(f, "group {name:?}"),
            Self::Robot(name) => write!(f, "robot {name}"),
            Self::Everything => f.write_str("everything"),
        }
    }
}

/// A party as the scene knows it: what kind it is and its number, in one integer. Numbers are never used again, so a
/// key never comes to mean somebody else.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct PartyKey(u64);

impl PartyKey {
    pub(super) const EVERYTHING: Self = Self(0);

    pub(super) fn body(id: BodyId) -> Self {
        Self::of_kind(1, id.0)
    }

    pub(super) fn group(number: u64) -> Self {
        Self::of_kind(2, number)
    }

    pub(super) fn robot(number: u64) -> Self {
        Self::of_kind(3, number)
    }

    /// Links are numbered through, over all robots that ever stood in the scene.
    pub(super) fn link(number: u64) -> Self {
        Self::of_kind(4, number)
    }

    fn of_kind(kind: u64, number: u64) -> Self {
        Self(number << 3 | kind)
    }

    /// A body or a link.
    pub(super) fn is_one(self) -> bool {
        matches!(self.0 & 7, 1 | 4)
    }

    /// A link or a robot as a whole: no entry that names it speaks of two bodies.
    pub(super) fn is_of_robot(self) -> bool {
        matches!(self.0 & 7, 3 | 4)
    }

    /// The body it stands for, if it is one.
    pub(super) fn as_body(self) -> Option<BodyId> {
        (self.0 & 7 == 1).then_some(BodyId(self.0 >> 3))
    }

    /// A group.
    pub(super) fn is_group(self) -> bool {
        self.0 & 7 == 2
    }

    pub(super) fn number(self) -> u64 {
        self.0
    }
}

/// A body or link of a snapshot, with the groups it belongs to: what entries for pairs are looked up by.
#[derive(Clone, Copy, Debug)]
pub struct Member<'a> {
    pub(super) one: PartyKey,
    pub(super) many: &'a [PartyKey],
}
