//! Whom does an entry for pairs speak of? One body or link, all of a group or robot, or everything.

use super::BodyId;
use super::edit::BodyRef;

/// One side of an entry of the allowed-collision matrix or of the table of margins, as a caller names it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Party {
    /// One body.
    Body(BodyRef),
    /// All bodies of a group, now and later. The group need not have members yet.
    Group(String),
    /// Every body and every link.
    Everything,
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

    fn of_kind(kind: u64, number: u64) -> Self {
        Self(number << 3 | kind)
    }

    /// A body.
    pub(super) fn is_one(self) -> bool {
        self.0 & 7 == 1
    }

    /// A group.
    pub(super) fn is_many(self) -> bool {
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
