//! What the dynamic tree is made of: leaves of up to eight entries, inner nodes of up to eight children.
//!
//! A node owns its children through counted references and knows nothing above it, so a version of the tree is a root,
//! and a change copies the nodes on the way to it and shares all others. What leads upward, from an entry to its leaf and
//! from a node to its parent, is kept apart (`places.rs`): only the writer needs it, and moves do not change it.

use std::sync::Arc;

use arrayvec::ArrayVec;

use super::volume::{BoundingVolume, LANES};

/// An entry on its way into a leaf.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry<V> {
    pub(super) volume: V,
    pub(super) payload: u64,
    pub(super) slot: u32,
}

/// Up to eight entries: everything a question wants to know of them, side by side.
#[derive(Clone, Debug)]
pub(super) struct Leaf<V: BoundingVolume> {
    pub(super) lanes: V::Lanes,
    pub(super) id: u32,
    /// Its cost when its entries were last chosen, not merely moved.
    pub(super) arranged: f32,
    pub(super) entries: ArrayVec<u32, LANES>,
    pub(super) payloads: [u64; LANES],
    /// In lanes without an entry a copy of some other one.
    pub(super) volumes: [V; LANES],
}

/// Up to eight children.
#[derive(Clone, Debug)]
pub(super) struct Inner<V: BoundingVolume> {
    pub(super) lanes: V::Lanes,
    pub(super) id: u32,
    /// The sum of its children's costs when they were last chosen.
    pub(super) arranged: f32,
    /// At least one more than any child's; a leaf's is zero.
    pub(super) level: u32,
    pub(super) kids: ArrayVec<Kid<V>, LANES>,
}

/// A child: a leaf or an inner node.
#[derive(Clone, Debug)]
pub(super) enum Kid<V: BoundingVolume> {
    Leaf(Arc<Leaf<V>>),
    Inner(Arc<Inner<V>>),
}

impl<V: BoundingVolume> Kid<V> {
    pub(super) fn id(&self) -> u32 {
        match self {
            Self::Leaf(leaf) => leaf.id,
            Self::Inner(inner) => inner.id,
        }
    }

    pub(super) fn level(&self) -> u32 {
        match self {
            Self::Leaf(_) => 0,
            Self::Inner(inner) => inner.level,
        }
    }

    /// Holds everything below. Of a node that is not empty.
    pub(super) fn bound(&self) -> V::Bound {
        match self {
            Self::Leaf(leaf) => leaf.bound(),
            Self::Inner(inner) => inner.bound(),
        }
    }
}

impl<V: BoundingVolume> Leaf<V> {
    /// A leaf of one to eight entries.
    pub(super) fn of(id: u32, entries: &[Entry<V>]) -> Self {
        let mut leaf = Self {
            lanes: V::no_lanes(),
            id,
            arranged: 0.0,
            entries: ArrayVec::new(),
            payloads: [0; LANES],
            volumes: [entries[0].volume; LANES],
        };
        entries.iter().for_each(|entry| leaf.push(entry));
        leaf.arranged = V::cost(&leaf.bound());
        leaf
    }

    pub(super) fn bound(&self) -> V::Bound {
        V::joined(&self.lanes, self.entries.len())
    }

    /// Adds an entry to a leaf that has room.
    pub(super) fn push(&mut self, entry: &Entry<V>) {
        let lane = self.entries.len();
        self.entries.push(entry.slot);
        self.payloads[lane] = entry.payload;
        self.set(lane, &entry.volume);
    }

    pub(super) fn set(&mut self, lane: usize, volume: &V) {
        self.volumes[lane] = *volume;
        V::put(&mut self.lanes, lane, &volume.bound());
    }

    pub(super) fn lane_of(&self, slot: u32) -> Option<usize> {
        self.entries.iter().position(|entry| *entry == slot)
    }

    pub(super) fn entry(&self, lane: usize) -> Entry<V> {
        Entry { volume: self.volumes[lane], payload: self.payloads[lane], slot: self.entries[lane] }
    }

    pub(super) fn all(&self) -> impl Iterator<Item = Entry<V>> + '_ {
        (0..self.entries.len()).map(|lane| self.entry(lane))
    }

    /// Takes an entry out; the last one gets its lane.
    pub(super) fn take(&mut self, lane: usize) -> Entry<V> {
        let entry = self.entry(lane);
        let last = self.entries.len() - 1;
        self.entries.swap_remove(lane);
        if lane != last {
            self.payloads[lane] = self.payloads[last];
            self.volumes[lane] = self.volumes[last];
            let bound = V::get(&self.lanes, last);
            V::put(&mut self.lanes, lane, &bound);
        }
        V::clear(&mut self.lanes, last);
        entry
    }
}

impl<V: BoundingVolume> Inner<V> {
    /// A node without children yet.
    pub(super) fn empty(id: u32, level: u32) -> Self {
        Self { lanes: V::no_lanes(), id, arranged: 0.0, level, kids: ArrayVec::new() }
    }

    pub(super) fn bound(&self) -> V::Bound {
        V::joined(&self.lanes, self.kids.len())
    }

    /// The sum of the children's costs.
    pub(super) fn spread(&self) -> f32 {
        (0..self.kids.len()).map(|lane| V::cost(&V::get(&self.lanes, lane))).sum()
    }

    /// Adds a child to a node that has room.
    pub(super) fn push(&mut self, kid: Kid<V>, bound: &V::Bound) {
        V::put(&mut self.lanes, self.kids.len(), bound);
        self.kids.push(kid);
    }

    /// Takes a child out; the last one gets its lane.
    pub(super) fn take(&mut self, lane: usize) -> Kid<V> {
        let last = self.kids.len() - 1;
        let kid = self.kids.swap_remove(lane);
        if lane != last {
            let bound = V::get(&self.lanes, last);
            V::put(&mut self.lanes, lane, &bound);
        }
        V::clear(&mut self.lanes, last);
        kid
    }
}

/// The lanes of a mask, lowest first.
#[inline(always)]
pub(super) fn lanes_of(mask: u8) -> impl Iterator<Item = usize> {
    let mut left = mask;
    std::iter::from_fn(move || {
        let lane = left.trailing_zeros() as usize;
        (left != 0).then(|| {
            left &= left - 1;
            lane
        })
    })
}
