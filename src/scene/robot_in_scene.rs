//! A robot that stands in a scene: its model, where its base is, and which of its links are held against each other.

use std::sync::Arc;

use super::Effects;
use super::pair_table::PairTable;
use super::party::{Member, PartyKey};
use crate::geometry::Pose;
use crate::robot::RobotModel;

/// A robot of a snapshot. It has no joint positions: those come with a question.
#[derive(Clone, Debug)]
pub struct RobotInScene {
    /// Unique in the scene.
    pub name: Arc<str>,
    /// Its links, with scale and padding applied to their shapes, and its joints.
    pub model: Arc<RobotModel>,
    /// The root link's frame in the world, metres.
    pub base: Pose,
    /// Pairs of links that are held against each other, each with the lower index first, sorted: those of the model,
    /// less the pairs whose collision the scene allows or that it declares empty, and with the excluded ones that the scene wants looked at.
    pub self_pairs: Arc<[(u32, u32)]>,
    /// Number of the first link; the others follow.
    pub(super) first_link: u64,
    /// What all links belong to.
    pub(super) key: [PartyKey; 1],
}

impl RobotInScene {
    pub(super) fn new(name: Arc<str>, model: Arc<RobotModel>, base: Pose, first_link: u64) -> Self {
        let self_pairs = model.self_pairs().into();
        Self { name, model, base, self_pairs, first_link, key: [PartyKey::robot(first_link)] }
    }

    /// A link, by its index in the model's links, as entries for pairs are looked up by.
    #[must_use]
    pub fn link(&self, index: u32) -> Member<'_> {
        Member { one: self.link_key(index), many: &self.key }
    }

    pub(super) fn link_key(&self, index: u32) -> PartyKey {
        PartyKey::link(self.first_link + u64::from(index))
    }

    /// The keys of all links.
    pub(super) fn link_keys(&self) -> impl Iterator<Item = PartyKey> {
        (self.first_link..).take(self.model.links().len()).map(PartyKey::link)
    }

    /// What [`RobotInScene::self_pairs`] is under a matrix. That the model excludes a pair is as specific as an entry
    /// for two links: only such an entry of the scene brings the pair back. Pairs that are declared empty are left out.
    pub(super) fn self_pairs_under(
        &self,
        allowed: &PairTable<bool>,
        effects: &PairTable<Effects>,
    ) -> Arc<[(u32, u32)]> {
        let tested = self.model.self_pairs().iter().copied();
        let mut pairs: Vec<(u32, u32)> =
            tested.filter(|(a, b)| !allowed.decide(self.link(*a), self.link(*b)).unwrap_or(false)).collect();
        let excluded = self.model.excluded_pairs().iter().map(|excluded| excluded.links);
        pairs.extend(excluded.filter(|(a, b)| allowed.get(self.link_key(*a), self.link_key(*b)) == Some(false)));
        pairs.retain(|(a, b)| !effects.decide(self.link(*a), self.link(*b)).is_some_and(Effects::is_empty));
        pairs.sort_unstable();
        pairs.into()
    }
}
