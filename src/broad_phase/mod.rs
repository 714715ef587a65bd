//! Which boxes meet, and which are near: the tree that decides what the narrow phase looks at.
//!
//! One [`DynamicTree`] holds the boxes of a scene, or other bounding volumes. It changes by lists of small steps (insert,
//! remove, move), a clone shares everything neither side changed, and no answer depends on its shape: an entry is reported
//! by its own volume, never by the larger bound the tree keeps to save work. The order of a report does depend on the
//! shape, except in the walk by distance, so callers sort. `docs/broad_phase.md` says why it is made the way it is.

mod aabb;
mod arrange;
mod build;
mod cast;
mod cells;
mod health;
mod insert;
mod maintain;
mod nearest;
mod node;
mod node_stack;
mod pages;
mod pairs;
mod places;
mod settle;
mod sphere;
mod traverse;
mod tree;
mod validate;
mod volume;

#[cfg(test)]
mod tests;

pub use health::Health;
pub use sphere::BoundingSphere;
pub use traverse::TraversalStats;
pub use tree::{DynamicTree, ProxyId};
pub use validate::TreeDefect;
pub use volume::{BoundingVolume, Growth, LANES, Meeting};
