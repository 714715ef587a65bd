//! How the tree changes: entries come, go and move, and the tree stays good while they do.
//!
//! A new leaf goes where it makes the tree least dear to traverse (surface-area heuristic, one descent bounded from
//! below: Bittner, Hapala, Havran, "Incremental BVH construction for ray tracing", 2015). On the way back up every node
//! tries to swap a child with a grandchild (Kopta et al., "Fast, effective BVH updates for animated scenes", 2012).
//! Where costs tie, the less tall side wins: boxes that all coincide still make a balanced tree.

use super::tree::{DynamicTree, Leaf, NONE, Node, ProxyId, fattened, visit_cost};
use crate::geometry::Aabb;

/// A leaf that has become much smaller than its fat box is put in anew: when the fat box reaches beyond the new one
/// grown by this many times its own fattening.
const LOOSE_FATTENINGS: f64 = 4.0;

/// A moved leaf stays where it is as long as its parent's cost grows by no more than this factor. Larger makes moves
/// cheaper and lets the tree get worse in between; at 1 nearly every move would be a removal and an insertion.
const LARGEST_STRETCH: f64 = 1.25;

/// After so many changes of its box in one place a leaf gets a new place all the same: steps that are small one by one
/// add up. More makes moves cheaper and the tree worse.
const MOST_STRETCHES: u32 = 7;

/// How far the heights of two siblings may differ. A leaf is never put beside a taller node, and siblings that come
/// farther apart are brought closer even where that costs surface: boxes nested in each other, or spaced ever wider,
/// would otherwise make the tree a chain. At 16 the height stays below some 5 times the least possible one in the worst
/// case, and trees of scattered boxes never feel it; smaller pushes large boxes (floors, walls) too far down.
const LARGEST_IMBALANCE: u32 = 16;

impl DynamicTree {
    /// Adds an entry: a box, metres, and the caller's number for it.
    pub fn insert(&mut self, tight: Aabb, payload: u64) -> ProxyId {
        debug_assert!(is_proper(&tight), "the tree was given {tight:?}");
        let leaf = self.allocate_leaf(Leaf { tight, payload, node: NONE, stretches: 0 });
        self.attach(leaf);
        self.count += 1;
        ProxyId(leaf)
    }

    /// Removes an entry. Its name may be given to another one afterwards.
    pub fn remove(&mut self, proxy: ProxyId) {
        let node = self.leaves[proxy.0].node;
        self.detach(node);
        self.free_leaf(proxy.0);
        self.count -= 1;
    }

    /// Gives an entry another box, metres. Says whether the tree had to change for it: not as long as the box stays in
    /// the fattened one. Small moves beyond that change boxes on the way to the root, large ones the entry's place.
    pub fn move_to(&mut self, proxy: ProxyId, tight: Aabb) -> bool {
        debug_assert!(is_proper(&tight), "the tree was given {tight:?}");
        self.leaves[proxy.0].tight = tight;
        let node = self.leaves[proxy.0].node;
        let fat = &self.nodes[node].fat;
        let wanted = fattened(&tight);
        let loosest = wanted.grown(LOOSE_FATTENINGS * (tight.min.x - wanted.min.x));
        if fat.contains(&tight) && loosest.contains(fat) {
            return false;
        }
        if !self.stretch(proxy.0, &wanted) {
            self.detach(node);
            self.attach(proxy.0);
        }
        true
    }

    /// Gives a leaf another fat box in the place it has, if its parent hardly grows by that: for bodies that move a
    /// little at a time, rotations on the way up keep the tree good for a while.
    fn stretch(&mut self, leaf: u32, fat: &Aabb) -> bool {
        let Leaf { node, stretches, .. } = self.leaves[leaf];
        if stretches >= MOST_STRETCHES {
            return false;
        }
        let parent = self.nodes[node].parent;
        if parent != NONE {
            let Node { fat: before, left, right, .. } = &self.nodes[parent];
            let sibling = if *left == node { *right } else { *left };
            let after = self.nodes[sibling].fat.union(fat);
            if visit_cost(&after) > LARGEST_STRETCH * visit_cost(before) {
                return false;
            }
        }
        self.leaves[leaf].stretches += 1;
        self.nodes[node].fat = *fat;
        self.refit_from(parent);
        true
    }

    /// Makes a node for the leaf and puts it where it costs least.
    fn attach(&mut self, leaf: u32) {
        let fat = fattened(&self.leaves[leaf].tight);
        let node = self.allocate_node(Node { fat, parent: NONE, left: NONE, right: leaf, height: 0 });
        self.leaves[leaf].node = node;
        self.leaves[leaf].stretches = 0;
        if self.root == NONE {
            self.root = node;
            return;
        }
        let sibling = self.best_sibling(&fat);
        let above = self.nodes[sibling].parent;
        let union = self.nodes[sibling].fat.union(&fat);
        let height = self.nodes[sibling].height + 1;
        let parent = self.allocate_node(Node { fat: union, parent: above, left: sibling, right: node, height });
        self.nodes[sibling].parent = parent;
        self.nodes[node].parent = parent;
        self.replace_child(above, sibling, parent);
        self.rotate(parent);
        self.refit_from(above);
    }

    /// Takes a leaf's node out and frees it; the leaf itself is left to the caller.
    fn detach(&mut self, node: u32) {
        let parent = self.nodes[node].parent;
        self.free_node(node);
        if parent == NONE {
            self.root = NONE;
            return;
        }
        let Node { left, right, parent: above, .. } = self.nodes[parent];
        let sibling = if left == node { right } else { left };
        self.free_node(parent);
        self.nodes[sibling].parent = above;
        self.replace_child(above, parent, sibling);
        self.refit_from(above);
    }

