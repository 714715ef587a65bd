//! A scene as it was at one revision: what queries read.

use std::sync::Arc;

use rpds::HashTrieMapSync;

use super::change_log::ChangeLog;
use super::groups::Groups;
use super::id_map::IdMap;
use super::pair_table::PairTable;
use super::{Body, BodyId, BodyRef, Effects, Epoch, Member, Revision, RobotInScene, SceneOptions};
use crate::broad_phase::BroadPhase;

/// A scene as it was at one revision. It never changes; the next revision shares with it what did not change.
#[derive(Clone, Debug)]
pub struct Snapshot {
    pub(super) epoch: Epoch,
    pub(super) revision: Revision,
    pub(super) bodies: IdMap<Arc<Body>>,
    // Never iterated: its order is not the same twice.
    pub(super) names: HashTrieMapSync<Arc<str>, BodyId>,
    /// The id of the next body.
    pub(super) next_body: BodyId,
    pub(super) groups: Groups,
    /// Enabled bodies with bounds, by their ids.
    pub(super) broad_phase: BroadPhase,
    /// Enabled bodies without bounds, sorted.
    pub(super) unbounded: Arc<Vec<BodyId>>,
    /// In the order of their names.
    pub(super) robots: Arc<Vec<Arc<RobotInScene>>>,
    /// The number of the next robot's first link.
    pub(super) next_link: u64,
    pub(super) allowed: PairTable<bool>,
    pub(super) margins: PairTable<f64>,
    pub(super) effects: PairTable<Effects>,
    pub(super) largest_margin: f64,
    /// An entry that may have had the largest margin was changed in this draft.
    pub(super) largest_margin_gone: bool,
    pub(super) changes: ChangeLog,
    /// Bytes that the edits wrote which led here.
    pub(super) written: usize,
}

impl Snapshot {
    /// The scene at the beginning of an epoch: empty, revision zero. The first body gets the id 1.
    pub(super) fn empty(epoch: Epoch, options: &SceneOptions) -> Self {
        Self {
            epoch,
            revision: Revision(0),
            bodies: IdMap::new(),
            names: HashTrieMapSync::new_sync(),
            next_body: BodyId(1),
            groups: Groups::new(),
            broad_phase: BroadPhase::new(options.broad_phase),
            unbounded: Arc::new(Vec::new()),
            robots: Arc::new(Vec::new()),
            next_link: 0,
            // Looking at a pair is more cautious than allowing its collision.
            allowed: PairTable::new(|a, b| a && b),
            margins: PairTable::new(f64::max),
            // Looking at more of a pair is more cautious than at less.
            effects: PairTable::new(Effects::and),
            largest_margin: 0.0,
            largest_margin_gone: false,
            changes: ChangeLog::new(Revision(0)),
            written: 0,
        }
    }

    /// Which life of the scene this is of.
    #[must_use]
    pub fn epoch(&self) -> Epoch {
        self.epoch
    }

    /// How many lists of edits the scene had accepted.
    #[must_use]
    pub fn revision(&self) -> Revision {
        self.revision
    }

    /// All bodies in the order of their ids.
    pub fn bodies(&self) -> impl Iterator<Item = &Arc<Body>> {
        self.bodies.values()
    }

    /// Bodies with ids above `id`, in the order of their ids.
    pub fn bodies_after(&self, id: BodyId) -> impl Iterator<Item = &Arc<Body>> {
        let first = id.0.checked_add(1);
        first.into_iter().flat_map(|first| self.bodies.values_from(first))
    }

    /// Number of bodies.
    #[must_use]
    pub fn body_count(&self) -> usize {
        self.bodies.len()
    }

    /// A body by its id.
    #[must_use]
    pub fn body(&self, id: BodyId) -> Option<&Arc<Body>> {
        self.bodies.get(id.0)
    }

    /// A body by its name.
    #[must_use]
    pub fn body_named(&self, name: &str) -> Option<&Arc<Body>> {
        self.body(*self.names.get(name)?)
    }

