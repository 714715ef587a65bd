//! How is a scene? What it holds, what its revisions hold, and how good its broad phase is just now.

use super::revision_rule::Kept;
use crate::scene::{BroadPhaseHealth, Epoch, Memory, Revision};

/// Figures of a scene, for people and programs that watch it.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneHealth {
    /// Unique in the daemon.
    pub name: String,
    /// When it began.
    pub epoch: Epoch,
    /// Its newest revision.
    pub revision: Revision,
    /// How many bodies.
    pub bodies: usize,
    /// Bytes of the newest revision, those it shares with others included.
    pub memory: Memory,
    /// Bytes of all kept revisions together, each byte once: those of the oldest, and what the later ones wrote.
    pub kept_bytes: usize,
    /// The revisions that can be asked, oldest first.
    pub kept: Vec<KeptRevision>,
    /// How good the broad phase is.
    pub broad_phase: BroadPhaseHealth,
    /// Where it was asked for, and the broad phase is a tree: the surface cost of a tree of the same boxes that is built at once.
    pub rebuilt_surface_cost: Option<f64>,
}

/// A revision that can be asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KeptRevision {
    /// Which.
    pub revision: Revision,
    /// Bytes that it does not share with the one before it.
    pub written: usize,
}

impl SceneHealth {
    /// Looks at the whole of a scene: milliseconds for a hundred thousand bodies, some ten times that if a tree is built to
    /// compare with.
    pub(super) fn of(name: String, revisions: &Kept, against_rebuilt: bool) -> Self {
        let (oldest, latest) = (revisions.oldest(), revisions.latest());
        let kept: Vec<KeptRevision> = revisions
            .iter()
            .map(|snapshot| KeptRevision { revision: snapshot.revision(), written: snapshot.written() })
            .collect();
        let later: usize = kept.iter().skip(1).map(|kept| kept.written).sum();
        Self {
            name,
            epoch: latest.epoch(),
            revision: latest.revision(),
            bodies: latest.body_count(),
            memory: latest.memory(),
            kept_bytes: oldest.memory().total() + later,
            kept,
            broad_phase: latest.broad_phase().health(),
            rebuilt_surface_cost: if against_rebuilt { latest.broad_phase().rebuilt_surface_cost() } else { None },
        }
    }
}
