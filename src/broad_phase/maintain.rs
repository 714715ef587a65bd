//! How does the tree stay good while it changes? Parts of it are arranged anew in turn, as fast as changes wear it down.
//!
//! Every change adds to a debt, counted in things to be arranged anew: insertions, removals and entries put in anew much,
//! moves within a leaf little. `settle` pays it off by visiting inner nodes in the order of the tree: near the leaves all
//! entries below a node are grouped anew (up to 512), higher up its dearest descendants (up to 512), if that is cheaper. So the work of a
//! list of changes is bounded by their number, and after some constant times as many changes as there are entries every
//! part has been visited. Treelets: Karras, Aila, "Fast parallel construction of high-quality bounding volume
//! hierarchies", 2013; in turn and by debt is our choice, since it needs no search for the worst.

use std::cmp::Reverse;
use std::collections::BTreeSet;
use std::sync::Arc;

use super::arrange::{Arranger, Item, Stock, items_of};
use super::insert::{adopt, tallest};
use super::node::{Entry, Inner, Kid, Leaf};
use super::places::Places;
use super::settle::free_ids;
use super::tree::DynamicTree;
use super::volume::{BoundingVolume, LANES};

/// What a change adds to the debt, in entries to be arranged anew.
pub(super) const MOVE_DEBT: f64 = 1.0 / 64.0;

/// What an insertion, a removal, or an entry that is put in anew adds.
pub(super) const PLACE_DEBT: f64 = 2.5;

/// At this level and below all entries under a node are grouped anew.
const ENTRY_LEVELS: u32 = 2;

/// One in so many entries of a part is put in anew when the part is grouped: those farthest from its middle (as Beckmann
/// and others, "The R*-tree", 1990, do where a node overflows).
const OUTERMOST: usize = 16;

/// Nodes below a higher node that are grouped anew.
const NODES: usize = 512;

/// Levels a part may use beyond those that it needs when all its nodes are full. Without room good splits are impossible.
const SPARE_LEVELS: u32 = 1;

/// How much upkeep is owed, was done, and where it goes on.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Upkeep {
    /// Things to be arranged anew, less those paid in advance.
    pub(super) debt: f64,
    /// Things arranged anew since the tree was made.
    pub(super) work: u64,
    /// Times that every part was visited.
    pub(super) rounds: u64,
    /// The next node is the first whose way is not before this; of equal ways the highest up to that level.
    next: (u64, Reverse<u32>),
}

impl Upkeep {
    pub(super) fn owe(&mut self, debt: f64) {
        self.debt += debt;
    }

    pub(super) fn paid_in_full(&mut self) {
        self.debt = 0.0;
    }
}

impl<V: BoundingVolume> DynamicTree<V> {
    /// Arranges parts anew until the debt is paid.
    pub(super) fn maintain(&mut self) {
        let mut turns = 0;
        let tallest = tallest(self.count);
        while self.upkeep.debt > 0.0 {
            let Some(Kid::Inner(root)) = &mut self.root else {
                self.upkeep.paid_in_full();
                return;
            };
            let mut upkeeper = Upkeeper { places: &mut self.places, tallest, loose: Vec::new() };
            let done = upkeeper.tend(root, 0, 61, &mut self.upkeep.next);
            let loose = upkeeper.loose;
            if done == 0 {
                // Past the last node: begin again, once.
                self.upkeep.next = (0, Reverse(u32::MAX));
                self.upkeep.rounds += 1;
                turns += 1;
                if turns > 1 {
                    self.upkeep.paid_in_full();
                }
            }
            self.upkeep.debt -= done as f64;
            self.upkeep.work += done as u64;
            loose.iter().for_each(|entry| self.place(entry));
            self.trim_root();
        }
    }
}

/// Arranges parts of a tree anew.
struct Upkeeper<'a, V> {
    places: &'a mut Places,
    /// No part may get so tall that the tree has more levels than this.
    tallest: u32,
    /// Entries to be put in anew.
    loose: Vec<Entry<V>>,
}

