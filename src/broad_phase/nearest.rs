//! Which entries are near a box? Those first that may be nearest, until none left can matter.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::traverse::TraversalStats;
use super::tree::{DynamicTree, NONE};
use crate::geometry::Aabb;

/// Distances between boxes are rounded down by this much, relatively, so that none is above the true one: four
/// roundings at most (difference, square, sum, root) go into it.
const ROUNDING_DOWN: f64 = 1.0 - 4.0 * f64::EPSILON;

/// Below this many metres a box distance counts as none: its square would lose digits to underflow.
const LEAST_DISTANCE: f64 = 1e-150;

impl DynamicTree {
    /// Walks through the entries whose boxes are within `max_distance` metres of `query`, nearest box first, boxes
    /// equally near in the order of their numbers.
    ///
    /// `visit` gets an entry's number and a proved lower bound of the distance between its box and the query's, and
    /// returns the distance beyond which it no longer cares: typically the least true distance found so far. The bound
    /// only ever shrinks; entries exactly at it are still visited, and a negative one ends the walk.
    pub fn nearest(&self, query: &Aabb, max_distance: f64, mut visit: impl FnMut(u64, f64) -> f64) -> TraversalStats {
        let mut stats = TraversalStats::default();
        if self.root == NONE {
            return stats;
        }
        let mut bound = max_distance;
        let mut waiting = BinaryHeap::with_capacity(64);
        let start = lower_distance(&self.nodes[self.root].fat, query);
        stats.nodes += 1;
        waiting.push(Waiting { distance: start, place: Place::Node(self.root) });
        while let Some(Waiting { distance, place }) = waiting.pop() {
            if distance > bound {
                break;
            }
            let index = match place {
                Place::Leaf { payload } => {
                    bound = bound.min(visit(payload, distance));
                    continue;
                }
                Place::Node(index) => index,
            };
            let node = &self.nodes[index];
            if node.is_leaf() {
                let leaf = self.leaf_of(node);
                stats.leaves += 1;
                let distance = lower_distance(&leaf.tight, query);
                if distance <= bound {
                    waiting.push(Waiting { distance, place: Place::Leaf { payload: leaf.payload } });
                }
                continue;
            }
            for child in [node.left, node.right] {
                stats.nodes += 1;
                let distance = lower_distance(&self.nodes[child].fat, query);
                if distance <= bound {
                    waiting.push(Waiting { distance, place: Place::Node(child) });
                }
            }
        }
        stats
    }
}

/// At most the distance between the boxes, metres, and no less for a box that holds another one.
fn lower_distance(a: &Aabb, b: &Aabb) -> f64 {
    let distance = a.distance(b) * ROUNDING_DOWN;
    if distance < LEAST_DISTANCE { 0.0 } else { distance }
}

/// What the walk has seen but not visited. The greatest comes out of the heap first, so the order is reversed.
struct Waiting {
    distance: f64,
    place: Place,
}

enum Place {
    /// Nodes come before leaves of the same distance, and leaves in the order of their numbers: then the order of
    /// visits does not depend on the tree's shape.
    Node(u32),
    Leaf {
        payload: u64,
    },
}

impl Ord for Waiting {
    fn cmp(&self, other: &Self) -> Ordering {
        other.distance.total_cmp(&self.distance).then_with(|| match (&self.place, &other.place) {
            (Place::Node(a), Place::Node(b)) => b.cmp(a),
            (Place::Node(_), Place::Leaf { .. }) => Ordering::Greater,
            (Place::Leaf { .. }, Place::Node(_)) => Ordering::Less,
            (Place::Leaf { payload: a }, Place::Leaf { payload: b }) => b.cmp(a),
        })
    }
}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Waiting {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Waiting {}
