//! The read-only tree of boxes over the triangles of a mesh: built once, never changed.
//!
//! A binary tree in one array, parents before children, cut at the median of the longest side of the centres' bounds.
//! It knows boxes only, not what is in them; walks over it are in the narrow phase.

use super::Aabb;

/// A node: an inner one with two children, or a leaf with a run of items.
#[derive(Clone, Copy, Debug)]
pub struct TreeNode {
    /// Bounds of everything below, in the mesh's frame.
    pub bounds: Aabb,
    /// Inner node: index of the left child. Leaf: start of the run in [`MeshTree::order`].
    first: u32,
    /// Inner node: zero. Leaf: length of the run.
    count: u32,
    /// Inner node: index of the right child.
    second: u32,
}

impl TreeNode {
    /// The two children of an inner node.
    #[must_use]
    pub fn children(&self) -> Option<[usize; 2]> {
        (self.count == 0).then_some([self.first as usize, self.second as usize])
    }
}

/// The tree. Node 0 is the root.
#[derive(Clone, Debug)]
pub struct MeshTree {
    nodes: Vec<TreeNode>,
    order: Vec<u32>,
}

/// Items in a leaf at most. Two triangles cost less to test than one more box to open.
const LEAF_ITEMS: usize = 2;

impl MeshTree {
    /// Builds the tree over the boxes of at least one item. O(n log n).
    #[must_use]
    pub fn new(items: &[Aabb]) -> Self {
        let count = u32::try_from(items.len()).expect("a mesh has less than 2^32 triangles");
        let mut tree = Self { nodes: Vec::with_capacity(items.len()), order: (0..count).collect() };
        let centers: Vec<_> = items.iter().map(Aabb::center).collect();
        tree.nodes.push(TreeNode { bounds: Aabb::empty(), first: 0, count: 0, second: 0 });
        let mut open = vec![(0, 0, items.len())];
        while let Some((node, start, end)) = open.pop() {
            let run = &mut tree.order[start..end];
            let over = |boxes: &mut dyn Iterator<Item = Aabb>| boxes.fold(Aabb::empty(), |all, b| all.union(&b));
            let bounds = over(&mut run.iter().map(|&i| items[i as usize]));
            tree.nodes[node].bounds = bounds;
            if run.len() <= LEAF_ITEMS {
                tree.nodes[node].first = start as u32;
                tree.nodes[node].count = run.len() as u32;
                continue;
            }
            let spread = Aabb::around(run.iter().map(|&i| centers[i as usize])).half_extents();
            let axis = spread.imax();
            let middle = run.len() / 2;
            // Ties by index, so that the tree is the same whatever the sort does with equals.
            run.select_nth_unstable_by(middle, |&i, &j| {
                centers[i as usize][axis].total_cmp(&centers[j as usize][axis]).then(i.cmp(&j))
            });
            let left = tree.nodes.len();
            for range in [(start, start + middle), (start + middle, end)] {
                open.push((tree.nodes.len(), range.0, range.1));
                tree.nodes.push(TreeNode { bounds: Aabb::empty(), first: 0, count: 0, second: 0 });
            }
            tree.nodes[node].first = left as u32;
            tree.nodes[node].second = left as u32 + 1;
        }
        tree
    }

    /// The nodes, parents before children.
    #[must_use]
    pub fn nodes(&self) -> &[TreeNode] {
        &self.nodes
    }

    /// The items of a leaf; none for an inner node.
    #[must_use]
    pub fn items(&self, node: &TreeNode) -> &[u32] {
        let start = if node.count == 0 { 0 } else { node.first as usize };
        &self.order[start..start + node.count as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::super::Vec3;
    use super::*;

    #[test]
    fn every_item_is_in_one_leaf_and_inside_every_box_above_it() {
        let items: Vec<Aabb> = (0..101)
            .map(|i| f64::from(i * 37 % 101))
            .map(|x| Aabb::centred(Vec3::new(x, (x * 7.0) % 13.0, -x * 0.1), Vec3::repeat(0.6)))
            .collect();
        let tree = MeshTree::new(&items);
        let mut seen = vec![0; items.len()];
        for node in tree.nodes() {
            if let Some(children) = node.children() {
                assert!(children.iter().all(|&c| node.bounds.contains(&tree.nodes()[c].bounds)));
            }
            for &item in tree.items(node) {
                seen[item as usize] += 1;
                assert!(node.bounds.contains(&items[item as usize]));
            }
        }
        assert!(seen.iter().all(|&n| n == 1));
    }
}
