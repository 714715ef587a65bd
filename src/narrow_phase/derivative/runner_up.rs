//! Of bodies of several pieces: may another pair of pieces be as near as the deciding one, somewhere else?
//!
//! Then a move, however small, may make it the deciding one, and the derivatives are those of one branch of a minimum. All pairs of pieces that are not
//! proved farther than the upper end of the bracket are measured, by the walks that found the deciding pair, until one has witness points of its own. Neighbours
//! that share the witness, as two triangles at a common edge, are no other place.

use arrayvec::ArrayVec;

use super::super::course::{Course, Next, Side};
use super::super::goal::{Depth, Goal};
use super::super::leaves::Leaves;
use super::super::outcome::{Separation, Termination};
use super::super::pieces::{Piece, Pieces, least_of_pieces, simple_pair, swapped, unbounded_of};
use super::super::support::{is_convex, radius};
use super::super::trees::{Branches, Growth, Inside, MOST_LEVELS, Tree, has_tree};
use super::super::unbounded::{self, Unbounded};
use super::super::walk::{NODES_PER_STOP, ROOM};
use super::super::wall::Heights;
use super::derivatives::{DerivativeCost, NoDerivatives};
use crate::geometry::{Core, OrientedBox, Placement, Shape, Siblings, Vec3};

/// Whether there is such a pair.
///
/// # Errors
/// [`NoDerivatives::Stopped`].
pub(super) fn is_contested(
    [(a, at_a), (b, at_b)]: [(&Shape, &Placement); 2],
    found: &Separation,
    again: &Goal,
    cost: &mut DerivativeCost,
) -> Result<bool, NoDerivatives> {
    if is_convex(a.core()) && is_convex(b.core()) {
        return Ok(false);
    }
    let composed = matches!(a.core(), Core::Compound(_)) || matches!(b.core(), Core::Compound(_));
    let pieces_a = Pieces::new(a, Placement::identity(), at_a, composed);
    let pieces_b = Pieces::new(b, Placement::relative(at_a, at_b), at_b, composed);
    let into_a = |point: Vec3| at_a.direction_into(point - at_a.translation);
    let within = as_near(a, b, found);
    let mut rivals = Rivals {
        goal: Goal { depth: Depth::Penetration, margin: 0.0, cut_off: within, ..*again },
        within,
        deciding: [found.subshape_a, found.subshape_b],
        are_parts: [&pieces_a, &pieces_b].map(|pieces| pieces.len() > 1),
        points: [found.point_on_a, found.point_on_b].map(into_a),
        point_error: found.point_error,
        width: found.bracket.width(),
        size: extent(a).min(extent(b)) + found.signed_distance.abs(),
        cost,
    };
    for pa in pieces_a.iter() {
        for pb in pieces_b.iter() {
            if !(least_of_pieces(&pa, &pb) > within) && rivals.among(&pa, &pb)? {
                return Ok(true);
            }
        }
    }
    Ok(false)
}

/// No point of the shape is farther from its origin, metres.
fn extent(shape: &Shape) -> f64 {
    if shape.bounds().is_some() { radius(shape.core()) + shape.swept_radius() } else { f64::INFINITY }
}

/// A pair that is proved farther than this is not as near, metres.
fn as_near(a: &Shape, b: &Shape, found: &Separation) -> f64 {
    let is_solid = |shape: &Shape| matches!(shape.core(), Core::Mesh(mesh) if mesh.is_solid());
    // What is wholly within a solid mesh is so far from its surface.
    let is_within = found.bracket.upper <= 0.0 && found.termination == Termination::Decided;
    if is_within && (is_solid(a) || is_solid(b)) {
        return found.point_error - found.signed_distance;
    }
    found.bracket.upper
}

/// Pairs of pieces that are held against the deciding one. Everything is in A's frame.
struct Rivals<'g, 'c> {
    goal: Goal<'g>,
    /// Metres.
    within: f64,
    /// The numbers of the deciding pair.
    deciding: [u32; 2],
    /// Whether the pieces of a side are parts of a compound, which the numbers are those of.
    are_parts: [bool; 2],
    /// The witness of the deciding pair, metres.
    points: [Vec3; 2],
    point_error: f64,
    /// Of the bracket of the deciding pair, metres.
    width: f64,
    /// Of the lesser shape, and how far they are apart; metres.
    size: f64,
    cost: &'c mut DerivativeCost,
}

