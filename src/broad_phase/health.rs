//! How good is the tree just now? Figures that rise when it rots.

use super::node::{Entry, Inner, Kid, Leaf};
use super::tree::{Change, DynamicTree};
use super::volume::{BoundingVolume, LANES};

/// A leaf that has become this many times as dear as when its entries were chosen counts as stale.
const STALE: f32 = 1.15;

/// Figures of a tree's quality. Reading them looks at every node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Health {
    /// Entries.
    pub entries: usize,
    /// Nodes: leaves, and inner nodes above them.
    pub leaves: usize,
    /// Inner nodes.
    pub inner_nodes: usize,
    /// Nodes on the longest way from the root to an entry; zero for an empty tree.
    pub depth: u32,
    /// The least depth that a tree of so many entries can have, eight to a node.
    pub least_depth: u32,
    /// Nodes that a traversal by a point placed at random in the root's bound visits on average by the surface-area
    /// heuristic: the sum of all nodes' costs over the root's. Rises when the tree gets worse;
    /// [`DynamicTree::rebuilt`] has the figure to hold it against.
    pub surface_cost: f64,
    /// Share of leaves that have grown, by moves of their entries, to at least 1.15 times the cost they had when the
    /// entries were chosen.
    pub stale: f64,
    /// Share of the places in leaves that are taken.
    pub fill: f64,
    /// Things to be grouped anew by upkeep that is owed; negative if some was done in advance.
    pub debt: f64,
    /// Things that upkeep has grouped anew since the tree was made.
    pub upkeep: u64,
    /// How often upkeep has been through the whole tree.
    pub rounds: u64,
    /// Bytes an entry, those shared with other versions included.
    pub bytes_per_entry: f64,
}

impl<V: BoundingVolume> DynamicTree<V> {
    /// Looks at the whole tree and says how good it is.
    #[must_use]
    pub fn health(&self) -> Health {
        let tree = self.settled();
        let (mut leaves, mut stale, mut entries, mut cost) = (0_usize, 0_usize, 0_usize, 0.0_f64);
        for leaf in tree.leaves() {
            let own = V::cost(&leaf.bound());
            leaves += 1;
            entries += leaf.entries.len();
            stale += usize::from(own > STALE * leaf.arranged);
            cost += f64::from(own);
        }
        let mut inner_nodes = 0;
        for inner in tree.inner_nodes() {
            inner_nodes += 1;
            cost += f64::from(V::cost(&inner.bound()));
        }
        let whole = tree.root.as_ref().map_or(0.0, |root| f64::from(V::cost(&root.bound())));
        let share = |part: usize, of: usize| if of > 0 { part as f64 / of as f64 } else { 0.0 };
        Health {
            entries,
            leaves,
            inner_nodes,
            depth: tree.depth(),
            least_depth: if entries == 0 { 0 } else { least_depth(entries) },
            surface_cost: if whole > 0.0 { cost / whole } else { 0.0 },
            stale: share(stale, leaves),
            fill: share(entries, leaves * LANES),
            debt: tree.upkeep.debt,
            upkeep: tree.upkeep.work,
            rounds: tree.upkeep.rounds,
            bytes_per_entry: share(tree.memory(), entries),
        }
    }

    /// The same entries in a tree that is built at once: what [`DynamicTree::health`] is to be held against. Its names
    /// are others.
    #[must_use]
    pub fn rebuilt(&self) -> Self {
        let entries: Vec<(u64, V)> = self.iter().collect();
        Self::build(entries.len(), |index| (entries[index].1, entries[index].0)).0
    }

    /// Bytes of all nodes and lists, those shared with other versions included.
    #[must_use]
    pub fn memory(&self) -> usize {
        let counts = 2 * size_of::<usize>();
        let leaves = self.leaves().count() * (size_of::<Leaf<V>>() + counts);
        let inner = self.inner_nodes().count() * (size_of::<Inner<V>>() + counts);
        let waiting = self.coming.capacity() * size_of::<Entry<V>>() + self.changes.capacity() * size_of::<Change<V>>();
        leaves + inner + waiting + self.places.memory() + size_of::<Self>()
    }

    fn depth(&self) -> u32 {
        let mut deepest = 0;
        let mut stack: Vec<_> = self.root.iter().map(|root| (root, 1)).collect();
        while let Some((kid, depth)) = stack.pop() {
            deepest = deepest.max(depth);
            if let Kid::Inner(inner) = kid {
                stack.extend(inner.kids.iter().map(|kid| (kid, depth + 1)));
            }
        }
        deepest
    }
}

fn least_depth(entries: usize) -> u32 {
    let (mut depth, mut room) = (1, LANES);
    while room < entries {
        depth += 1;
        room = room.saturating_mul(LANES);
    }
    depth
}
