//! Which entries are near a box? Those first that may be nearest, until none left can matter.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use wide::f32x8;

use super::aabb::{BoxBound, BoxLanes};
use super::node::{Kid, lanes_of};
use super::traverse::TraversalStats;
use super::tree::DynamicTree;
use super::volume::{BoundingVolume, LANES};
use super::walk_by_distance::lower_distance;
use crate::geometry::Aabb;

/// How the distances of nodes' bounds are rounded down, in single precision: two roundings for each gap, five for squares, sums and root,
/// and the one by which the root of a product may come out above the larger factor.
const BOUND_ROUNDING_DOWN: f32 = 1.0 - 8.0 * f32::EPSILON;

/// Gaps of nodes, metres, that are squared: outside of it squares would under- or overflow.
const SQUARED_GAPS: std::ops::Range<f32> = 1e-18..1e18;

impl DynamicTree {
    /// Walks through the entries whose boxes are within `max_distance` metres of `query`, nearest box first, boxes
    /// equally near in the order of their numbers.
    ///
    /// `visit` gets an entry's number and a proved lower bound of the distance between its box and the query's, and
    /// returns the distance beyond which it no longer cares: typically the least true distance found so far. The bound
    /// only ever shrinks; entries exactly at it are still visited, and a negative one ends the walk.
    pub fn nearest(&self, query: &Aabb, max_distance: f64, mut visit: impl FnMut(u64, f64) -> f64) -> TraversalStats {
        let tree = self.settled();
        let mut stats = TraversalStats::default();
        let Some(root) = &tree.root else { return stats };
        let mut bound = max_distance;
        let rounded = query.bound();
        let mut waiting = BinaryHeap::with_capacity(64);
        waiting.push(Waiting { distance: 0.0, place: Place::Node(root) });
        while let Some(Waiting { distance, place }) = waiting.pop() {
            if distance > bound {
                break;
            }
            match place {
                Place::Entry { payload } => bound = bound.min(visit(payload, distance)),
                Place::Node(Kid::Inner(inner)) => {
                    stats.nodes += 1;
                    let distances = lower_distances(&inner.lanes, &rounded);
                    for (kid, distance) in inner.kids.iter().zip(distances) {
                        let distance = f64::from(distance);
                        if distance <= bound {
                            waiting.push(Waiting { distance, place: Place::Node(kid) });
                        }
                    }
                }
                Place::Node(Kid::Leaf(leaf)) => {
                    stats.nodes += 1;
                    let distances = lower_distances(&leaf.lanes, &rounded);
                    let near = distances.map(|distance| f64::from(distance) <= bound);
                    let mask = (0..leaf.entries.len()).fold(0, |mask, lane| mask | u8::from(near[lane]) << lane);
                    stats.leaves += u64::from(mask.count_ones());
                    for lane in lanes_of(mask) {
                        let distance = lower_distance(&leaf.volumes[lane], query);
                        if distance <= bound {
                            waiting.push(Waiting { distance, place: Place::Entry { payload: leaf.payloads[lane] } });
                        }
                    }
                }
            }
        }
        stats
    }
}

/// For each lane at most the [`lower_distance`] of every box below it.
fn lower_distances(lanes: &BoxLanes, query: &BoxBound) -> [f32; LANES] {
    let low = |i: usize| f32x8::from(lanes.0[i]);
    let gap = |axis: usize| {
        // Both negated: the least corner of the one less the greatest of the other, and the other way round.
        let above = low(axis) + f32x8::splat(query.0[axis + 3]);
        let below = low(axis + 3) + f32x8::splat(query.0[axis]);
        above.max(below).max(f32x8::ZERO)
    };
    let (x, y, z) = (gap(0), gap(1), gap(2));
    let root = (x * x + y * y + z * z).sqrt();
    let largest = x.max(y).max(z);
    let (root, largest) = ((root * f32x8::splat(BOUND_ROUNDING_DOWN)).to_array(), largest.to_array());
    std::array::from_fn(|lane| {
        if SQUARED_GAPS.contains(&largest[lane]) {
            root[lane]
        } else if largest[lane] < SQUARED_GAPS.start {
            0.0
        } else {
            // A gap alone is a lower bound too; infinite are only those of lanes without a box.
            (largest[lane] * BOUND_ROUNDING_DOWN).min(f32::MAX)
        }
    })
}

/// What the walk has seen but not visited. The greatest comes out of the heap first, so the order is reversed.
struct Waiting<'a> {
    distance: f64,
    place: Place<'a>,
}

enum Place<'a> {
    /// Nodes come before entries of the same distance, and entries in the order of their numbers: then the order of
    /// visits does not depend on the tree's shape.
    Node(&'a Kid<Aabb>),
    Entry {
        payload: u64,
    },
}

impl Ord for Waiting<'_> {
    fn cmp(&self, other: &Self) -> Ordering {
        other.distance.total_cmp(&self.distance).then_with(|| match (&self.place, &other.place) {
            (Place::Node(_), Place::Node(_)) => Ordering::Equal,
            (Place::Node(_), Place::Entry { .. }) => Ordering::Greater,
            (Place::Entry { .. }, Place::Node(_)) => Ordering::Less,
            (Place::Entry { payload: a }, Place::Entry { payload: b }) => b.cmp(a),
        })
    }
}

impl PartialOrd for Waiting<'_> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Waiting<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Waiting<'_> {}
