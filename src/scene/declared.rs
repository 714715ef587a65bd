//! What has a scene declared of the pairs that a question is about? Told by the declarations alone, wherever the bodies are.

use std::collections::BTreeSet;

use super::party::PartyKey;
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

    /// Every declaration that speaks of the asker, from its side; of both sides where it is either.
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
            (is_own(own) && meets).then_some(Declaration { own: own_party?, other: other_party?, is_own_too, effects })
        };
        self.effects.halves().filter_map(told).collect()
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

enum Keys {
    /// Every body and group.
    All,
    Some(BTreeSet<PartyKey>),
}
