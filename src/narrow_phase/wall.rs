//! A mesh, a cloud or terrain against a half-space or a plane: down its tree, lowest boxes first.

use std::borrow::Borrow;

use arrayvec::ArrayVec;

use super::box_gaps::BOX_ERROR_ULPS;
use super::course::Side;
use super::goal::Goal;
use super::least::Least;
use super::outcome::Separation;
use super::pieces::Piece;
use super::support::radius;
use super::trees::{Branches, Growth, Inside, MOST_LEVELS, Tree};
use super::unbounded::{self, Unbounded};
use crate::geometry::tolerance::UNIT_ROUNDOFF;
use crate::geometry::{OrientedBox, Placement, Siblings, TwinBox, Vec3, length};

/// The least separation of what is in a piece with a tree from an unbounded piece.
pub(super) fn walk(a: &Piece, wall: Unbounded, goal: &Goal) -> Option<Separation> {
    let alone = Siblings::alone(&OrientedBox::upright(&a.shape.core().bounds()?));
    match Branches::of(a, &alone) {
        Some(tree) => along(Side { piece: a, tree }, wall, goal),
        None => along(Side { piece: a, tree: Growth::of(a, &alone)? }, wall, goal),
    }
}

fn along<'a, T: Tree<'a>>(a: Side<'a, T>, wall: Unbounded, goal: &Goal) -> Option<Separation> {
    let heights = Heights::new(a.piece, &wall);
    let mut least = Least::new(goal);
    let mut waiting: ArrayVec<_, { MOST_LEVELS + 1 }> = ArrayVec::new();
    waiting.push((f64::NEG_INFINITY, a.tree.root()));
    while let Some((lower, node)) = waiting.pop() {
        // Until one leaf has been looked at none is left out: its corners are the proof from above.
        if least.has_witness() {
            if least.leaves_out(lower) {
                continue;
            }
            if least.must_stop() {
                least.put_aside(lower);
                waiting.iter().for_each(|(lower, _)| least.put_aside(*lower));
                break;
            }
        }
        match a.tree.inside(node) {
            Inside::Leaf(leaf) => {
                let found = a.with_core(leaf, |core| unbounded::separation(a.convex(core), wall, &least.goal()));
                least.take(Separation { subshape_a: a.number(leaf), ..found });
            }
            Inside::Children(children) => {
                least.cost.nodes += 1;
                let lowers = heights.lower_bounds(a.tree.both(children).borrow());
                let nearer = usize::from(lowers[1] < lowers[0]);
                for child in [1 - nearer, nearer] {
                    waiting.push((lowers[child].max(lower), children[child]));
                }
            }
        }
    }
    least.finish()
}

/// Heights of boxes over a wall.
pub(super) struct Heights {
    /// In the piece's frame.
    up: Vec3,
    /// Of the piece's origin, metres.
    origin: f64,
    thin: bool,
    /// Rounding and swept radii, metres.
    slack: f64,
}

impl Heights {
    pub fn new(a: &Piece, wall: &Unbounded) -> Self {
        let (normal, offset) = wall.upright();
        let wall_in_a = Placement::relative(&a.at, wall.at);
        let up = wall_in_a.direction(normal);
        let origin = -up.dot(&wall_in_a.translation) - offset;
        let radii = a.swept_radius + wall.swept_radius;
        let extent = radius(a.shape.core()) + length(wall_in_a.translation) + offset.abs() + radii;
        let slack = BOX_ERROR_ULPS * UNIT_ROUNDOFF * extent + a.placement_error + wall.placement_error + radii;
        Self { up, origin, thin: wall.thin, slack }
    }

    /// Lower bounds of the signed distance of what is in two boxes: their lowest corners, or, where a plane passes between lowest
    /// and highest, the lesser part that sticks through it.
    pub fn lower_bounds(&self, boxes: &TwinBox) -> [f64; 2] {
        [0, 1].map(|lane| {
            let b = boxes.lane(lane);
            let height = self.up.dot(&b.center) + self.origin;
            let half = b.axes.tr_mul(&self.up).abs().dot(&b.half_extents);
            let (low, high) = (height - half, height + half);
            (if self.thin { low.max(-high) } else { low }) - self.slack
        })
    }
}
