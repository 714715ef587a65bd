//! A run of boxes in the order of their lower ends: what is copied when one of them changes.
//!
//! Coordinates lie one axis after the other, so that a scan along a segment reads memory in order.

use std::cmp::Ordering;

use crate::geometry::{Aabb, Vec3};

/// Boxes of a full segment. More make the lists above shorter and each copy dearer; 64 are some 4 KiB.
pub(super) const SEGMENT: usize = 64;

/// Where an entry stands in the order: by its lower end along the sorted axis, metres, then by its place in the table
/// of entries, so that no two are equal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Key {
    pub(super) at: f64,
    pub(super) slot: u32,
}

impl Key {
    pub(super) fn comes_before(&self, other: &Self) -> bool {
        self.order(other) == Ordering::Less
    }

    /// Numbers are finite, so they are all comparable; the two zeros are the same place.
    pub(super) fn order(&self, other: &Self) -> Ordering {
        self.at.partial_cmp(&other.at).unwrap_or(Ordering::Equal).then(self.slot.cmp(&other.slot))
    }
}

/// One box with its number.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry {
    pub(super) tight: Aabb,
    pub(super) payload: u64,
    pub(super) slot: u32,
}

impl Entry {
    pub(super) fn key(&self, axis: usize) -> Key {
        Key { at: self.tight.min[axis], slot: self.slot }
    }
}

/// At most [`SEGMENT`] entries, sorted.
#[derive(Clone, Debug)]
pub(super) struct Segment {
    length: usize,
    /// Lower ends, by axis.
    lower: [[f64; SEGMENT]; 3],
    /// Upper ends, by axis.
    upper: [[f64; SEGMENT]; 3],
    payloads: [u64; SEGMENT],
    slots: [u32; SEGMENT],
}

impl Segment {
    pub(super) fn empty() -> Self {
        let zeros = [[0.0; SEGMENT]; 3];
        Self { length: 0, lower: zeros, upper: zeros, payloads: [0; SEGMENT], slots: [0; SEGMENT] }
    }

    pub(super) fn len(&self) -> usize {
        self.length
    }

    pub(super) fn is_full(&self) -> bool {
        self.length == SEGMENT
    }

    pub(super) fn entry(&self, index: usize) -> Entry {
        let corner = |ends: &[[f64; SEGMENT]; 3]| Vec3::new(ends[0][index], ends[1][index], ends[2][index]);
        let tight = Aabb { min: corner(&self.lower), max: corner(&self.upper) };
        Entry { tight, payload: self.payloads[index], slot: self.slots[index] }
    }

    pub(super) fn entries(&self) -> impl Iterator<Item = Entry> + '_ {
        (0..self.length).map(|index| self.entry(index))
    }

    pub(super) fn payload(&self, index: usize) -> u64 {
        self.payloads[index]
    }

    pub(super) fn key(&self, index: usize, axis: usize) -> Key {
        Key { at: self.lower[axis][index], slot: self.slots[index] }
    }

    /// How many entries come before `key`: its place, if it is here.
    pub(super) fn place_of(&self, key: &Key, axis: usize) -> usize {
        let (mut low, mut high) = (0, self.length);
        while low < high {
            let middle = usize::midpoint(low, high);
            if self.key(middle, axis).comes_before(key) {
                low = middle + 1;
            } else {
                high = middle;
            }
        }
        low
    }

    pub(super) fn set(&mut self, index: usize, entry: &Entry) {
        for axis in 0..3 {
            self.lower[axis][index] = entry.tight.min[axis];
            self.upper[axis][index] = entry.tight.max[axis];
        }
        self.payloads[index] = entry.payload;
        self.slots[index] = entry.slot;
    }

    /// Puts an entry in at its place; there must be room.
    pub(super) fn insert(&mut self, index: usize, entry: &Entry) {
        let range = index..self.length;
        for ends in self.lower.iter_mut().chain(&mut self.upper) {
            ends.copy_within(range.clone(), index + 1);
        }
        self.payloads.copy_within(range.clone(), index + 1);
        self.slots.copy_within(range, index + 1);
        self.length += 1;
        self.set(index, entry);
    }

    pub(super) fn remove(&mut self, index: usize) {
        let range = index + 1..self.length;
        for ends in self.lower.iter_mut().chain(&mut self.upper) {
            ends.copy_within(range.clone(), index);
        }
        self.payloads.copy_within(range.clone(), index);
        self.slots.copy_within(range, index);
        self.length -= 1;
    }

    /// Takes the entries from `first` on out, into a segment of their own.
    pub(super) fn split_off(&mut self, first: usize) -> Self {
        let mut rest = Self::empty();
        for (place, index) in (first..self.length).enumerate() {
            rest.set(place, &self.entry(index));
        }
        rest.length = self.length - first;
        self.length = first;
        rest
    }

    /// Takes over the entries of a segment that comes after this one; there must be room.
    pub(super) fn append(&mut self, next: &Self) {
        for entry in next.entries() {
            self.set(self.length, &entry);
            self.length += 1;
        }
    }

    /// The least box that holds all.
    pub(super) fn bounds(&self) -> Aabb {
        let mut bounds = Aabb::empty();
        for axis in 0..3 {
            let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
            for index in 0..self.length {
                let (low, high) = (self.lower[axis][index], self.upper[axis][index]);
                least = if low < least { low } else { least };
                greatest = if high > greatest { high } else { greatest };
            }
            (bounds.min[axis], bounds.max[axis]) = (least, greatest);
        }
        bounds
    }

    /// How many entries, from the first, have their lower end at or before a place along an axis that they are sorted by.
    pub(super) fn begun_by(&self, axis: usize, at: f64) -> usize {
        self.lower[axis][..self.length].partition_point(|low| *low <= at)
    }

    /// Whether an entry's box has a point in common with `other`. All six comparisons are made: whether one decides
    /// alone cannot be guessed, and a wrong guess costs more than they do.
    pub(super) fn meets(&self, index: usize, other: &Aabb) -> bool {
        let apart =
            |axis: usize| (self.lower[axis][index] > other.max[axis]) | (self.upper[axis][index] < other.min[axis]);
        !(apart(0) | apart(1) | apart(2))
    }
}
