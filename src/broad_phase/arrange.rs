//! How should these be grouped? Builds a subtree over entries, or over existing nodes, by the surface-area heuristic.
//!
//! Top down: a node's things are split in two again and again, the dearest part first, until it has eight children (as
//! Wald, Benthin, Boulos, "Getting rid of packets", 2008, collapse binary trees). A split is chosen among those between
//! eight bins of the centres along the axis on which they spread most (Wald, "On fast construction of SAH-based bounding
//! volume hierarchies", 2007), its price taken in whole leaves, so that leaves come out full. Very many things are parted
//! by the cells of a grid first (`grid.rs`). More bins, or all three axes, take longer and give no better trees. The depth
//! is bounded: a split that would leave a part with more things than its levels can hold is not made.

use std::sync::Arc;

use arrayvec::ArrayVec;

use super::grid;
use super::node::{Entry, Inner, Kid, Leaf};
use super::places::Places;
use super::volume::{BoundingVolume, LANES};

/// Bins along an axis.
const BINS: usize = 8;

/// More things than these are parted by a grid: fewer are not worth looking at 64 cells.
const GRIDDED: usize = 256;

/// What is to be grouped.
pub(super) enum Stock<'a, V: BoundingVolume> {
    /// Into leaves of up to eight.
    Entries(&'a [Entry<V>]),
    /// Under inner nodes.
    Nodes(&'a mut [Option<Kid<V>>]),
}

/// One thing: its bound and its index in the stock.
#[derive(Clone, Copy)]
pub(super) struct Item<V: BoundingVolume> {
    pub(super) bound: V::Bound,
    pub(super) index: u32,
}

/// A part of the items.
pub(super) struct Part<V: BoundingVolume> {
    pub(super) start: usize,
    pub(super) end: usize,
    pub(super) bound: V::Bound,
}

/// Makes nodes over a stock.
pub(super) struct Arranger<'a, V: BoundingVolume> {
    stock: Stock<'a, V>,
    places: &'a mut Places,
    /// Where the leaf of each slot is noted; nowhere but in `places` if there is no list.
    homes: Option<&'a mut Vec<u32>>,
    /// Memory for items on their way to their parts.
    spare: Vec<Item<V>>,
    /// Memory for the cells that items are in.
    numbers: Vec<u8>,
}

/// Inner levels that `count` things need, with room for uneven splits.
pub(super) fn roomy_levels(count: usize) -> u32 {
    (count.max(1) as u64).ilog(LANES as u64) + 3
}

impl<'a, V: BoundingVolume> Arranger<'a, V> {
    pub(super) fn new(stock: Stock<'a, V>, places: &'a mut Places, homes: Option<&'a mut Vec<u32>>) -> Self {
        Self { stock, places, homes, spare: Vec::new(), numbers: Vec::new() }
    }

    /// Things of the stock that one child without children of its own holds.
    fn unit(&self) -> usize {
        match self.stock {
            Stock::Entries(_) => LANES,
            Stock::Nodes(_) => 1,
        }
    }

    /// A node over the items, at least one, with at most `levels` inner levels: `unit` times eight to that power must
    /// hold them. Its bound stands beside it.
    pub(super) fn arrange(&mut self, items: &mut [Item<V>], levels: u32) -> (Kid<V>, V::Bound) {
        let bound = joined(items);
        (self.subtree(items, &bound, levels), bound)
    }

