//! Is the tree what it claims to be? Every link, box, height and count, and both free lists.

use super::tree::{DynamicTree, FREE, NONE};

/// What is wrong with a tree. None of these can be reached through the public operations; tests and fuzzers look.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TreeDefect {
    /// A node does not point back to the node that points to it.
    #[error("node {node} does not know its parent")]
    Parent {
        /// Index of the child.
        node: u32,
    },
    /// A box that is not the union of the children's boxes, or a leaf's that does not hold the tight one.
    #[error("node {node} has wrong bounds")]
    Bounds {
        /// Index of the node.
        node: u32,
    },
    /// A height that is not one more than the taller child's.
    #[error("node {node} has a wrong height")]
    Height {
        /// Index of the node.
        node: u32,
    },
    /// A leaf's node and its entry do not point to each other.
    #[error("node {node} and its leaf do not agree")]
    Leaf {
        /// Index of the node.
        node: u32,
    },
    /// Nodes or leaves that are neither in the tree nor free, or both.
    #[error("{what}: {counted} in the tree and {free} free do not make {total}")]
    Count {
        /// `nodes` or `leaves`.
        what: &'static str,
        /// Reached from the root.
        counted: usize,
        /// Reached through the free list.
        free: usize,
        /// Places there are.
        total: usize,
    },
}

impl DynamicTree {
    /// Looks at everything the operations rely on.
    ///
    /// # Errors
    /// The first defect found. A tree changed through its public operations has none.
    pub fn validate(&self) -> Result<(), TreeDefect> {
        let (mut nodes, mut leaves) = (0, 0);
        let mut stack = Vec::new();
        if self.root != NONE {
            stack.push((self.root, NONE));
        }
        while let Some((index, parent)) = stack.pop() {
            nodes += 1;
            if nodes > self.nodes.len() {
                break; // A circle of links; the counts below will not add up.
            }
            let node = &self.nodes[index];
            if node.parent != parent {
                return Err(TreeDefect::Parent { node: index });
            }
            if node.is_leaf() {
                leaves += 1;
                let leaf = self.leaf_of(node);
                if leaf.node != index {
                    return Err(TreeDefect::Leaf { node: index });
                }
                if !node.fat.contains(&leaf.tight) {
                    return Err(TreeDefect::Bounds { node: index });
                }
                if node.height != 0 {
                    return Err(TreeDefect::Height { node: index });
                }
                continue;
            }
            let (left, right) = (&self.nodes[node.left], &self.nodes[node.right]);
            if node.fat != left.fat.union(&right.fat) {
                return Err(TreeDefect::Bounds { node: index });
            }
            if node.height != 1 + left.height.max(right.height) {
                return Err(TreeDefect::Height { node: index });
            }
            stack.extend([(node.left, index), (node.right, index)]);
        }
        let free_nodes = free_chain(self.first_free_node, self.nodes.len(), |i| {
            (self.nodes[i].height == FREE).then_some(self.nodes[i].parent)
        });
        let free_leaves = free_chain(self.first_free_leaf, self.leaves.len(), |i| {
            (self.leaves[i].node == NONE).then_some(self.leaves[i].payload as u32)
        });
        count("nodes", nodes, free_nodes, self.nodes.len())?;
        count("leaves", leaves, free_leaves, self.leaves.len())?;
        count("leaves", self.count, free_leaves, self.leaves.len())
    }
}

/// Length of a free list; stops where an element is not free, or after more steps than there are places.
fn free_chain(first: u32, total: usize, next: impl Fn(u32) -> Option<u32>) -> usize {
    let mut length = 0;
    let mut index = first;
    while index != NONE && length <= total {
        let Some(following) = next(index) else { break };
        index = following;
        length += 1;
    }
    length
}

fn count(what: &'static str, counted: usize, free: usize, total: usize) -> Result<(), TreeDefect> {
    if counted + free == total { Ok(()) } else { Err(TreeDefect::Count { what, counted, free, total }) }
}
