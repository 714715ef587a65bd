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
        let row = self.row(a);
        row.binary_search_by_key(&b, |(other, _)| *other).ok().map(|place| row[place].1)
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
        let everything = PartyKey::EVERYTHING;
        let all = |pairs: &mut dyn Iterator<Item = (PartyKey, PartyKey)>| {
            pairs.filter_map(|(a, b)| self.get(a, b)).reduce(self.cautious)
        };
        let one_and_many = || a.many.iter().map(|m| (*m, b.one)).chain(b.many.iter().map(|m| (*m, a.one)));
        let one_and_everything = || [(a.one, everything), (b.one, everything)].into_iter();
        let many_and_many = || a.many.iter().flat_map(|m| b.many.iter().map(|n| (*m, *n)));
        let many_and_everything = || a.many.iter().chain(b.many).map(|m| (*m, everything));
        all(&mut one_and_many())
            .or_else(|| all(&mut one_and_everything()))
            .or_else(|| all(&mut many_and_many()))
            .or_else(|| all(&mut many_and_everything()))
            .or_else(|| self.get(everything, everything))
    }

    /// All values, each entry's once or twice.
    pub(super) fn values(&self) -> impl Iterator<Item = V> {
        self.rows.values().flat_map(|row| row.entries.iter().map(|(_, value)| *value))
    }

    /// Every entry from both its sides, or once where these are the same.
    pub(super) fn halves(&self) -> impl Iterator<Item = (PartyKey, PartyKey, V)> {
        self.rows.values().flat_map(|row| row.entries.iter().map(|(other, value)| (row.party, *other, *value)))
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
