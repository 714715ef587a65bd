//! How many bytes does a snapshot hold, and how many of them did its own edits add?
//!
//! Counted are the nodes of its maps and of its broad phase, and its bodies. Names and entries of hash maps, whose
//! nodes cannot be seen, are estimated by their number. Shapes are left out: bodies, scenes and robots share them.

use std::sync::Arc;

use super::{Body, Snapshot};

/// What an allocation behind an `Arc` has beside its content.
pub(super) const COUNTS: usize = 2 * size_of::<usize>();

/// An entry of the map from names to ids: its allocation, its share of the map's nodes, and a name of some 20 bytes.
const NAME: usize = 128;

/// Bytes of a snapshot, those it shares with other revisions included.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Memory {
    /// Bodies, and the map from ids to them. Without shapes.
    pub bodies: usize,
    /// Names of bodies, estimated.
    pub names: usize,
    /// Boxes, and what finds them.
    pub broad_phase: usize,
    /// Allowed collisions, margins, declared effects and groups.
    pub entries: usize,
}

impl Memory {
    /// All of it.
    #[must_use]
    pub fn total(&self) -> usize {
        self.bodies + self.names + self.broad_phase + self.entries
    }
}

impl Snapshot {
    /// Bytes of this revision, those it shares with others included. Looks at every node.
    #[must_use]
    pub fn memory(&self) -> Memory {
        Memory {
            bodies: self.bodies.memory() + self.bodies.len() * (size_of::<Body>() + COUNTS),
            names: self.names.size() * NAME,
            broad_phase: self.broad_phase.memory(),
            entries: self.allowed.memory() + self.margins.memory() + self.effects.memory() + self.groups.memory(),
        }
    }

    /// Bytes that the edits which led to this revision wrote anew: what it does not share with the one before. All
    /// revisions that are kept together hold what the oldest holds and what the later ones wrote.
    #[must_use]
    pub fn written(&self) -> usize {
        self.written
    }

    /// To be called on a draft whose edits are made, while the revision before is still there.
    pub(super) fn count_written(&mut self, bodies_added: usize) {
        self.written += self.bodies.own_memory() + self.broad_phase.own_memory() + bodies_added * NAME;
        self.written += self.allowed.own_memory() + self.margins.own_memory() + self.effects.own_memory();
        self.written += self.groups.own_memory();
    }

    /// A body that a draft puts in place: its bytes count as written.
    pub(super) fn store(&mut self, body: Body) {
        self.written += size_of::<Body>() + COUNTS;
        self.bodies.insert(body.id.0, Arc::new(body));
    }
}
