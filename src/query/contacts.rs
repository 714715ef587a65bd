//! What is asked about contacts, and what became of them from one revision to another.
//!
//! A pair of bodies is in one of three states: in contact, apart, or undecided where the bracket does not tell. Events are
//! the differences of the states at two revisions, whatever happened in between; `docs/queries.md` has the table.

use super::answer::{PairAnswer, Refused};
use super::declared::Coverage;
use super::request::{Filter, Wants};
use crate::limits::LimitExceeded;
use crate::narrow_phase::{Accuracy, Cost, DerivativeGoal, MOST_POINTS, Solver};
use crate::scene::{BodyId, Epoch, Revision};

/// When is a pair in contact?
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Threshold {
    /// When it is proved to touch or overlap. Margins do not count, nor do the scene's entries for them.
    #[default]
    Touching,
    /// When it is proved to be within this margin, metres, not negative; a scene's entry for a pair replaces it.
    Margin(f64),
}

/// What is tracked.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactQuestion {
    /// When a pair is in contact.
    pub threshold: Threshold,
    /// What is computed of each pair: `distance`, `witness`, `depth`, `patch` and `derivatives`.
    pub wants: Wants,
    /// How narrow brackets have to be where `distance` is wanted.
    pub accuracy: Accuracy,
    /// Who measures each pair.
    pub solver: Solver,
    /// Which pairs count. A group without members and a body that left are no error after the first revision.
    pub filter: Filter,
    /// List what stays, too. Costs time and memory in proportion to the contacts there are.
    pub stays: bool,
    /// Points of a contact patch at most, from 1 to [`MOST_POINTS`](crate::narrow_phase::MOST_POINTS).
    pub max_patch_points: usize,
    /// How derivatives are made, where they are wanted.
    pub derivatives: DerivativeGoal,
    /// Pairs held at a time, in contact or undecided; with more of them there is no leading on.
    pub max_contacts: usize,
}

impl Default for ContactQuestion {
    fn default() -> Self {
        Self {
            threshold: Threshold::Touching,
            wants: Wants::VERDICT,
            accuracy: Accuracy::default(),
            solver: Solver::Default,
            filter: Filter::default(),
            stays: false,
            max_patch_points: MOST_POINTS,
            derivatives: DerivativeGoal::default(),
            max_contacts: 250_000,
        }
    }
}

/// What is known of a pair at a revision.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactState {
    /// Proved beyond the threshold, or no pair at all.
    Apart,
    /// The bracket straddles the threshold.
    Undecided,
    /// Proved within the threshold.
    Contact,
}

/// What became of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactEventKind {
    /// It is in contact, and was not known to be.
    Begin,
    /// It is what it was: in contact, or undecided.
    Stay,
    /// It is apart, or no pair any more, and was not known to be.
    End,
    /// It cannot be decided any more.
    Undecided,
}

/// Why a pair is not in contact any more. The first that applies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EndReason {
    /// A side left the scene.
    Removed,
    /// A side is not enabled.
    Disabled,
    /// Layers, groups, the filter or an allowed collision keep the pair from being looked at, or neither side has bounds.
    NotAPair,
    /// It was measured, and is proved beyond the threshold.
    Apart,
}

/// One pair from one revision to the next.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactEvent {
    /// The lower id.
    pub a: BodyId,
    /// The higher id.
    pub b: BodyId,
    /// What became of the pair: follows from the two states.
    pub kind: ContactEventKind,
    /// The pair at the revision led on from.
    pub before: ContactState,
    /// The pair at the new revision.
    pub after: ContactState,
    /// Of `End`: why.
    pub reason: Option<EndReason>,
    /// Of everything but `End`: what is known of the pair at the new revision.
    pub pair: Option<PairAnswer>,
}

/// What became of the contacts.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactChanges {
    /// Which life of the scene.
    pub epoch: Epoch,
    /// The revision that the events lead on from; none: from nothing, so that every contact begins.
    pub from: Option<Revision>,
    /// The revision that they lead to.
    pub revision: Revision,
    /// In the order of the pairs.
    pub events: Vec<ContactEvent>,
    /// Pairs in contact at the new revision.
    pub contacts: usize,
    /// Undecided pairs at the new revision.
    pub undecided: usize,
    /// What no event says anything about.
    pub coverage: Coverage,
    /// What it cost.
    pub cost: Cost,
}

/// Why a tracker was not led on. It is as it was.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NotAdvanced {
    /// The question cannot be asked.
    #[error(transparent)]
    Refused(#[from] Refused),
    /// The snapshot is of another epoch than the contacts.
    #[error("the contacts are of epoch {tracked}, the snapshot of epoch {asked}")]
    OtherEpoch {
        /// The snapshot's.
        asked: Epoch,
        /// The tracker's.
        tracked: Epoch,
    },
    /// The snapshot is earlier than the contacts.
    #[error("the contacts are of revision {tracked}, the snapshot of the earlier revision {asked}")]
    Backwards {
        /// The snapshot's.
        asked: Revision,
        /// The tracker's.
        tracked: Revision,
    },
    /// More pairs than may be held.
    #[error(transparent)]
    TooMany(#[from] LimitExceeded),
    /// The caller said stop.
    #[error("stopped before all pairs were measured")]
    Stopped,
}

/// The lower id first.
pub(super) type PairKey = (BodyId, BodyId);

impl ContactEvent {
    /// What becomes of a pair that goes from one state to another, without the reason and what is known of it.
    pub(super) fn of((a, b): PairKey, before: ContactState, after: ContactState) -> Self {
        let kind = match (before, after) {
            (ContactState::Contact, ContactState::Contact) | (ContactState::Undecided, ContactState::Undecided) => {
                ContactEventKind::Stay
            }
            (_, ContactState::Contact) => ContactEventKind::Begin,
            (_, ContactState::Undecided) => ContactEventKind::Undecided,
            (_, ContactState::Apart) => ContactEventKind::End,
        };
        Self { a, b, kind, before, after, reason: None, pair: None }
    }
}
