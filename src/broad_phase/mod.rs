//! Which boxes meet, and which are near: the tree that decides what the narrow phase looks at.
//!
//! One [`DynamicTree`] holds the boxes of a scene. It changes by small steps (insert, remove, move), a clone shares
//! everything neither side changed, and no answer depends on its shape: a leaf is reported by its own tight box, never
//! by the larger one the tree keeps to save work. The order of a report does depend on the shape, except in the walk
//! by distance, so callers sort.

mod cast;
mod health;
mod insert;
mod nearest;
mod node_stack;
mod pages;
mod traverse;
mod tree;
mod validate;

#[cfg(test)]
mod tests;

pub use health::Health;
pub use traverse::TraversalStats;
pub use tree::{DynamicTree, FATTENING_CAP, FATTENING_FRACTION, ProxyId};
pub use validate::TreeDefect;