    fn subtree(&mut self, items: &mut [Item<V>], bound: &V::Bound, levels: u32) -> Kid<V> {
        if items.len() <= self.unit() {
            return self.lowest(items);
        }
        let unit = self.unit();
        let most = unit.saturating_mul(LANES.saturating_pow(levels.saturating_sub(1)));
        let gridded = (items.len() > GRIDDED)
            .then(|| grid::parts(items, &mut self.spare, &mut self.numbers, bound, unit, most))
            .flatten();
        let mut parts: ArrayVec<Part<V>, LANES> = gridded.unwrap_or_else(|| {
            let mut parts = ArrayVec::new();
            parts.push(Part { start: 0, end: items.len(), bound: *bound });
            parts
        });
        while parts.len() < LANES {
            // A part that is too large for a child goes first; else the one that is dearest to visit.
            let price = |part: &Part<V>| match part.end - part.start {
                few if few <= unit => None,
                many => Some((many > most, V::cost(&part.bound))),
            };
            let prices = parts.iter().enumerate().filter_map(|(i, part)| price(part).map(|price| (price, i)));
            let Some((_, worst)) = prices.reduce(|a, b| if a.0 < b.0 { b } else { a }) else { break };
            let taken: usize = parts.iter().map(|part| (part.end - part.start).div_ceil(most)).sum();
            let Part { start, end, .. } = parts[worst];
            let room = LANES - (taken - (end - start).div_ceil(most));
            let (left, first, second) = split::<V>(&mut items[start..end], &mut self.spare, unit, most, room);
            parts[worst] = Part { start, end: start + left, bound: first };
            parts.push(Part { start: start + left, end, bound: second });
        }
        let mut inner = Inner::empty(self.places.new_node(), 0);
        for Part { start, end, bound } in parts {
            let kid = self.subtree(&mut items[start..end], &bound, levels - 1);
            self.places.set_parent(kid.id(), inner.id, inner.kids.len());
            inner.level = inner.level.max(kid.level() + 1);
            inner.push(kid, &bound);
        }
        inner.arranged = inner.spread();
        Kid::Inner(Arc::new(inner))
    }

    fn lowest(&mut self, items: &[Item<V>]) -> Kid<V> {
        match &mut self.stock {
            Stock::Entries(entries) => {
                let id = self.places.new_node();
                let own: ArrayVec<Entry<V>, LANES> = items.iter().map(|item| entries[item.index as usize]).collect();
                match self.homes.as_deref_mut() {
                    Some(homes) => own.iter().for_each(|entry| homes[entry.slot as usize] = id),
                    None => own.iter().for_each(|entry| self.places.set_leaf(entry.slot, id)),
                }
                Kid::Leaf(Arc::new(Leaf::of(id, &own)))
            }
            Stock::Nodes(nodes) => nodes[items[0].index as usize].take().expect("each node is taken once"),
        }
    }
}

/// Divides entries of an overfull leaf, or children of an overfull node, in two: at least `least` on each side. The
/// first come before the returned place.
pub(super) fn halve<V: BoundingVolume>(items: &mut [Item<V>], least: usize) -> usize {
    let count = items.len();
    let mut best = (f32::INFINITY, 0, count / 2);
    for axis in 0..3 {
        sort_along::<V>(items, axis);
        let mut after: ArrayVec<V::Bound, { LANES + 1 }> = items.iter().map(|item| item.bound).collect();
        for i in (0..count - 1).rev() {
            after[i] = V::union(&after[i], &after[i + 1]);
        }
        let mut before = items[0].bound;
        for left in 1..count {
            if (least..=count - least).contains(&left) {
                let cost = V::cost(&before) * left as f32 + V::cost(&after[left]) * (count - left) as f32;
                if cost < best.0 {
                    best = (cost, axis, left);
                }
            }
            before = V::union(&before, &items[left].bound);
        }
    }
    if best.1 != 2 {
        sort_along::<V>(items, best.1);
    }
    best.2
}

fn sort_along<V: BoundingVolume>(items: &mut [Item<V>], axis: usize) {
    items.sort_unstable_by(|a, b| {
        let key = |item: &Item<V>| V::centre(&item.bound)[axis];
        key(a).total_cmp(&key(b)).then(a.index.cmp(&b.index))
    });
}

fn joined<V: BoundingVolume>(items: &[Item<V>]) -> V::Bound {
    items[1..].iter().fold(items[0].bound, |all, item| V::union(&all, &item.bound))
}

