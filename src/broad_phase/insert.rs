//! How an entry comes in: down to the leaf that it makes least dearer, and nodes that overflow are divided.
//!
//! A full leaf's nine entries are divided in two by the best split there is. If their parent is full too, the two halves
//! get a node of their own as long as the tree may get taller there; else the parent's nine children are divided, and so
//! on upward, like in a B-tree (Bayer, McCreight, 1972). So divisions hardly ever reach the nodes near the root, whose
//! halves would overlap much, and still no order of insertions makes a chain of it.

use std::sync::Arc;

use arrayvec::ArrayVec;

use super::arrange::{Item, halve};
use super::node::{Entry, Inner, Kid, Leaf, lanes_of};
use super::places::Places;
use super::tree::DynamicTree;
use super::volume::{BoundingVolume, LANES};

/// The fewest entries or children on one side of a division.
const LEAST_SIDE: usize = 3;

impl<V: BoundingVolume> DynamicTree<V> {
    /// Puts an entry into the tree.
    pub(super) fn place(&mut self, entry: &Entry<V>) {
        let tallest = tallest(self.count);
        let places = &mut self.places;
        let Some(root) = &mut self.root else {
            let id = places.new_node();
            places.set_leaf(entry.slot, id);
            places.set_root(id);
            self.root = Some(Kid::Leaf(Arc::new(Leaf::of(id, std::slice::from_ref(entry)))));
            return;
        };
        let bound = entry.volume.bound();
        let way = Search::for_leaf(root, &bound);
        let Some(sibling) = place_in(root, entry, &bound, way, tallest, places) else { return };
        let mut above = Inner::empty(places.new_node(), root.level().max(sibling.level()) + 1);
        places.set_root(above.id);
        let Some(old) = self.root.take() else { return };
        for kid in [old, sibling] {
            adopt(&mut above, kid, places);
        }
        above.arranged = above.spread();
        self.root = Some(Kid::Inner(Arc::new(above)));
    }
}

/// The highest level that a root of a tree of so many entries may get by anything but a division: half more than the
/// least one, and two.
pub(super) fn tallest(count: usize) -> u32 {
    3 * (count.max(1) as u64).ilog(LANES as u64) / 2 + 2
}

/// Adds a child to a node that has room.
pub(super) fn adopt<V: BoundingVolume>(inner: &mut Inner<V>, kid: Kid<V>, places: &mut Places) {
    places.set_parent(kid.id(), inner.id, inner.kids.len());
    let bound = kid.bound();
    inner.push(kid, &bound);
}

/// Puts an entry into the leaf at the end of `way`, the next lane in its lowest three bits; gives back what had no room
/// any more, for the parent to take.
fn place_in<V: BoundingVolume>(
    kid: &mut Kid<V>,
    entry: &Entry<V>,
    bound: &V::Bound,
    way: u64,
    tallest: u32,
    places: &mut Places,
) -> Option<Kid<V>> {
    match kid {
        Kid::Leaf(leaf) => {
            let leaf = Arc::make_mut(leaf);
            if leaf.entries.len() < LANES {
                places.set_leaf(entry.slot, leaf.id);
                leaf.push(entry);
                leaf.arranged = leaf.arranged.max(V::cost(&leaf.bound()));
                return None;
            }
            Some(divide_leaf(leaf, entry, places))
        }
        Kid::Inner(inner) => {
            let inner = Arc::make_mut(inner);
            let lane = (way & 7) as usize;
            let before = V::get(&inner.lanes, lane);
            let sibling = place_in(&mut inner.kids[lane], entry, bound, way >> 3, tallest.saturating_sub(1), places);
            inner.level = inner.level.max(inner.kids[lane].level() + 1);
            let Some(sibling) = sibling else {
                let after = V::union(&before, bound);
                if after != before {
                    V::put(&mut inner.lanes, lane, &after);
                    inner.arranged += V::cost(&after) - V::cost(&before);
                }
                return None;
            };
            let after = inner.kids[lane].bound();
            V::put(&mut inner.lanes, lane, &after);
            if inner.kids.len() < LANES {
                adopt(inner, sibling, places);
                inner.arranged = inner.spread();
                return None;
            }
            let level = inner.kids[lane].level().max(sibling.level()) + 1;
            if level < tallest {
                // The two halves get a node of their own: that costs a visit here, a division would spoil nodes above.
                inner.level = inner.level.max(level + 1);
                let mut between = Inner::empty(places.new_node(), level);
                places.set_parent(between.id, inner.id, lane);
                let both = Kid::Inner(Arc::new(Inner::empty(between.id, level)));
                let first = std::mem::replace(&mut inner.kids[lane], both);
                adopt(&mut between, first, places);
                adopt(&mut between, sibling, places);
                between.arranged = between.spread();
                let bound = between.bound();
                inner.kids[lane] = Kid::Inner(Arc::new(between));
                V::put(&mut inner.lanes, lane, &bound);
                inner.arranged = inner.spread();
                return None;
            }
            Some(divide_inner(inner, sibling, places))
        }
    }
}

