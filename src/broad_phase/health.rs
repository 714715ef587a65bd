//! How good is the tree just now? Figures that rise when it rots.

use super::tree::{DynamicTree, NONE, visit_cost};
use crate::geometry::Aabb;

/// Figures of a tree's quality. Reading them looks at every node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Health {
    /// Entries.
    pub leaves: usize,
    /// Longest way from the root to a leaf, in steps; zero for an empty tree or one entry.
    pub height: u32,
    /// The least height a binary tree of so many leaves can have.
    pub least_height: u32,
    /// Inner nodes that a traversal by a point placed at random in the root's box visits on average by the
    /// surface-area heuristic: the sum of the inner nodes' surfaces over the root's. Rises when the tree gets worse.
    pub surface_cost: f64,
    /// Sum of the side lengths of the fat boxes of all leaves over that of the tight ones; 1 when no leaf has any
    /// extent. Twice the fattening is the price of cheap moves, what is beyond it comes from boxes that shrank.
    pub inflation: f64,
    /// Places kept for entries that are gone: they are used again before the tree takes more memory.
    pub free_places: usize,
}

impl DynamicTree {
    /// Looks at the whole tree and says how good it is.
    #[must_use]
    pub fn health(&self) -> Health {
        let (mut fat_sides, mut tight_sides, mut inner) = (0.0, 0.0, 0.0);
        for leaf in self.live_leaves() {
            fat_sides += sides(&self.nodes[leaf.node].fat);
            tight_sides += sides(&leaf.tight);
        }
        let mut stack = Vec::new();
        stack.extend((self.root != NONE).then_some(self.root));
        while let Some(index) = stack.pop() {
            let node = &self.nodes[index];
            if !node.is_leaf() {
                inner += visit_cost(&node.fat);
                stack.extend([node.left, node.right]);
            }
        }
        let (height, whole) = match self.root {
            NONE => (0, 0.0),
            root => (self.nodes[root].height, visit_cost(&self.nodes[root].fat)),
        };
        Health {
            leaves: self.count,
            height,
            least_height: self.count.max(1).next_power_of_two().ilog2(),
            surface_cost: if whole > 0.0 { inner / whole } else { 0.0 },
            inflation: if tight_sides > 0.0 { fat_sides / tight_sides } else { 1.0 },
            free_places: self.leaves.len() - self.count,
        }
    }
}

fn sides(aabb: &Aabb) -> f64 {
    (aabb.max - aabb.min).sum()
}
