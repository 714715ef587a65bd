//! What of a tree is its own, and not shared with another version?

use std::sync::Arc;

use super::node::{Inner, Kid, Leaf};
use super::tree::DynamicTree;
use super::volume::BoundingVolume;

/// Reference counts beside what an `Arc` holds, bytes.
const COUNTS: usize = 2 * size_of::<usize>();

impl<V: BoundingVolume> DynamicTree<V> {
    /// Bytes that no other version holds. A node that is shared has only shared ones below it, so the walk ends there.
    #[must_use]
    pub fn own_memory(&self) -> usize {
        let mut bytes = self.places.own_memory();
        let mut stack: Vec<&Kid<V>> = self.root.iter().collect();
        while let Some(kid) = stack.pop() {
            match kid {
                Kid::Leaf(leaf) if Arc::strong_count(leaf) == 1 => bytes += size_of::<Leaf<V>>() + COUNTS,
                Kid::Inner(inner) if Arc::strong_count(inner) == 1 => {
                    bytes += size_of::<Inner<V>>() + COUNTS;
                    stack.extend(&inner.kids);
                }
                Kid::Leaf(_) | Kid::Inner(_) => {}
            }
        }
        bytes
    }
}