/// The search for the leaf that makes the tree least dearer: by what all nodes on the way grow, and a share of what the
/// leaf then costs, since its entries are looked at whenever it is. Depth first, what grows least first, and no farther
/// where the rest cannot be better than what was found (branch and bound, as Bittner, Hapala, Havran, "Incremental BVH
/// construction for ray tracing", 2015).
struct Search<'a, V: BoundingVolume> {
    bound: &'a V::Bound,
    /// What any leaf costs at least with the entry in it, as far as it counts.
    least: f32,
    best: f32,
    way: u64,
    /// Nodes that may still be looked at.
    left: u32,
}

/// What one more entry adds to the price of a leaf, as a share of its cost. It keeps small boxes out of the leaf of a
/// floor, which would grow by nothing.
const ENTRY_SHARE: f32 = 1.0 / 8.0;

/// Nodes a search looks at, beyond the way down. Where all boxes overlap, nothing tells the ways apart.
const MOST_LOOKED_AT: u32 = 256;

impl<V: BoundingVolume> Search<'_, V> {
    fn for_leaf(root: &Kid<V>, bound: &V::Bound) -> u64 {
        let least = ENTRY_SHARE * V::cost(bound);
        let mut search = Search::<V> { bound, least, best: f32::INFINITY, way: 0, left: MOST_LOOKED_AT };
        search.look(root, 0.0, 0, 0);
        search.way
    }

    fn look(&mut self, kid: &Kid<V>, grown: f32, way: u64, shift: u32) {
        let Kid::Inner(inner) = kid else { return };
        self.left = self.left.saturating_sub(1);
        let growth = V::growth(&inner.lanes, inner.kids.len(), self.bound);
        let mut untried = ((1_u32 << inner.kids.len()) - 1) as u8;
        while untried != 0 {
            let cheaper = |a: usize, b: usize| if growth.by[b] < growth.by[a] { b } else { a };
            let Some(lane) = lanes_of(untried).reduce(cheaper) else { return };
            untried &= !(1 << lane);
            let price = grown + growth.by[lane];
            if self.best <= price + self.least || (self.left == 0 && self.best < f32::INFINITY) {
                return;
            }
            let way = way | (lane as u64) << shift;
            match &inner.kids[lane] {
                Kid::Leaf(_) => {
                    let price = price + ENTRY_SHARE * growth.after[lane];
                    if price < self.best || self.best == f32::INFINITY {
                        (self.best, self.way) = (price.min(f32::MAX), way);
                    }
                }
                below @ Kid::Inner(_) => self.look(below, price, way, shift + 3),
            }
        }
    }
}

fn divide_leaf<V: BoundingVolume>(leaf: &mut Leaf<V>, entry: &Entry<V>, places: &mut Places) -> Kid<V> {
    let nine: ArrayVec<Entry<V>, { LANES + 1 }> = leaf.all().chain([*entry]).collect();
    let mut items: ArrayVec<Item<V>, { LANES + 1 }> =
        (0..).zip(&nine).map(|(index, entry)| Item::new(entry.volume.bound(), index)).collect();
    let left = halve(&mut items, LEAST_SIDE);
    let side = |items: &[Item<V>]| -> ArrayVec<Entry<V>, LANES> {
        items.iter().map(|item| nine[item.index as usize]).collect()
    };
    let (stays, goes) = (side(&items[..left]), side(&items[left..]));
    let id = places.new_node();
    stays.iter().for_each(|entry| places.set_leaf(entry.slot, leaf.id));
    goes.iter().for_each(|entry| places.set_leaf(entry.slot, id));
    *leaf = Leaf::of(leaf.id, &stays);
    Kid::Leaf(Arc::new(Leaf::of(id, &goes)))
}

fn divide_inner<V: BoundingVolume>(inner: &mut Inner<V>, sibling: Kid<V>, places: &mut Places) -> Kid<V> {
    let mut nine: ArrayVec<Option<Kid<V>>, { LANES + 1 }> = inner.kids.drain(..).map(Some).collect();
    nine.push(Some(sibling));
    let mut items: ArrayVec<Item<V>, { LANES + 1 }> =
        (0..).zip(nine.iter().flatten()).map(|(index, kid)| Item::new(kid.bound(), index)).collect();
    let left = halve(&mut items, LEAST_SIDE);
    let mut other = Inner::empty(places.new_node(), inner.level);
    inner.lanes = V::no_lanes();
    for (i, item) in items.iter().enumerate() {
        let into = if i < left { &mut *inner } else { &mut other };
        if let Some(kid) = nine[item.index as usize].take() {
            adopt(into, kid, places);
        }
    }
    inner.arranged = inner.spread();
    other.arranged = other.spread();
    Kid::Inner(Arc::new(other))
}