    /// A body as an edit or an entry names it.
    #[must_use]
    pub fn found(&self, body: &BodyRef) -> Option<&Arc<Body>> {
        match body {
            BodyRef::Id(id) => self.body(*id),
            BodyRef::Name(name) => self.body_named(name),
        }
    }

    /// The enabled bodies that have bounds; a payload is the number of a [`BodyId`], a box is [`Body::bounds`].
    #[must_use]
    pub fn broad_phase(&self) -> &BroadPhase {
        &self.broad_phase
    }

    /// The enabled bodies that have no bounds (half-spaces and planes), in the order of their ids.
    #[must_use]
    pub fn unbounded(&self) -> &[BodyId] {
        &self.unbounded
    }

    /// All robots in the order of their names.
    pub fn robots(&self) -> impl Iterator<Item = &Arc<RobotInScene>> {
        self.robots.iter()
    }

    /// A robot by its name.
    #[must_use]
    pub fn robot(&self, name: &str) -> Option<&Arc<RobotInScene>> {
        let place = self.robots.binary_search_by(|robot| (*robot.name).cmp(name)).ok()?;
        Some(&self.robots[place])
    }

    /// Whether a body is in the group, or an entry for pairs speaks of it.
    #[must_use]
    pub fn has_group(&self, name: &str) -> bool {
        self.groups.key(name).is_some()
    }

    /// Whether two different bodies are held against each other: both take part, each is in a layer that the other
    /// collides with, and the allowed-collision matrix does not allow their collision.
    #[must_use]
    pub fn admits(&self, a: &Body, b: &Body) -> bool {
        b.enabled && a.meets(b.layers, b.mask) && self.is_looked_at(a.member(), b.member())
    }

    /// Whether a robot's link, by its index, is held against a body: the body takes part and is in and collides with
    /// some layer (robots are in all and collide with all), and the allowed-collision matrix does not allow their
    /// collision.
    #[must_use]
    pub fn admits_link(&self, robot: &RobotInScene, link: u32, body: &Body) -> bool {
        body.meets(u32::MAX, u32::MAX) && self.is_looked_at(robot.link(link), body.member())
    }

    /// Whether the allowed-collision matrix allows the pair's collision, so that it is not looked at. A pair that no
    /// entry speaks of is looked at.
    ///
    /// The most specific entry decides: one that names two single bodies or links; then one of them and a group or
    /// robot; then one of them and everything; then two groups or robots; then a group or robot and everything; then
    /// everything and everything. Among entries of the same rank one that says to look at the pair wins.
    #[must_use]
    pub fn is_allowed(&self, a: Member<'_>, b: Member<'_>) -> bool {
        self.allowed.decide(a, b).unwrap_or(false)
    }

    /// Whether neither the allowed-collision matrix nor an empty declaration takes the pair out of every question.
    fn is_looked_at(&self, a: Member<'_>, b: Member<'_>) -> bool {
        !self.is_allowed(a, b) && !self.is_declared_empty(a, b)
    }

    /// Whether no effect at all is declared of the pair, so that it is not looked at. The most specific declaration decides, as in
    /// [`Snapshot::is_allowed`]; among those of the same rank the effects of all of them. A pair that none speaks of permits
    /// everything.
    #[must_use]
    pub fn is_declared_empty(&self, a: Member<'_>, b: Member<'_>) -> bool {
        self.declared(a, b).is_some_and(Effects::is_empty)
    }

    /// What may be asked of the pair, where a declaration speaks of it.
    #[must_use]
    pub fn declared(&self, a: Member<'_>, b: Member<'_>) -> Option<Effects> {
        self.effects.decide(a, b)
    }

    /// The margin for a pair, metres, where an entry speaks of it; it takes the place of the question's. The most
    /// specific entry decides, as in [`Snapshot::is_allowed`]; among entries of the same rank the largest.
    #[must_use]
    pub fn margin(&self, a: Member<'_>, b: Member<'_>) -> Option<f64> {
        self.margins.decide(a, b)
    }

    /// The largest margin of any entry, metres; zero without entries. A search for pairs within their margins has to
    /// reach at least so far.
    #[must_use]
    pub fn largest_margin(&self) -> f64 {
        self.largest_margin
    }
}