impl Rivals<'_, '_> {
    /// Whether there is a rival among what is in two pieces.
    fn among(&mut self, a: &Piece, b: &Piece) -> Result<bool, NoDerivatives> {
        if !has_tree(a) && !has_tree(b) {
            if self.is_deciding([a.part, b.part], [0, 0]) {
                return Ok(false);
            }
            self.check_time()?;
            return Ok(simple_pair(a, b, &self.goal).is_some_and(|found| self.is_one(&found)));
        }
        match (unbounded_of(a), unbounded_of(b)) {
            (None, Some(wall)) => self.over_wall(a, wall, false),
            (Some(wall), None) => self.over_wall(b, wall, true),
            (Some(_), Some(_)) => Ok(false),
            (None, None) => {
                let (Some(box_a), Some(box_b)) = (a.shape.core().bounds(), b.shape.core().bounds()) else {
                    return Ok(false);
                };
                let [alone_a, alone_b] = [box_a, box_b].map(|bounds| Siblings::alone(&OrientedBox::upright(&bounds)));
                if let (Some(tree_a), Some(tree_b)) = (Branches::of(a, &alone_a), Branches::of(b, &alone_b)) {
                    return self.along(&Course::new(Side { piece: a, tree: tree_a }, Side { piece: b, tree: tree_b }));
                }
                let (Some(tree_a), Some(tree_b)) = (Growth::of(a, &alone_a), Growth::of(b, &alone_b)) else {
                    return Ok(false);
                };
                self.along(&Course::new(Side { piece: a, tree: tree_a }, Side { piece: b, tree: tree_b }))
            }
        }
    }

    fn along<'t, T: Tree<'t>>(&mut self, course: &Course<'t, T>) -> Result<bool, NoDerivatives> {
        let mut waiting: ArrayVec<_, ROOM> = ArrayVec::new();
        waiting.push((course.a.tree.root(), course.b.tree.root()));
        let mut nodes = 0;
        while let Some((a, b)) = waiting.pop() {
            match course.open(a, b) {
                Next::Children(opened, children) => {
                    nodes += 1;
                    if nodes % NODES_PER_STOP == 0 {
                        self.check_time()?;
                    }
                    let lowers = course.bounds(&opened, None, self.within).lower;
                    // Negated: what is not a number is looked at.
                    let near = children.into_iter().zip(lowers).filter(|(_, lower)| !(*lower > self.within));
                    near.for_each(|(child, _)| waiting.push(child));
                }
                Next::Leaves(a, b) => {
                    let parts = [course.a.piece.part, course.b.piece.part];
                    if self.is_deciding(parts, [course.a.number(a), course.b.number(b)]) {
                        continue;
                    }
                    self.check_time()?;
                    if let Leaves::Known(found) = course.leaves(a, b, &self.goal, self.within, None)
                        && self.is_one(&found)
                    {
                        return Ok(true);
                    }
                }
            }
        }
        Ok(false)
    }

    /// What is in a piece with a tree, against a wall, which may be side A.
    fn over_wall(&mut self, piece: &Piece, wall: Unbounded, is_a: bool) -> Result<bool, NoDerivatives> {
        let Some(bounds) = piece.shape.core().bounds() else { return Ok(false) };
        let alone = Siblings::alone(&OrientedBox::upright(&bounds));
        let Some(tree) = Growth::of(piece, &alone) else { return Ok(false) };
        let side = Side { piece, tree };
        let heights = Heights::new(piece, &wall);
        let mut waiting: ArrayVec<_, { MOST_LEVELS + 1 }> = ArrayVec::new();
        waiting.push(tree.root());
        while let Some(node) = waiting.pop() {
            match tree.inside(node) {
                Inside::Children(children) => {
                    let lowers = heights.lower_bounds(&tree.both(children));
                    let near = children.into_iter().zip(lowers).filter(|(_, lower)| !(*lower > self.within));
                    near.for_each(|(child, _)| waiting.push(child));
                }
                Inside::Leaf(leaf) => {
                    // A wall is always alone.
                    let (part, number) = (piece.part, side.number(leaf));
                    let (parts, numbers) = if is_a { ([0, part], [0, number]) } else { ([part, 0], [number, 0]) };
                    if self.is_deciding(parts, numbers) {
                        continue;
                    }
                    self.check_time()?;
                    let found = side.with_core(leaf, |core| unbounded::separation(side.convex(core), wall, &self.goal));
                    if self.is_one(&if is_a { swapped(found) } else { found }) {
                        return Ok(true);
                    }
                }
            }
        }
        Ok(false)
    }

    /// Whether these are the pieces that decided: of a compound its parts, else what is in leaves.
    fn is_deciding(&self, parts: [u32; 2], leaves: [u32; 2]) -> bool {
        (0..2).all(|side| self.deciding[side] == if self.are_parts[side] { parts[side] } else { leaves[side] })
    }

    /// Whether a pair may be as near, with a witness of its own.
    fn is_one(&mut self, found: &Separation) -> bool {
        self.cost.separations += 1;
        if found.bracket.lower > self.within {
            return false;
        }
        // How far apart two places may be that both are as near as the brackets say, where the lesser shape is as round as a ball.
        let sideways = libm::sqrt(2.0 * (self.width + found.bracket.width()) * self.size);
        let same = self.point_error + found.point_error + sideways;
        let [a, b] = self.points;
        (found.point_on_a - a).norm() > same || (found.point_on_b - b).norm() > same
    }

    fn check_time(&self) -> Result<(), NoDerivatives> {
        if (self.goal.stop)() { Err(NoDerivatives::Stopped) } else { Ok(()) }
    }
}
