//! Which entries meet a volume? Down through every lane that may, eight at a time.
//!
//! Reported is whatever meets by its own volume, in an order that depends on the tree's shape.

use std::ops::ControlFlow;

use super::node::{Kid, Leaf, lanes_of};
use super::node_stack::NodeStack;
use super::tree::DynamicTree;
use super::volume::BoundingVolume;

/// What a traversal cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TraversalStats {
    /// Nodes (or pairs of nodes) whose lanes were compared.
    pub nodes: u64,
    /// Entries (or pairs of entries) that were met by their bounds, so that their volumes decided.
    pub leaves: u64,
}

impl<V: BoundingVolume> DynamicTree<V> {
    /// Calls `visit` with the number of every entry whose volume has a point in common with `query`, until it breaks.
    pub fn overlap(&self, query: &V, mut visit: impl FnMut(u64) -> ControlFlow<()>) -> TraversalStats {
        let tree = self.settled();
        let mut stats = TraversalStats::default();
        let probe = query.probe();
        let mut stack = match &tree.root {
            None => return stats,
            Some(Kid::Leaf(leaf)) => {
                let _ = in_leaf(leaf, query, &probe, &mut stats, &mut visit);
                return stats;
            }
            Some(Kid::Inner(root)) => NodeStack::starting_with(&**root),
        };
        while let Some(node) = stack.pop() {
            stats.nodes += 1;
            for lane in lanes_of(V::meeting(&node.lanes, &probe).maybe) {
                match &node.kids[lane] {
                    Kid::Inner(inner) => stack.push(&**inner),
                    Kid::Leaf(leaf) => {
                        if in_leaf(leaf, query, &probe, &mut stats, &mut visit).is_break() {
                            return stats;
                        }
                    }
                }
            }
        }
        stats
    }
}

#[inline(always)]
fn in_leaf<V: BoundingVolume>(
    leaf: &Leaf<V>,
    query: &V,
    probe: &V::Probe,
    stats: &mut TraversalStats,
    visit: &mut impl FnMut(u64) -> ControlFlow<()>,
) -> ControlFlow<()> {
    stats.nodes += 1;
    let meeting = V::meeting(&leaf.lanes, probe);
    stats.leaves += u64::from(meeting.maybe.count_ones());
    for lane in lanes_of(meeting.maybe) {
        if meeting.surely >> lane & 1 != 0 || leaf.volumes[lane].overlaps(query) {
            visit(leaf.payloads[lane])?;
        }
    }
    ControlFlow::Continue(())
}
