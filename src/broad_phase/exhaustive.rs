//! The broad phase that looks at everything: nothing to keep in order, nothing to get wrong.
//!
//! The fastest for some tens of boxes, and what the others are held against.

use std::ops::ControlFlow;

use super::shared_array::SharedArray;
use super::walk_by_distance::{Next, Waiting, lower_distance};
use super::{ProxyId, TraversalStats};
use crate::geometry::{Aabb, BoxCast};

/// Stands for no entry.
const NONE: u32 = u32::MAX;

/// Boxes with a number each, in no order. Every question looks at all of them, and [`Exhaustive::self_pairs`] at all
/// pairs. A clone shares what neither side changed. Boxes must be finite and not empty.
#[derive(Clone, Debug)]
pub struct Exhaustive {
    places: SharedArray<Place>,
    first_free: u32,
    count: usize,
}

#[derive(Clone, Copy, Debug)]
enum Place {
    Taken { tight: Aabb, payload: u64 },
    Free { next: u32 },
}

/// What there is to say of boxes in no order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExhaustiveHealth {
    /// Entries.
    pub entries: usize,
    /// Places kept for entries that are gone: they are used again before more memory is taken.
    pub free_places: usize,
}

/// Entries and free places that do not add up. It cannot be reached through the public operations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{taken} taken and {free} free of {places} places, counted {count}")]
pub struct ExhaustiveDefect {
    taken: usize,
    free: usize,
    places: usize,
    count: usize,
}

impl Exhaustive {
    /// Without entries.
    #[must_use]
    pub fn new() -> Self {
        Self { places: SharedArray::new(), first_free: NONE, count: 0 }
    }

    /// Adds an entry: a box, metres, and the caller's number for it.
    pub fn insert(&mut self, tight: Aabb, payload: u64) -> ProxyId {
        let taken = Place::Taken { tight, payload };
        let place = self.first_free;
        self.count += 1;
        if place == NONE {
            let place = u32::try_from(self.places.len()).ok().filter(|place| *place < NONE);
            self.places.push(taken);
            return ProxyId(place.expect("a scene has fewer than 2^32 - 1 bodies"));
        }
        if let Place::Free { next } = self.places[place] {
            self.first_free = next;
        }
        self.places.set(place, taken);
        ProxyId(place)
    }

    /// Removes an entry. Its name may be given to another one afterwards.
    pub fn remove(&mut self, proxy: ProxyId) {
        self.places.set(proxy.0, Place::Free { next: self.first_free });
        self.first_free = proxy.0;
        self.count -= 1;
    }

    /// Gives an entry another box, metres. Says whether it is another one.
    pub fn move_to(&mut self, proxy: ProxyId, tight: Aabb) -> bool {
        let (before, payload) = self.entry(proxy);
        if before == tight {
            return false;
        }
        self.places.set(proxy.0, Place::Taken { tight, payload });
        true
    }

    /// Number of entries.
    #[must_use]
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there are no entries.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// The box of an entry, as it was given last.
    #[must_use]
    pub fn tight(&self, proxy: ProxyId) -> Aabb {
        self.entry(proxy).0
    }

    /// The number of an entry.
    #[must_use]
    pub fn payload(&self, proxy: ProxyId) -> u64 {
        self.entry(proxy).1
    }

