//! The dynamic tree from outside: what it holds, and how changes are handed to it.
//!
//! Changes are noted down and made together by [`DynamicTree::settle`], in the order of the tree: each node is then copied
//! and measured once, however many of its entries changed. Questions asked in between answer by the changes all the same.

use std::borrow::Cow;
use std::collections::BTreeMap;

use super::maintain::Upkeep;
use super::node::{Entry, Inner, Kid, Leaf};
use super::places::{Place, Places};
use super::volume::BoundingVolume;
use crate::geometry::Aabb;

/// Names an entry of a tree, from its insertion to its removal; afterwards another entry may get the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ProxyId(pub(super) u32);

/// Bounding volumes with a number each, kept so that the ones that meet a volume, or are near it, are found without
/// looking at all.
///
/// A clone shares everything with its original until one of them changes, and a change copies little: versions for
/// concurrent readers are cheap. Volumes must be finite and not empty.
#[derive(Clone, Debug)]
pub struct DynamicTree<V: BoundingVolume = Aabb> {
    pub(super) root: Option<Kid<V>>,
    pub(super) places: Places,
    /// Entries that are not in the tree yet.
    pub(super) coming: Vec<Entry<V>>,
    /// Moves and removals of entries in it that were not made yet, in their order.
    pub(super) changes: Vec<Change<V>>,
    pub(super) count: usize,
    pub(super) upkeep: Upkeep,
}

/// What is to become of an entry in the tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Change<V> {
    pub(super) volume: V,
    pub(super) slot: u32,
    pub(super) removed: bool,
}

/// In place of the slot of an entry that was taken back before it came into the tree.
pub(super) const TAKEN_BACK: u32 = u32::MAX;

impl<V: BoundingVolume> DynamicTree<V> {
    /// A tree without entries.
    #[must_use]
    pub fn new() -> Self {
        Self {
            root: None,
            places: Places::new(),
            coming: Vec::new(),
            changes: Vec::new(),
            count: 0,
            upkeep: Upkeep::default(),
        }
    }

    /// Adds an entry: a volume, metres, and the caller's number for it.
    pub fn insert(&mut self, volume: V, payload: u64) -> ProxyId {
        let slot = self.places.new_slot(self.coming.len());
        self.coming.push(Entry { volume, payload, slot });
        self.count += 1;
        ProxyId(slot)
    }

    /// Removes an entry. Its name may be given to another one afterwards.
    pub fn remove(&mut self, proxy: ProxyId) {
        self.count -= 1;
        match self.places.place(proxy.0) {
            Place::Waiting(index) => {
                self.coming[index as usize].slot = TAKEN_BACK;
                self.places.free_slot(proxy.0);
            }
            Place::Leaf(_) => {
                let volume = match self.changes.last() {
                    Some(change) => change.volume,
                    None => self.tight(proxy),
                };
                self.changes.push(Change { volume, slot: proxy.0, removed: true });
            }
            Place::Free => unreachable!("an entry is removed once"),
        }
    }

    /// Gives an entry another volume, metres. Says whether the tree has to change for it.
    pub fn move_to(&mut self, proxy: ProxyId, volume: V) -> bool {
        match self.places.place(proxy.0) {
            Place::Waiting(index) => self.coming[index as usize].volume = volume,
            Place::Leaf(_) => self.changes.push(Change { volume, slot: proxy.0, removed: false }),
            Place::Free => unreachable!("an entry that is gone does not move"),
        }
        true
    }

    /// To be called after a list of changes and before the next question: makes the changes, and a share of upkeep that
    /// is bounded by their number. A question asked before has to make them for itself.
    pub fn settle(&mut self) {
        self.flush();
        self.maintain();
    }

    /// Gives back the memory that a settled tree keeps for its next list of changes: for a version that is only read
    /// from now on.
    pub fn release(&mut self) {
        self.changes.shrink_to_fit();
    }

    pub(super) fn is_settled(&self) -> bool {
        self.coming.is_empty() && self.changes.is_empty()
    }

    /// This tree with its changes made.
    pub(super) fn settled(&self) -> Cow<'_, Self> {
        if self.is_settled() {
            return Cow::Borrowed(self);
        }
        let mut settled = self.clone();
        settled.flush();
        Cow::Owned(settled)
    }

    /// Number of entries.
    #[must_use]
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there are no entries.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// The volume of an entry, as it was given last.
    #[must_use]
    pub fn tight(&self, proxy: ProxyId) -> V {
        if let Place::Waiting(index) = self.places.place(proxy.0) {
            return self.coming[index as usize].volume;
        }
        let changed = self.changes.iter().rev().find(|change| change.slot == proxy.0);
        changed.map_or_else(|| self.placed(proxy).volume, |change| change.volume)
    }

    /// The number of an entry.
    #[must_use]
    pub fn payload(&self, proxy: ProxyId) -> u64 {
        match self.places.place(proxy.0) {
            Place::Waiting(index) => self.coming[index as usize].payload,
            Place::Leaf(_) | Place::Free => self.placed(proxy).payload,
        }
    }

    /// All entries, in no order that means anything: number and volume as it was given last.
    pub fn iter(&self) -> impl Iterator<Item = (u64, V)> + '_ {
        let changed: BTreeMap<u32, &Change<V>> = self.changes.iter().map(|change| (change.slot, change)).collect();
        let coming = self.coming.iter().filter(|entry| entry.slot != TAKEN_BACK);
        let placed = self.leaves().flat_map(Leaf::all).filter_map(move |entry| match changed.get(&entry.slot) {
            None => Some((entry.payload, entry.volume)),
            Some(change) if change.removed => None,
            Some(change) => Some((entry.payload, change.volume)),
        });
        coming.map(|entry| (entry.payload, entry.volume)).chain(placed)
    }

    /// All leaves in the order of the tree.
    pub(super) fn leaves(&self) -> impl Iterator<Item = &Leaf<V>> {
        let mut stack: Vec<&Kid<V>> = self.root.iter().collect();
        std::iter::from_fn(move || {
            loop {
                match stack.pop()? {
                    Kid::Leaf(leaf) => return Some(&**leaf),
                    Kid::Inner(inner) => stack.extend(inner.kids.iter().rev()),
                }
            }
        })
    }

    /// All inner nodes, parents before children.
    pub(super) fn inner_nodes(&self) -> impl Iterator<Item = &Inner<V>> {
        let mut stack: Vec<&Kid<V>> = self.root.iter().collect();
        std::iter::from_fn(move || {
            loop {
                if let Kid::Inner(inner) = stack.pop()? {
                    stack.extend(inner.kids.iter().rev());
                    return Some(&**inner);
                }
            }
        })
    }

    /// An entry that is in the tree.
    fn placed(&self, proxy: ProxyId) -> Entry<V> {
        let Place::Leaf(leaf) = self.places.place(proxy.0) else { unreachable!("the entry is in the tree") };
        let mut way = Vec::new();
        let mut node = leaf;
        while let Some((parent, lane)) = self.places.parent(node) {
            way.push(lane);
            node = parent;
        }
        let mut kid = self.root.as_ref();
        while let Some(Kid::Inner(inner)) = kid {
            kid = way.pop().and_then(|lane| inner.kids.get(lane));
        }
        let Some(Kid::Leaf(leaf)) = kid else { unreachable!("the way to an entry ends in its leaf") };
        leaf.lane_of(proxy.0).map(|lane| leaf.entry(lane)).expect("a leaf holds the entries that are placed in it")
    }
}

impl<V: BoundingVolume> Default for DynamicTree<V> {
    fn default() -> Self {
        Self::new()
    }
}
