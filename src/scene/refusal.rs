//! Why was a list of edits refused? Then nothing of it was done.

use super::{BodyId, Effect, Party, Revision};
use crate::geometry::InvalidShape;
use crate::limits::LimitExceeded;

/// Why a list of edits was refused as a whole.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// The caller's picture of the scene is not the latest.
    #[error("the scene is at revision {actual}, not at the expected {expected}")]
    RevisionMismatch {
        /// What the caller expected.
        expected: Revision,
        /// Where the scene is.
        actual: Revision,
    },
    /// More edits than a list may have.
    #[error(transparent)]
    TooManyEdits(#[from] LimitExceeded),
    /// One edit cannot be made in the state that the earlier ones of the list lead to.
    #[error("edits[{index}].{field}: {reason}")]
    Edit {
        /// Which edit, from zero.
        index: usize,
        /// Which field of it.
        field: &'static str,
        /// What is wrong with the field.
        reason: Reason,
    },
}

/// What is wrong with a field of an edit.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Reason {
    /// A name without characters.
    #[error("a name must not be empty")]
    NameEmpty,
    /// A robot's name with the character that stands between a robot and its link.
    #[error("the name {name:?} of a robot must not contain '/'")]
    NameWithSlash {
        /// As it was given.
        name: String,
    },
    /// A body or robot has that name already.
    #[error("the name {name:?} is taken")]
    NameTaken {
        /// As it was given.
        name: String,
    },
    /// An id that the scene has not given to any body.
    #[error("no body has the id {id}")]
    UnknownId {
        /// As it was given.
        id: BodyId,
    },
    /// An id whose body is gone.
    #[error("the body {id} was removed")]
    BodyRemoved {
        /// As it was given.
        id: BodyId,
    },
    /// A name that no body has.
    #[error("no body is named {name:?}")]
    UnknownBody {
        /// As it was given.
        name: String,
    },
    /// A name that no robot of the scene has.
    #[error("no robot is named {name:?}")]
    UnknownRobot {
        /// As it was given.
        name: String,
    },
    /// A link that the robot does not have.
    #[error("the robot {robot:?} has no link {link:?}")]
    UnknownLink {
        /// The robot's name in the scene.
        robot: String,
        /// As it was given.
        link: String,
    },
    /// An entry for a pair of a body or link with itself.
    #[error("a body or link makes no pair with itself")]
    PairWithItself,
    /// A margin above zero for a pair whose declared effects are without `margin`.
    #[error("the pair of {} and {} is declared without the effect `{effect}`, and has a margin of {margin} m", pair.0, pair.1)]
    NotDeclared {
        /// Both sides.
        pair: Box<(Party, Party)>,
        /// The effect that is lacking.
        effect: Effect,
        /// Metres.
        margin: f64,
    },
    /// NaN or infinite.
    #[error("not a finite number")]
    NotFinite,
    /// Less than zero.
    #[error("{value} is negative")]
    Negative {
        /// As it was given.
        value: f64,
    },
    /// A scale of zero or less.
    #[error("{value} is not positive")]
    NotPositive {
        /// As it was given.
        value: f64,
    },
    /// Points are inserted into voxels and boxes cleared of them, and the body is something else.
    #[error("the body's shape is a {kind}, and only voxels can be edited")]
    NotVoxels {
        /// What the shape is.
        kind: &'static str,
    },
    /// The shape cannot be scaled, padded or edited so.
    #[error(transparent)]
    Shape(#[from] InvalidShape),
    /// A cap of the scene.
    #[error(transparent)]
    Limit(#[from] LimitExceeded),
}

/// Why a snapshot of an earlier or later revision cannot be had.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NotKept {
    /// Forgotten: only the last ones are kept.
    #[error("revision {asked} is gone; the oldest kept is {oldest}")]
    Gone {
        /// The revision asked for.
        asked: Revision,
        /// The oldest that can be had.
        oldest: Revision,
    },
    /// Not reached yet.
    #[error("revision {asked} is not reached yet; the latest is {latest}")]
    Ahead {
        /// The revision asked for.
        asked: Revision,
        /// The latest there is.
        latest: Revision,
    },
}
