//! How should these be grouped? Builds a subtree over entries, or over existing nodes, by the surface-area heuristic.
//!
//! Top down: a node's things are split in two again and again, the dearest part first, until it has eight children (as
//! Wald, Benthin, Boulos, "Getting rid of packets", 2008, collapse binary trees). A split is chosen among those between
//! sixteen bins of the centres (Wald, "On fast construction of SAH-based bounding volume hierarchies", 2007), its price
//! taken in whole leaves, so that leaves come out full. The depth is bounded: a split that would leave a part with more
//! things than its levels can hold is not made.

use std::sync::Arc;

use arrayvec::ArrayVec;

use super::cells::Cells;
use super::node::{Entry, Inner, Kid, Leaf};
use super::places::Places;
use super::volume::{BoundingVolume, LANES};

/// Bins along an axis; half as many for parts of few things.
const BINS: usize = 16;

/// Things that are few. With eight bins for more than that, leaves come out less full, and a tree after churn visits 7 % more.
const FEW: usize = 12;

/// Up to so many things the best split of all three axes is sought, above it of the axis along which they spread most:
/// high up in the tree splits hardly differ.
const ALL_AXES: usize = 512;

/// Entries by their index, wherever they are kept: copying large lists would cost more than asking again.
pub(super) type Supply<'a, V> = &'a dyn Fn(u32) -> Entry<V>;

/// What is to be grouped.
pub(super) enum Stock<'a, V: BoundingVolume> {
    /// Into leaves of up to eight.
    Entries(Supply<'a, V>),
    /// Under inner nodes.
    Nodes(&'a mut [Option<Kid<V>>]),
    /// Under inner nodes, the entries of each cell for themselves.
    Cells(&'a Cells<V>, Supply<'a, V>),
}

/// One thing: its bound, where that is, and its index in the stock.
#[derive(Clone, Copy)]
pub(super) struct Item<V: BoundingVolume> {
    bound: V::Bound,
    centre: [f32; 3],
    pub(super) index: u32,
}

impl<V: BoundingVolume> Item<V> {
    pub(super) fn new(bound: V::Bound, index: u32) -> Self {
        Self { bound, centre: V::centre(&bound), index }
    }
}

/// A part of the items.
struct Part<V: BoundingVolume> {
    start: usize,
    end: usize,
    bound: V::Bound,
}

/// Makes nodes over a stock.
pub(super) struct Arranger<'a, V: BoundingVolume> {
    pub(super) stock: Stock<'a, V>,
    pub(super) places: &'a mut Places,
    /// Where the leaf of each slot is noted; nowhere but in `places` if there is no list.
    pub(super) homes: Option<&'a mut Vec<u32>>,
}

/// Some of the entries, as things to be grouped.
pub(super) fn items_of<V: BoundingVolume>(
    entries: Supply<'_, V>,
    indices: impl IntoIterator<Item = u32>,
) -> Vec<Item<V>> {
    indices.into_iter().map(|index| Item::new(entries(index).volume.bound(), index)).collect()
}

/// Inner levels that `count` things need, with room for uneven splits.
pub(super) fn roomy_levels(count: usize) -> u32 {
    (count.max(1) as u64).ilog(LANES as u64) + 3
}

impl<V: BoundingVolume> Arranger<'_, V> {
    /// Things of the stock that one child without children of its own holds.
    fn unit(&self) -> usize {
        match self.stock {
            Stock::Entries(_) => LANES,
            Stock::Nodes(_) | Stock::Cells(..) => 1,
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
        let mut parts: ArrayVec<Part<V>, LANES> = ArrayVec::new();
        parts.push(Part { start: 0, end: items.len(), bound: *bound });
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
            let part = &mut items[start..end];
            let (left, first, second) = match &self.stock {
                Stock::Cells(cells, _) => split(part, unit, most, room, |item| cells.entries(item.index).len()),
                Stock::Entries(_) | Stock::Nodes(_) => split(part, unit, most, room, |_| 1),
            };
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
                let own: ArrayVec<Entry<V>, LANES> = items.iter().map(|item| entries(item.index)).collect();
                match self.homes.as_deref_mut() {
                    Some(homes) => own.iter().for_each(|entry| homes[entry.slot as usize] = id),
                    None => own.iter().for_each(|entry| self.places.set_leaf(entry.slot, id)),
                }
                Kid::Leaf(Arc::new(Leaf::of(id, &own)))
            }
            Stock::Nodes(nodes) => nodes[items[0].index as usize].take().expect("each node is taken once"),
            Stock::Cells(cells, entries) => {
                let mut own = items_of(entries, cells.entries(items[0].index).iter().copied());
                let levels = roomy_levels(own.len());
                let homes = self.homes.as_deref_mut();
                Arranger { stock: Stock::Entries(*entries), places: self.places, homes }.arrange(&mut own, levels).0
            }
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
        let key = |item: &Item<V>| item.centre[axis];
        key(a).total_cmp(&key(b)).then(a.index.cmp(&b.index))
    });
}

