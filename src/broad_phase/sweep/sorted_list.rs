//! A long sorted list that many versions share: shelves of segments of entries.
//!
//! Three levels, each at most 64 wide but the first: a clone counts one reference for each shelf (some 500 in a list of
//! a million), and a change copies one segment and one shelf. Segmented lists for sweep and prune are from Tracy, Buss,
//! Woods, "Efficient large-scale sweep and prune methods with AABB insertion and removal", 2009; theirs are in place.

use std::sync::Arc;

use super::segment::{Entry, Key, SEGMENT, Segment};
use crate::geometry::Aabb;

/// Segments of a full shelf.
const SHELF: usize = 64;

/// A part with fewer entries than this is joined with its neighbour if both then fill at most three quarters of one.
const SPARSE: usize = SEGMENT / 4;
const JOINED: usize = SEGMENT / 4 * 3;

/// Something sorted, with what a search has to know of it.
#[derive(Clone, Debug)]
pub(super) struct Part<T> {
    /// Of its first entry.
    pub(super) first: Key,
    /// The least box that holds all its entries.
    pub(super) bounds: Aabb,
    pub(super) content: Arc<T>,
}

/// A run of segments.
pub(super) type Shelf = Vec<Part<Segment>>;

/// All entries, sorted by their keys.
#[derive(Clone, Debug)]
pub(super) struct SortedList {
    /// The axis whose lower ends are the keys: 0, 1 or 2.
    pub(super) axis: usize,
    pub(super) shelves: Vec<Part<Shelf>>,
}

impl SortedList {
    pub(super) fn new(axis: usize) -> Self {
        Self { axis, shelves: Vec::new() }
    }

    /// The list of these entries, in any order.
    pub(super) fn of(axis: usize, mut entries: Vec<Entry>) -> Self {
        entries.sort_unstable_by(|a, b| a.key(axis).order(&b.key(axis)));
        let segments = entries.chunks(JOINED).map(|run| {
            let mut segment = Segment::empty();
            run.iter().enumerate().for_each(|(index, entry)| segment.insert(index, entry));
            Part::of_segment(segment, axis)
        });
        let segments: Vec<Part<Segment>> = segments.collect();
        let shelves = segments.chunks(SHELF / 4 * 3).map(|run| Part::of_shelf(run.to_vec())).collect();
        Self { axis, shelves }
    }

    /// All segments, in order.
    pub(super) fn segments(&self) -> impl Iterator<Item = &Part<Segment>> {
        self.shelves.iter().flat_map(|shelf| shelf.content.iter())
    }

    /// The entry of a key that is in the list.
    pub(super) fn entry(&self, key: &Key) -> Entry {
        let shelf = &self.shelves[place(&self.shelves, key)].content;
        let segment = &shelf[place(shelf, key)].content;
        segment.entry(segment.place_of(key, self.axis))
    }

    pub(super) fn insert(&mut self, entry: &Entry) {
        let (axis, key) = (self.axis, entry.key(self.axis));
        if self.shelves.is_empty() {
            let mut segment = Segment::empty();
            segment.insert(0, entry);
            self.shelves.push(Part::of_shelf(vec![Part::of_segment(segment, axis)]));
            return;
        }
        let at = place(&self.shelves, &key);
        let part = &mut self.shelves[at];
        let shelf = Arc::make_mut(&mut part.content);
        let mut within = place(shelf, &key);
        if shelf[within].content.is_full() {
            let rest = Arc::make_mut(&mut shelf[within].content).split_off(SEGMENT / 2);
            let rest = Part::of_segment(rest, axis);
            shelf[within].bounds = shelf[within].content.bounds();
            let later = !key.comes_before(&rest.first);
            shelf.insert(within + 1, rest);
            within += usize::from(later);
        }
        let segment = &mut shelf[within];
        let content = Arc::make_mut(&mut segment.content);
        content.insert(content.place_of(&key, axis), entry);
        segment.first = content.key(0, axis);
        segment.bounds = segment.bounds.union(&entry.tight);
        part.bounds = part.bounds.union(&entry.tight);
        part.first = shelf[0].first;
        if shelf.len() > SHELF {
            let rest = Part::of_shelf(shelf.split_off(SHELF / 2));
            part.bounds = bounds_of(shelf);
            self.shelves.insert(at + 1, rest);
        }
    }

    /// Takes the entry of a key that is in the list out.
    pub(super) fn remove(&mut self, key: &Key) {
        let axis = self.axis;
        let at = place(&self.shelves, key);
        let part = &mut self.shelves[at];
        let shelf = Arc::make_mut(&mut part.content);
        let within = place(shelf, key);
        let segment = &mut shelf[within];
        let content = Arc::make_mut(&mut segment.content);
        let index = content.place_of(key, axis);
        let gone = content.entry(index).tight;
        content.remove(index);
        let length = content.len();
        if length == 0 {
            shelf.remove(within);
        } else {
            segment.first = content.key(0, axis);
            if reaches_edge(&gone, &segment.bounds) {
                segment.bounds = content.bounds();
            }
            if length < SPARSE {
                join_neighbours(shelf, within);
            }
        }
        if shelf.is_empty() {
            self.shelves.remove(at);
            return;
        }
        part.first = shelf[0].first;
        if reaches_edge(&gone, &part.bounds) {
            part.bounds = bounds_of(shelf);
        }
        if shelf.len() < SHELF / 4 {
            self.join_shelves(at);
        }
    }

