//! Many entries at once: the tree is built over all of them, far faster and better than by single insertions.
//!
//! Nothing of the size of all entries is written but the nodes and a few numbers an entry: on memory that is touched for
//! the first time, a page costs more than the work on the entries in it.

use super::arrange::{Arranger, Stock, Supply, items_of, roomy_levels};
use super::cells::Cells;
use super::node::Entry;
use super::tree::{DynamicTree, ProxyId};
use super::volume::BoundingVolume;

/// Above so many entries they are sorted into cells first.
const MANY: usize = 1024;

impl<V: BoundingVolume> DynamicTree<V> {
    /// A tree of so many entries, and their names in the same order. `entry` gives the volume, metres, and the caller's
    /// number of each; it is asked several times.
    #[must_use]
    pub fn build(count: usize, entry: impl Fn(usize) -> (V, u64)) -> (Self, Vec<ProxyId>) {
        let mut tree = Self::new();
        tree.count = count;
        let supply = |slot: u32| {
            let (volume, payload) = entry(slot as usize);
            Entry { volume, payload, slot }
        };
        tree.build_over(count, &supply, &mut vec![0; count]);
        (tree, (0..count as u32).map(ProxyId).collect())
    }

    /// Makes the root over entries when there is none. `homes` has what is kept for each slot; those of the entries are
    /// set.
    pub(super) fn build_over(&mut self, count: usize, entries: Supply<'_, V>, homes: &mut Vec<u32>) {
        if count > 0 {
            let cells = if count > MANY { Cells::of(count, entries) } else { None };
            let (stock, mut items) = match &cells {
                None => (Stock::Entries(entries), items_of(entries, 0..count as u32)),
                Some(cells) => (Stock::Cells(cells, entries), cells.items()),
            };
            let levels = roomy_levels(items.len());
            let mut arranger = Arranger { stock, places: &mut self.places, homes: Some(&mut *homes) };
            let (root, _) = arranger.arrange(&mut items, levels);
            self.places.set_root(root.id());
            self.root = Some(root);
        }
        self.places.set_homes(homes);
    }
}
