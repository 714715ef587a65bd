//! What does a moving box meet, and what first? A ray is a box without extent.

use super::node_stack::NodeStack;
use super::traverse::TraversalStats;
use super::tree::{DynamicTree, NONE};
use crate::geometry::BoxCast;

impl DynamicTree {
    /// Walks through the entries whose boxes the moving box meets within `max_fraction` of its motion, those that may be
    /// met early before others as far as their nodes tell: not in a strict order, so callers sort.
    ///
    /// `visit` gets an entry's number and a proved lower bound of the fraction at which the boxes first touch, and returns
    /// the fraction beyond which it no longer cares. The bound only ever shrinks; entries exactly at it are still
    /// visited, and a negative one ends the walk.
    pub fn cast(&self, cast: &BoxCast, max_fraction: f64, mut visit: impl FnMut(u64, f64) -> f64) -> TraversalStats {
        let mut stats = TraversalStats::default();
        if self.root == NONE {
            return stats;
        }
        let mut bound = max_fraction;
        stats.nodes += 1;
        let Some(first) = cast.first_touch(&self.nodes[self.root].fat) else { return stats };
        let mut stack = NodeStack::starting_with((first, self.root));
        while let Some((fraction, index)) = stack.pop() {
            if bound < 0.0 {
                break;
            }
            if fraction > bound {
                continue;
            }
            let node = &self.nodes[index];
            if node.is_leaf() {
                let leaf = self.leaf_of(node);
                stats.leaves += 1;
                if let Some(fraction) = cast.first_touch(&leaf.tight).filter(|fraction| *fraction <= bound) {
                    bound = bound.min(visit(leaf.payload, fraction));
                }
                continue;
            }
            stats.nodes += 2;
            let touch = |child: u32| cast.first_touch(&self.nodes[child].fat).map(|fraction| (fraction, child));
            let (mut later, mut earlier) = (touch(node.right), touch(node.left));
            if earlier.zip(later).is_some_and(|(one, two)| one.0 > two.0) {
                (later, earlier) = (earlier, later);
            }
            later.into_iter().chain(earlier).for_each(|child| stack.push(child));
        }
        stats
    }
}
