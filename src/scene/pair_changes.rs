//! How entries for pairs come and go, in the allowed-collision matrix, in the table of margins and among the declared effects.

use std::sync::Arc;

use super::body_changes::{check_distance, check_group_name};
use super::change::Fault;
use super::party::PartyKey;
use super::{Effect, Effects, Party, Reason, Snapshot};
use crate::limits::{LimitExceeded, Limits};

impl Snapshot {
    pub(super) fn set_allowed_collision(
        &mut self,
        a: &Party,
        b: &Party,
        allowed: Option<bool>,
        limits: &Limits,
    ) -> Result<(), Fault> {
        let (a, b) = self.pair_of_keys(a, b, limits)?;
        let before = self.allowed.get(a, b);
        let names = self.names_of([a, b]);
        self.count_entry(before.is_some(), allowed.is_some(), (a, b), limits)?;
        if before != allowed {
            self.changes.entry(a, b, names);
        }
        self.allowed.set(a, b, allowed);
        Ok(())
    }

    pub(super) fn set_pair_margin(
        &mut self,
        a: &Party,
        b: &Party,
        margin: Option<f64>,
        limits: &Limits,
    ) -> Result<(), Fault> {
        let (a, b) = self.pair_of_keys(a, b, limits)?;
        if let Some(margin) = margin {
            check_distance(margin, "margin")?;
        }
        self.check_margin_is_declared((a, b), margin, self.effects.get(a, b), "margin")?;
        let before = self.margins.get(a, b);
        let names = self.names_of([a, b]);
        self.count_entry(before.is_some(), margin.is_some(), (a, b), limits)?;
        if before != margin {
            self.changes.entry(a, b, names);
        }
        self.margins.set(a, b, margin);
        // Only where the largest went are all entries looked at again.
        self.largest_margin = self.largest_margin.max(margin.unwrap_or(0.0));
        self.largest_margin_gone |=
            before.is_some_and(|before| before >= self.largest_margin && margin != Some(before));
        Ok(())
    }

    pub(super) fn declare_effects(
        &mut self,
        a: &Party,
        b: &Party,
        effects: Option<Effects>,
        limits: &Limits,
    ) -> Result<(), Fault> {
        let (a, b) = self.pair_of_keys(a, b, limits)?;
        self.check_margin_is_declared((a, b), self.margins.get(a, b), effects, "effects")?;
        let before = self.effects.get(a, b);
        let names = self.names_of([a, b]);
        self.count_entry(before.is_some(), effects.is_some(), (a, b), limits)?;
        if before != effects {
            self.changes.entry(a, b, names);
        }
        self.effects.set(a, b, effects);
        Ok(())
    }

    /// A margin above zero is an effect: two parties that are declared without it have none entered.
    fn check_margin_is_declared(
        &self,
        (a, b): (PartyKey, PartyKey),
        margin: Option<f64>,
        effects: Option<Effects>,
        field: &'static str,
    ) -> Result<(), Fault> {
        let Some(margin) = margin.filter(|margin| *margin > 0.0) else { return Ok(()) };
        if effects.is_none_or(|effects| effects.contains(Effect::Margin)) {
            return Ok(());
        }
        let party = |key| self.party(key, &|_| None).unwrap_or(Party::Everything);
        let pair = Box::new((party(a), party(b)));
        Err(Reason::NotDeclared { pair, effect: Effect::Margin, margin }.of(field))
    }

    /// Takes back all entries that name a party which leaves the scene.
    pub(super) fn forget_entries_of(&mut self, party: PartyKey) {
        let mut others = self.allowed.forget(party);
        let with_margins = self.margins.forget(party);
        self.largest_margin_gone |= !with_margins.is_empty();
        others.extend(with_margins);
        others.extend(self.effects.forget(party));
        others.into_iter().filter(|other| other.is_group()).for_each(|other| self.groups.drop_use(other));
    }

    fn pair_of_keys(&mut self, a: &Party, b: &Party, limits: &Limits) -> Result<(PartyKey, PartyKey), Fault> {
        let (a, b) = (self.key_of(a, "a", limits)?, self.key_of(b, "b", limits)?);
        if a == b && a.is_one() {
            return Err(Reason::PairWithItself.of("b"));
        }
        Ok((a, b))
    }

    fn key_of(&mut self, party: &Party, field: &'static str, limits: &Limits) -> Result<PartyKey, Fault> {
        match party {
            Party::Body(body) => Ok(PartyKey::body(self.find(body, field)?.id)),
            Party::Link { robot, link } => {
                let robot = &self.robots[self.place_of_robot(robot, field)?];
                let index = robot.model.link(link);
                index
                    .map(|index| robot.link_key(index))
                    .ok_or_else(|| Reason::UnknownLink { robot: robot.name.to_string(), link: link.clone() }.of(field))
            }
            Party::Robot(name) => Ok(self.robots[self.place_of_robot(name, field)?].key[0]),
            Party::Group(name) => {
                check_group_name(name, field, limits)?;
                Ok(self.groups.named(name).0)
            }
            Party::Everything => Ok(PartyKey::EVERYTHING),
        }
    }

    /// What the groups among the parties are called.
    fn names_of(&self, parties: [PartyKey; 2]) -> impl Iterator<Item = (PartyKey, Arc<str>)> + use<> {
        let named = |party: PartyKey| self.groups.name(party).map(|name| (party, Arc::clone(name)));
        parties.map(named).into_iter().flatten()
    }

    /// Counts an entry that comes into being or goes.
    fn count_entry(
        &mut self,
        existed: bool,
        exists: bool,
        (a, b): (PartyKey, PartyKey),
        limits: &Limits,
    ) -> Result<(), Fault> {
        if exists && !existed {
            let entries = self.allowed.len() + self.margins.len() + self.effects.len() + 1;
            LimitExceeded::check("max_pair_entries", entries, limits.max_pair_entries)
                .map_err(|limit| Reason::Limit(limit).of("a"))?;
        }
        for party in [a, b] {
            // A use of a group begins before the old one ends, so that a name taken up for nothing is forgotten again.
            self.groups.add_use(party);
            if existed || !exists {
                self.groups.drop_use(party);
            }
            if existed && !exists {
                self.groups.drop_use(party);
            }
        }
        Ok(())
    }
}
