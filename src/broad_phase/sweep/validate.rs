//! Is the sorted list what it claims to be? Its order, the boxes around its parts, and the way from an entry to its place.

use super::segment::{Key, SEGMENT};
use super::sorted_list::bounds_of;
use super::sweep_and_prune::{NONE, SlotState, SweepAndPrune};
use crate::broad_phase::ProxyId;

/// What is wrong with a sorted list. None of these can be reached through the public operations; tests and fuzzers look.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SweepDefect {
    /// An entry comes before one with a lower end that is less.
    #[error("the entry of slot {slot} is out of order")]
    Order {
        /// Of the later entry.
        slot: u32,
    },
    /// A box around a part, or the key of its first entry, is of other entries; or a part is empty or too long.
    #[error("a part that begins with slot {slot} has wrong bounds, length or key")]
    Part {
        /// Of the part's first entry.
        slot: u32,
    },
    /// An entry is not found by its slot.
    #[error("the entry of slot {slot} is not found")]
    Lost {
        /// Of the entry.
        slot: u32,
    },
    /// Entries, slots and free slots do not add up.
    #[error("{entries} entries, {free} free of {slots} slots, counted {count}")]
    Count {
        /// In the list.
        entries: usize,
        /// Reached through the free list.
        free: usize,
        /// Places there are.
        slots: usize,
        /// As counted along.
        count: usize,
    },
}

impl SweepAndPrune {
    /// Looks at everything the operations rely on.
    ///
    /// # Errors
    /// The first defect found. A list changed through its public operations has none.
    pub fn validate(&self) -> Result<(), SweepDefect> {
        let axis = self.list.axis;
        let mut last: Option<Key> = None;
        let mut entries = 0;
        for shelf in &self.list.shelves {
            let proper = shelf.content.first().is_some_and(|part| part.first == shelf.first);
            if !proper || shelf.bounds != bounds_of(&shelf.content) {
                return Err(SweepDefect::Part { slot: shelf.first.slot });
            }
            for part in shelf.content.iter() {
                let segment = &part.content;
                let proper = (1..=SEGMENT).contains(&segment.len()) && segment.key(0, axis) == part.first;
                if !proper || part.bounds != segment.bounds() {
                    return Err(SweepDefect::Part { slot: part.first.slot });
                }
                for entry in segment.entries() {
                    let key = entry.key(axis);
                    if last.is_some_and(|last| !last.comes_before(&key)) {
                        return Err(SweepDefect::Order { slot: entry.slot });
                    }
                    let found = self.slots[entry.slot].state == SlotState::Taken
                        && self.key(ProxyId(entry.slot)) == key
                        && self.list.entry(&key).slot == entry.slot;
                    if !found {
                        return Err(SweepDefect::Lost { slot: entry.slot });
                    }
                    last = Some(key);
                    entries += 1;
                }
            }
        }
        let (mut free, mut slot) = (0, self.first_free);
        while slot != NONE && free <= self.slots.len() {
            let SlotState::Free { next } = self.slots[slot].state else { break };
            (slot, free) = (next, free + 1);
        }
        let slots = self.slots.len();
        if entries == self.count && entries + free == slots && slot == NONE {
            return Ok(());
        }
        Err(SweepDefect::Count { entries, free, slots, count: self.count })
    }
}