impl<V: BoundingVolume> Upkeeper<'_, V> {
    /// Arranges the next node in the order of ways anew, this one or one below, and says how many things it had. `shift`
    /// is where the lane of a child goes into the way.
    fn tend(&mut self, shared: &mut Arc<Inner<V>>, way: u64, shift: u32, next: &mut (u64, Reverse<u32>)) -> usize {
        let tallest = self.tallest.saturating_sub((61 - shift.min(61)) / 3);
        if (way, Reverse(shared.level)) >= *next {
            *next = (way, Reverse(shared.level - 1));
            if shared.level > ENTRY_LEVELS {
                return self.regroup_nodes(shared, tallest);
            }
            // Nothing below needs a visit of its own.
            let span = 1_u64.checked_shl(shift + 3).unwrap_or(u64::MAX);
            *next = (way.saturating_add(span), Reverse(u32::MAX));
            return self.regroup_entries(shared, tallest, shift == 61);
        }
        for lane in 0..shared.kids.len() {
            let below = way | (lane as u64) << shift;
            let end = below + ((1_u64 << shift) - 1);
            if end < next.0 || !matches!(shared.kids[lane], Kid::Inner(_)) {
                continue;
            }
            let inner = Arc::make_mut(shared);
            let Kid::Inner(child) = &mut inner.kids[lane] else { continue };
            let done = self.tend(child, below, shift.saturating_sub(3), next);
            if done > 0 {
                inner.level = inner.level.max(child.level + 1);
                return done;
            }
        }
        0
    }

    /// Groups all entries below a node anew, if that makes it cheaper; some are left to be put in anew, unless the node is
    /// the whole tree.
    fn regroup_entries(&mut self, shared: &mut Arc<Inner<V>>, tallest: u32, whole: bool) -> usize {
        let mut entries: Vec<Entry<V>> = Vec::with_capacity(64);
        shared.kids.iter().for_each(|kid| collect_entries(kid, &mut entries));
        let count = entries.len();
        // Those farthest out may have moved to where another part would hold them better.
        let staying = if whole { count } else { count - count / OUTERMOST };
        if staying < count {
            let middle = V::centre(&shared.bound());
            let distance = |entry: &Entry<V>| {
                let centre = V::centre(&entry.volume.bound());
                (0..3).map(|axis| (centre[axis] - middle[axis]).abs()).fold(0.0, f32::max)
            };
            entries.select_nth_unstable_by(staying, |a, b| distance(a).total_cmp(&distance(b)));
        }
        let outermost = entries.split_off(staying);
        let supply = |index: u32| entries[index as usize];
        let mut items = items_of(&supply, 0..staying as u32);
        let mut arranger = Arranger { stock: Stock::Entries(&supply), places: self.places, homes: None };
        let (kid, _) = arranger.arrange(&mut items, shared.level + SPARE_LEVELS);
        if kid.level() <= tallest && cost_below(&kid) < shared.kids.iter().map(cost_of).sum() {
            shared.kids.iter().for_each(|kid| free_ids(kid, self.places));
            self.replace_kids(Arc::make_mut(shared), kid);
            self.loose.extend(outermost);
        } else {
            free_ids(&kid, self.places);
            shared.kids.iter().for_each(|kid| self.relink(kid));
        }
        count
    }

    /// Groups nodes below a node anew, if that makes it cheaper: its children, and again and again those of the dearest
    /// one instead of it.
    fn regroup_nodes(&mut self, shared: &mut Arc<Inner<V>>, tallest: u32) -> usize {
        let mut tops: Vec<(f32, Kid<V>, V::Bound)> = Vec::with_capacity(NODES);
        let mut dissolved: Vec<Arc<Inner<V>>> = Vec::with_capacity(NODES);
        let (mut before, mut next) = (0.0, Some(Arc::clone(shared)));
        while let Some(inner) = next.take() {
            for (lane, kid) in inner.kids.iter().enumerate() {
                let bound = V::get(&inner.lanes, lane);
                tops.push((V::cost(&bound), kid.clone(), bound));
            }
            dissolved.push(inner);
            if tops.len() + LANES > NODES {
                break;
            }
            let inner_tops = (0..tops.len()).filter(|i| tops[*i].1.level() > 0);
            if let Some(dearest) = inner_tops.reduce(|a, b| if tops[b].0 > tops[a].0 { b } else { a })
                && let (cost, Kid::Inner(inner), _) = tops.swap_remove(dearest)
            {
                before += f64::from(cost);
                next = Some(inner);
            }
        }
        let count = tops.len();
        let mut items: Vec<Item<V>> = (0..).zip(&tops).map(|(index, (_, _, bound))| Item::new(*bound, index)).collect();
        let mut nodes: Vec<Option<Kid<V>>> = tops.into_iter().map(|(_, kid, _)| Some(kid)).collect();
        let ids: BTreeSet<u32> = nodes.iter().flatten().map(Kid::id).collect();
        let mut arranger = Arranger { stock: Stock::Nodes(&mut nodes), places: self.places, homes: None };
        let levels = (count.max(2) as u64 - 1).ilog(LANES as u64) + 1 + SPARE_LEVELS;
        let (kid, _) = arranger.arrange(&mut items, levels);
        let (mut after, mut new_ids) = (0.0, Vec::new());
        new_nodes(&kid, &ids, &mut after, &mut new_ids);
        if kid.level() <= tallest && after < before {
            dissolved[1..].iter().for_each(|inner| self.places.free_node(inner.id));
            drop(dissolved);
            self.replace_kids(Arc::make_mut(shared), kid);
        } else {
            new_ids.into_iter().for_each(|id| self.places.free_node(id));
            for inner in &dissolved {
                self.link_kids(inner);
            }
        }
        count
    }

    /// Gives a node the children of another one, which is given up.
    fn replace_kids(&mut self, inner: &mut Inner<V>, by: Kid<V>) {
        inner.kids.clear();
        inner.lanes = V::no_lanes();
        match by {
            Kid::Inner(other) => {
                self.places.free_node(other.id);
                for (lane, kid) in other.kids.iter().enumerate() {
                    inner.push(kid.clone(), &V::get(&other.lanes, lane));
                }
                inner.level = other.level;
                self.link_kids(inner);
            }
            Kid::Leaf(_) => adopt(inner, by, self.places),
        }
        inner.arranged = inner.spread();
    }

    fn link_kids(&mut self, inner: &Inner<V>) {
        for (lane, kid) in inner.kids.iter().enumerate() {
            self.places.set_parent(kid.id(), inner.id, lane);
        }
    }

    /// Notes the places of everything below a node as they are.
    fn relink(&mut self, kid: &Kid<V>) {
        match kid {
            Kid::Leaf(leaf) => leaf.entries.iter().for_each(|slot| self.places.set_leaf(*slot, leaf.id)),
            Kid::Inner(inner) => {
                self.link_kids(inner);
                inner.kids.iter().for_each(|kid| self.relink(kid));
            }
        }
    }
}

