//! Where is an entry? From its name to its leaf, and from a node to its parent, in arrays that versions share.
//!
//! Readers do not come here. Moving an entry within its leaf changes nothing here either.

use super::pages::Pages;

/// Slots there can be.
const MOST_SLOTS: u32 = 1 << 29;

/// Nodes there can be: a node and a lane in it fit below [`FREE`].
const MOST_NODES: u32 = (1 << 27) - 1;

/// In place of a parent: the node is the root.
const ROOT: u32 = (1 << 30) - 1;

/// Set in a slot's number: the entry waits at that place of the list of changes.
const WAITING: u32 = 1 << 31;

/// Set in a slot's or a node's number: it is free, and the rest says which is the next free one.
const FREE: u32 = 1 << 30;

/// The end of a list of free ones.
const END: u32 = FREE - 1;

/// Steps from the root down that a [`Path`] has room for.
pub(super) const LONGEST_PATH: u32 = 21;

/// Where the entry of a slot is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// In the leaf of that id.
    Leaf(u32),
    /// Not in the tree yet, but at that index of the changes to be made.
    Waiting(u32),
    /// There is no such entry.
    Free,
}

#[derive(Clone, Debug)]
pub(super) struct Places {
    slots: Pages,
    /// By node: the parent's id times eight, plus the lane in it; [`ROOT`] for the root.
    parents: Pages,
    free_slot: u32,
    free_node: u32,
}

impl Places {
    pub(super) fn new() -> Self {
        Self { slots: Pages::default(), parents: Pages::default(), free_slot: END, free_node: END }
    }

    pub(super) fn slot_count(&self) -> usize {
        self.slots.len()
    }

    pub(super) fn node_count(&self) -> usize {
        self.parents.len()
    }

    pub(super) fn place(&self, slot: u32) -> Place {
        let word = self.slots[slot];
        if word & WAITING != 0 {
            Place::Waiting(word & !WAITING)
        } else if word & FREE != 0 {
            Place::Free
        } else {
            Place::Leaf(word)
        }
    }

    pub(super) fn set_leaf(&mut self, slot: u32, leaf: u32) {
        self.slots.set(slot, leaf);
    }

    /// What is kept for each slot, to be changed as a whole.
    pub(super) fn homes(&self) -> Vec<u32> {
        (0..self.slots.len() as u32).map(|slot| self.slots[slot]).collect()
    }

    /// Keeps this for each slot.
    pub(super) fn set_homes(&mut self, homes: &[u32]) {
        self.slots = Pages::of(homes);
    }

    pub(super) fn set_parent(&mut self, node: u32, parent: u32, lane: usize) {
        self.parents.set(node, parent << 3 | lane as u32);
    }

    pub(super) fn set_root(&mut self, node: u32) {
        self.parents.set(node, ROOT);
    }

    /// The parent's id and the lane in it; nothing for the root.
    pub(super) fn parent(&self, node: u32) -> Option<(u32, usize)> {
        let word = self.parents[node];
        (word != ROOT).then_some((word >> 3, (word & 7) as usize))
    }

    /// A slot for an entry that waits at an index of the changes to be made.
    pub(super) fn new_slot(&mut self, waiting: usize) -> u32 {
        let word = WAITING | waiting as u32;
        take(&mut self.slots, &mut self.free_slot, MOST_SLOTS, word)
    }

    pub(super) fn free_slot(&mut self, slot: u32) {
        give(&mut self.slots, &mut self.free_slot, slot);
    }

    /// An id for a node whose parent is set later.
    pub(super) fn new_node(&mut self) -> u32 {
        take(&mut self.parents, &mut self.free_node, MOST_NODES, ROOT)
    }

    pub(super) fn free_node(&mut self, node: u32) {
        give(&mut self.parents, &mut self.free_node, node);
    }

    /// The lanes from the root down to a node, three bits each from the top: nodes in the order of their paths are in
    /// the order of the tree. Nothing if the way is too long.
    pub(super) fn path(&self, node: u32) -> Option<u64> {
        let (mut path, mut steps, mut node) = (0_u64, 0, node);
        while let Some((parent, lane)) = self.parent(node) {
            path = path >> 3 | (lane as u64) << 61;
            node = parent;
            steps += 1;
        }
        (steps <= LONGEST_PATH).then_some(path)
    }

    /// Length of the list of free slots, and of that of free nodes; stops where something on it is not free.
    pub(super) fn free_counts(&self) -> (usize, usize) {
        let chain = |pages: &Pages, first: u32| {
            let (mut length, mut index) = (0, first);
            while index != END && length <= pages.len() && pages[index] & FREE != 0 {
                length += 1;
                index = pages[index] & !FREE;
            }
            length
        };
        (chain(&self.slots, self.free_slot), chain(&self.parents, self.free_node))
    }

    pub(super) fn own_memory(&self) -> usize {
        self.slots.own_memory() + self.parents.own_memory()
    }

    pub(super) fn memory(&self) -> usize {
        self.slots.memory() + self.parents.memory()
    }

    #[cfg(test)]
    pub(super) fn pages_shared_with(&self, other: &Self) -> usize {
        self.slots.shared_with(&other.slots) + self.parents.shared_with(&other.parents)
    }
}

fn take(pages: &mut Pages, free: &mut u32, most: u32, word: u32) -> u32 {
    let index = *free;
    if index == END {
        let index = u32::try_from(pages.len()).ok().filter(|index| *index < most);
        pages.push(word);
        return index.expect("a tree has fewer than 2^29 entries");
    }
    *free = pages[index] & !FREE;
    pages.set(index, word);
    index
}

fn give(pages: &mut Pages, free: &mut u32, index: u32) {
    pages.set(index, FREE | *free);
    *free = index;
}
