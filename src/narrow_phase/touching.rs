//! All pairs of triangles of two meshes that touch, or are within a margin.

use super::course::{Course, Next, Side};
use super::goal::{Depth, Goal};
use super::leaves::Leaves;
use super::outcome::{Bracket, Cost};
use super::pieces::{Pieces, mesh_of};
use super::support::is_convex;
use super::trees::Branches;
use super::walk::{NODES_PER_STOP, ROOM};
use crate::geometry::{Core, NodeId, OrientedBox, Placement, Shape, Siblings};

/// Two triangles that are not proved farther apart than the margin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TouchingPair {
    /// Number of the triangle in mesh A; 0 where A is a convex shape.
    pub a: u32,
    /// The same in B.
    pub b: u32,
    /// Their signed distance, metres. Sure to be within the margin when `upper` is; else too close to tell.
    pub bracket: Bracket,
}

/// Which pairs are asked for.
#[derive(Clone, Copy)]
pub struct Within<'a> {
    /// Pairs that may be this near, metres; 0 for those that touch.
    pub margin: f64,
    /// Pairs to be listed at most.
    pub limit: usize,
    /// Asked now and then; true ends the search.
    pub stop: &'a dyn Fn() -> bool,
}

impl Within<'_> {
    /// All pairs that touch.
    #[must_use]
    pub fn contact() -> Self {
        Self { margin: 0.0, limit: usize::MAX, stop: &|| false }
    }
}

/// How the search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Touching {
    /// Whether the limit or the time cut the list. If not, every pair that is not listed is proved farther than the margin.
    pub truncated: bool,
    /// What it cost.
    pub cost: Cost,
}

/// Two shapes that have no pairs of triangles to be listed: one has to be a mesh, the other a mesh or convex.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a {a} and a {b} have no pairs of triangles to list: one has to be a mesh, the other a mesh or convex")]
pub struct NoTriangles {
    /// Kind of the first shape.
    pub a: &'static str,
    /// Kind of the second.
    pub b: &'static str,
}

/// Lists in `found` the pairs of triangles of `a` and `b` that touch or are within the margin, in the order of their numbers. What was in the
/// list before is removed; its room is used.
///
/// The surfaces alone are asked about: what lies inside a solid mesh touches no triangle.
///
/// # Errors
/// [`NoTriangles`] unless one shape is a mesh and the other a mesh or convex.
pub fn touching_pairs(
    a: &Shape,
    b: &Shape,
    at_a: &Placement,
    at_b: &Placement,
    within: &Within,
    found: &mut Vec<TouchingPair>,
) -> Result<Touching, NoTriangles> {
    found.clear();
    let refused = NoTriangles { a: a.kind(), b: b.kind() };
    let of_triangles = |shape: &Shape| matches!(shape.core(), Core::Mesh(_)) || is_convex(shape.core());
    if !of_triangles(a) || !of_triangles(b) {
        return Err(refused);
    }
    let (piece_a, piece_b) = (Pieces::alone(a, *at_a, at_a), Pieces::alone(b, *at_b, at_b));
    let bounds = (a.core().bounds(), b.core().bounds());
    let ((Some(box_a), Some(box_b)), true) = (bounds, mesh_of(&piece_a).is_some() || mesh_of(&piece_b).is_some())
    else {
        return Err(refused);
    };
    let [alone_a, alone_b] = [box_a, box_b].map(|bounds| Siblings::alone(&OrientedBox::upright(&bounds)));
    let (Some(tree_a), Some(tree_b)) = (Branches::of(&piece_a, &alone_a), Branches::of(&piece_b, &alone_b)) else {
        return Err(refused);
    };
    let course = Course::new(Side { piece: &piece_a, tree: tree_a }, Side { piece: &piece_b, tree: tree_b });
    let touching = search(&course, within, found);
    found.sort_unstable_by_key(|pair| (pair.a, pair.b));
    Ok(touching)
}

fn search<'a>(course: &Course<'a, Branches<'a>>, within: &Within, found: &mut Vec<TouchingPair>) -> Touching {
    let margin = within.margin;
    let goal = Goal { depth: Depth::Verdict, margin, stop: within.stop, ..Goal::verdict() };
    let mut cost = Cost::default();
    let mut waiting = [(NodeId::ROOT, NodeId::ROOT); ROOM];
    // Negated, here and below: what is not a number is looked at.
    let mut count = usize::from(!(course.bounds(&course.roots(), None, margin).lower[0] > margin));
    while count > 0 {
        count -= 1;
        if cost.nodes.is_multiple_of(NODES_PER_STOP) && (within.stop)() {
            return Touching { truncated: true, cost };
        }
        let (a, b) = waiting[count];
        match course.open(a, b) {
            Next::Children(opened, children) => {
                cost.nodes += 1;
                let lowers = course.bounds(&opened, None, margin).lower;
                for (child, lower) in children.into_iter().zip(lowers).rev() {
                    if !(lower > margin) {
                        waiting[count] = child;
                        count += 1;
                    }
                }
            }
            Next::Leaves(a, b) => {
                let Leaves::Known(pair) = course.leaves(a, b, &goal, margin, None) else {
                    cost.pairs += 1;
                    continue;
                };
                cost += pair.cost;
                if pair.bracket.lower > margin {
                    continue;
                }
                if found.len() == within.limit {
                    return Touching { truncated: true, cost };
                }
                found.push(TouchingPair { a: pair.subshape_a, b: pair.subshape_b, bracket: pair.bracket });
            }
        }
    }
    Touching { truncated: false, cost }
}
