//! The read-only tree of turned boxes over the triangles of a mesh: built once, never changed.
//!
//! A binary tree, cut at the median of the longest side of the centres' bounds, with one triangle in each leaf. Siblings lie
//! side by side, so that a walk asks about both at once; parents come before children, and the triangles' corners are
//! kept in the order of the leaves, so that neighbours in space are neighbours in memory.
//! Walks over the tree are in the narrow phase.

use super::{Aabb, OrientedBox, TwinBox, Vec3};

/// A box of the tree, by number. The children of an inner node have numbers that differ in the last bit alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct NodeId(u32);

impl NodeId {
    /// The box around everything.
    pub const ROOT: Self = Self(0);
}

/// What is in a box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content {
    /// Two children.
    Children([NodeId; 2]),
    /// One triangle: its place in the order of the leaves.
    Leaf(usize),
}

/// Two sibling boxes and what is in them.
#[derive(Clone, Copy, Debug)]
pub struct Siblings {
    boxes: TwinBox,
    content: [u32; 2],
}

/// Set in `Siblings::content` for leaves.
const LEAF: u32 = 1 << 31;

/// Levels of a tree at most. The median cut halves each run, and a mesh has less than 2^31 triangles.
pub const MOST_LEVELS: usize = 32;

/// Nodes as a walk sees them: those of a mesh's tree, or one that stands alone.
#[derive(Clone, Copy, Debug)]
pub struct Nodes<'a>(&'a [Siblings]);

impl Siblings {
    /// A box on its own, as a tree of one leaf.
    #[must_use]
    pub fn alone(only: &OrientedBox) -> Self {
        Self { boxes: TwinBox::new([only, only]), content: [LEAF, LEAF] }
    }
}

impl<'a> Nodes<'a> {
    /// A single leaf.
    #[must_use]
    pub fn alone(only: &'a Siblings) -> Self {
        Self(std::slice::from_ref(only))
    }

    /// The box of a node.
    #[inline(always)]
    #[must_use]
    pub fn bounds(&self, node: NodeId) -> OrientedBox {
        self.0[(node.0 / 2) as usize].boxes.lane((node.0 % 2) as usize)
    }

    /// The longest half edge of a node's box, metres.
    #[inline(always)]
    #[must_use]
    pub fn size(&self, node: NodeId) -> f64 {
        let half = &self.0[(node.0 / 2) as usize].boxes.half_extents;
        half.largest().0[(node.0 % 2) as usize]
    }

    /// The boxes of two children.
    #[inline(always)]
    #[must_use]
    pub fn both(&self, children: [NodeId; 2]) -> &'a TwinBox {
        &self.0[(children[0].0 / 2) as usize].boxes
    }

    /// What is in a node.
    #[inline(always)]
    #[must_use]
    pub fn content(&self, node: NodeId) -> Content {
        let content = self.0[(node.0 / 2) as usize].content[(node.0 % 2) as usize];
        if content & LEAF != 0 {
            Content::Leaf((content & !LEAF) as usize)
        } else {
            Content::Children([NodeId(2 * content), NodeId(2 * content + 1)])
        }
    }
}

/// The tree.
#[derive(Clone, Debug)]
pub struct MeshTree {
    siblings: Vec<Siblings>,
    /// Corners of the triangle of each leaf.
    corners: Vec<[Vec3; 3]>,
    /// Number of the triangle of each leaf.
    numbers: Vec<u32>,
}

