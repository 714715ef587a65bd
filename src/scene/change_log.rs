//! What changed since an earlier revision? Every revision keeps what its edits changed, and shares what the ones before it kept.
//!
//! The log is a persistent map from revisions to steps: publishing a revision costs one insertion whatever the scene's size,
//! and asking what changed costs in proportion to what did. It reaches back as far as snapshots are kept.
//!
//! What changed is said by the edits, not found by comparing: a body that went away and came back to where it was has
//! changed. An edit that says what is so already changes nothing; a replaced shape is not compared, and always counts.

use std::ops::{BitOr, BitOrAssign};
use std::sync::Arc;

use super::id_map::IdMap;
use super::pair_table::parties_of;
use super::party::{Member, PartyKey};
use super::{BodyId, NotKept, Revision, Snapshot};

/// In which ways a body or robot changed: a set of the constants.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ChangeKinds(u8);

impl ChangeKinds {
    /// It entered the scene.
    pub const ADDED: Self = Self(1);
    /// It left the scene.
    pub const REMOVED: Self = Self(1 << 1);
    /// Its pose, or a robot's base.
    pub const MOVED: Self = Self(1 << 2);
    /// Its shape, scale or padding.
    pub const RESHAPED: Self = Self(1 << 3);
    /// The layers it is in or collides with.
    pub const LAYERS: Self = Self(1 << 4);
    /// The groups it is in.
    pub const GROUPS: Self = Self(1 << 5);
    /// Whether it is enabled.
    pub const ENABLED: Self = Self(1 << 6);

    /// Whether all of `kinds` are among these.
    #[must_use]
    pub fn contains(self, kinds: Self) -> bool {
        self.0 & kinds.0 == kinds.0
    }
}

impl BitOr for ChangeKinds {
    type Output = Self;

    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl BitOrAssign for ChangeKinds {
    fn bitor_assign(&mut self, other: Self) {
        *self = *self | other;
    }
}

/// A body that edits changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BodyChange {
    /// Its id; the body may have left the scene since.
    pub id: BodyId,
    /// In which ways, all edits together.
    pub kinds: ChangeKinds,
}

/// A robot that edits changed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RobotChange {
    /// Its name in the scene; the robot may have left it since.
    pub name: Arc<str>,
    /// In which ways, all edits together.
    pub kinds: ChangeKinds,
}

/// What changed from one revision to a later one.
#[derive(Clone, Debug, Default)]
pub struct Changes {
    bodies: Vec<BodyChange>,
    robots: Vec<RobotChange>,
    /// Entries for pairs that were made, replaced by others or taken back, each in both orders, sorted.
    entries: Vec<(PartyKey, PartyKey)>,
    /// What the groups of `entries` were called, sorted.
    groups: Vec<(PartyKey, Arc<str>)>,
}

impl Changes {
    /// The bodies that changed, in the order of their ids; those that came and went again are among them.
    #[must_use]
    pub fn bodies(&self) -> &[BodyChange] {
        &self.bodies
    }

    /// Whether the body changed.
    #[must_use]
    pub fn has_body(&self, id: BodyId) -> bool {
        self.bodies.binary_search_by_key(&id, |body| body.id).is_ok()
    }

    /// The robots that changed, in the order of their names.
    #[must_use]
    pub fn robots(&self) -> &[RobotChange] {
        &self.robots
    }

    /// Whether any entry for pairs was made, replaced by another or taken back, other than by the leaving of whom it
    /// names.
    #[must_use]
    pub fn has_entries(&self) -> bool {
        !self.entries.is_empty()
    }

    /// The two sides of each entry, once.
    pub(super) fn entries(&self) -> impl Iterator<Item = (PartyKey, PartyKey)> {
        self.entries.iter().copied().filter(|(a, b)| a <= b)
    }

    /// What a group of an entry was called.
    pub(super) fn group_name(&self, key: PartyKey) -> Option<&Arc<str>> {
        let place = self.groups.binary_search_by_key(&key, |(group, _)| *group).ok()?;
        Some(&self.groups[place].1)
    }

    /// Whether an entry that speaks of the pair was made, replaced by another or taken back. It need not be the one that
    /// decides.
    #[must_use]
    pub fn has_entry_for(&self, a: Member<'_>, b: Member<'_>) -> bool {
        let has = |pair| self.entries.binary_search(&pair).is_ok();
        self.has_entries() && parties_of(a).any(|(a, _)| parties_of(b).any(|(b, _)| has((a, b))))
    }

    /// Bodies of a snapshot, in the order of their ids, such that every pair of bodies that a changed entry speaks of has at
    /// least one of them: the narrower side of each entry. Without groups and everything among the entries, the rest of
    /// the scene is not looked at.
    #[must_use]
    pub fn bodies_of_entries(&self, snapshot: &Snapshot) -> Vec<BodyId> {
        let (mut bodies, mut groups, mut everything) = (Vec::new(), Vec::new(), false);
        for (a, b) in self.entries.iter().filter(|(a, b)| !a.is_of_robot() && !b.is_of_robot()) {
            match (a.as_body(), b.as_body()) {
                (Some(id), _) | (None, Some(id)) => bodies.push(id),
                (None, None) if a.is_group() || b.is_group() => groups.push(if a.is_group() { *a } else { *b }),
                (None, None) => everything = true,
            }
        }
        groups.sort_unstable();
        if everything || !groups.is_empty() {
            let named = |key: &PartyKey| groups.binary_search(key).is_ok();
            let all = snapshot.bodies();
            bodies.extend(all.filter(|body| everything || body.group_keys.iter().any(named)).map(|body| body.id));
        }
        bodies.sort_unstable();
        bodies.dedup();
        bodies.retain(|id| snapshot.body(*id).is_some());
        bodies
    }
}