    /// Gives the entry whose key was `before` another box, and puts it where it now belongs. Says whether it is another
    /// box; if not, nothing is copied.
    pub(super) fn change(&mut self, before: &Key, tight: Aabb) -> bool {
        let axis = self.axis;
        let at = place(&self.shelves, before);
        let within = place(&self.shelves[at].content, before);
        let segment = &self.shelves[at].content[within].content;
        let from = segment.place_of(before, axis);
        let gone = segment.entry(from);
        if gone.tight == tight {
            return false;
        }
        let entry = &Entry { tight, ..gone };
        let (gone, key) = (gone.tight, entry.key(axis));
        if !self.belongs(&key, at, within) {
            self.remove(before);
            self.insert(entry);
            return true;
        }
        let part = &mut self.shelves[at];
        let shelf = Arc::make_mut(&mut part.content);
        let segment = &mut shelf[within];
        let content = Arc::make_mut(&mut segment.content);
        // Insertion sort: the entries that it overtook, or that overtook it, make room.
        let mut to = from;
        while to > 0 && key.comes_before(&content.key(to - 1, axis)) {
            let pushed = content.entry(to - 1);
            content.set(to, &pushed);
            to -= 1;
        }
        while to + 1 < content.len() && content.key(to + 1, axis).comes_before(&key) {
            let pushed = content.entry(to + 1);
            content.set(to, &pushed);
            to += 1;
        }
        content.set(to, entry);
        segment.first = content.key(0, axis);
        let shrinks = reaches_edge(&gone, &segment.bounds);
        segment.bounds = if shrinks { content.bounds() } else { segment.bounds.union(&entry.tight) };
        part.first = shelf[0].first;
        let shrinks = reaches_edge(&gone, &part.bounds);
        part.bounds = if shrinks { bounds_of(shelf) } else { part.bounds.union(&entry.tight) };
        true
    }

    /// Whether a key belongs into that segment, as the segments are now.
    fn belongs(&self, key: &Key, at: usize, within: usize) -> bool {
        let shelf = &self.shelves[at].content;
        let is_first = at == 0 && within == 0;
        let next = shelf.get(within + 1).map(|part| part.first);
        let next = next.or_else(|| self.shelves.get(at + 1).map(|part| part.first));
        (is_first || !key.comes_before(&shelf[within].first)) && next.is_none_or(|next| key.comes_before(&next))
    }

    /// Joins a short shelf with a neighbour if there is room.
    fn join_shelves(&mut self, at: usize) {
        let fits = |a: usize, b: usize| {
            self.shelves.get(b).is_some_and(|next| self.shelves[a].content.len() + next.content.len() <= SHELF / 4 * 3)
        };
        let left = match at {
            at if at > 0 && fits(at - 1, at) => at - 1,
            at if fits(at, at + 1) => at,
            _ => return,
        };
        let next = self.shelves.remove(left + 1);
        let part = &mut self.shelves[left];
        Arc::make_mut(&mut part.content).extend(next.content.iter().cloned());
        part.bounds = part.bounds.union(&next.bounds);
    }
}

impl Part<Segment> {
    fn of_segment(segment: Segment, axis: usize) -> Self {
        Self { first: segment.key(0, axis), bounds: segment.bounds(), content: Arc::new(segment) }
    }
}

impl Part<Shelf> {
    fn of_shelf(shelf: Shelf) -> Self {
        Self { first: shelf[0].first, bounds: bounds_of(&shelf), content: Arc::new(shelf) }
    }
}

/// The last part that begins at or before the key, or the first.
fn place<T>(parts: &[Part<T>], key: &Key) -> usize {
    parts.partition_point(|part| !key.comes_before(&part.first)).saturating_sub(1)
}

pub(super) fn bounds_of<T>(parts: &[Part<T>]) -> Aabb {
    parts.iter().fold(Aabb::empty(), |bounds, part| bounds.union(&part.bounds))
}

/// Joins a sparse segment with a neighbour if there is room.
fn join_neighbours(shelf: &mut Shelf, within: usize) {
    let fits =
        |a: usize, b: usize| shelf.get(b).is_some_and(|next| shelf[a].content.len() + next.content.len() <= JOINED);
    let left = match within {
        at if at > 0 && fits(at - 1, at) => at - 1,
        at if fits(at, at + 1) => at,
        _ => return,
    };
    let next = shelf.remove(left + 1);
    let part = &mut shelf[left];
    Arc::make_mut(&mut part.content).append(&next.content);
    part.bounds = part.bounds.union(&next.bounds);
}

/// Whether a box that is gone may have been what `bounds` reached so far for.
fn reaches_edge(gone: &Aabb, bounds: &Aabb) -> bool {
    (0..3).any(|axis| gone.min[axis] <= bounds.min[axis] || gone.max[axis] >= bounds.max[axis])
}
