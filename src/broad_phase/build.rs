//! Many entries at once: the tree is built over all of them, far faster and better than by single insertions.

use super::node::Entry;
use super::tree::{DynamicTree, ProxyId};
use super::volume::BoundingVolume;

impl<V: BoundingVolume> DynamicTree<V> {
    /// A tree of these entries, and their names in the order they came.
    #[must_use]
    pub fn build(entries: impl IntoIterator<Item = (V, u64)>) -> (Self, Vec<ProxyId>) {
        let mut tree = Self::new();
        let entries: Vec<Entry<V>> = entries
            .into_iter()
            .map(|(volume, payload)| Entry { volume, payload, slot: tree.places.new_slot(0) })
            .collect();
        tree.count = entries.len();
        tree.build_over(&entries);
        let names = entries.iter().map(|entry| ProxyId(entry.slot)).collect();
        (tree, names)
    }
}
