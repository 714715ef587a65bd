//! A mesh, a cloud or terrain against a convex piece or another of them: down the trees, depth first, towards what looks nearest.
//!
//! A pair of nodes is opened when the boxes do not prove that it cannot change the answer: the larger of the two is
//! replaced by its children, and of the two new pairs the one that looks nearer comes first. So the first leaves
//! reached are near one another (or cross, in an overlap), and of what waits on the way back most is left out. The stack
//! needs no more room than both trees have levels, so a walk allocates nothing; best-first order would open a tenth
//! less, and its queue would cost more than that.

use std::f64::consts::PI;

use arrayvec::ArrayVec;

use super::course::{Course, Next, Side};
use super::goal::Goal;
use super::least::Least;
use super::leaves::{Cores, Leaves};
use super::outcome::{Bracket, Separation, Termination};
use super::pieces::{Piece, swapped, unbounded_of};
use super::support::unit;
use super::trees::{Branches, Growth, MOST_LEVELS, Tree};
use super::wall;
use crate::geometry::{OrientedBox, Siblings, Vec3, length};

/// The least separation of what is in two pieces, at least one of them with a tree; as far as the goal needs it.
pub(super) fn walk(a: &Piece, b: &Piece, goal: &Goal) -> Option<Separation> {
    match (unbounded_of(a), unbounded_of(b)) {
        (None, Some(wall)) => wall::walk(a, wall, goal),
        (Some(wall), None) => wall::walk(b, wall, goal).map(swapped),
        (Some(_), Some(_)) => None,
        (None, None) => {
            let alone = |piece: &Piece| Some(Siblings::alone(&OrientedBox::upright(&piece.shape.core().bounds()?)));
            let (alone_a, alone_b) = (alone(a)?, alone(b)?);
            if let (Some(tree_a), Some(tree_b)) = (Branches::of(a, &alone_a), Branches::of(b, &alone_b)) {
                return along(Side { piece: a, tree: tree_a }, Side { piece: b, tree: tree_b }, goal);
            }
            let (tree_a, tree_b) = (Growth::of(a, &alone_a)?, Growth::of(b, &alone_b)?);
            along(Side { piece: a, tree: tree_a }, Side { piece: b, tree: tree_b }, goal)
        }
    }
}

fn along<'a, T: Tree<'a>>(a: Side<'a, T>, b: Side<'a, T>, goal: &Goal) -> Option<Separation> {
    Walk { course: &Course::new(a, b), least: Least::new(goal), normal: None }.run()
}

/// Pairs that wait at most: each pair on the way down leaves one behind, and each level of either tree is opened once.
pub(super) const ROOM: usize = 2 * MOST_LEVELS + 1;
/// Nodes opened between two questions whether time is over: reading a clock costs as much as opening a node.
pub(super) const NODES_PER_STOP: u64 = 16;

/// A pair of nodes that waits to be opened, with a lower bound of the signed distance of what is in them.
#[derive(Clone, Copy)]
struct Waiting<N> {
    lower: f64,
    a: N,
    b: N,
}

struct Walk<'c, 't, 'g, T> {
    course: &'c Course<'t, T>,
    least: Least<'g>,
    /// From A to B at the nearest pair so far, in both frames.
    normal: Option<[Vec3; 2]>,
}

impl<'t, T: Tree<'t>> Walk<'_, 't, '_, T> {
    fn run(mut self) -> Option<Separation> {
        let [lower, _] = self.course.bounds(&self.course.roots(), None, self.least.threshold()).lower;
        let mut waiting: ArrayVec<_, ROOM> = ArrayVec::new();
        waiting.push(Waiting { lower, a: self.course.a.tree.root(), b: self.course.b.tree.root() });
        while let Some(pair) = waiting.pop() {
            if self.least.leaves_out(pair.lower) {
                continue;
            }
            if self.least.cost.nodes.is_multiple_of(NODES_PER_STOP)
                && self.least.has_witness()
                && self.least.must_stop()
            {
                self.least.put_aside(pair.lower);
                waiting.iter().for_each(|left| self.least.put_aside(left.lower));
                break;
            }
            let (opened, children) = match self.course.open(pair.a, pair.b) {
                Next::Children(opened, children) => (opened, children),
                Next::Leaves(a, b) => {
                    self.leaves(a, b);
                    continue;
                }
            };
            self.least.cost.nodes += 1;
            let bounds = self.course.bounds(&opened, self.normal, self.least.threshold());
            let nearer = usize::from(bounds.order[1] < bounds.order[0]);
            for child in [1 - nearer, nearer] {
                // What holds for the parents holds for the children.
                let lower = bounds.lower[child].max(pair.lower);
                if !self.least.leaves_out(lower) {
                    let (a, b) = children[child];
                    waiting.push(Waiting { lower, a, b });
                }
            }
        }
        if !self.least.has_witness() {
            let witness = self.any_witness();
            self.least.take(witness);
        }
        self.least.finish()
    }

    fn leaves(&mut self, a: T::Leaf, b: T::Leaf) {
        match self.course.leaves(a, b, &self.least.goal(), self.least.threshold(), self.normal) {
            Leaves::Farther(lower) => self.least.put_aside(lower),
            Leaves::Known(found) => {
                let (apart, normal) = (found.bracket.lower > 0.0, found.normal);
                if self.least.take(found) && apart {
                    let in_a = self.course.a.piece.at.direction_into(normal);
                    self.normal = Some([in_a, self.course.b_in_a.direction_into(in_a)]);
                }
            }
        }
    }

    /// What nobody needs to know better: some pair of points, where boxes decided before any leaf was reached.
    fn any_witness(&self) -> Separation {
        let (course, lower) = (self.course, self.least.lower());
        let points = [course.a.any_point(), course.b_in_a.point(course.b.any_point())];
        let across = points[1] - points[0];
        // The slack of boxes is more than that of points, and has the radii in it.
        let error = course.slack - course.radii;
        let upper = length(across) + error;
        let bracket = Bracket { lower, upper: lower.max(upper - course.radii + error) };
        let direction = unit(across).unwrap_or_else(Vec3::x);
        let estimate = lower + course.radii;
        let cores = Cores { lower: estimate, upper, estimate, direction, points, error };
        let placed = course.placed(&cores, bracket, Termination::Decided);
        // Neither the points nor the direction have anything to do with the nearest ones.
        Separation { normal_error: PI, point_error: placed.point_error + 2.0 * upper, ..placed }
    }
}
