//! Which entries meet: a box against the tree, the tree against itself, one tree against another.
//!
//! Loops with a stack that grows; each returns what it looked at. Reported is whatever meets by its tight box, in an
//! order that depends on the tree's shape.

use std::ops::ControlFlow;

use super::node_stack::NodeStack;
use super::tree::{DynamicTree, Leaf, NONE, Node};
use crate::geometry::Aabb;

/// What a traversal cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TraversalStats {
    /// Nodes (or pairs of nodes) whose boxes were compared.
    pub nodes: u64,
    /// Entries (or pairs of entries) whose tight boxes were compared.
    pub leaves: u64,
}

impl DynamicTree {
    /// Calls `visit` with the number of every entry whose box has a point in common with `query`, until it breaks.
    pub fn overlap(&self, query: &Aabb, mut visit: impl FnMut(u64) -> ControlFlow<()>) -> TraversalStats {
        let mut stats = TraversalStats::default();
        if self.root == NONE {
            return stats;
        }
        let mut stack = NodeStack::starting_with(self.root);
        while let Some(index) = stack.pop() {
            let node = &self.nodes[index];
            stats.nodes += 1;
            if !node.fat.overlaps(query) {
                continue;
            }
            if !node.is_leaf() {
                stack.push(node.right);
                stack.push(node.left);
                continue;
            }
            let leaf = self.leaf_of(node);
            stats.leaves += 1;
            if leaf.tight.overlaps(query) && visit(leaf.payload).is_break() {
                break;
            }
        }
        stats
    }

    /// Calls `visit` once for every unordered pair of entries whose boxes have a point in common, the lower number
    /// first, until it breaks.
    pub fn self_pairs(&self, mut visit: impl FnMut(u64, u64) -> ControlFlow<()>) -> TraversalStats {
        if self.root == NONE {
            return TraversalStats::default();
        }
        self.pairs_from((self.root, self.root), None, |a, b| visit(a.min(b), a.max(b)))
    }

    /// Calls `visit` for every entry of this tree and every one of `other` whose boxes have a point in common, this
    /// tree's number first, until it breaks.
    pub fn pairs_with(&self, other: &Self, visit: impl FnMut(u64, u64) -> ControlFlow<()>) -> TraversalStats {
        if self.root == NONE || other.root == NONE {
            return TraversalStats::default();
        }
        self.pairs_from((self.root, other.root), Some(other), visit)
    }

    /// Pairs below the two nodes. Without another tree these are nodes of this one, and a node beside itself stands
    /// for the pairs within it.
    fn pairs_from(
        &self,
        start: (u32, u32),
        other: Option<&Self>,
        mut visit: impl FnMut(u64, u64) -> ControlFlow<()>,
    ) -> TraversalStats {
        let within_one_tree = other.is_none();
        let other = other.unwrap_or(self);
        let mut stats = TraversalStats::default();
        let mut stack = NodeStack::starting_with(start);
        while let Some((index_a, index_b)) = stack.pop() {
            let (a, b) = (&self.nodes[index_a], &other.nodes[index_b]);
            if within_one_tree && index_a == index_b {
                if !a.is_leaf() {
                    stack.push((a.left, a.right));
                    stack.push((a.right, a.right));
                    stack.push((a.left, a.left));
                }
                continue;
            }
            stats.nodes += 1;
            if !a.fat.overlaps(&b.fat) {
                continue;
            }
            if a.is_leaf() && b.is_leaf() {
                let (leaf_a, leaf_b) = (self.leaf_of(a), other.leaf_of(b));
                stats.leaves += 1;
                if leaf_a.tight.overlaps(&leaf_b.tight) && visit(leaf_a.payload, leaf_b.payload).is_break() {
                    break;
                }
            } else if b.height > a.height {
                stack.push((index_a, b.right));
                stack.push((index_a, b.left));
            } else {
                stack.push((a.right, index_b));
                stack.push((a.left, index_b));
            }
        }
        stats
    }

    pub(super) fn leaf_of(&self, node: &Node) -> &Leaf {
        &self.leaves[node.right]
    }
}
