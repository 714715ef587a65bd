//! How does the tree stay good while it changes? Parts of it are arranged anew in turn, as fast as changes wear it down.
//!
//! Every change adds to a debt, counted in things to be arranged anew: insertions, removals and entries put in anew much,
//! moves within a leaf little. `settle` pays it off by visiting inner nodes in the order of the tree: near the leaves all
//! entries below a node are grouped anew (up to 512), higher up the nodes two levels below (up to 64). So the work of a
//! list of changes is bounded by their number, and after some constant times as many changes as there are entries every
//! part has been visited. Treelets: Karras, Aila, "Fast parallel construction of high-quality bounding volume
//! hierarchies", 2013; in turn and by debt is our choice, since it needs no search for the worst.

use std::cmp::Reverse;
use std::sync::Arc;

use super::arrange::{Arranger, Item, Stock};
use super::insert::adopt;
use super::node::{Entry, Inner, Kid, Leaf};
use super::places::Places;
use super::settle::free_ids;
use super::tree::DynamicTree;
use super::volume::BoundingVolume;

/// What a change adds to the debt, in entries to be arranged anew.
pub(super) const MOVE_DEBT: f64 = 1.0 / 16.0;

/// What an insertion, a removal, or an entry that is put in anew adds.
pub(super) const PLACE_DEBT: f64 = 1.0;

/// At this level and below all entries under a node are grouped anew.
const ENTRY_LEVELS: u32 = 2;

/// Levels below a higher node whose nodes are grouped anew.
const NODE_LEVELS: u32 = 2;

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
        while self.upkeep.debt > 0.0 {
            let Some(Kid::Inner(root)) = &mut self.root else {
                self.upkeep.paid_in_full();
                return;
            };
            let done = tend(root, 0, 61, &mut self.upkeep.next, &mut self.places);
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
            self.trim_root();
        }
    }
}

/// Arranges the next node in the order of ways anew, this one or one below, and says how many things it had. `shift` is
/// where the lane of a child goes into the way.
fn tend<V: BoundingVolume>(
    shared: &mut Arc<Inner<V>>,
    way: u64,
    shift: u32,
    next: &mut (u64, Reverse<u32>),
    places: &mut Places,
) -> usize {
    if (way, Reverse(shared.level)) >= *next {
        let inner = Arc::make_mut(shared);
        *next = (way, Reverse(inner.level - 1));
        return if inner.level <= ENTRY_LEVELS {
            // Nothing below needs a visit of its own.
            let span = 1_u64.checked_shl(shift + 3).unwrap_or(u64::MAX);
            *next = (way.saturating_add(span), Reverse(u32::MAX));
            regroup_entries(inner, places)
        } else {
            regroup_nodes(inner, places)
        };
    }
    for lane in 0..shared.kids.len() {
        let below = way | (lane as u64) << shift;
        let end = below + ((1_u64 << shift) - 1);
        if end < next.0 || !matches!(shared.kids[lane], Kid::Inner(_)) {
            continue;
        }
        let inner = Arc::make_mut(shared);
        let Kid::Inner(child) = &mut inner.kids[lane] else { continue };
        let done = tend(child, below, shift.saturating_sub(3), next, places);
        if done > 0 {
            return done;
        }
    }
    0
}

/// Groups all entries below a node anew.
fn regroup_entries<V: BoundingVolume>(inner: &mut Inner<V>, places: &mut Places) -> usize {
    let mut entries: Vec<Entry<V>> = Vec::with_capacity(64);
    inner.kids.iter().for_each(|kid| collect_entries(kid, &mut entries));
    inner.kids.iter().for_each(|kid| free_ids(kid, places));
    let mut items: Vec<Item<V>> =
        (0..).zip(&entries).map(|(index, entry)| Item { bound: entry.volume.bound(), index }).collect();
    let mut arranger = Arranger::new(Stock::Entries(&entries), places, None);
    let (kid, _) = arranger.arrange(&mut items, inner.level);
    replace_kids(inner, kid, places);
    entries.len()
}

fn collect_entries<V: BoundingVolume>(kid: &Kid<V>, entries: &mut Vec<Entry<V>>) {
    match kid {
        Kid::Leaf(leaf) => entries.extend(Leaf::all(leaf)),
        Kid::Inner(inner) => inner.kids.iter().for_each(|kid| collect_entries(kid, entries)),
    }
}

/// Groups the nodes two levels below a node anew.
fn regroup_nodes<V: BoundingVolume>(inner: &mut Inner<V>, places: &mut Places) -> usize {
    let (mut nodes, mut items) = (Vec::with_capacity(64), Vec::with_capacity(64));
    let bottom = inner.level - NODE_LEVELS;
    let mut above: Vec<(Kid<V>, V::Bound)> = Vec::new();
    let lanes = &inner.lanes;
    above.extend(inner.kids.drain(..).enumerate().map(|(lane, kid)| (kid, V::get(lanes, lane))));
    while let Some((kid, bound)) = above.pop() {
        match &kid {
            Kid::Inner(child) if child.level > bottom => {
                places.free_node(child.id);
                let kids = child.kids.iter().enumerate();
                above.extend(kids.map(|(lane, kid)| (kid.clone(), V::get(&child.lanes, lane))));
            }
            Kid::Inner(_) | Kid::Leaf(_) => {
                items.push(Item { bound, index: nodes.len() as u32 });
                nodes.push(Some(kid));
            }
        }
    }
    let count = nodes.len();
    let mut arranger = Arranger::new(Stock::Nodes(&mut nodes), places, None);
    let (kid, _) = arranger.arrange(&mut items, NODE_LEVELS);
    replace_kids(inner, kid, places);
    count
}

/// Gives a node the children of another one, which is given up.
fn replace_kids<V: BoundingVolume>(inner: &mut Inner<V>, by: Kid<V>, places: &mut Places) {
    inner.kids.clear();
    inner.lanes = V::no_lanes();
    match by {
        Kid::Inner(other) => {
            places.free_node(other.id);
            for (lane, kid) in other.kids.iter().enumerate() {
                places.set_parent(kid.id(), inner.id, lane);
                inner.push(kid.clone(), &V::get(&other.lanes, lane));
            }
            inner.level = other.level;
        }
        Kid::Leaf(_) => adopt(inner, by, places),
    }
    inner.arranged = inner.spread();
}
