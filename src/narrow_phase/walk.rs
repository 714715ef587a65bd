//! A mesh against a convex piece, a half-space or another mesh: down the trees, nearest boxes first.

use std::borrow::Cow;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::goal::Goal;
use super::outcome::Separation;
use super::pieces::{Piece, least_of_boxes, mesh_of, simple_pair};
use super::union::Least;
use crate::geometry::{Aabb, Placement, Shape, TriangleMesh};

/// Opens pairs of nodes in the order of what their boxes prove, least signed distance first, until what is left cannot
/// matter.
pub(super) fn walk(a: &Piece, b: &Piece, goal: &Goal) -> Option<Separation> {
    let mut least = Least::new(goal);
    let (side_a, side_b) = (Side::new(a), Side::new(b));
    let b_in_a = Placement::relative(&a.at, &b.at);
    let pair =
        |na, nb| Open { lower: least_of_boxes(a, side_a.bounds(na), b, side_b.bounds(nb), &b_in_a), a: na, b: nb };
    let mut open = BinaryHeap::from([pair(0, 0)]);
    while let Some(Open { lower, a: na, b: nb }) = open.pop() {
        if least.leaves_out(lower) {
            break; // The bounds of what is left are larger still.
        }
        least.cost.nodes += 1;
        let size = |side: &Side, n: usize| side.bounds(n).map_or(f64::INFINITY, |b| b.half_area());
        match (side_a.children(na), side_b.children(nb)) {
            (None, None) => leaf_pair(&side_a, na, &side_b, nb, &mut least),
            // The larger one is opened: its boxes say least.
            (Some(children), other) if other.is_none() || size(&side_a, na) >= size(&side_b, nb) => {
                open.extend(children.map(|child| pair(child, nb)));
            }
            (_, Some(children)) => open.extend(children.map(|child| pair(na, child))),
            (Some(_), None) => unreachable!("covered by the second arm"),
        }
    }
    least.finish()
}

fn leaf_pair(a: &Side, na: usize, b: &Side, nb: usize, least: &mut Least) {
    for &i in a.items(na) {
        let (shape_a, subshape_a) = a.item(i);
        let item_a = Piece { shape: &shape_a, ..*a.piece };
        for &j in b.items(nb) {
            let (shape_b, subshape_b) = b.item(j);
            let item_b = Piece { shape: &shape_b, ..*b.piece };
            if let Some(found) = simple_pair(&item_a, &item_b, &least.goal()) {
                least.take(Separation { subshape_a, subshape_b, ..found });
            }
        }
    }
}

/// A pair of tree nodes to be opened, with a lower bound of the signed distance of what is in them. A piece without a tree is its own single node.
struct Open {
    lower: f64,
    a: usize,
    b: usize,
}

impl PartialEq for Open {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Open {}

impl Ord for Open {
    /// Least bound first; equals by their indices.
    fn cmp(&self, other: &Self) -> Ordering {
        other.lower.total_cmp(&self.lower).then((other.a, other.b).cmp(&(self.a, self.b)))
    }
}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// One side of a walk.
struct Side<'a> {
    piece: &'a Piece<'a>,
    mesh: Option<&'a TriangleMesh>,
}

impl<'a> Side<'a> {
    fn new(piece: &'a Piece<'a>) -> Self {
        Self { piece, mesh: mesh_of(piece) }
    }

    /// Bounds of a node without swept radius, in the piece's frame; none when unbounded.
    fn bounds(&self, node: usize) -> Option<Aabb> {
        self.mesh.map_or_else(|| self.piece.shape.core().bounds(), |mesh| Some(mesh.tree().nodes()[node].bounds))
    }

    fn children(&self, node: usize) -> Option<[usize; 2]> {
        self.mesh.and_then(|mesh| mesh.tree().nodes()[node].children())
    }

    /// What a leaf holds: the triangles of a mesh, or the piece itself.
    fn items(&self, node: usize) -> &[u32] {
        self.mesh.map_or(&[0], |mesh| mesh.tree().items(&mesh.tree().nodes()[node]))
    }

    /// One of the items, as a shape and its number.
    fn item(&self, index: u32) -> (Cow<'a, Shape>, u32) {
        match self.mesh {
            Some(mesh) => {
                let [a, b, c] = mesh.triangle(index as usize);
                let triangle = Shape::triangle(a, b, c).expect("the vertices of a mesh were checked");
                (Cow::Owned(triangle), index)
            }
            None => (Cow::Borrowed(self.piece.shape), self.piece.part),
        }
    }
}
