//! Makes the changes of a list: moves and removals in one pass from the root, each node on the way visited once, then
//! the insertions.
//!
//! A moved entry stays in its leaf, whose bound is taken anew, and so on upward as far as bounds change. An entry that
//! stretches its leaf too much is taken out and put in anew. Few changes are sorted by the way to their leaves; many are
//! looked up leaf by leaf, so that moving everything reads and writes everything once.

use std::mem;
use std::sync::Arc;

use super::maintain::{MOVE_DEBT, PLACE_DEBT};
use super::node::{Entry, Inner, Kid, Leaf, lanes_of};
use super::places::{Place, Places};
use super::tree::{Change, DynamicTree, TAKEN_BACK};
use super::volume::{BoundingVolume, LANES};

/// With more than one change in so many entries the whole tree is walked instead of sorting them.
const MANY: usize = 8;

/// Stands for no change.
const NO_CHANGE: u32 = u32::MAX;

/// A moved entry may make its leaf this many times as dear as when the leaf's entries were last chosen. Smaller puts more
/// entries in anew, larger leaves the tree worse until upkeep comes by.
const LARGEST_STRETCH: f32 = 1.3;

/// In a leaf that is too dear without its moved entries, these may make it dearer by no more than this factor each.
const LEAST_BLAME: f32 = 1.03;

/// After a removal a leaf of so few entries gives them to others.
const TOO_FEW: usize = 2;

/// Once at least this many times as many entries come in as there are, all are arranged anew.
const BULK: usize = 1;

/// The changes that concern a subtree.
#[derive(Clone, Copy)]
enum Share<'a> {
    /// By the way to their leaves, and in their order for each leaf: the way, and the change's index. Then where the
    /// next lane stands in the way.
    Few(&'a [(u64, u32)], u32),
    /// By slot: the index of the last change.
    Many(&'a [u32]),
}

struct Pass<'a, V: BoundingVolume> {
    changes: &'a [Change<V>],
    places: &'a mut Places,
    /// Entries that have to be put in anew.
    loose: Vec<Entry<V>>,
}

/// What became of a node.
#[derive(Clone, Copy)]
struct Outcome<V: BoundingVolume> {
    /// Its bound may be another one: this one, if it is known.
    changed: bool,
    bound: Option<V::Bound>,
    /// It has lost entries or children.
    shrunk: bool,
}

impl<V: BoundingVolume> Outcome<V> {
    fn nothing() -> Self {
        Self { changed: false, bound: None, shrunk: false }
    }
}

impl<V: BoundingVolume> DynamicTree<V> {
    /// Makes the changes that wait.
    pub(super) fn flush(&mut self) {
        if self.is_settled() {
            return;
        }
        let mut loose = mem::take(&mut self.coming);
        loose.retain(|entry| entry.slot != TAKEN_BACK);
        let mut changes = mem::take(&mut self.changes);
        if !changes.is_empty() {
            self.upkeep.owe(changes.len() as f64 * MOVE_DEBT);
            loose.extend(self.change(&changes));
            for change in changes.iter().filter(|change| change.removed) {
                self.upkeep.owe(PLACE_DEBT);
                self.places.free_slot(change.slot);
            }
        }
        // The list keeps its memory for the next one, if this one needed it: memory touched for the first time is slow.
        if changes.len() < changes.capacity() / 4 {
            changes.shrink_to_fit();
        }
        changes.clear();
        self.changes = changes;
        let placed = self.count - loose.len().min(self.count);
        if loose.len() > BULK * placed + 8 {
            self.rearrange_all(loose);
            return;
        }
        self.upkeep.owe(loose.len() as f64 * PLACE_DEBT);
        loose.iter().for_each(|entry| self.place(entry));
    }

    /// Builds the tree anew over its entries and further ones.
    fn rearrange_all(&mut self, further: Vec<Entry<V>>) {
        let mut entries = further;
        entries.extend(self.leaves().flat_map(Leaf::all));
        if let Some(root) = self.root.take() {
            free_ids(&root, &mut self.places);
        }
        self.upkeep.paid_in_full();
        let mut homes = self.places.homes();
        self.build_over(entries.len(), &|index| entries[index as usize], &mut homes);
    }

