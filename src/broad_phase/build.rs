//! Many entries at once: the tree is built over all of them, far faster and better than by single insertions.

use super::arrange::{Arranger, Item, Stock, roomy_levels};
use super::node::Entry;
use super::tree::{DynamicTree, ProxyId};
use super::volume::BoundingVolume;

impl<V: BoundingVolume> DynamicTree<V> {
    /// A tree of these entries, and their names in the order they came.
    #[must_use]
    pub fn build(entries: impl IntoIterator<Item = (V, u64)>) -> (Self, Vec<ProxyId>) {
        let mut tree = Self::new();
        let numbered = (0..).zip(entries);
        let entries: Vec<Entry<V>> =
            numbered.map(|(slot, (volume, payload))| Entry { volume, payload, slot }).collect();
        tree.count = entries.len();
        let mut homes = vec![0; entries.len()];
        tree.build_over(&entries, &mut homes);
        let names = entries.iter().map(|entry| ProxyId(entry.slot)).collect();
        (tree, names)
    }

    /// Makes the root over entries when there is none. `homes` has what is kept for each slot; those of the entries are
    /// set.
    pub(super) fn build_over(&mut self, entries: &[Entry<V>], homes: &mut Vec<u32>) {
        if !entries.is_empty() {
            let mut items: Vec<Item<V>> =
                (0..).zip(entries).map(|(index, entry)| Item { bound: entry.volume.bound(), index }).collect();
            let stock = Stock::Entries(entries);
            let mut arranger = Arranger::new(stock, &mut self.places, Some(&mut *homes));
            let (root, _) = arranger.arrange(&mut items, roomy_levels(entries.len()));
            self.places.set_root(root.id());
            self.root = Some(root);
        }
        self.places.set_homes(homes);
    }
}
