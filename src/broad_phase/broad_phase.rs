//! One interface over the three broad phases: a scene is made with one of them, and no answer depends on which.
//!
//! What each operation means is said once, at [`DynamicTree`]. The order of reports differs, except in the walk by
//! distance; so do the counts of what was looked at.

use std::ops::ControlFlow;

use super::exhaustive::{Exhaustive, ExhaustiveDefect, ExhaustiveHealth};
use super::sweep::{SweepAndPrune, SweepDefect, SweepHealth};
use super::{DynamicTree, Health, ProxyId, TraversalStats, TreeDefect};
use crate::geometry::{Aabb, BoxCast};

/// Which way of finding boxes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BroadPhaseKind {
    /// [`DynamicTree`]: the choice unless there is a reason for another.
    #[default]
    Tree,
    /// [`SweepAndPrune`].
    SweepAndPrune,
    /// [`Exhaustive`].
    Exhaustive,
}

/// The boxes of a scene, in one of the ways.
#[derive(Clone, Debug)]
pub enum BroadPhase {
    /// A tree of boxes.
    Tree(DynamicTree),
    /// Boxes sorted along an axis.
    SweepAndPrune(SweepAndPrune),
    /// Boxes in no order.
    Exhaustive(Exhaustive),
}

/// How good it is just now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BroadPhaseHealth {
    /// Of a tree.
    Tree(Health),
    /// Of boxes sorted along an axis.
    SweepAndPrune(SweepHealth),
    /// Of boxes in no order.
    Exhaustive(ExhaustiveHealth),
}

/// What is wrong with a broad phase; nothing, after public operations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum BroadPhaseDefect {
    /// Of a tree.
    #[error("tree: {0}")]
    Tree(#[from] TreeDefect),
    /// Of boxes sorted along an axis.
    #[error("sweep and prune: {0}")]
    SweepAndPrune(#[from] SweepDefect),
    /// Of boxes in no order.
    #[error("exhaustive: {0}")]
    Exhaustive(#[from] ExhaustiveDefect),
}

/// The same expression for whichever it is.
macro_rules! whichever {
    ($which:expr, $one:ident => $does:expr) => {
        match $which {
            BroadPhase::Tree($one) => $does,
            BroadPhase::SweepAndPrune($one) => $does,
            BroadPhase::Exhaustive($one) => $does,
        }
    };
}

impl BroadPhase {
    /// Without entries.
    #[must_use]
    pub fn new(kind: BroadPhaseKind) -> Self {
        match kind {
            BroadPhaseKind::Tree => Self::Tree(DynamicTree::new()),
            BroadPhaseKind::SweepAndPrune => Self::SweepAndPrune(SweepAndPrune::new()),
            BroadPhaseKind::Exhaustive => Self::Exhaustive(Exhaustive::new()),
        }
    }

    /// Which it is.
    #[must_use]
    pub fn kind(&self) -> BroadPhaseKind {
        match self {
            Self::Tree(_) => BroadPhaseKind::Tree,
            Self::SweepAndPrune(_) => BroadPhaseKind::SweepAndPrune,
            Self::Exhaustive(_) => BroadPhaseKind::Exhaustive,
        }
    }

    /// Adds an entry: a box, metres, and the caller's number for it.
    pub fn insert(&mut self, tight: Aabb, payload: u64) -> ProxyId {
        whichever!(self, it => it.insert(tight, payload))
    }

    /// Removes an entry. Its name may be given to another one afterwards.
    pub fn remove(&mut self, proxy: ProxyId) {
        whichever!(self, it => it.remove(proxy));
    }

    /// Gives an entry another box, metres. Says whether more had to change than the box itself.
    pub fn move_to(&mut self, proxy: ProxyId, tight: Aabb) -> bool {
        whichever!(self, it => it.move_to(proxy, tight))
    }

    /// To be called after a list of changes and before the next question: puts right what the changes put off.
    pub fn settle(&mut self) {
        match self {
            Self::Tree(tree) => {
                tree.settle();
                // What is settled here is published and changes no more: its list of moves would wait in vain.
                tree.release();
            }
            Self::SweepAndPrune(sweep) => sweep.settle(),
            Self::Exhaustive(_) => (),
        }
    }

    /// Number of entries.
    #[must_use]
    pub fn len(&self) -> usize {
        whichever!(self, it => it.len())
    }

    /// Whether there are no entries.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// All entries, in no order that means anything: number and box.
    #[must_use]
    pub fn iter(&self) -> Box<dyn Iterator<Item = (u64, Aabb)> + '_> {
        whichever!(self, it => Box::new(it.iter()))
    }

    /// The box of an entry, as it was given last.
    #[must_use]
    pub fn tight(&self, proxy: ProxyId) -> Aabb {
        whichever!(self, it => it.tight(proxy))
    }

    /// The number of an entry.
    #[must_use]
    pub fn payload(&self, proxy: ProxyId) -> u64 {
        whichever!(self, it => it.payload(proxy))
    }

    /// As [`DynamicTree::overlap`].
    pub fn overlap(&self, query: &Aabb, visit: impl FnMut(u64) -> ControlFlow<()>) -> TraversalStats {
        whichever!(self, it => it.overlap(query, visit))
    }

    /// As [`DynamicTree::self_pairs`].
    pub fn self_pairs(&self, visit: impl FnMut(u64, u64) -> ControlFlow<()>) -> TraversalStats {
        whichever!(self, it => it.self_pairs(visit))
    }

    /// As [`DynamicTree::nearest`], in the same order whichever it is.
    pub fn nearest(&self, query: &Aabb, max_distance: f64, visit: impl FnMut(u64, f64) -> f64) -> TraversalStats {
        whichever!(self, it => it.nearest(query, max_distance, visit))
    }

    /// As [`DynamicTree::cast`].
    pub fn cast(&self, cast: &BoxCast, max_fraction: f64, visit: impl FnMut(u64, f64) -> f64) -> TraversalStats {
        whichever!(self, it => it.cast(cast, max_fraction, visit))
    }

    /// Looks at the whole and says how good it is.
    #[must_use]
    pub fn health(&self) -> BroadPhaseHealth {
        match self {
            Self::Tree(tree) => BroadPhaseHealth::Tree(tree.health()),
            Self::SweepAndPrune(sweep) => BroadPhaseHealth::SweepAndPrune(sweep.health()),
            Self::Exhaustive(exhaustive) => BroadPhaseHealth::Exhaustive(exhaustive.health()),
        }
    }

    /// Of a tree: the surface cost that [`Health`] would give of one of the same boxes that is built at once.
    #[must_use]
    pub fn rebuilt_surface_cost(&self) -> Option<f64> {
        if let Self::Tree(tree) = self { Some(tree.rebuilt().health().surface_cost) } else { None }
    }

    /// Bytes of this version, those it shares with others included.
    #[must_use]
    pub fn memory(&self) -> usize {
        whichever!(self, it => it.memory())
    }

    /// Bytes that no other version holds: after a list of changes to a clone, what they cost. It looks only at what is
    /// not shared.
    #[must_use]
    pub fn own_memory(&self) -> usize {
        whichever!(self, it => it.own_memory())
    }

    /// Looks at everything the operations rely on.
    ///
    /// # Errors
    /// The first defect found.
    pub fn validate(&self) -> Result<(), BroadPhaseDefect> {
        whichever!(self, it => it.validate()?);
        Ok(())
    }
}
