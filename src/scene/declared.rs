//! What has a scene declared of the pairs that a question is about? Told by the declarations alone, wherever the bodies are.

use std::collections::{BTreeMap, BTreeSet};

use super::pair_table::parties_of;
use super::party::{Member, PartyKey};
use super::{BodyId, Effects, Party, Snapshot};

/// Who is held against the scene.
#[derive(Clone, Debug)]
pub enum Asker<'a> {
    /// Every body against every other.
    Everybody,
    /// These bodies.
    Bodies(&'a [BodyId]),
    /// A robot, against itself, too, with the bodies that it holds.
    Robot(&'a str, Vec<BodyId>),
}

/// What is declared of an asker and somebody else.
#[derive(Clone, Debug, PartialEq)]
pub struct Declaration {
    /// The asker's side.
    pub own: Party,
    /// The other side.
    pub other: Party,
    /// Whether the other side is the asking robot itself, or part of it.
    pub is_own_too: bool,
    /// What may be asked.
    pub effects: Effects,
}

impl Snapshot {
    /// Whether anything is declared at all. A scene that declares nothing permits everything.
    #[must_use]
    pub fn declares_effects(&self) -> bool {
        self.effects.len() > 0
    }

    /// Every declaration that speaks of the asker, from its side; of both sides where it is either. Costs in proportion to them.
    pub fn declared_of(&self, asker: &Asker<'_>) -> Vec<Declaration> {
        let Some(own) = self.keys_of(asker) else { return Vec::new() };
        let is_own = |key: PartyKey| match &own {
            Keys::All => !key.is_of_robot(),
            Keys::Some(keys) => keys.contains(&key),
        };
        let told = |(own, other, effects): (PartyKey, PartyKey, Effects)| {
            let is_robots = |key: PartyKey| key == PartyKey::EVERYTHING || key.is_of_robot() && is_own(key);
            let meets = !other.is_of_robot() || is_own(other);
            let is_own_too = matches!(asker, Asker::Robot(..)) && is_robots(other);
            let [own_party, other_party] = [own, other].map(|key| self.party(key, &|_| None));
            meets.then_some(Declaration { own: own_party?, other: other_party?, is_own_too, effects })
        };
        match &own {
            Keys::All => self.effects.halves().filter(|(own, ..)| is_own(*own)).filter_map(told).collect(),
            Keys::Some(keys) => {
                let row = |own: PartyKey| self.effects.of(own).map(move |(other, effects)| (own, other, effects));
                keys.iter().copied().flat_map(row).filter_map(told).collect()
            }
        }
    }

    /// Whether [`Loners`] has the member.
    #[must_use]
    pub fn meets_no_body(&self, member: Member<'_>) -> bool {
        self.loners().has(member)
    }

    /// To ask of many members whether they meet nobody.
    #[must_use]
    pub fn loners(&self) -> Loners<'_> {
        Loners { snapshot: self, permits_nothing: BTreeMap::new() }
    }

    /// Of the groups that are declared empty with themselves the one that is used most: its quiet bodies need not look for each
    /// other.
    #[must_use]
    pub fn quiet_bodies(&self) -> QuietBodies<'_> {
        let with_itself = |party: &PartyKey| self.effects.get(*party, *party).is_some_and(Effects::is_empty);
        let groups = self.effects.parties().filter(|party| party.is_group()).filter(with_itself);
        QuietBodies { snapshot: self, group: groups.max_by_key(|group| (self.groups.uses(*group), *group)) }
    }

    /// The parties that speak of the asker; none for a robot that is not there.
    fn keys_of(&self, asker: &Asker<'_>) -> Option<Keys> {
        let mut keys = BTreeSet::from([PartyKey::EVERYTHING]);
        let bodies = match asker {
            Asker::Everybody => return Some(Keys::All),
            Asker::Bodies(bodies) => *bodies,
            Asker::Robot(name, held) => {
                let robot = self.robot(name)?;
                keys.extend(robot.link_keys().chain(robot.key));
                &held[..]
            }
        };
        for body in bodies.iter().filter_map(|id| self.body(*id)) {
            keys.insert(body.member().one);
            keys.extend(body.member().many);
        }
        Some(Keys::Some(keys))
    }
}

/// Bodies and links that need not look for what they meet: everything that is declared of them and any body is empty, and something is
/// declared of them and everybody.
#[derive(Clone, Debug)]
pub struct Loners<'a> {
    snapshot: &'a Snapshot,
    /// Of parties asked about so far: whether no declaration that names one permits anything with a body. Rows may be long, and many
    /// members have the same.
    permits_nothing: BTreeMap<PartyKey, bool>,
}

impl Loners<'_> {
    /// Whether it is one. `false` does not say that there is somebody whom it meets.
    pub fn has(&mut self, member: Member<'_>) -> bool {
        let effects = &self.snapshot.effects;
        let with_everybody = |party| effects.get(party, PartyKey::EVERYTHING).is_some_and(Effects::is_empty);
        // No entry that names a robot speaks of a body.
        let permits = |(other, effects): (PartyKey, Effects)| !other.is_of_robot() && !effects.is_empty();
        self.snapshot.declares_effects()
            && parties_of(member).any(|(party, _)| with_everybody(party))
            && parties_of(member)
                .all(|(party, _)| *self.permits_nothing.entry(party).or_insert_with(|| !effects.of(party).any(permits)))
    }
}

/// Bodies of one group of which no two make a pair that is looked at.
#[derive(Clone, Copy, Debug)]
pub struct QuietBodies<'a> {
    snapshot: &'a Snapshot,
    group: Option<PartyKey>,
}

impl QuietBodies<'_> {
    /// Whether the body is in this group and no other, and nothing is declared of it alone: of two such bodies, the entry of the
    /// group with itself is the most specific one, and it is empty.
    #[must_use]
    pub fn has(&self, member: Member<'_>) -> bool {
        self.group.is_some_and(|group| member.many == [group] && self.snapshot.effects.of(member.one).next().is_none())
    }
}

enum Keys {
    /// Every body and group.
    All,
    Some(BTreeSet<PartyKey>),
}