fn joined<V: BoundingVolume>(items: &[Item<V>]) -> V::Bound {
    items[1..].iter().fold(items[0].bound, |all, item| V::union(&all, &item.bound))
}

/// A way to divide a part: at the lower edge of a bin of an axis.
#[derive(Clone, Copy)]
struct Split {
    price: f32,
    axis: usize,
    edge: usize,
}

/// Reorders the items and says how many go to the first side, and what holds either side. Each side's number of parts of
/// at most `most` things, together, stays within `room`.
fn split<V: BoundingVolume>(
    items: &mut [Item<V>],
    unit: usize,
    most: usize,
    room: usize,
    weight: impl Fn(&Item<V>) -> usize,
) -> (usize, V::Bound, V::Bound) {
    let count = items.len();
    let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for item in items.iter() {
        let centre = item.centre;
        for axis in 0..3 {
            // Plain comparisons: no centre is NaN.
            low[axis] = if centre[axis] < low[axis] { centre[axis] } else { low[axis] };
            high[axis] = if centre[axis] > high[axis] { centre[axis] } else { high[axis] };
        }
    }
    let extent = |axis: usize| high[axis] / 2.0 - low[axis] / 2.0;
    let longest = (1..3).fold(0, |best, axis| if extent(axis) > extent(best) { axis } else { best });
    let bins = if count > FEW { BINS } else { BINS / 2 };
    let axes = if count > ALL_AXES { longest..longest + 1 } else { 0..3 };
    // A split makes at most one part more; there are few parts for which that is too many.
    let tight = count.div_ceil(most) >= room;
    let leaves = |count: usize| ((count + unit - 1) >> unit.trailing_zeros()) as i32 as f32;
    let scale_of = |axis: usize| (bins as f32 * 0.499_999) / extent(axis);
    let mut best = Split { price: f32::INFINITY, axis: longest, edge: 0 };
    for axis in axes {
        let scale = scale_of(axis);
        if !(scale.is_finite() && extent(axis) > 0.0) {
            continue;
        }
        let (mut counts, mut weights) = ([0_usize; BINS], [0_usize; BINS]);
        let mut bounds = [V::nothing(); BINS];
        for item in items.iter() {
            let bin = (((item.centre[axis] - low[axis]) * scale) as usize).min(bins - 1);
            counts[bin] += 1;
            weights[bin] += weight(item);
            bounds[bin] = V::union(&bounds[bin], &item.bound);
        }
        // What the second side costs if it begins with each bin; then the first side grows bin by bin.
        let mut dear = [0.0; BINS];
        let (mut second, mut heavier) = (V::nothing(), 0);
        for edge in (1..bins).rev() {
            second = V::union(&second, &bounds[edge]);
            heavier += weights[edge];
            dear[edge] = V::cost(&second) * leaves(heavier);
        }
        let (mut left, mut lighter, mut first) = (0, 0, V::nothing());
        for edge in 1..bins {
            left += counts[edge - 1];
            lighter += weights[edge - 1];
            first = V::union(&first, &bounds[edge - 1]);
            let right = count - left;
            if left == 0 || right == 0 || tight && left.div_ceil(most) + right.div_ceil(most) > room {
                continue;
            }
            let price = V::cost(&first) * leaves(lighter) + dear[edge];
            if best.edge == 0 || price < best.price {
                best = Split { price, axis, edge };
            }
        }
    }
    let Split { axis, edge, .. } = best;
    if edge == 0 {
        return cut::<V>(items, unit, most, longest);
    }
    let scale = scale_of(axis);
    let first_side = |item: &Item<V>| (item.centre[axis] - low[axis]) * scale < edge as f32;
    let (mut front, mut back) = (0, count);
    loop {
        while front < back && first_side(&items[front]) {
            front += 1;
        }
        while front < back && !first_side(&items[back - 1]) {
            back -= 1;
        }
        if front >= back {
            break;
        }
        back -= 1;
        items.swap(front, back);
        front += 1;
    }
    let (first, second) = items.split_at(front);
    (front, joined(first), joined(second))
}

/// Cuts in two full parts where no split between bins will do: all centres equal, or too little room.
fn cut<V: BoundingVolume>(items: &mut [Item<V>], unit: usize, most: usize, axis: usize) -> (usize, V::Bound, V::Bound) {
    let step = if items.len() > most { most } else { unit };
    let left = items.len().div_ceil(step).div_ceil(2) * step;
    let left = if left < items.len() { left } else { items.len() / 2 };
    items.select_nth_unstable_by(left, |a, b| {
        let key = |item: &Item<V>| item.centre[axis];
        key(a).total_cmp(&key(b)).then(a.index.cmp(&b.index))
    });
    let (first, second) = items.split_at(left);
    (left, joined::<V>(first), joined::<V>(second))
}
