//! Which entries are near a box? Those first that may be nearest, until none left can matter.
//!
//! What touches the box comes before all else, and every node on the way to it has to be opened: so that much of the walk goes
//! by a stack, without distances. Only what is apart waits in a heap, the nearest on top.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use arrayvec::ArrayVec;
use wide::f32x8;

use super::aabb::{BoxBound, BoxLanes, down};
use super::node::{Inner, Kid, Leaf, lanes_of};
use super::node_stack::NodeStack;
use super::traverse::TraversalStats;
use super::tree::DynamicTree;
use super::volume::BoundingVolume;
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
        let Some(root) = tree.root.as_ref().filter(|_| max_distance >= 0.0) else { return stats };
        let mut touching = Touching::new();
        let mut waiting = BinaryHeap::new();
        if max_distance == 0.0 {
            touch(root, query, &mut touching, &mut stats);
        } else {
            approach(root, query, max_distance, &mut touching, &mut waiting, &mut stats);
        }
        let mut bound = max_distance;
        for payload in touching.in_order() {
            bound = bound.min(visit(*payload, 0.0));
            if bound < 0.0 {
                return stats;
            }
        }
        let rounded = query.bound();
        while let Some(Waiting { distance, place }) = waiting.pop() {
            if distance > bound {
                break;
            }
            match place {
                Place::Entry(payload) => bound = bound.min(visit(payload, distance)),
                Place::Inner(inner) => {
                    stats.nodes += 1;
                    let gaps = Gaps::of(&inner.lanes, &rounded, inner.kids.len());
                    gaps.put_off(inner, gaps.within(bound), &mut waiting);
                }
                Place::Leaf(leaf) => {
                    stats.nodes += 1;
                    let near = Gaps::of(&leaf.lanes, &rounded, leaf.entries.len()).within(bound);
                    stats.leaves += u64::from(near.count_ones());
                    for lane in lanes_of(near) {
                        let distance = lower_distance(&leaf.volumes[lane], query);
                        if distance <= bound {
                            waiting.push(Waiting { distance, place: Place::Entry(leaf.payloads[lane]) });
                        }
                    }
                }
            }
        }
        stats
    }
}

/// Finds the entries at distance zero.
///
/// Numbers of which a rounded one parts two boxes differ by more than [`lower_distance`] takes for none: near zero, where `f64` are
/// closest, rounded ones part nothing below 1e-61.
fn touch(root: &Kid<Aabb>, query: &Aabb, touching: &mut Touching, stats: &mut TraversalStats) {
    let probe = query.probe();
    let mut stack = NodeStack::starting_with(root);
    while let Some(kid) = stack.pop() {
        stats.nodes += 1;
        match kid {
            Kid::Inner(inner) => {
                lanes_of(Aabb::meeting(&inner.lanes, &probe).maybe).for_each(|lane| stack.push(&inner.kids[lane]));
            }
            Kid::Leaf(leaf) => {
                let meeting = Aabb::meeting(&leaf.lanes, &probe);
                stats.leaves += u64::from(meeting.maybe.count_ones());
                for lane in lanes_of(meeting.maybe) {
                    if meeting.surely >> lane & 1 != 0 || lower_distance(&leaf.volumes[lane], query) == 0.0 {
                        touching.push(leaf.payloads[lane]);
                    }
                }
            }
        }
    }
}

/// Finds the entries at distance zero, and lets wait what is beside the way to them and within `bound` metres.
fn approach<'a>(
    root: &'a Kid<Aabb>,
    query: &Aabb,
    bound: f64,
    touching: &mut Touching,
    waiting: &mut BinaryHeap<Waiting<'a>>,
    stats: &mut TraversalStats,
) {
    let rounded = query.bound();
    let mut stack = NodeStack::starting_with(root);
    while let Some(kid) = stack.pop() {
        stats.nodes += 1;
        match kid {
            Kid::Inner(inner) => {
                let gaps = Gaps::of(&inner.lanes, &rounded, inner.kids.len());
                lanes_of(gaps.none).for_each(|lane| stack.push(&inner.kids[lane]));
                gaps.put_off(inner, gaps.within(bound) & !gaps.none, waiting);
            }
            Kid::Leaf(leaf) => {
                let near = Gaps::of(&leaf.lanes, &rounded, leaf.entries.len()).within(bound);
                stats.leaves += u64::from(near.count_ones());
                for lane in lanes_of(near) {
                    let distance = lower_distance(&leaf.volumes[lane], query);
                    if distance == 0.0 {
                        touching.push(leaf.payloads[lane]);
                    } else if distance <= bound {
                        waiting.push(Waiting { distance, place: Place::Entry(leaf.payloads[lane]) });
                    }
                }
            }
        }
    }
}