fn collect_entries<V: BoundingVolume>(kid: &Kid<V>, entries: &mut Vec<Entry<V>>) {
    match kid {
        Kid::Leaf(leaf) => entries.extend(Leaf::all(leaf)),
        Kid::Inner(inner) => inner.kids.iter().for_each(|kid| collect_entries(kid, entries)),
    }
}

/// The costs of a node and all nodes below it.
fn cost_of<V: BoundingVolume>(kid: &Kid<V>) -> f64 {
    f64::from(V::cost(&kid.bound())) + cost_below(kid)
}

/// The costs of all nodes below a node; of a leaf, in whose place its parent would stand, its own.
fn cost_below<V: BoundingVolume>(kid: &Kid<V>) -> f64 {
    match kid {
        Kid::Leaf(_) => 0.0,
        Kid::Inner(inner) => inner.kids.iter().map(cost_of).sum(),
    }
}

/// The ids of the nodes above the old ones, and the costs of all of them but the first.
fn new_nodes<V: BoundingVolume>(kid: &Kid<V>, old: &BTreeSet<u32>, costs: &mut f64, ids: &mut Vec<u32>) {
    let Kid::Inner(inner) = kid else { return };
    if old.contains(&inner.id) {
        return;
    }
    ids.push(inner.id);
    for (lane, kid) in inner.kids.iter().enumerate() {
        if !old.contains(&kid.id()) {
            *costs += f64::from(V::cost(&V::get(&inner.lanes, lane)));
        }
        new_nodes(kid, old, costs, ids);
    }
}
