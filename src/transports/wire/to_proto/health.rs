//! How a scene is.

use super::count;
use crate::scene::BroadPhaseHealth;
use crate::service::{KeptRevision, SceneHealth};
use crate::transports::wire::v1;
use crate::transports::wire::v1::scene_health::BroadPhase;

/// Figures of a scene.
#[must_use]
pub fn scene_health(health: &SceneHealth) -> v1::SceneHealth {
    let kept = |kept: &KeptRevision| v1::KeptRevision { revision: kept.revision.0, written_bytes: kept.written as u64 };
    v1::SceneHealth {
        name: health.name.clone(),
        epoch: health.epoch.0,
        revision: health.revision.0,
        bodies: health.bodies as u64,
        memory: Some(v1::SceneMemory {
            bodies: health.memory.bodies as u64,
            names: health.memory.names as u64,
            broad_phase: health.memory.broad_phase as u64,
            entries: health.memory.entries as u64,
        }),
        kept_bytes: health.kept_bytes as u64,
        kept: health.kept.iter().map(kept).collect(),
        broad_phase: Some(broad_phase(health)),
    }
}

fn broad_phase(health: &SceneHealth) -> BroadPhase {
    match &health.broad_phase {
        BroadPhaseHealth::Tree(tree) => BroadPhase::Tree(v1::TreeHealth {
            entries: tree.entries as u64,
            depth: tree.depth,
            least_depth: tree.least_depth,
            surface_cost: tree.surface_cost,
            rebuilt_surface_cost: health.rebuilt_surface_cost,
            stale: tree.stale,
            fill: tree.fill,
            debt: tree.debt,
            upkeep: tree.upkeep,
            rounds: tree.rounds,
            bytes_per_entry: tree.bytes_per_entry,
        }),
        BroadPhaseHealth::SweepAndPrune(sweep) => BroadPhase::SweepAndPrune(v1::SweepHealth {
            entries: sweep.entries as u64,
            axis: count(sweep.axis),
            meeting_share: sweep.meeting_share,
            best_meeting_share: sweep.best_meeting_share,
            filling: sweep.filling,
            changes_since_choice: sweep.changes_since_choice as u64,
            free_places: sweep.free_places as u64,
        }),
        BroadPhaseHealth::Exhaustive(exhaustive) => BroadPhase::Exhaustive(v1::ExhaustiveHealth {
            entries: exhaustive.entries as u64,
            free_places: exhaustive.free_places as u64,
        }),
    }
}
