//! What meets, what is near, what is on the way: questions to the sorted list.
//!
//! Shelves and segments are skipped by the boxes around them, which along the sorted axis are short; what is left is
//! compared entry by entry.

use std::collections::BinaryHeap;
use std::ops::ControlFlow;

use super::segment::Segment;
use super::sorted_list::Part;
use super::sweep_and_prune::SweepAndPrune;
use crate::broad_phase::TraversalStats;
use crate::broad_phase::walk_by_distance::{Next, Waiting, lower_distance};
use crate::geometry::{Aabb, BoxCast};

impl SweepAndPrune {
    /// Calls `visit` with the number of every entry whose box has a point in common with `query`, until it breaks.
    pub fn overlap(&self, query: &Aabb, mut visit: impl FnMut(u64) -> ControlFlow<()>) -> TraversalStats {
        let mut stats = TraversalStats::default();
        let axis = self.list.axis;
        for shelf in begun_by(&self.list.shelves, query.max[axis]) {
            stats.nodes += 1;
            if !shelf.bounds.overlaps(query) {
                continue;
            }
            for part in begun_by(&shelf.content, query.max[axis]) {
                stats.nodes += 1;
                if !part.bounds.overlaps(query) {
                    continue;
                }
                let segment = &part.content;
                for index in 0..segment.begun_by(axis, query.max[axis]) {
                    stats.leaves += 1;
                    if segment.meets(index, query) && visit(segment.payload(index)).is_break() {
                        return stats;
                    }
                }
            }
        }
        stats
    }

    /// Calls `visit` once for every unordered pair of entries whose boxes have a point in common, the lower number
    /// first, until it breaks. The sweep: in the order of lower ends each box is held against those that begin before it
    /// ends.
    pub fn self_pairs(&self, mut visit: impl FnMut(u64, u64) -> ControlFlow<()>) -> TraversalStats {
        let mut stats = TraversalStats::default();
        let axis = self.list.axis;
        let parts: Vec<&Part<Segment>> = self.list.segments().collect();
        let mut ordered = |a: u64, b: u64| visit(a.min(b), a.max(b));
        for (i, one) in parts.iter().enumerate() {
            for (place, entry) in one.content.entries().enumerate() {
                let begun = one.content.begun_by(axis, entry.tight.max[axis]);
                for index in place + 1..begun {
                    stats.leaves += 1;
                    if one.content.meets(index, &entry.tight)
                        && ordered(entry.payload, one.content.payload(index)).is_break()
                    {
                        return stats;
                    }
                }
            }
            // Segment by segment, so that both are at hand while all their pairs are looked at.
            for other in &parts[i + 1..] {
                if other.first.at > one.bounds.max[axis] {
                    break;
                }
                stats.nodes += 1;
                if !one.bounds.overlaps(&other.bounds) {
                    continue;
                }
                for entry in one.content.entries().filter(|entry| entry.tight.overlaps(&other.bounds)) {
                    for index in 0..other.content.begun_by(axis, entry.tight.max[axis]) {
                        stats.leaves += 1;
                        if other.content.meets(index, &entry.tight)
                            && ordered(entry.payload, other.content.payload(index)).is_break()
                        {
                            return stats;
                        }
                    }
                }
            }
        }
        stats
    }

    /// Walks through the entries whose boxes are within `max_distance` metres of `query`, nearest box first, boxes
    /// equally near in the order of their numbers.
    ///
    /// `visit` gets an entry's number and a proved lower bound of the distance between its box and the query's, and
    /// returns the distance beyond which it no longer cares: typically the least true distance found so far. The bound
    /// only ever shrinks; entries exactly at it are still visited, and a negative one ends the walk.
    pub fn nearest(&self, query: &Aabb, max_distance: f64, mut visit: impl FnMut(u64, f64) -> f64) -> TraversalStats {
        let mut stats = TraversalStats::default();
        let mut bound = max_distance;
        let mut waiting = Waiting::new();
        for shelf in &self.list.shelves {
            stats.nodes += 1;
            let distance = lower_distance(&shelf.bounds, query);
            if distance <= bound {
                waiting.add_part(distance, Content::Shelf(&shelf.content));
            }
        }
        while let Some(next) = waiting.next_within(bound) {
            match next {
                Next::Entry(payload, distance) => bound = bound.min(visit(payload, distance)),
                Next::Part(Content::Shelf(segments)) => {
                    for part in segments {
                        stats.nodes += 1;
                        let distance = lower_distance(&part.bounds, query);
                        if distance <= bound {
                            waiting.add_part(distance, Content::Segment(&part.content));
                        }
                    }
                }
                Next::Part(Content::Segment(segment)) => {
                    for entry in segment.entries() {
                        stats.leaves += 1;
                        let distance = lower_distance(&entry.tight, query);
                        if distance <= bound {
                            waiting.add_entry(distance, entry.payload);
                        }
                    }
                }
            }
        }
        stats
    }

    /// Walks through the entries whose boxes the moving box meets within `max_fraction` of its motion, those that may be
    /// met early before others as far as their segments tell: not in a strict order, so callers sort.
    ///
    /// `visit` gets an entry's number and a proved lower bound of the fraction at which the boxes first touch, and returns
    /// the fraction beyond which it no longer cares. The bound only ever shrinks; entries exactly at it are still
    /// visited, and a negative one ends the walk.
    pub fn cast(&self, cast: &BoxCast, max_fraction: f64, mut visit: impl FnMut(u64, f64) -> f64) -> TraversalStats {
        let mut stats = TraversalStats::default();
        let mut bound = max_fraction;
        let mut waiting = BinaryHeap::new();
        for shelf in &self.list.shelves {
            stats.nodes += 1;
            if cast.first_touch(&shelf.bounds).is_none() {
                continue;
            }
            for part in shelf.content.iter() {
                stats.nodes += 1;
                if let Some(fraction) = cast.first_touch(&part.bounds).filter(|fraction| *fraction <= bound) {
                    waiting.push(ByFraction { fraction, segment: &part.content });
                }
            }
        }
        while let Some(ByFraction { fraction, segment }) = waiting.pop().filter(|next| next.fraction <= bound) {
            debug_assert!(fraction <= bound);
            for entry in segment.entries() {
                stats.leaves += 1;
                if let Some(fraction) = cast.first_touch(&entry.tight).filter(|fraction| *fraction <= bound) {
                    bound = bound.min(visit(entry.payload, fraction));
                }
            }
        }
        stats
    }
}

/// What a walk by distance has yet to look into.
enum Content<'a> {
    Shelf(&'a [Part<Segment>]),
    Segment(&'a Segment),
}

/// Parts whose first entry begins at or before a place along the sorted axis: no later one can meet what ends there.
fn begun_by<T>(parts: &[Part<T>], at: f64) -> &[Part<T>] {
    &parts[..parts.partition_point(|part| part.first.at <= at)]
}

/// A segment, the earliest met first out of the heap.
struct ByFraction<'a> {
    fraction: f64,
    segment: &'a Segment,
}

impl Ord for ByFraction<'_> {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        other.fraction.total_cmp(&self.fraction)
    }
}

impl PartialOrd for ByFraction<'_> {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for ByFraction<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == std::cmp::Ordering::Equal
    }
}

impl Eq for ByFraction<'_> {}
