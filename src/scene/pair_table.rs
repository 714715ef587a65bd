//! What does a scene say about a pair? The table behind the allowed-collision matrix and behind the margins.
//!
//! An entry speaks of two parties. When several speak of a pair, the most specific ones decide:
//!
//! 1. two single ones (body or link),
//! 2. a single one and a group or robot,
//! 3. a single one and everything,
//! 4. two groups or robots,
//! 5. a group or robot and everything,
//! 6. everything and everything.
//!
//! Where several of the same rank speak of a pair, the cautious one decides: looking at a pair beats allowing its
//! collision, and the larger margin beats the smaller.

use std::sync::Arc;

use super::id_map::IdMap;
use super::party::{Member, PartyKey};

/// Entries for unordered pairs of parties. A clone shares everything until one side changes.
#[derive(Clone, Debug)]
pub(super) struct PairTable<V> {
    /// One for each party that an entry names.
    rows: IdMap<Arc<Row<V>>>,
    /// Of several values of the same rank, the one to follow.
    cautious: fn(V, V) -> V,
    entries: usize,
    /// Entries that do not name two single ones. Without any, one lookup decides.
    wide_entries: usize,
    /// Rises with every change, so that two versions of one table are told apart.
    changes: u64,
}

/// All entries that name one party.
#[derive(Clone, Debug)]
struct Row<V> {
    party: PartyKey,
    /// The other sides, sorted.
    entries: Vec<(PartyKey, V)>,
}

impl<V: Copy> PairTable<V> {
    pub(super) fn new(cautious: fn(V, V) -> V) -> Self {
        Self { rows: IdMap::new(), cautious, entries: 0, wide_entries: 0, changes: 0 }
    }

    /// Bytes of all rows, those that other versions hold too included.
    pub(super) fn memory(&self) -> usize {
        let row = |row: &Arc<Row<V>>| size_of::<Row<V>>() + row.entries.len() * size_of::<(PartyKey, V)>();
        self.rows.memory() + self.rows.values().map(row).sum::<usize>()
    }

    /// Bytes of the nodes that no other version holds; rows are left out.
    pub(super) fn own_memory(&self) -> usize {
        self.rows.own_memory()
    }

    pub(super) fn len(&self) -> usize {
        self.entries
    }

    /// Whether an earlier version of this table says the same.
    pub(super) fn is_as_in(&self, earlier: &Self) -> bool {
        self.changes == earlier.changes
    }

    /// Makes an entry, replaces it, or (`None`) takes it back.
    pub(super) fn set(&mut self, a: PartyKey, b: PartyKey, value: Option<V>) {
        self.changes += 1;
        let before = self.get(a, b).is_some();
        self.set_half(a, b, value);
        if a != b {
            self.set_half(b, a, value);
        }
        let wide = !(a.is_one() && b.is_one());
        let (made, taken) = (usize::from(value.is_some() && !before), usize::from(value.is_none() && before));
        self.entries = self.entries + made - taken;
        self.wide_entries = self.wide_entries + made * usize::from(wide) - taken * usize::from(wide);
    }

    /// Takes back every entry that names the party, and returns the other sides.
    pub(super) fn forget(&mut self, party: PartyKey) -> Vec<PartyKey> {
        let others: Vec<PartyKey> = self.row(party).iter().map(|(other, _)| *other).collect();
        for other in &others {
            self.set(party, *other, None);
        }
        others
    }

    /// The entry of exactly these two parties.
    pub(super) fn get(&self, a: PartyKey, b: PartyKey) -> Option<V> {
        value_in(self.row(a), b)
    }

    /// What holds for a pair; none if no entry speaks of it.
    pub(super) fn decide(&self, a: Member<'_>, b: Member<'_>) -> Option<V> {
        if self.entries == 0 {
            return None;
        }
        let exact = self.get(a.one, b.one);
        if exact.is_some() || self.wide_entries == 0 {
            return exact;
        }
        let mut best: Option<(usize, V)> = None;
        for (party, far) in parties_of(a) {
            let row = self.row(party);
            if row.is_empty() {
                continue;
            }
            for (other, other_far) in parties_of(b) {
                let Some(value) = value_in(row, other) else { continue };
                // Ranks in the order of the list above: 0, 1, 2, 4, 5, 8.
                let rank = 3 * far.min(other_far) + far.max(other_far);
                best = match best {
                    Some((least, decided)) if least == rank => Some((rank, (self.cautious)(decided, value))),
                    Some((least, _)) if least < rank => best,
                    _ => Some((rank, value)),
                };
            }
        }
        best.map(|(_, value)| value)
    }

    /// All values, each entry's once or twice.
    pub(super) fn values(&self) -> impl Iterator<Item = V> {
        self.rows.values().flat_map(|row| row.entries.iter().map(|(_, value)| *value))
    }

    /// Every entry from both its sides, or once where these are the same.
    pub(super) fn halves(&self) -> impl Iterator<Item = (PartyKey, PartyKey, V)> {
        self.rows.values().flat_map(|row| row.entries.iter().map(|(other, value)| (row.party, *other, *value)))
    }

    /// Whom entries name.
    pub(super) fn parties(&self) -> impl Iterator<Item = PartyKey> {
        self.rows.values().map(|row| row.party)
    }

    /// All entries that name the party: the other sides.
    pub(super) fn of(&self, party: PartyKey) -> impl Iterator<Item = (PartyKey, V)> {
        self.row(party).iter().copied()
    }

    fn row(&self, party: PartyKey) -> &[(PartyKey, V)] {
        self.rows.get(party.number()).map_or(&[], |row| &row.entries)
    }

    fn set_half(&mut self, party: PartyKey, other: PartyKey, value: Option<V>) {
        let Some(row) = self.rows.get_mut(party.number()) else {
            if let Some(value) = value {
                self.rows.insert(party.number(), Arc::new(Row { party, entries: vec![(other, value)] }));
            }
            return;
        };
        let row = &mut Arc::make_mut(row).entries;
        match (row.binary_search_by_key(&other, |(key, _)| *key), value) {
            (Ok(place), Some(value)) => row[place].1 = value,
            (Ok(place), None) => drop(row.remove(place)),
            (Err(place), Some(value)) => row.insert(place, (other, value)),
            (Err(_), None) => {}
        }
        if row.is_empty() {
            self.rows.remove(party.number());
        }
    }
}

fn value_in<V: Copy>(row: &[(PartyKey, V)], party: PartyKey) -> Option<V> {
    row.binary_search_by_key(&party, |(other, _)| *other).ok().map(|place| row[place].1)
}

/// The parties that speak of a body or link, each with how far it is from naming it alone: 0 itself, 1 its groups or
/// its robot, 2 everything.
pub(super) fn parties_of(member: Member<'_>) -> impl Iterator<Item = (PartyKey, usize)> {
    let many = member.many.iter().map(|party| (*party, 1));
    std::iter::once((member.one, 0)).chain(many).chain(std::iter::once((PartyKey::EVERYTHING, 2)))
}
