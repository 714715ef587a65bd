//! What can go wrong with a request as a whole? The closed list that every transport translates.
//!
//! Geometry is never in it: a question that can be asked has a verdict.

use crate::limits::LimitExceeded;
use crate::query::{NotSupposed, Refused, field_of};
use crate::scene::{Effect, Epoch, Party, Reason, Refusal, Revision};

/// Why a request was not answered.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ServiceError {
    /// A field that cannot be as it is, whatever the scene.
    #[error("{field}: {problem}")]
    Invalid {
        /// Path of the field, for example `items[3].shape.box.half_extents.x`.
        field: String,
        /// What is wrong with it.
        problem: String,
    },
    /// Something that is not there.
    #[error("no {what} {name:?}")]
    NotFound {
        /// `scene`, `body`, `robot`, `robot model`, `asset`, `group`.
        what: &'static str,
        /// As it was asked for.
        name: String,
    },
    /// A name that is taken.
    #[error("{what} {name:?} exists already")]
    AlreadyExists {
        /// `scene`.
        what: &'static str,
        /// As it was asked for.
        name: String,
    },
    /// An edit does not fit the scene as it is; nothing was changed.
    #[error("{field}: {problem}")]
    EditRefused {
        /// Path of the field, for example `edits[2].body`.
        field: String,
        /// Why.
        problem: String,
    },
    /// An effect is wanted that the scene does not declare for a pair.
    #[error("the pair of {a} and {b} is declared without the effect `{effect}`, which is wanted")]
    EffectNotDeclared {
        /// Which.
        effect: Effect,
        /// One side.
        a: Party,
        /// The other side.
        b: Party,
    },
    /// An output whose code was left out of the daemon.
    #[error("{field}: this daemon was built without the effect `{effect}`")]
    EffectNotBuilt {
        /// Where it was wanted.
        field: &'static str,
        /// Its name.
        effect: &'static str,
    },
    /// An idempotency key came again with other edits.
    #[error("idempotency_key {key:?} was used before with other edits")]
    KeyReused {
        /// The key.
        key: String,
    },
    /// The scene is in another epoch than was asked for.
    #[error("epoch {asked} was asked for, the scene is in epoch {current}")]
    WrongEpoch {
        /// As asked.
        asked: Epoch,
        /// The scene's.
        current: Epoch,
    },
    /// Compare-and-set lost: the scene is at another revision than was expected.
    #[error("revision {expected} was expected, the scene is at revision {current}")]
    RevisionMovedOn {
        /// As expected.
        expected: Revision,
        /// The scene's.
        current: Revision,
    },
    /// The revision was there, and is not kept any more.
    #[error("revision {asked} is not kept any more, the oldest kept is {oldest}")]
    RevisionGone {
        /// As asked.
        asked: Revision,
        /// The oldest that can be asked.
        oldest: Revision,
    },
    /// The deadline came before the revision.
    #[error("revision {asked} did not come before the deadline, the scene is at revision {current}")]
    RevisionNotYet {
        /// As asked.
        asked: Revision,
        /// The scene's.
        current: Revision,
    },
    /// A cap of the service.
    #[error(transparent)]
    Limit(#[from] LimitExceeded),
    /// The deadline came before anything could be answered.
    #[error("the deadline came before anything could be answered")]
    DeadlineExceeded,
    /// An upload's bytes are not what was announced.
    #[error("{problem}")]
    HashMismatch {
        /// What was announced and what came.
        problem: String,
    },
    /// The daemon drains.
    #[error("the daemon is shutting down")]
    ShuttingDown,
    /// A defect. The daemon goes on; its log says more under the same number.
    #[error("internal error, incident {incident} in the daemon's log")]
    Internal {
        /// Number in the log.
        incident: u64,
    },
}

impl ServiceError {
    /// An invalid field, from anything that says what is wrong.
    pub fn invalid(field: impl Into<String>, problem: impl ToString) -> Self {
        Self::Invalid { field: field.into(), problem: problem.to_string() }
    }

    /// The same error of a request that is a part of another one.
    #[must_use]
    pub fn within(mut self, part: &str) -> Self {
        if let Self::Invalid { field, .. } | Self::EditRefused { field, .. } = &mut self {
            *field = format!("{part}.{field}");
        }
        self
    }

    /// Why the world of an overlay cannot be made; `number` says which overlay.
    #[must_use]
    pub fn of_overlay(error: NotSupposed, number: usize) -> Self {
        let within = |field: &str| format!("{}.{field}", field_of(number));
        match error {
            NotSupposed::Edit(refusal) => {
                let mut error = Self::from(refusal);
                if let Self::Invalid { field, .. } | Self::EditRefused { field, .. } = &mut error {
                    *field = within(field);
                }
                error
            }
            NotSupposed::Attached { index, field, problem } => {
                Self::EditRefused { field: within(&format!("attached[{index}].{field}")), problem }
            }
            NotSupposed::HeldBefore { problem } => Self::EditRefused { field: within("edits"), problem },
        }
    }
}

impl From<Refusal> for ServiceError {
    /// What could never be done is invalid; what another state of the scene would allow is refused.
    fn from(refusal: Refusal) -> Self {
        let (index, field, reason) = match refusal {
            Refusal::RevisionMismatch { expected, actual } => {
                return Self::RevisionMovedOn { expected, current: actual };
            }
            Refusal::TooManyEdits(exceeded) => return Self::Limit(exceeded),
            Refusal::Edit { index, field, reason } => (index, field, reason),
        };
        let (field, problem) = (format!("edits[{index}].{field}"), reason.to_string());
        match reason {
            Reason::Limit(exceeded) => Self::Limit(exceeded),
            Reason::NameEmpty
            | Reason::NameWithSlash { .. }
            | Reason::PairWithItself
            | Reason::NotFinite
            | Reason::Negative { .. }
            | Reason::NotPositive { .. }
            | Reason::Shape(_) => Self::Invalid { field, problem },
            Reason::NameTaken { .. }
            | Reason::NotVoxels { .. }
            | Reason::UnknownId { .. }
            | Reason::BodyRemoved { .. }
            | Reason::UnknownBody { .. }
            | Reason::UnknownRobot { .. }
            | Reason::UnknownLink { .. }
            | Reason::NotDeclared { .. } => Self::EditRefused { field, problem },
        }
    }
}

impl From<Refused> for ServiceError {
    fn from(refused: Refused) -> Self {
        match refused {
            Refused::Invalid { field, problem } => Self::Invalid { field, problem },
            Refused::Gone { asked, oldest } => Self::RevisionGone { asked, oldest },
            Refused::NotFound { what, name, revision: _ } => Self::NotFound { what, name },
            Refused::NotDeclared { effect, a, b } => Self::EffectNotDeclared { effect, a, b },
            Refused::NotBuilt { field, effect } => Self::EffectNotBuilt { field, effect },
        }
    }
}