    /// The node beside which a leaf of that box adds least to the cost of all nodes.
    fn best_sibling(&self, fat: &Aabb) -> u32 {
        let own = visit_cost(fat);
        let mut node = self.root;
        let mut best = node;
        let mut least = match self.nodes[node].height {
            0..=LARGEST_IMBALANCE => visit_cost(&self.nodes[node].fat.union(fat)),
            _ => f64::INFINITY,
        };
        // What the nodes from the root down to `node` grow by if the leaf goes below them.
        let mut grown = 0.0;
        while !self.nodes[node].is_leaf() {
            let Node { fat: bounds, left, right, .. } = &self.nodes[node];
            grown += visit_cost(&bounds.union(fat)) - visit_cost(bounds);
            let [mut near, mut far] = [*left, *right].map(|child| self.candidate(child, fat, own, grown));
            if (far.bound, far.height) < (near.bound, near.height) {
                (near, far) = (far, near);
            }
            if far.cost < least {
                (best, least) = (far.node, far.cost);
            }
            if near.cost <= least {
                (best, least) = (near.node, near.cost);
            }
            if near.bound > least {
                break;
            }
            node = near.node;
        }
        best
    }

    fn candidate(&self, node: u32, fat: &Aabb, own: f64, grown: f64) -> Candidate {
        let Node { fat: bounds, height, .. } = &self.nodes[node];
        let cost = grown + visit_cost(&bounds.union(fat));
        // Anywhere below, this node grows as well, and the new parent is at least as large as the leaf.
        let bound = if *height == 0 { cost } else { cost - visit_cost(bounds) + own };
        let cost = if *height > LARGEST_IMBALANCE { f64::INFINITY } else { cost };
        Candidate { node, cost, bound, height: *height }
    }

    /// Makes `parent` (or the root's place) point to `new` where it pointed to `old`.
    fn replace_child(&mut self, parent: u32, old: u32, new: u32) {
        if parent == NONE {
            self.root = new;
            return;
        }
        let node = &mut self.nodes[parent];
        if node.left == old {
            node.left = new;
        } else {
            node.right = new;
        }
    }

    /// Puts boxes and heights right from `node` up to the root, and rotates on the way. Stops as soon as nothing has
    /// changed, so that untouched pages stay shared with other versions.
    fn refit_from(&mut self, mut node: u32) {
        while node != NONE {
            let (fat, height) = self.united(self.nodes[node].left, self.nodes[node].right);
            let before = &self.nodes[node];
            let changed = before.fat != fat || before.height != height;
            if changed {
                self.nodes[node].fat = fat;
                self.nodes[node].height = height;
            }
            if !self.rotate(node) && !changed {
                break;
            }
            node = self.nodes[node].parent;
        }
    }

    /// Box and height of a node with these children.
    fn united(&self, left: u32, right: u32) -> (Aabb, u32) {
        let (left, right) = (&self.nodes[left], &self.nodes[right]);
        (left.fat.union(&right.fat), 1 + left.height.max(right.height))
    }

    /// Swaps a child of `node` with a child of the other one if that makes the latter cheaper, or the tree less tall
    /// at the same cost, or less out of balance at any cost. Says whether it did. The box of `node` stays what it was.
    fn rotate(&mut self, node: u32) -> bool {
        let Node { left, right, height, .. } = self.nodes[node];
        let mut best = None;
        let mut best_change = (imbalance(self.nodes[left].height, self.nodes[right].height), 0.0, height);
        for (lone, split) in [(left, right), (right, left)] {
            if self.nodes[split].is_leaf() {
                continue;
            }
            let Node { fat, left: first, right: second, .. } = &self.nodes[split];
            let cost = visit_cost(fat);
            for (goes_up, stays) in [(*first, *second), (*second, *first)] {
                let (united, inner_height) = self.united(lone, stays);
                let [lone_height, up_height, stay_height] = [lone, goes_up, stays].map(|i| self.nodes[i].height);
                let change = (
                    imbalance(lone_height, stay_height).max(imbalance(up_height, inner_height)),
                    visit_cost(&united) - cost,
                    1 + inner_height.max(up_height),
                );
                if change < best_change {
                    best_change = change;
                    best = Some(Rotation { lone, split, goes_up });
                }
            }
        }
        let Some(Rotation { lone, split, goes_up }) = best else { return false };
        self.replace_child(node, lone, goes_up);
        self.replace_child(split, goes_up, lone);
        self.nodes[lone].parent = split;
        self.nodes[goes_up].parent = node;
        let (fat, inner_height) = self.united(self.nodes[split].left, self.nodes[split].right);
        self.nodes[split].fat = fat;
        self.nodes[split].height = inner_height;
        self.nodes[node].height = best_change.2;
        true
    }
}

/// A node that might become the sibling of a new leaf.
struct Candidate {
    node: u32,
    /// What the tree's cost grows by if it does.
    cost: f64,
    /// Nothing at or below the node costs less.
    bound: f64,
    height: u32,
}

/// `lone` goes below `split` in the place of `goes_up`, which takes `lone`'s.
struct Rotation {
    lone: u32,
    split: u32,
    goes_up: u32,
}

/// By how much two children's heights are farther apart than they may be.
fn imbalance(a: u32, b: u32) -> u32 {
    a.abs_diff(b).saturating_sub(LARGEST_IMBALANCE)
}

fn is_proper(aabb: &Aabb) -> bool {
    aabb.min.iter().zip(aabb.max.iter()).all(|(min, max)| min <= max && min.is_finite() && max.is_finite())
}