    /// Makes the moves and removals, and gives back the entries to be put in anew.
    fn change(&mut self, changes: &[Change<V>]) -> Vec<Entry<V>> {
        let mut ways: Vec<(u64, u32)> = Vec::new();
        let mut many = changes.len() > self.count / MANY;
        if !many {
            ways.reserve_exact(changes.len());
            for (index, change) in (0..).zip(changes) {
                let Place::Leaf(leaf) = self.places.place(change.slot) else { continue };
                match self.places.path(leaf) {
                    Some(way) => ways.push((way, index)),
                    None => many = true,
                }
            }
            ways.sort_unstable();
        }
        let mut last = Vec::new();
        if many {
            last = vec![NO_CHANGE; self.places.slot_count()];
            for (index, change) in (0..).zip(changes) {
                last[change.slot as usize] = index;
            }
        }
        let share = if many { Share::Many(&last) } else { Share::Few(&ways, 61) };
        let mut pass = Pass { changes, places: &mut self.places, loose: Vec::new() };
        if let Some(root) = &mut self.root {
            pass.visit(root, share);
        }
        let loose = pass.loose;
        self.trim_root();
        loose
    }

    /// A root without children is none, and one with one child is that child.
    pub(super) fn trim_root(&mut self) {
        while let Some(root) = &self.root {
            let id = root.id();
            let only = match root {
                Kid::Leaf(leaf) if leaf.entries.is_empty() => None,
                Kid::Inner(inner) if inner.kids.is_empty() => None,
                Kid::Inner(inner) if inner.kids.len() == 1 => Some(inner.kids[0].clone()),
                Kid::Leaf(_) | Kid::Inner(_) => return,
            };
            self.places.free_node(id);
            if let Some(only) = &only {
                self.places.set_root(only.id());
            }
            self.root = only;
        }
    }
}

impl<V: BoundingVolume> Pass<'_, V> {
    fn visit(&mut self, kid: &mut Kid<V>, share: Share<'_>) -> Outcome<V> {
        match kid {
            Kid::Leaf(leaf) => self.visit_leaf(leaf, share),
            Kid::Inner(inner) => {
                let inner = Arc::make_mut(inner);
                let (mut outcome, mut thin) = (Outcome::nothing(), 0_u8);
                match share {
                    Share::Many(_) => {
                        for lane in 0..inner.kids.len() {
                            self.visit_lane(inner, lane, share, &mut outcome, &mut thin);
                        }
                    }
                    Share::Few(ways, shift) => {
                        let mut rest = ways;
                        while let Some((way, _)) = rest.first() {
                            let lane = (way >> shift & 7) as usize;
                            let own = rest.partition_point(|(way, _)| (way >> shift & 7) as usize == lane);
                            let below = Share::Few(&rest[..own], shift.saturating_sub(3));
                            rest = &rest[own..];
                            self.visit_lane(inner, lane, below, &mut outcome, &mut thin);
                        }
                    }
                }
                if thin != 0 {
                    self.thin_out(inner, thin);
                    outcome = Outcome { changed: true, bound: None, shrunk: true };
                }
                outcome
            }
        }
    }

    fn visit_lane(&mut self, inner: &mut Inner<V>, lane: usize, share: Share<'_>, sum: &mut Outcome<V>, thin: &mut u8) {
        let outcome = self.visit(&mut inner.kids[lane], share);
        let kid = &inner.kids[lane];
        let few = match kid {
            Kid::Leaf(leaf) => leaf.entries.len() <= TOO_FEW,
            Kid::Inner(inner) => inner.kids.len() <= 1,
        };
        if outcome.shrunk && few {
            *thin |= 1 << lane;
            return;
        }
        if outcome.changed {
            let bound = outcome.bound.unwrap_or_else(|| kid.bound());
            if bound != V::get(&inner.lanes, lane) {
                V::put(&mut inner.lanes, lane, &bound);
                sum.changed = true;
            }
        }
    }

    /// Dissolves the children in those lanes: entries of leaves are put in anew, an only child takes its parent's place.
    fn thin_out(&mut self, inner: &mut Inner<V>, thin: u8) {
        let lanes: Vec<usize> = lanes_of(thin).collect();
        for &lane in lanes.iter().rev() {
            let only = match &inner.kids[lane] {
                Kid::Inner(child) => child.kids.first().cloned(),
                Kid::Leaf(leaf) => {
                    self.loose.extend(leaf.all());
                    None
                }
            };
            self.places.free_node(inner.kids[lane].id());
            if let Some(only) = only {
                self.places.set_parent(only.id(), inner.id, lane);
                V::put(&mut inner.lanes, lane, &only.bound());
                inner.kids[lane] = only;
                continue;
            }
            inner.take(lane);
            if let Some(moved) = inner.kids.get(lane) {
                self.places.set_parent(moved.id(), inner.id, lane);
            }
        }
    }

    fn visit_leaf(&mut self, shared: &mut Arc<Leaf<V>>, share: Share<'_>) -> Outcome<V> {
        let changes = self.changes;
        let (mut moved, mut gone) = (0_u8, 0_u8);
        let mut make = |leaf: &mut Leaf<V>, lane: usize, change: &Change<V>| {
            if change.removed {
                gone |= 1 << lane;
            } else {
                moved |= 1 << lane;
                leaf.set(lane, &change.volume);
            }
        };
        let leaf = match share {
            Share::Few(ways, _) => {
                let leaf = Arc::make_mut(shared);
                for (_, index) in ways {
                    let change = &changes[*index as usize];
                    if let Some(lane) = leaf.lane_of(change.slot) {
                        make(leaf, lane, change);
                    }
                }
                leaf
            }
            Share::Many(last) => {
                let of_lane = |lane| shared.entries.get(lane).map_or(NO_CHANGE, |slot: &u32| last[*slot as usize]);
                let found: [u32; LANES] = std::array::from_fn(of_lane);
                if found.iter().all(|index| *index == NO_CHANGE) {
                    return Outcome::nothing();
                }
                let leaf = Arc::make_mut(shared);
                for (lane, index) in found.iter().enumerate() {
                    if let Some(change) = changes.get(*index as usize) {
                        make(leaf, lane, change);
                    }
                }
                leaf
            }
        };
        if gone == 0 {
            let bound = leaf.bound();
            if V::cost(&bound) <= LARGEST_STRETCH * leaf.arranged {
                return Outcome { changed: true, bound: Some(bound), shrunk: false };
            }
        }
        let mut going = gone;
        if gone.count_ones() as usize != leaf.entries.len() {
            going |= overstretching(leaf, moved, gone);
        }
        for lane in (0..leaf.entries.len()).rev().filter(|lane| going >> lane & 1 != 0) {
            let entry = leaf.take(lane);
            if gone >> lane & 1 == 0 {
                self.loose.push(entry);
            }
        }
        Outcome { changed: true, bound: None, shrunk: going != 0 }
    }
}