impl MeshTree {
    /// Builds the tree over at least one triangle and less than 2^31. O(n log n).
    #[must_use]
    pub fn new(triangles: &[[Vec3; 3]]) -> Self {
        let count =
            u32::try_from(triangles.len()).ok().filter(|n| *n < LEAF).expect("a mesh has less than 2^31 triangles");
        let mut numbers: Vec<u32> = (0..count).collect();
        let mut corners = triangles.to_vec();
        let root = OrientedBox::around(triangles);
        let mut siblings = vec![Siblings { boxes: TwinBox::new([&root, &root]), content: [LEAF, LEAF] }];
        // Runs of triangles to be cut, and the lane that names their children.
        let mut open = vec![(0, 0, 0, triangles.len())];
        while let Some((parent, lane, start, end)) = open.pop() {
            if end - start == 1 {
                siblings[parent].content[lane] = LEAF | start as u32;
                continue;
            }
            let middle = start + cut(&mut numbers[start..end], triangles);
            for place in start..end {
                corners[place] = triangles[numbers[place] as usize];
            }
            let [left, right] = [&corners[start..middle], &corners[middle..end]].map(OrientedBox::around);
            let children = siblings.len();
            siblings.push(Siblings { boxes: TwinBox::new([&left, &right]), content: [0, 0] });
            siblings[parent].content[lane] = children as u32;
            open.push((children, 0, start, middle));
            open.push((children, 1, middle, end));
        }
        // The root stands twice in its pair.
        siblings[0].content[1] = siblings[0].content[0];
        Self { siblings, corners, numbers }
    }

    /// The nodes.
    #[must_use]
    pub fn nodes(&self) -> Nodes<'_> {
        Nodes(&self.siblings)
    }

    /// Corners of the triangle of a leaf, in the order of the mesh.
    #[inline(always)]
    #[must_use]
    pub fn corners(&self, leaf: usize) -> &[Vec3; 3] {
        &self.corners[leaf]
    }

    /// Number of the triangle of a leaf in the mesh.
    #[inline(always)]
    #[must_use]
    pub fn number(&self, leaf: usize) -> u32 {
        self.numbers[leaf]
    }
}

/// Puts the half with the lesser centres first, along the axis in which centres are spread most; where the halves meet.
fn cut(run: &mut [u32], triangles: &[[Vec3; 3]]) -> usize {
    // Thirds first: a sum of three of the largest coordinates is still finite.
    let center = |i: u32| triangles[i as usize].iter().map(|p| p / 3.0).sum::<Vec3>();
    let axis = Aabb::around(run.iter().map(|&i| center(i))).half_extents().imax();
    let middle = run.len() / 2;
    // Ties by number, so that the tree is the same whatever the selection does with equals.
    run.select_nth_unstable_by(middle, |&i, &j| center(i)[axis].total_cmp(&center(j)[axis]).then(i.cmp(&j)));
    middle
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_triangle_is_in_one_leaf_and_inside_every_box_above_it() {
        let corner = |i: u32, k: u32| {
            let x = f64::from(i * 37 % 101) + 0.3 * f64::from(k);
            Vec3::new(x, (x * 7.0) % 13.0 + f64::from(k), -x * 0.1)
        };
        let triangles: Vec<[Vec3; 3]> = (0..101).map(|i| [corner(i, 0), corner(i, 1), corner(i, 2)]).collect();
        let tree = MeshTree::new(&triangles);
        let nodes = tree.nodes();
        let mut seen = [0; 101];
        let mut open = vec![(NodeId::ROOT, Vec::new())];
        while let Some((node, mut above)) = open.pop() {
            above.push(node);
            assert!(above.len() <= 9, "deeper than the median cut can be");
            match nodes.content(node) {
                Content::Children(children) => open.extend(children.map(|child| (child, above.clone()))),
                Content::Leaf(leaf) => {
                    let number = tree.number(leaf) as usize;
                    seen[number] += 1;
                    assert_eq!(tree.corners(leaf), &triangles[number]);
                    for bounds in above.iter().map(|&node| nodes.bounds(node)) {
                        for p in tree.corners(leaf) {
                            let beyond = bounds.axes.tr_mul(&(p - bounds.center)).abs() - bounds.half_extents;
                            assert!(beyond.max() < 1e-12);
                        }
                    }
                }
            }
        }
        assert!(seen.iter().all(|&n| n == 1));
    }
}
