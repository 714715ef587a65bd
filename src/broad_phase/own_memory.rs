//! What of a tree is its own, and not shared with another version?

use super::DynamicTree;

impl DynamicTree {
    /// Bytes that no other version holds.
    #[must_use]
    pub fn own_memory(&self) -> usize {
        self.nodes.own_memory() + self.leaves.own_memory()
    }
}
