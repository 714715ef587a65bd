//! What the dynamic tree is made of.
//!
//! A binary tree of boxes in a flat array. Every leaf has two boxes: the tight one, which decides what is reported, and
//! a fattened one, in which it may move without changing the tree. An inner node's box is the union of its children's
//! fat boxes. Indices are never negative and [`NONE`] stands for no node.

use super::pages::Pages;
use crate::geometry::Aabb;

/// How far a leaf's box is fattened on every side, as a part of its longest side. Larger saves reinsertions of
/// moving bodies, and makes every traversal visit more nodes.
pub const FATTENING_FRACTION: f64 = 1.0 / 16.0;

/// The most a leaf's box is fattened on a side, metres: what a body of a few metres a second moves between two updates
/// at 100 Hz. Larger would make the boxes of large bodies (floors, walls) reach into everything near them.
pub const FATTENING_CAP: f64 = 0.05;

/// Stands for no node and no leaf.
pub(super) const NONE: u32 = u32::MAX;

/// The `height` of a node that is on the free list.
pub(super) const FREE: u32 = u32::MAX;

/// Names an entry of a tree, from its insertion to its removal; afterwards another entry may get the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ProxyId(pub(super) u32);

/// Boxes with a number each, kept so that the ones that meet a box, or are near it, are found without looking at all.
///
/// A clone shares everything with its original until one of them changes, and a change copies little: versions for
/// concurrent readers are cheap. Boxes must be finite and not empty; coordinates up to 1e103 metres are exact enough.
#[derive(Clone, Debug)]
pub struct DynamicTree {
    pub(super) nodes: Pages<Node>,
    pub(super) leaves: Pages<Leaf>,
    pub(super) root: u32,
    pub(super) first_free_node: u32,
    pub(super) first_free_leaf: u32,
    pub(super) count: usize,
}

/// One cache line.
#[derive(Clone, Debug)]
pub(super) struct Node {
    /// Holds everything below.
    pub(super) fat: Aabb,
    /// The node above; of a free node the next free one.
    pub(super) parent: u32,
    /// First child; [`NONE`] for a leaf.
    pub(super) left: u32,
    /// Second child; for a leaf the index of its [`Leaf`].
    pub(super) right: u32,
    /// Zero for a leaf, else one more than the taller child's; [`FREE`] on the free list.
    pub(super) height: u32,
}

/// What the tree keeps for an entry, apart from its node, since traversals read it only when the fat box is met.
#[derive(Clone, Debug)]
pub(super) struct Leaf {
    pub(super) tight: Aabb,
    /// The caller's number; of a free leaf the index of the next free one.
    pub(super) payload: u64,
    /// [`NONE`] for a free leaf.
    pub(super) node: u32,
    /// How often the node's box was changed since the leaf got its place.
    pub(super) stretches: u32,
}

impl Node {
    pub(super) fn is_leaf(&self) -> bool {
        self.left == NONE
    }
}

impl DynamicTree {
    /// A tree without entries.
    #[must_use]
    pub fn new() -> Self {
        Self {
            nodes: Pages::new(),
            leaves: Pages::new(),
            root: NONE,
            first_free_node: NONE,
            first_free_leaf: NONE,
            count: 0,
        }
    }

    /// To be called after a list of changes and before the next question: puts right what the changes put off.
    pub fn settle(&mut self) {}

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

    /// The box of an entry, as it was given last.
    #[must_use]
    pub fn tight(&self, proxy: ProxyId) -> Aabb {
        self.leaves[proxy.0].tight
    }

    /// The number of an entry.
    #[must_use]
    pub fn payload(&self, proxy: ProxyId) -> u64 {
        self.leaves[proxy.0].payload
    }

    /// Bytes of this version, those it shares with others included.
    #[must_use]
    pub fn memory(&self) -> usize {
        self.nodes.len() * size_of::<Node>() + self.leaves.len() * size_of::<Leaf>()
    }

    /// All entries, in no order that means anything: number and tight box.
    pub fn iter(&self) -> impl Iterator<Item = (u64, Aabb)> + '_ {
        self.live_leaves().map(|leaf| (leaf.payload, leaf.tight))
    }

    pub(super) fn live_leaves(&self) -> impl Iterator<Item = &Leaf> {
        let slots = u32::try_from(self.leaves.len()).expect("allocation keeps indices within u32");
        (0..slots).map(|slot| &self.leaves[slot]).filter(|leaf| leaf.node != NONE)
    }

    /// A node from the free list, or a new one.
    pub(super) fn allocate_node(&mut self, node: Node) -> u32 {
        let index = self.first_free_node;
        if index == NONE {
            let index = u32::try_from(self.nodes.len()).ok().filter(|index| *index < NONE);
            self.nodes.push(node);
            return index.expect("a tree has fewer than 2^32 - 1 nodes");
        }
        self.first_free_node = self.nodes[index].parent;
        self.nodes[index] = node;
        index
    }

    pub(super) fn free_node(&mut self, index: u32) {
        let next = self.first_free_node;
        let node = &mut self.nodes[index];
        node.parent = next;
        node.height = FREE;
        self.first_free_node = index;
    }

    /// A leaf from the free list, or a new one.
    pub(super) fn allocate_leaf(&mut self, leaf: Leaf) -> u32 {
        let index = self.first_free_leaf;
        if index == NONE {
            // There are more nodes than leaves, so this cannot be the index that runs out.
            let index = self.leaves.len() as u32;
            self.leaves.push(leaf);
            return index;
        }
        self.first_free_leaf = self.leaves[index].payload as u32;
        self.leaves[index] = leaf;
        index
    }

    pub(super) fn free_leaf(&mut self, index: u32) {
        let next = u64::from(self.first_free_leaf);
        let leaf = &mut self.leaves[index];
        leaf.node = NONE;
        leaf.payload = next;
        self.first_free_leaf = index;
    }
}

impl Default for DynamicTree {
    fn default() -> Self {
        Self::new()
    }
}

/// The box in which an entry may move without changing the tree.
pub(super) fn fattened(tight: &Aabb) -> Aabb {
    let longest = (tight.max - tight.min).max();
    tight.grown((FATTENING_FRACTION * longest).min(FATTENING_CAP))
}

/// What a traversal pays for a box: its surface, by the surface-area heuristic, and a little for its length, so that
/// lines and points, which have no surface, are told apart too. Grows with the box.
pub(super) fn visit_cost(aabb: &Aabb) -> f64 {
    let sides = aabb.max - aabb.min;
    let sum = sides.x + sides.y + sides.z;
    aabb.half_area() + sum * sum / 64.0
}