    /// All entries, in the order of their places: number and box.
    pub fn iter(&self) -> impl Iterator<Item = (u64, Aabb)> + '_ {
        (0..self.places.len() as u32).filter_map(|place| match self.places[place] {
            Place::Taken { tight, payload } => Some((payload, tight)),
            Place::Free { .. } => None,
        })
    }

    /// Calls `visit` with the number of every entry whose box has a point in common with `query`, until it breaks.
    pub fn overlap(&self, query: &Aabb, mut visit: impl FnMut(u64) -> ControlFlow<()>) -> TraversalStats {
        let mut stats = TraversalStats::default();
        for (payload, tight) in self.iter() {
            stats.leaves += 1;
            if tight.overlaps(query) && visit(payload).is_break() {
                break;
            }
        }
        stats
    }

    /// Calls `visit` once for every unordered pair of entries whose boxes have a point in common, the lower number
    /// first, until it breaks.
    pub fn self_pairs(&self, mut visit: impl FnMut(u64, u64) -> ControlFlow<()>) -> TraversalStats {
        let mut stats = TraversalStats::default();
        let entries: Vec<(u64, Aabb)> = self.iter().collect();
        for (i, (a, one)) in entries.iter().enumerate() {
            for (b, other) in &entries[i + 1..] {
                stats.leaves += 1;
                if one.overlaps(other) && visit(*a.min(b), *a.max(b)).is_break() {
                    return stats;
                }
            }
        }
        stats
    }

    /// Walks through the entries whose boxes are within `max_distance` metres of `query`, nearest box first, boxes
    /// equally near in the order of their numbers.
    ///
    /// `visit` gets an entry's number and a proved lower bound of the distance between its box and the query's, and
    /// returns the distance beyond which it no longer cares. The bound only ever shrinks; entries exactly at it are
    /// still visited, and a negative one ends the walk.
    pub fn nearest(&self, query: &Aabb, max_distance: f64, mut visit: impl FnMut(u64, f64) -> f64) -> TraversalStats {
        let mut stats = TraversalStats::default();
        let mut waiting = Waiting::<()>::new();
        for (payload, tight) in self.iter() {
            stats.leaves += 1;
            let distance = lower_distance(&tight, query);
            if distance <= max_distance {
                waiting.add_entry(distance, payload);
            }
        }
        let mut bound = max_distance;
        while let Some(Next::Entry(payload, distance)) = waiting.next_within(bound) {
            bound = bound.min(visit(payload, distance));
        }
        stats
    }

    /// Walks through the entries whose boxes the moving box meets within `max_fraction` of its motion, in no order.
    ///
    /// `visit` gets an entry's number and a proved lower bound of the fraction at which the boxes first touch, and returns
    /// the fraction beyond which it no longer cares. The bound only ever shrinks; entries exactly at it are still
    /// visited, and a negative one ends the walk.
    pub fn cast(&self, cast: &BoxCast, max_fraction: f64, mut visit: impl FnMut(u64, f64) -> f64) -> TraversalStats {
        let mut stats = TraversalStats::default();
        let mut bound = max_fraction;
        for (payload, tight) in self.iter() {
            if bound < 0.0 {
                break;
            }
            stats.leaves += 1;
            if let Some(fraction) = cast.first_touch(&tight).filter(|fraction| *fraction <= bound) {
                bound = bound.min(visit(payload, fraction));
            }
        }
        stats
    }

    /// Counts entries and free places.
    #[must_use]
    pub fn health(&self) -> ExhaustiveHealth {
        ExhaustiveHealth { entries: self.count, free_places: self.places.len() - self.count }
    }

    /// Bytes of this version, those it shares with others included.
    #[must_use]
    pub fn memory(&self) -> usize {
        self.places.memory()
    }

    /// Bytes that no other version holds.
    #[must_use]
    pub fn own_memory(&self) -> usize {
        self.places.own_memory()
    }

    /// Looks at everything the operations rely on.
    ///
    /// # Errors
    /// Entries and free places do not add up.
    pub fn validate(&self) -> Result<(), ExhaustiveDefect> {
        let (taken, places) = (self.iter().count(), self.places.len());
        let (mut free, mut place) = (0, self.first_free);
        while place != NONE && free <= places {
            let Place::Free { next } = self.places[place] else { break };
            (place, free) = (next, free + 1);
        }
        let adds_up = taken == self.count && taken + free == places && place == NONE;
        if adds_up { Ok(()) } else { Err(ExhaustiveDefect { taken, free, places, count: self.count }) }
    }

    fn entry(&self, proxy: ProxyId) -> (Aabb, u64) {
        match self.places[proxy.0] {
            Place::Taken { tight, payload } => (tight, payload),
            // A name whose entry is gone; the box that holds nothing meets nothing.
            Place::Free { .. } => (Aabb::empty(), u64::MAX),
        }
    }
}

impl Default for Exhaustive {
    fn default() -> Self {
        Self::new()
    }
}
