//! What do a scene's tables say, as a caller would have made the entries? For those who keep a copy of a scene.

use super::party::PartyKey;
use super::{BodyRef, Changes, Effects, Party, Snapshot};

/// All that the tables say of two parties.
#[derive(Clone, Debug, PartialEq)]
pub struct PairEntry {
    /// One side; a body by its id.
    pub a: Party,
    /// The other side.
    pub b: Party,
    /// What the allowed-collision matrix says of exactly these two; `None`: no entry.
    pub allowed: Option<bool>,
    /// The margin of exactly these two, metres; `None`: no entry.
    pub margin: Option<f64>,
    /// What is declared that may be asked of exactly these two; `None`: nothing is declared.
    pub effects: Option<Effects>,
}

impl Snapshot {
    /// All entries for pairs, each once, in the same order for equal histories.
    #[must_use]
    pub fn pair_entries(&self) -> Vec<PairEntry> {
        let allowed = self.allowed.halves().map(|(a, b, _)| (a, b));
        let margins = self.margins.halves().map(|(a, b, _)| (a, b));
        let effects = self.effects.halves().map(|(a, b, _)| (a, b));
        let mut pairs: Vec<_> = allowed.chain(margins).chain(effects).filter(|(a, b)| a <= b).collect();
        pairs.sort_unstable();
        pairs.dedup();
        pairs.into_iter().filter_map(|(a, b)| self.entry(a, b, &|_| None)).collect()
    }

    /// What is said now of the parties of each entry that changed; those that left the scene took their entries along, and are
    /// not told. A group that was forgotten and came again may be told twice.
    #[must_use]
    pub fn changed_entries(&self, changes: &Changes) -> Vec<PairEntry> {
        let forgotten = |key| changes.group_name(key).map(ToString::to_string);
        changes.entries().filter_map(|(a, b)| self.entry(a, b, &forgotten)).collect()
    }

    fn entry(&self, a: PartyKey, b: PartyKey, forgotten: &dyn Fn(PartyKey) -> Option<String>) -> Option<PairEntry> {
        let (a, b) = (self.party(a, forgotten)?, self.party(b, forgotten)?);
        // A group that was forgotten and came again has another key: what counts is what it is called.
        let keys = self.known_key(&a).zip(self.known_key(&b));
        let allowed = keys.and_then(|(a, b)| self.allowed.get(a, b));
        let margin = keys.and_then(|(a, b)| self.margins.get(a, b));
        let effects = keys.and_then(|(a, b)| self.effects.get(a, b));
        Some(PairEntry { a, b, allowed, margin, effects })
    }

    /// Whom a key means, if it is still there.
    pub(super) fn party(&self, key: PartyKey, forgotten: &dyn Fn(PartyKey) -> Option<String>) -> Option<Party> {
        if key == PartyKey::EVERYTHING {
            return Some(Party::Everything);
        }
        if let Some(id) = key.as_body() {
            return self.body(id).map(|body| Party::Body(BodyRef::Id(body.id)));
        }
        if key.is_group() {
            let name = self.groups.name(key).map(ToString::to_string);
            return name.or_else(|| forgotten(key)).map(Party::Group);
        }
        self.robots().find_map(|robot| {
            if robot.key[0] == key {
                return Some(Party::Robot(robot.name.to_string()));
            }
            let index = robot.link_keys().position(|link| link == key)?;
            Some(Party::Link { robot: robot.name.to_string(), link: robot.model.links()[index].name.clone() })
        })
    }

    /// The key of a party that [`Self::party`] gave.
    fn known_key(&self, party: &Party) -> Option<PartyKey> {
        match party {
            Party::Body(BodyRef::Id(id)) => Some(PartyKey::body(*id)),
            Party::Body(BodyRef::Name(name)) => self.body_named(name).map(|body| PartyKey::body(body.id)),
            Party::Link { robot, link } => {
                let robot = self.robot(robot)?;
                Some(robot.link_key(robot.model.link(link)?))
            }
            Party::Robot(name) => Some(self.robot(name)?.key[0]),
            Party::Group(name) => self.groups.key(name),
            Party::Everything => Some(PartyKey::EVERYTHING),
        }
    }
}
