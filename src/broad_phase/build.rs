//! Many entries at once: the tree is built over all of them, far faster and better than by single insertions.

use std::ops::Range;

use super::arrange::{Arranger, Item, Stock, joined, roomy_levels};
use super::cells::into_cells;
use super::node::Entry;
use super::tree::{DynamicTree, ProxyId};
use super::volume::BoundingVolume;

/// Above so many entries they are sorted into cells first.
const MANY: usize = 1024;

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
                (0..).zip(entries).map(|(index, entry)| Item::new(entry.volume.bound(), index)).collect();
            let cells = if entries.len() > MANY { into_cells(&mut items) } else { None };
            let places = &mut self.places;
            let root = match cells {
                None => {
                    let levels = roomy_levels(items.len());
                    let stock = Stock::Entries(entries);
                    Arranger { stock, places, homes: Some(&mut *homes) }.arrange(&mut items, levels).0
                }
                Some(cells) => {
                    let bound = |range: &Range<usize>| joined(&items[range.clone()]);
                    let mut tops: Vec<Item<V>> =
                        (0..).zip(&cells).map(|(index, range)| Item::new(bound(range), index)).collect();
                    let levels = roomy_levels(cells.len());
                    let stock = Stock::Cells(&cells, &mut items, entries);
                    Arranger { stock, places, homes: Some(&mut *homes) }.arrange(&mut tops, levels).0
                }
            };
            self.places.set_root(root.id());
            self.root = Some(root);
        }
        self.places.set_homes(homes);
    }
}
