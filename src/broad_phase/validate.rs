//! Is the tree what it claims to be? Every link, bound, level and count, and both lists of free places.

use super::node::{Inner, Kid, Leaf};
use super::places::Place;
use super::tree::DynamicTree;
use super::volume::{BoundingVolume, LANES};

/// What is wrong with a tree. None of these can be reached through the public operations; tests and fuzzers look.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TreeDefect {
    /// A node's parent, or its lane in it, is not the one that is kept for it.
    #[error("node {node} does not know its parent")]
    Parent {
        /// Its id.
        node: u32,
    },
    /// A bound that does not hold every entry below it, or an empty lane that is met.
    #[error("a bound on the way to node {node} is wrong")]
    Bounds {
        /// Its id.
        node: u32,
    },
    /// A level that is not above those of the children.
    #[error("node {node} has a wrong level")]
    Level {
        /// Its id.
        node: u32,
    },
    /// An entry whose leaf is not the one that is kept for it, or a node without any.
    #[error("node {node} and its entries do not agree")]
    Entries {
        /// Its id.
        node: u32,
    },
    /// Nodes or entries that are neither in the tree nor free, or both.
    #[error("{what}: {counted} in the tree and {free} free do not make {total}")]
    Count {
        /// `nodes` or `entries`.
        what: &'static str,
        /// Reached from the root, and those not in the tree yet.
        counted: usize,
        /// Reached through the list of free ones.
        free: usize,
        /// Places there are.
        total: usize,
    },
}

/// A node, its parent and the lane in it, and how many bounds are above it.
type Reached<'a, V> = (&'a Kid<V>, Option<(&'a Inner<V>, usize)>, usize);

impl<V: BoundingVolume> DynamicTree<V> {
    /// Looks at everything the operations rely on.
    ///
    /// # Errors
    /// The first defect found. A tree changed through its public operations has none.
    pub fn validate(&self) -> Result<(), TreeDefect> {
        let tree = self.settled();
        let (mut nodes, mut entries) = (0, 0);
        let mut stack: Vec<Reached<'_, V>> = Vec::new();
        stack.extend(tree.root.iter().map(|root| (root, None, 0)));
        let mut above: Vec<V::Bound> = Vec::new();
        while let Some((kid, parent, depth)) = stack.pop() {
            nodes += 1;
            above.truncate(depth.saturating_sub(1));
            above.extend(parent.map(|(parent, lane)| V::get(&parent.lanes, lane)));
            let parent = parent.map(|(parent, lane)| (parent.id, lane));
            if tree.places.parent(kid.id()) != parent {
                return Err(TreeDefect::Parent { node: kid.id() });
            }
            match kid {
                Kid::Leaf(leaf) => {
                    entries += leaf.entries.len();
                    tree.check_leaf(leaf, &above)?;
                }
                Kid::Inner(inner) => {
                    check_inner(inner)?;
                    let kids = inner.kids.iter().enumerate();
                    stack.extend(kids.map(|(lane, kid)| (kid, Some((&**inner, lane)), depth + 1)));
                }
            }
        }
        let (free_slots, free_nodes) = tree.places.free_counts();
        count("nodes", nodes, free_nodes, tree.places.node_count())?;
        count("entries", entries, free_slots, tree.places.slot_count())?;
        count("entries", tree.count, free_slots, tree.places.slot_count())
    }

    fn check_leaf(&self, leaf: &Leaf<V>, above: &[V::Bound]) -> Result<(), TreeDefect> {
        let defect = Err(TreeDefect::Entries { node: leaf.id });
        if leaf.entries.is_empty() {
            return defect;
        }
        for (lane, slot) in leaf.entries.iter().enumerate() {
            if self.places.place(*slot) != Place::Leaf(leaf.id) {
                return defect;
            }
            let bound = leaf.volumes[lane].bound();
            if V::get(&leaf.lanes, lane) != bound || above.iter().any(|outer| !V::holds(outer, &bound)) {
                return Err(TreeDefect::Bounds { node: leaf.id });
            }
        }
        check_empty_lanes::<V>(&leaf.lanes, leaf.entries.len(), leaf.id)
    }
}

fn check_inner<V: BoundingVolume>(inner: &Inner<V>) -> Result<(), TreeDefect> {
    if inner.kids.is_empty() {
        return Err(TreeDefect::Entries { node: inner.id });
    }
    for kid in &inner.kids {
        if kid.level() >= inner.level {
            return Err(TreeDefect::Level { node: inner.id });
        }
    }
    check_empty_lanes::<V>(&inner.lanes, inner.kids.len(), inner.id)
}

/// A lane without a child must meet nothing, whatever is asked: not even the bound of all the others.
fn check_empty_lanes<V: BoundingVolume>(lanes: &V::Lanes, count: usize, node: u32) -> Result<(), TreeDefect> {
    let all = V::joined(lanes, count);
    let met = V::meeting(lanes, &V::probe_of(&all)).maybe;
    if u32::from(met) == (1_u32 << count.min(LANES)) - 1 { Ok(()) } else { Err(TreeDefect::Bounds { node }) }
}

fn count(what: &'static str, counted: usize, free: usize, total: usize) -> Result<(), TreeDefect> {
    if counted + free == total { Ok(()) } else { Err(TreeDefect::Count { what, counted, free, total }) }
}
