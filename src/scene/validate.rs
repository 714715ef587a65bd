//! Is a snapshot what it claims to be? Everything that is kept twice, held against each other.

use std::collections::{BTreeMap, BTreeSet};

use super::pair_table::PairTable;
use super::party::PartyKey;
use super::{Body, Effect, Snapshot};
use crate::broad_phase::BroadPhaseDefect;

/// What is wrong with a snapshot. None of these can be reached through edits; tests and fuzzers look.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SnapshotDefect {
    /// The broad phase is not what it claims to be.
    #[error("broad phase: {0}")]
    BroadPhase(#[from] BroadPhaseDefect),
    /// A body that is not where it is looked up.
    #[error("body {body}: {what}")]
    Body {
        /// Its name.
        body: String,
        /// What does not agree.
        what: &'static str,
    },
    /// A robot whose name or links are another's, or whose self-collision pairs are of another matrix.
    #[error("robot {robot}: name, links or self-collision pairs are not right")]
    Robot {
        /// Its name.
        robot: String,
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
        self.broad_phase.validate()?;
        for body in self.bodies() {
            let sound = self.check_body(body);
            sound.map_err(|what| SnapshotDefect::Body { body: body.name.to_string(), what })?;
        }
        check(self.names.size() == self.bodies.len(), "there are names of no body")?;
        let listed = self.bodies().filter(|body| body.proxy.is_some()).count();
        check(listed == self.broad_phase.len(), "the broad phase has entries of no body")?;
        let unbounded = self.bodies().filter(|body| body.is_unbounded()).map(|body| body.id);
        check(unbounded.eq(self.unbounded.iter().copied()), "the list of bodies without bounds is not right")?;
        self.check_robots()?;
        self.check_entries()?;
        self.changes.defect(self.revision).map_or(Ok(()), |what| check(false, what))
    }

    fn check_body(&self, body: &Body) -> Result<(), &'static str> {
        let holds = |holds: bool, what| if holds { Ok(()) } else { Err(what) };
        holds(self.names.get(&body.name) == Some(&body.id), "not found by its name")?;
        holds(self.body(body.id).is_some_and(|found| std::ptr::eq(&**found, body)), "not found by its id")?;
        holds(body.id < self.next_body, "has an id that was not given yet")?;
        holds(body.placement == body.pose.placement(), "its placement is of another pose")?;
        holds(body.bounds == body.shape.placed_bounds(&body.placement), "its bounds are of another shape or pose")?;
        match body.proxy {
            Some(proxy) => {
                let (payload, tight) = (self.broad_phase.payload(proxy), Some(self.broad_phase.tight(proxy)));
                holds(body.enabled, "in the broad phase, but not enabled")?;
                holds(payload == body.id.0 && tight == body.bounds, "its entry in the broad phase is another's")?;
            }
            None => holds(!body.enabled || body.bounds.is_none(), "not in the broad phase")?,
        }
        let mut keys: Vec<Option<PartyKey>> = body.groups.iter().map(|name| self.groups.key(name)).collect();
        keys.sort_unstable();
        holds(body.groups.is_sorted(), "its groups are not sorted")?;
        let same = keys.into_iter().eq(body.group_keys.iter().map(|key| Some(*key)));
        holds(same, "names and keys of its groups do not agree")
    }

    fn check_robots(&self) -> Result<(), SnapshotDefect> {
        check(self.robots.is_sorted_by(|a, b| a.name < b.name), "robots are not in the order of their names")?;
        let mut links = BTreeSet::new();
        for robot in self.robots() {
            let own_links = robot.link_keys().all(|key| key < PartyKey::link(self.next_link) && links.insert(key));
            let own_name = !self.names.contains_key(&robot.name);
            if !own_links || !own_name || robot.self_pairs != robot.self_pairs_under(&self.allowed, &self.effects) {
                return Err(SnapshotDefect::Robot { robot: robot.name.to_string() });
            }
        }
        Ok(())
    }

    /// Looks at the tables, and at the groups that live by being used.
    fn check_entries(&self) -> Result<(), SnapshotDefect> {
        let mut uses: BTreeMap<PartyKey, usize> = BTreeMap::new();
        self.bodies().flat_map(|body| body.group_keys.iter()).for_each(|key| *uses.entry(*key).or_default() += 1);
        let mut ones: BTreeSet<PartyKey> = self.bodies().map(|body| PartyKey::body(body.id)).collect();
        ones.extend(self.robots().flat_map(|robot| robot.link_keys().chain(robot.key)));
        ones.insert(PartyKey::EVERYTHING);
        check_table(&self.allowed, &ones, &mut uses)?;
        check_table(&self.margins, &ones, &mut uses)?;
        check_table(&self.effects, &ones, &mut uses)?;
        let undeclared = |(a, b, margin): (PartyKey, PartyKey, f64)| {
            margin > 0.0 && self.effects.get(a, b).is_some_and(|effects| !effects.contains(Effect::Margin))
        };
        check(!self.margins.halves().any(undeclared), "a margin is entered for parties declared without one")?;
        check(uses.len() == self.groups.len(), "there are groups without use")?;
        check(uses.iter().all(|(key, count)| self.groups.uses(*key) == *count), "uses of a group are miscounted")?;
        let largest = self.margins.values().fold(0.0, f64::max);
        check(self.largest_margin == largest, "the largest margin is not right")
    }
}

fn check(holds: bool, what: &'static str) -> Result<(), SnapshotDefect> {
    if holds { Ok(()) } else { Err(SnapshotDefect::Lists { what }) }
}

/// Looks whether a table agrees with itself and names only groups and `others`, and counts its uses of groups.
fn check_table<V: Copy + PartialEq>(
    table: &PairTable<V>,
    others: &BTreeSet<PartyKey>,
    uses: &mut BTreeMap<PartyKey, usize>,
) -> Result<(), SnapshotDefect> {
    let (mut halves, mut diagonal) = (0, 0);
    for (party, other, value) in table.halves() {
        check(table.get(other, party) == Some(value), "an entry for a pair is not found from its other side")?;
        check(party.is_group() || others.contains(&party), "an entry for a pair names nobody")?;
        let both = party == other;
        halves += 1;
        diagonal += usize::from(both);
        if party.is_group() {
            *uses.entry(party).or_default() += 1 + usize::from(both);
        }
    }
    check(halves + diagonal == 2 * table.len(), "entries for pairs are miscounted")
}
