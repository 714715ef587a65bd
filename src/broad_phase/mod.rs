//! Which boxes meet, and which are near: what decides what the narrow phase looks at.
//!
//! A [`BroadPhase`] holds the boxes of a scene, in one of three ways. [`DynamicTree`] is the usual one; it can hold other
//! bounding volumes, too. It changes by lists of small steps (insert, remove, move), a clone shares everything neither side
//! changed, and no answer depends on its shape: an entry is reported by its own volume, never by the larger bound the tree
//! keeps to save work. The order of a report does depend on the shape, except in the walk by distance, so callers sort.
//! `docs/broad_phase.md` says why it is made the way it is.

mod aabb;
mod arrange;
#[expect(clippy::module_inception, reason = "what a scene holds of the broad phase")]
mod broad_phase;
mod build;
mod cast;
mod cells;
mod exhaustive;
mod health;
mod insert;
mod kdop;
mod maintain;
mod nearest;
mod node;
mod node_stack;
mod obb;
mod own_memory;
mod pages;
mod pairs;
mod places;
mod settle;
mod shared_array;
mod sphere;
mod sweep;
mod traverse;
mod tree;
mod validate;
mod volume;
mod walk_by_distance;

#[cfg(test)]
mod tests;

pub use broad_phase::{BroadPhase, BroadPhaseDefect, BroadPhaseHealth, BroadPhaseKind};
pub use exhaustive::{Exhaustive, ExhaustiveDefect, ExhaustiveHealth};
pub use health::Health;
pub use kdop::{Dop18, Dop26, KDop};
pub use sphere::BoundingSphere;
pub use sweep::{SweepAndPrune, SweepDefect, SweepHealth};
pub use traverse::TraversalStats;
pub use tree::{DynamicTree, ProxyId};
pub use validate::TreeDefect;
pub use volume::{BoundingVolume, Growth, LANES, Meeting};
