//! Which boxes meet, and which are near: what decides what the narrow phase looks at.
//!
//! A [`BroadPhase`] holds the boxes of a scene, in one of three ways. [`DynamicTree`] is the usual one. It changes by small steps (insert, remove, move), a clone shares
//! everything neither side changed, and no answer depends on its shape: a leaf is reported by its own tight box, never
//! by the larger one the tree keeps to save work. The order of a report does depend on the shape, except in the walk
//! by distance, so callers sort.

#[expect(clippy::module_inception, reason = "what a scene holds of the broad phase")]
mod broad_phase;
mod cast;
mod exhaustive;
mod health;
mod insert;
mod nearest;
mod node_stack;
mod own_memory;
mod pages;
mod shared_array;
mod sweep;
mod traverse;
mod tree;
mod validate;
mod walk_by_distance;

#[cfg(test)]
mod tests;

pub use broad_phase::{BroadPhase, BroadPhaseDefect, BroadPhaseHealth, BroadPhaseKind};
pub use exhaustive::{Exhaustive, ExhaustiveDefect, ExhaustiveHealth};
pub use health::Health;
pub use sweep::{SweepAndPrune, SweepDefect, SweepHealth};
pub use traverse::TraversalStats;
pub use tree::{DynamicTree, FATTENING_CAP, FATTENING_FRACTION, ProxyId};
pub use validate::TreeDefect;
