//! Is a snapshot what it claims to be? Everything that is kept twice, held against each other.

use std::collections::BTreeMap;

use super::Snapshot;
use super::pair_table::PairTable;
use super::party::PartyKey;
use crate::broad_phase::TreeDefect;

/// What is wrong with a snapshot. None of these can be reached through edits; tests and fuzzers look.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SnapshotDefect {
    /// The tree is not a valid tree.
    #[error("tree: {0}")]
    Tree(#[from] TreeDefect),
    /// A body that is not where it is looked up.
    #[error("body {body}: {what}")]
    Body {
        /// Its name.
        body: String,
        /// What does not agree.
        what: &'static str,
    },
    /// Counts or lists that do not agree.
    #[error("{what}")]
    Lists {
        /// Which.
        what: &'static str,
    },
}

impl Snapshot {
    /// Looks at everything that queries and edits rely on.
    ///
    /// # Errors
    /// The first defect found. A snapshot that edits have led to has none.
    pub fn validate(&self) -> Result<(), SnapshotDefect> {
        self.tree.validate()?;
        let (mut in_tree, mut unbounded) = (0, Vec::new());
        let mut uses: BTreeMap<PartyKey, usize> = BTreeMap::new();
        for body in self.bodies() {
            let defect = |what| SnapshotDefect::Body { body: body.name.to_string(), what };
            if self.names.get(&body.name) != Some(&body.id)
                || self.bodies.get(body.id.0).is_none_or(|found| found.id != body.id)
            {
                return Err(defect("not found by its name or id"));
            }
            if body.id >= self.next_body {
                return Err(defect("has an id that was not given yet"));
            }
            if body.bounds != body.shape.placed_bounds(&body.pose.placement())
                || body.placement != body.pose.placement()
            {
                return Err(defect("bounds or placement are of another pose"));
            }
            match body.proxy {
                Some(proxy) if self.tree.payload(proxy) == body.id.0 && Some(self.tree.tight(proxy)) == body.bounds => {
                    in_tree += 1;
                }
                Some(_) => return Err(defect("its entry in the tree is another's, or of another box")),
                None if body.enabled && body.bounds.is_some() => return Err(defect("not in the tree")),
                None => {}
            }
            if body.enabled && body.bounds.is_none() {
                unbounded.push(body.id);
            }
            let mut keys: Vec<Option<PartyKey>> = body.groups.iter().map(|name| self.groups.key(name)).collect();
            keys.sort_unstable();
            if !keys.into_iter().eq(body.group_keys.iter().map(|key| Some(*key))) || !body.groups.is_sorted() {
                return Err(defect("names and keys of its groups do not agree"));
            }
            body.group_keys.iter().for_each(|key| *uses.entry(*key).or_default() += 1);
        }
        let lists = |holds: bool, what| if holds { Ok(()) } else { Err(SnapshotDefect::Lists { what }) };
        lists(in_tree == self.tree.len(), "the tree has entries of no body")?;
        lists(unbounded == *self.unbounded, "the list of bodies without bounds is not right")?;
        lists(self.names.size() == self.bodies.len(), "there are names of no body")?;
        self.count_parties(&self.allowed, &mut uses)?;
        self.count_parties(&self.margins, &mut uses)?;
        lists(uses.len() == self.groups.len(), "there are groups without use")?;
        lists(uses.iter().all(|(key, count)| self.groups.uses(*key) == *count), "uses of a group are miscounted")?;
        let largest = self.margins.values().fold(0.0, f64::max);
        lists(self.largest_margin == largest, "the largest margin is not right")
    }

    /// Looks whether all parties of a table are in the scene, and counts its uses of groups.
    fn count_parties<V: Copy + PartialEq>(
        &self,
        table: &PairTable<V>,
        uses: &mut BTreeMap<PartyKey, usize>,
    ) -> Result<(), SnapshotDefect> {
        let lists = |holds: bool, what| if holds { Ok(()) } else { Err(SnapshotDefect::Lists { what }) };
        let (mut halves, mut diagonal) = (0, 0);
        for (party, other, value) in table.halves() {
            lists(table.get(other, party) == Some(value), "an entry for a pair is not found from its other side")?;
            lists(self.has_party(party), "an entry for a pair names nobody")?;
            halves += 1;
            diagonal += usize::from(party == other);
            if party.is_many() {
                *uses.entry(party).or_default() += 1 + usize::from(party == other);
            }
        }
        lists(halves + diagonal == 2 * table.len(), "entries for pairs are miscounted")
    }

    fn has_party(&self, party: PartyKey) -> bool {
        party == PartyKey::EVERYTHING
            || self.groups.uses(party) > 0
            || self.bodies().any(|body| PartyKey::body(body.id) == party)
    }
}