/// What one list of edits changed.
#[derive(Clone, Debug, Default)]
struct Step {
    /// In the order of the ids, each once.
    bodies: Vec<BodyChange>,
    /// In the order of the names, each once.
    robots: Vec<RobotChange>,
    /// In both orders, sorted, each once.
    entries: Vec<(PartyKey, PartyKey)>,
    /// What the groups of `entries` are called: the scene may forget them with the entry. Sorted, each once.
    groups: Vec<(PartyKey, Arc<str>)>,
}

impl Step {
    fn add(&mut self, other: &Self) {
        self.bodies.extend_from_slice(&other.bodies);
        self.robots.extend_from_slice(&other.robots);
        self.entries.extend_from_slice(&other.entries);
        self.groups.extend_from_slice(&other.groups);
    }

    /// Puts in order what was added, and makes one of what is about the same.
    fn settle(&mut self) {
        self.bodies.sort_by_key(|body| body.id);
        self.bodies.dedup_by(|next, kept| {
            let same = next.id == kept.id;
            if same {
                kept.kinds |= next.kinds;
            }
            same
        });
        self.robots.sort_by(|one, two| one.name.cmp(&two.name));
        self.robots.dedup_by(|next, kept| {
            let same = next.name == kept.name;
            if same {
                kept.kinds |= next.kinds;
            }
            same
        });
        self.entries.sort_unstable();
        self.entries.dedup();
        self.groups.sort_unstable();
        self.groups.dedup();
    }
}

/// The steps of the last revisions, and the one that is being made. A clone shares the steps.
#[derive(Clone, Debug)]
pub(super) struct ChangeLog {
    /// By revision: what led to it from the one before.
    steps: IdMap<Arc<Step>>,
    /// The revision that the first step leads on from.
    oldest: Revision,
    /// What the edits of the draft changed so far, or those of a hypothesis; empty in a snapshot that was published.
    open: Step,
}

impl ChangeLog {
    /// A log that begins at a revision.
    pub(super) fn new(at: Revision) -> Self {
        Self { steps: IdMap::new(), oldest: at, open: Step::default() }
    }

    pub(super) fn body(&mut self, id: BodyId, kinds: ChangeKinds) {
        self.open.bodies.push(BodyChange { id, kinds });
    }

    pub(super) fn robot(&mut self, name: &Arc<str>, kinds: ChangeKinds) {
        self.open.robots.push(RobotChange { name: Arc::clone(name), kinds });
    }

    /// `groups`: what those of the two that are groups are called.
    pub(super) fn entry(&mut self, a: PartyKey, b: PartyKey, groups: impl IntoIterator<Item = (PartyKey, Arc<str>)>) {
        self.open.entries.extend([(a, b), (b, a)]);
        self.open.groups.extend(groups);
    }

    /// Ends the draft: its changes led to `revision`. Of the steps stay those that lead on from one of the `kept` latest
    /// revisions.
    pub(super) fn close(&mut self, revision: Revision, kept: usize) {
        let mut step = std::mem::take(&mut self.open);
        step.settle();
        self.steps.insert(revision.0, Arc::new(step));
        while revision.0 - self.oldest.0 >= kept.max(1) as u64 {
            self.oldest.0 += 1;
            self.steps.remove(self.oldest.0);
        }
    }

    /// Ends a hypothesis: what its edits changed has no revision of its own, and counts as after the one that it is made on.
    pub(super) fn suppose(&mut self) {
        self.open.settle();
    }

    /// What does not agree with the snapshot that the log is part of.
    pub(super) fn defect(&self, revision: Revision) -> Option<&'static str> {
        let whole = (self.oldest.0 + 1..=revision.0).all(|step| self.steps.get(step).is_some());
        if !whole || self.steps.len() as u64 != revision.0 - self.oldest.0 {
            return Some("the log of changes has a gap, or steps of other revisions");
        }
        let sorted = |step: &Arc<Step>| {
            step.bodies.is_sorted_by(|a, b| a.id < b.id)
                && step.robots.is_sorted_by(|a, b| a.name < b.name)
                && step.entries.is_sorted_by(|a, b| a < b)
        };
        let hypothesis = Arc::new(self.open.clone());
        let in_order = self.steps.values().chain([&hypothesis]).all(sorted);
        (!in_order).then_some("a step of the log of changes is not in order")
    }
}

impl Snapshot {
    /// The oldest revision since which this snapshot knows what changed: the oldest that was kept when it was published.
    #[must_use]
    pub fn oldest_change(&self) -> Revision {
        self.changes.oldest
    }

    /// What changed since an earlier revision of the same epoch; what a hypothesis changed is part of it.
    ///
    /// # Errors
    /// The revision is older than [`Snapshot::oldest_change`], or later than the snapshot's own.
    pub fn changes_since(&self, since: Revision) -> Result<Changes, NotKept> {
        let ChangeLog { steps, oldest, open } = &self.changes;
        if since < *oldest {
            return Err(NotKept::Gone { asked: since, oldest: *oldest });
        }
        if since > self.revision {
            return Err(NotKept::Ahead { asked: since, latest: self.revision });
        }
        let mut whole = Step::default();
        (since.0 + 1..=self.revision.0).filter_map(|step| steps.get(step)).for_each(|step| whole.add(step));
        whole.add(open);
        whole.settle();
        let Step { bodies, robots, entries, groups } = whole;
        Ok(Changes { bodies, robots, entries, groups })
    }
}