/// The moved entries that should leave a leaf that has become too dear: those that do not fit in, taken in one by one,
/// those that fit best first. (Not those without which it is cheaper: two that have gone the same way hide each other.)
fn overstretching<V: BoundingVolume>(leaf: &Leaf<V>, moved: u8, gone: u8) -> u8 {
    let of = |lane: usize| V::get(&leaf.lanes, lane);
    let limit = LARGEST_STRETCH * leaf.arranged;
    let there = (((1_u32 << leaf.entries.len()) - 1) as u8) & !gone;
    let mut outside = moved & there;
    let mut inside = lanes_of(there & !moved).map(of).reduce(|a, b| V::union(&a, &b));
    while outside != 0 {
        let with = |lane: usize| inside.map_or_else(|| of(lane), |inside| V::union(&inside, &of(lane)));
        let best = match inside {
            Some(_) => {
                let priced = lanes_of(outside).map(|lane| (V::cost(&with(lane)), lane));
                priced.reduce(|a, b| if b.0 < a.0 { b } else { a })
            }
            None => middlemost(leaf, outside).map(|lane| (V::cost(&of(lane)), lane)),
        };
        let Some((cost, lane)) = best else { break };
        let fits = inside.is_none_or(|inside| cost <= limit.max(LEAST_BLAME * V::cost(&inside)));
        if !fits {
            break;
        }
        inside = Some(with(lane));
        outside &= !(1 << lane);
    }
    outside
}

/// The entry, among some, that is nearest to the middle of them, counted by entries and not by where the outermost are.
fn middlemost<V: BoundingVolume>(leaf: &Leaf<V>, among: u8) -> Option<usize> {
    let centre = |lane: usize| V::centre(&V::get(&leaf.lanes, lane));
    let median: [f32; 3] = std::array::from_fn(|axis| {
        let mut along: Vec<f32> = lanes_of(among).map(|lane| centre(lane)[axis]).collect();
        along.sort_unstable_by(f32::total_cmp);
        along.get(along.len() / 2).copied().unwrap_or(0.0)
    });
    let far = |lane: usize| -> f32 { (0..3).map(|axis| (centre(lane)[axis] - median[axis]).abs()).sum() };
    lanes_of(among).reduce(|a, b| if far(b) < far(a) { b } else { a })
}

/// Gives back the ids of a subtree.
pub(super) fn free_ids<V: BoundingVolume>(kid: &Kid<V>, places: &mut Places) {
    places.free_node(kid.id());
    if let Kid::Inner(inner) = kid {
        inner.kids.iter().for_each(|kid| free_ids(kid, places));
    }
}