/// A way to divide a part: at the lower edge of a bin.
struct Split<V: BoundingVolume> {
    price: f32,
    edge: usize,
    /// Things on the first side.
    left: usize,
    first: V::Bound,
    second: V::Bound,
}

/// Reorders the items and says how many go to the first side, and what holds either side. Each side's number of parts of
/// at most `most` things, together, stays within `room`.
fn split<V: BoundingVolume>(
    items: &mut [Item<V>],
    spare: &mut Vec<Item<V>>,
    unit: usize,
    most: usize,
    room: usize,
) -> (usize, V::Bound, V::Bound) {
    let count = items.len();
    let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for item in items.iter() {
        let centre = V::centre(&item.bound);
        for axis in 0..3 {
            low[axis] = low[axis].min(centre[axis]);
            high[axis] = high[axis].max(centre[axis]);
        }
    }
    let extent = |axis: usize| high[axis] / 2.0 - low[axis] / 2.0;
    let longest = (1..3).fold(0, |best, axis| if extent(axis) > extent(best) { axis } else { best });
    let scale = (BINS as f32 * 0.499_999) / extent(longest);
    if !(scale.is_finite() && extent(longest) > 0.0) {
        return cut::<V>(items, unit, most, longest);
    }
    let bin_of = |item: &Item<V>| {
        let centre = V::centre_along(&item.bound, longest);
        (((centre - low[longest]) * scale) as usize).min(BINS - 1)
    };
    let mut counts = [0_usize; BINS];
    let mut bounds = [V::nothing(); BINS];
    for item in items.iter() {
        let bin = bin_of(item);
        counts[bin] += 1;
        bounds[bin] = V::union(&bounds[bin], &item.bound);
    }
    let mut after = bounds;
    for i in (1..BINS - 1).rev() {
        after[i] = V::union(&after[i], &after[i + 1]);
    }
    let mut best: Option<Split<V>> = None;
    let (mut left, mut first) = (0, V::nothing());
    for edge in 1..BINS {
        left += counts[edge - 1];
        first = V::union(&first, &bounds[edge - 1]);
        let right = count - left;
        if left == 0 || right == 0 || left.div_ceil(most) + right.div_ceil(most) > room {
            continue;
        }
        let second = after[edge];
        let price = V::cost(&first) * left.div_ceil(unit) as f32 + V::cost(&second) * right.div_ceil(unit) as f32;
        if best.as_ref().is_none_or(|best| price < best.price) {
            best = Some(Split { price, edge, left, first, second });
        }
    }
    let Some(Split { edge, left, first, second, .. }) = best else { return cut::<V>(items, unit, most, longest) };
    // Through a copy, and without a branch that nobody can predict.
    spare.clear();
    spare.extend_from_slice(items);
    let (mut front, mut back) = (0, left);
    for item in spare.iter() {
        let is_first = bin_of(item) < edge;
        items[if is_first { front } else { back }] = *item;
        front += usize::from(is_first);
        back += usize::from(!is_first);
    }
    debug_assert_eq!(front, left, "items fall into the same bins again");
    (left, first, second)
}

/// Cuts in two full parts where no split between bins will do: all centres equal, or too little room.
fn cut<V: BoundingVolume>(items: &mut [Item<V>], unit: usize, most: usize, axis: usize) -> (usize, V::Bound, V::Bound) {
    let step = if items.len() > most { most } else { unit };
    let left = items.len().div_ceil(step).div_ceil(2) * step;
    let left = if left < items.len() { left } else { items.len() / 2 };
    items.select_nth_unstable_by(left, |a, b| {
        let key = |item: &Item<V>| V::centre(&item.bound)[axis];
        key(a).total_cmp(&key(b)).then(a.index.cmp(&b.index))
    });
    let (first, second) = items.split_at(left);
    (left, joined::<V>(first), joined::<V>(second))
}
