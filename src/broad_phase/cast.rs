//! What does a moving box meet, and what first? A ray is a box without extent.
//!
//! Nodes are entered in the order in which the moving box may first touch them, by a slab test of eight bounds at once
//! that errs only to the safe side. What is met, and when, is decided by [`BoxCast::first_touch`] of the entry's box.

use wide::f32x8;

use super::aabb::{BoxLanes, down};
use super::node::{Kid, Leaf, lanes_of};
use super::node_stack::NodeStack;
use super::traverse::TraversalStats;
use super::tree::DynamicTree;
use super::volume::LANES;
use crate::geometry::{Aabb, BoxCast};

/// Fractions of the motion are moved outward by this part of themselves: they come of a difference, a rounded inverse
/// and a product, half a unit in the last place each.
const ROUNDING: f32 = 4.0 * f32::EPSILON;

/// And by this, where products underflow.
const LEAST_FRACTION: f32 = 1e-30;

/// Motions along an axis, metres, whose inverses are proper numbers of `f32`. Along an axis in which the box moves less
/// it is taken to be over the whole of its way at once; one in which it moves more is not looked at.
const MOTIONS: std::ops::Range<f64> = 1e-30..1e30;

impl DynamicTree {
    /// Walks through the entries whose boxes the moving box meets within `max_fraction` of its motion, those that may be
    /// met early before others as far as their nodes tell: not in a strict order, so callers sort.
    ///
    /// `visit` gets an entry's number and a proved lower bound of the fraction at which the boxes first touch, and returns
    /// the fraction beyond which it no longer cares. The bound only ever shrinks; entries exactly at it are still
    /// visited, and a negative one ends the walk.
    pub fn cast(&self, cast: &BoxCast, max_fraction: f64, mut visit: impl FnMut(u64, f64) -> f64) -> TraversalStats {
        let tree = self.settled();
        let mut stats = TraversalStats::default();
        let slabs = Slabs::of(cast);
        let mut bound = max_fraction;
        let mut stack = match &tree.root {
            None => return stats,
            Some(root) => NodeStack::starting_with((0.0_f32, root)),
        };
        while let Some((fraction, kid)) = stack.pop() {
            if bound < 0.0 {
                break;
            }
            if f64::from(fraction) > bound {
                continue;
            }
            stats.nodes += 1;
            let inner = match kid {
                Kid::Inner(inner) => inner,
                Kid::Leaf(leaf) => {
                    let (_, met) = slabs.touched(&leaf.lanes, leaf.entries.len());
                    stats.leaves += u64::from(met.count_ones());
                    bound = in_leaf(leaf, cast, met, bound, &mut visit);
                    continue;
                }
            };
            let (fractions, met) = slabs.touched(&inner.lanes, inner.kids.len());
            // The earliest is put on the stack last: the rest keep their order by insertion.
            let mut order: [(f32, u8); LANES] = [(0.0, 0); LANES];
            let mut count = 0;
            for lane in lanes_of(met) {
                let fraction = fractions[lane];
                let mut at = count;
                while at > 0 && order[at - 1].0 < fraction {
                    order[at] = order[at - 1];
                    at -= 1;
                }
                order[at] = (fraction, lane as u8);
                count += 1;
            }
            for (fraction, lane) in &order[..count] {
                stack.push((*fraction, &inner.kids[usize::from(*lane)]));
            }
        }
        stats
    }
}

fn in_leaf(leaf: &Leaf<Aabb>, cast: &BoxCast, met: u8, mut bound: f64, visit: &mut impl FnMut(u64, f64) -> f64) -> f64 {
    for lane in lanes_of(met) {
        if bound < 0.0 {
            break;
        }
        if let Some(fraction) = cast.first_touch(&leaf.volumes[lane]).filter(|fraction| *fraction <= bound) {
            bound = bound.min(visit(leaf.payloads[lane], fraction));
        }
    }
    bound
}

/// A moving box, ready to be held against eight bounds at once.
struct Slabs {
    /// The start's least corner and negated greatest one, rounded down; in an axis that is not moved along those of the
    /// whole way.
    start: [f32; 6],
    /// One over the motion, by axis.
    inverse: [f32; 3],
    axes: [Axis; 3],
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Axis {
    Forward,
    Backward,
    /// Hardly moved along: overlap on the whole way is asked for.
    Still,
    /// Moved along too far for single precision: not looked at.
    Unbounded,
}

impl Slabs {
    fn of(cast: &BoxCast) -> Self {
        let Aabb { min, max } = &cast.start;
        let mut slabs = Self { start: [0.0; 6], inverse: [0.0; 3], axes: [Axis::Unbounded; 3] };
        for axis in 0..3 {
            let motion = cast.motion[axis];
            let (mut least, mut greatest) = (min[axis], max[axis]);
            slabs.axes[axis] = if MOTIONS.contains(&motion) {
                Axis::Forward
            } else if MOTIONS.contains(&-motion) {
                Axis::Backward
            } else if motion.abs() < MOTIONS.start {
                // Twice the motion covers the rounding of the sum.
                (least, greatest) = (least - 2.0 * motion.abs(), greatest + 2.0 * motion.abs());
                Axis::Still
            } else {
                continue;
            };
            slabs.inverse[axis] = (1.0 / motion) as f32;
            slabs.start[axis] = down(least);
            slabs.start[axis + 3] = down(-greatest);
        }
        slabs
    }

    /// For each of the first `count` lanes a lower bound of the fraction at which the moving box first touches it, and
    /// which of them it may touch at all.
    #[inline(always)]
    fn touched(&self, lanes: &BoxLanes, count: usize) -> ([f32; LANES], u8) {
        let all = f32x8::splat(f32::from_bits(u32::MAX));
        let (mut enters, mut leaves, mut may) = (f32x8::ZERO, f32x8::ONE, all);
        for axis in 0..3 {
            // What the greatest corner has to go until it reaches the lane, and the least one until it leaves it.
            let before = f32x8::from(lanes.0[axis]) + f32x8::splat(self.start[axis + 3]);
            let beyond = -(f32x8::from(lanes.0[axis + 3]) + f32x8::splat(self.start[axis]));
            let (near, far) = match self.axes[axis] {
                Axis::Unbounded => continue,
                Axis::Still => {
                    may &= before.simd_le(f32x8::ZERO) & f32x8::ZERO.simd_le(beyond);
                    continue;
                }
                Axis::Forward => (before, beyond),
                Axis::Backward => (beyond, before),
            };
            let inverse = f32x8::splat(self.inverse[axis]);
            let (near, far) = (near * inverse, far * inverse);
            let (rounding, least) = (f32x8::splat(ROUNDING), f32x8::splat(LEAST_FRACTION));
            enters = enters.fast_max(near - (near.abs() * rounding + least));
            leaves = leaves.fast_min(far + (far.abs() * rounding + least));
        }
        let met = (may & enters.simd_le(leaves)).to_bitmask() as u8;
        (enters.to_array(), met & ((1_u32 << count) - 1) as u8)
    }
}
