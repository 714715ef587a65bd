//! The broad phase that sorts: what it keeps, and how boxes come, go and move.

use std::sync::Arc;

use super::segment::{Entry, Key, Segment};
use super::sorted_list::{Part, Shelf, SortedList};
use crate::broad_phase::ProxyId;
use crate::broad_phase::shared_array::{COUNTS, SharedArray};
use crate::geometry::Aabb;

/// Stands for no entry.
pub(super) const NONE: u32 = u32::MAX;

/// Boxes with a number each, sorted along one axis by their lower ends.
///
/// Good where boxes are few, or long in one direction (a road, a belt, a rack) and nearly still; its questions look at
/// every box that meets the query along the axis. Nothing is fattened and no set of pairs is kept: pairs are swept when
/// they are asked for, so that a version costs what moved and not what met. A clone shares what neither side changed.
/// Boxes must be finite and not empty.
#[derive(Clone, Debug)]
pub struct SweepAndPrune {
    pub(super) list: SortedList,
    pub(super) slots: SharedArray<Slot>,
    pub(super) first_free: u32,
    pub(super) count: usize,
    /// Since the axis was looked at.
    pub(super) changes: usize,
}

/// How an entry is found: its key, or the next free slot.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slot {
    /// Lower end along the sorted axis, metres.
    pub(super) at: f64,
    pub(super) state: SlotState,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SlotState {
    Taken,
    Free { next: u32 },
}

/// How good the order is just now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SweepHealth {
    /// Entries.
    pub entries: usize,
    /// The axis they are sorted along: 0, 1, 2 for x, y, z.
    pub axis: usize,
    /// The share of all pairs of boxes that meet along that axis, estimated from a sample: what a sweep compares.
    pub meeting_share: f64,
    /// The same along the best axis.
    pub best_meeting_share: f64,
    /// How full the segments are on average, 0 to 1.
    pub filling: f64,
    /// Changes since the axis was looked at; it is looked at again after as many as there are entries.
    pub changes_since_choice: usize,
    /// Places kept for entries that are gone: they are used again before more memory is taken.
    pub free_places: usize,
}

impl SweepAndPrune {
    /// Without entries, to be sorted along x until there are enough to choose by.
    #[must_use]
    pub fn new() -> Self {
        Self { list: SortedList::new(0), slots: SharedArray::new(), first_free: NONE, count: 0, changes: 0 }
    }

    /// Adds an entry: a box, metres, and the caller's number for it.
    pub fn insert(&mut self, tight: Aabb, payload: u64) -> ProxyId {
        let taken = Slot { at: tight.min[self.list.axis], state: SlotState::Taken };
        let slot = match self.first_free {
            NONE => {
                let slot = u32::try_from(self.slots.len()).ok().filter(|slot| *slot < NONE);
                self.slots.push(taken);
                slot.expect("a scene has fewer than 2^32 - 1 bodies")
            }
            slot => {
                if let SlotState::Free { next } = self.slots[slot].state {
                    self.first_free = next;
                }
                self.slots.set(slot, taken);
                slot
            }
        };
        self.list.insert(&Entry { tight, payload, slot });
        self.count += 1;
        self.changes += 1;
        ProxyId(slot)
    }

    /// Removes an entry. Its name may be given to another one afterwards.
    pub fn remove(&mut self, proxy: ProxyId) {
        self.list.remove(&self.key(proxy));
        self.slots.set(proxy.0, Slot { at: 0.0, state: SlotState::Free { next: self.first_free } });
        self.first_free = proxy.0;
        self.count -= 1;
        self.changes += 1;
    }

    /// Gives an entry another box, metres. Says whether the box is another one: boxes are not fattened, so each change
    /// changes the list.
    pub fn move_to(&mut self, proxy: ProxyId, tight: Aabb) -> bool {
        let before = self.key(proxy);
        if !self.list.change(&before, tight) {
            return false;
        }
        let at = tight.min[self.list.axis];
        if at != before.at {
            self.slots.set(proxy.0, Slot { at, state: SlotState::Taken });
        }
        self.changes += 1;
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
        self.list.entry(&self.key(proxy)).tight
    }

    /// The number of an entry.
    #[must_use]
    pub fn payload(&self, proxy: ProxyId) -> u64 {
        self.list.entry(&self.key(proxy)).payload
    }

    /// All entries, in the order of their lower ends: number and box.
    pub fn iter(&self) -> impl Iterator<Item = (u64, Aabb)> + '_ {
        self.list.segments().flat_map(|part| part.content.entries()).map(|entry| (entry.payload, entry.tight))
    }

    /// Looks at the order as a whole and says how good it is. Estimates come from a sample.
    #[must_use]
    pub fn health(&self) -> SweepHealth {
        let shares = self.meeting_shares();
        let places: usize = self.list.segments().map(|_| super::segment::SEGMENT).sum();
        SweepHealth {
            entries: self.count,
            axis: self.list.axis,
            meeting_share: shares[self.list.axis],
            best_meeting_share: shares.into_iter().fold(f64::INFINITY, f64::min),
            filling: if places == 0 { 1.0 } else { self.count as f64 / places as f64 },
            changes_since_choice: self.changes,
            free_places: self.slots.len() - self.count,
        }
    }

    /// Bytes of this version, those it shares with others included.
    #[must_use]
    pub fn memory(&self) -> usize {
        let shelf =
            |part: &Part<Shelf>| part.content.len() * (size_of::<Part<Segment>>() + size_of::<Segment>() + COUNTS);
        let shelves: usize = self.list.shelves.iter().map(shelf).sum();
        shelves + self.list.shelves.len() * (size_of::<Part<Shelf>>() + COUNTS) + self.slots.memory()
    }

    /// Bytes that no other version holds.
    #[must_use]
    pub fn own_memory(&self) -> usize {
        let own_shelves = self.list.shelves.iter().filter(|part| Arc::strong_count(&part.content) == 1);
        let shelf = |part: &Part<Shelf>| {
            let own = part.content.iter().filter(|part| Arc::strong_count(&part.content) == 1).count();
            own * (size_of::<Segment>() + COUNTS) + part.content.len() * size_of::<Part<Segment>>()
        };
        let shelves: usize = own_shelves.map(shelf).sum();
        shelves + self.list.shelves.len() * size_of::<Part<Shelf>>() + self.slots.own_memory()
    }

    /// Entries by their slots: an order that does not depend on where the boxes are.
    pub(super) fn entries_by_slot(&self) -> impl Iterator<Item = Entry> + '_ {
        (0..self.slots.len() as u32)
            .filter(|slot| self.slots[*slot].state == SlotState::Taken)
            .map(|slot| self.list.entry(&self.key(ProxyId(slot))))
    }

    pub(super) fn key(&self, proxy: ProxyId) -> Key {
        Key { at: self.slots[proxy.0].at, slot: proxy.0 }
    }

    pub(super) fn sort_along(&mut self, axis: usize) {
        let entries: Vec<Entry> = self.list.segments().flat_map(|part| part.content.entries()).collect();
        for entry in &entries {
            self.slots.set(entry.slot, Slot { at: entry.tight.min[axis], state: SlotState::Taken });
        }
        self.list = SortedList::of(axis, entries);
    }
}

impl Default for SweepAndPrune {
    fn default() -> Self {
        Self::new()
    }
}