/// The distances of a node's lanes from a box.
struct Gaps {
    /// For each lane at most the [`lower_distance`] of every box below it.
    distances: f32x8,
    /// The lanes that hold something, and those of them at distance zero.
    all: u8,
    none: u8,
}

impl Gaps {
    #[inline(always)]
    fn of(lanes: &BoxLanes, query: &BoxBound, count: usize) -> Self {
        let low = |i: usize| f32x8::from(lanes.0[i]);
        let gap = |axis: usize| {
            // Both negated: the least corner of the one less the greatest of the other, and the other way round. What is not a
            // number can only be in lanes that hold nothing.
            let above = low(axis) + f32x8::splat(query.0[axis + 3]);
            let below = low(axis + 3) + f32x8::splat(query.0[axis]);
            above.fast_max(below).fast_max(f32x8::ZERO)
        };
        let (x, y, z) = (gap(0), gap(1), gap(2));
        let largest = x.fast_max(y).fast_max(z);
        let all = ((1_u32 << count) - 1) as u8;
        let mask = |lanes: f32x8| lanes.to_bitmask() as u8 & all;
        let root = (x * x + y * y + z * z).sqrt();
        let is_squared = largest.simd_lt(f32x8::splat(SQUARED_GAPS.end));
        // A gap alone is a lower bound too.
        let longest = if mask(is_squared) == all {
            root
        } else {
            is_squared.select(root, largest.fast_min(f32x8::splat(f32::MAX)))
        };
        let none = mask(largest.simd_lt(f32x8::splat(SQUARED_GAPS.start)));
        Self { distances: longest * f32x8::splat(BOUND_ROUNDING_DOWN), all, none }
    }

    /// The lanes that may be within `bound` metres.
    #[inline(always)]
    fn within(&self, bound: f64) -> u8 {
        let bound = f32x8::splat(-down(-bound));
        (self.distances.simd_le(bound).to_bitmask() as u8 | self.none) & self.all
    }

    /// Lets those children wait.
    #[inline(always)]
    fn put_off<'a>(&self, inner: &'a Inner<Aabb>, lanes: u8, waiting: &mut BinaryHeap<Waiting<'a>>) {
        if lanes == 0 {
            return;
        }
        let distances = self.distances.to_array();
        for lane in lanes_of(lanes) {
            let place = match &inner.kids[lane] {
                Kid::Inner(inner) => Place::Inner(inner),
                Kid::Leaf(leaf) => Place::Leaf(leaf),
            };
            waiting.push(Waiting { distance: f64::from(distances[lane]), place });
        }
    }
}

/// The numbers of entries at distance zero: on the call stack as long as they are few.
struct Touching {
    few: ArrayVec<u64, 32>,
    many: Vec<u64>,
}

impl Touching {
    fn new() -> Self {
        Self { few: ArrayVec::new(), many: Vec::new() }
    }

    #[inline(always)]
    fn push(&mut self, payload: u64) {
        if self.many.is_empty() {
            if self.few.try_push(payload).is_ok() {
                return;
            }
            self.many.extend(self.few.drain(..));
        }
        self.many.push(payload);
    }

    /// Sorted.
    fn in_order(&mut self) -> &[u64] {
        let all = if self.many.is_empty() { &mut self.few[..] } else { &mut self.many[..] };
        all.sort_unstable();
        all
    }
}

/// What the walk has seen but not visited. The greatest comes out of the heap first, so the order is reversed.
struct Waiting<'a> {
    distance: f64,
    place: Place<'a>,
}

/// Nodes come before entries of the same distance, and entries in the order of their numbers: then the order of visits does
/// not depend on the tree's shape.
enum Place<'a> {
    Inner(&'a Inner<Aabb>),
    Leaf(&'a Leaf<Aabb>),
    Entry(u64),
}

impl Place<'_> {
    /// Of equal distances the greatest rank comes first.
    fn rank(&self) -> (bool, u64) {
        match self {
            Self::Inner(_) | Self::Leaf(_) => (true, 0),
            Self::Entry(payload) => (false, !payload),
        }
    }
}

impl Ord for Waiting<'_> {
    fn cmp(&self, other: &Self) -> Ordering {
        let nearer = other.distance.total_cmp(&self.distance);
        if nearer.is_ne() { nearer } else { self.place.rank().cmp(&other.place.rank()) }
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
