//! How well do the pieces of a decomposition fit their mesh? The two one-sided Hausdorff distances between them, as proved brackets.
//!
//! - *Loss*: how far a point of the mesh's surface may be from all pieces. What is lost may collide unseen.
//! - *Inflation*: how far a point of a piece may be from the mesh: from the body it encloses where it is closed and faces outwards, else from its
//!   surface, of which the inside of a piece is away too. What is inflated may be told to collide that does not.
//!
//! Both are greatest values of a distance, which changes no faster than the point moves. So a region of radius r around a point at distance d
//! holds no value above d + r, and branch and bound does the rest: the region that promises most is cut in two until what it promises is hardly
//! more than the best point found. On a triangle more is known: the distance from one convex piece is a convex function, so it is greatest
//! at a corner. Values are those of the narrow phase's own brackets; the lower ends come from points of the mesh or the pieces,
//! the upper ends from regions, whatever ends the search.

use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::sync::Arc;

use super::goal::{Depth, Goal};
use super::outcome::{Bracket, Separation};
use super::separation::separation;
use crate::geometry::tolerance::UNIT_ROUNDOFF;
use crate::geometry::{Aabb, Compound, Core, Placement, Pose, Quaternion, Shape, TriangleMesh, Vec3, length};

/// How long a fit is worked on.
#[derive(Clone, Copy)]
pub struct FitGoal<'a> {
    /// Brackets need not be narrower than this, metres.
    pub accuracy: f64,
    /// Distances that are worked out for each of the two values at most, beside one for each triangle and corner.
    pub most_points: usize,
    /// Asked now and then; true ends the work with the brackets reached so far.
    pub stop: &'a dyn Fn() -> bool,
}

/// How far a decomposition and its mesh are from one another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// The greatest distance of a point of the pieces from the mesh, metres.
    pub inflation: Bracket,
    /// The greatest distance of a point of the mesh's surface from the pieces, metres.
    pub loss: Bracket,
    /// Whether the mesh is closed, so that what it encloses counts as inside.
    pub closed: bool,
    /// Distances that were worked out.
    pub points: u64,
}

/// The fit of `pieces` and `mesh`, both in one frame. The pieces have to be convex hulls.
#[must_use]
pub fn fit(mesh: &Arc<TriangleMesh>, pieces: &Arc<Compound>, goal: &FitGoal) -> Fit {
    let body = if mesh.is_solid() {
        Some(Arc::clone(mesh))
    } else {
        TriangleMesh::solid(mesh.vertices().to_vec(), mesh.triangles().to_vec()).ok().map(Arc::new)
    };
    let closed = body.is_some();
    let mut points = 0;
    let loss = loss(mesh, pieces, goal, &mut points);
    let body = Shape::mesh(body.unwrap_or_else(|| Arc::clone(mesh)));
    let inflation = inflation(&body, pieces, goal, &mut points);
    Fit { inflation, loss, closed, points }
}

/// A region and the most that a point of it may have.
struct Region<T> {
    upper: f64,
    /// Which was made first: ties are broken by it, so that the search is the same each time.
    number: u64,
    what: T,
}

impl<T> PartialEq for Region<T> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl<T> Eq for Region<T> {}

impl<T> PartialOrd for Region<T> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<T> Ord for Region<T> {
    fn cmp(&self, other: &Self) -> Ordering {
        self.upper.total_cmp(&other.upper).then(other.number.cmp(&self.number))
    }
}

/// The search for the greatest value over regions.
struct Greatest<T> {
    open: BinaryHeap<Region<T>>,
    /// The greatest value of a point.
    lower: f64,
    made: u64,
}

impl<T> Greatest<T> {
    fn new() -> Self {
        Self { open: BinaryHeap::new(), lower: 0.0, made: 0 }
    }

    /// A region, with the value that a point of it surely has.
    fn offer(&mut self, what: T, lower: f64, upper: f64) {
        self.lower = self.lower.max(lower);
        self.open.push(Region { upper, number: self.made, what });
        self.made += 1;
    }

    /// Cuts what promises most, until it promises no more than is known or the work is over. `cut` offers the parts of a region.
    fn settle(mut self, goal: &FitGoal, mut cut: impl FnMut(&mut Self, T)) -> Bracket {
        let begun = self.made;
        loop {
            let Some(top) = self.open.pop() else { return Bracket { lower: self.lower, upper: self.lower } };
            let is_over = self.made - begun >= goal.most_points as u64 || (goal.stop)();
            if top.upper <= self.lower + goal.accuracy || is_over {
                return Bracket { lower: self.lower, upper: top.upper.max(self.lower) };
            }
            cut(&mut self, top.what);
        }
    }
}

fn loss(mesh: &TriangleMesh, pieces: &Arc<Compound>, goal: &FitGoal, points: &mut u64) -> Bracket {
    let whole = Shape::compound(Arc::clone(pieces));
    let mut promise = |greatest: &mut Greatest<[Vec3; 3]>, triangle: [Vec3; 3]| {
        *points += 4;
        let middle = triangle.iter().map(|p| p / 3.0).sum::<Vec3>();
        let nearest = distance(&whole, middle);
        let reach = triangle.iter().map(|p| length(p - middle)).fold(0.0, f64::max);
        // From one piece alone: at most what it is from the farthest corner.
        let piece = &pieces.parts()[nearest.subshape_a as usize].shape;
        let at_corners = triangle.map(|p| distance(piece, p).bracket.upper).into_iter().fold(0.0, f64::max);
        let by_reach = outward(nearest.bracket.upper.max(0.0) + reach, middle);
        greatest.offer(triangle, nearest.bracket.lower, at_corners.min(by_reach));
    };
    let mut greatest = Greatest::new();
    for i in 0..mesh.triangles().len() {
        if (goal.stop)() {
            return Bracket { lower: 0.0, upper: f64::INFINITY };
        }
        promise(&mut greatest, mesh.triangle(i));
    }
    greatest.settle(goal, |greatest, [a, b, c]| {
        // Across the longest edge.
        let edges = [length(b - a), length(c - b), length(a - c)];
        let [a, b, c] = match edges.iter().fold(0.0, |m: f64, e| m.max(*e)) {
            longest if edges[0] == longest => [a, b, c],
            longest if edges[1] == longest => [b, c, a],
            _ => [c, a, b],
        };
        let middle = 0.5 * a + 0.5 * b;
        promise(greatest, [a, middle, c]);
        promise(greatest, [middle, b, c]);
    })
}

fn inflation(body: &Shape, pieces: &Compound, goal: &FitGoal, points: &mut u64) -> Bracket {
    let mut promise = |greatest: &mut Greatest<(usize, Aabb)>, index: usize, cell: Aabb| {
        *points += 1;
        let part = &pieces.parts()[index];
        let (center, half) = (cell.center(), cell.half_extents());
        let (Ok(cuboid), frame) = (Shape::cuboid(half), Placement::identity()) else { return };
        let inside = separation(&part.shape, &cuboid, &frame, &placed(center), &Goal::verdict());
        if inside.is_ok_and(|found| found.bracket.lower > 0.0) {
            return; // Nothing of the piece is in the cell.
        }
        let from_body = distance(body, center).bracket;
        // Inside of a solid the distance is negative, and as deep as the surface is far.
        let upper = outward((from_body.upper + length(half)).max(0.0), center);
        let to_piece = distance(&part.shape, center);
        let lower = if to_piece.bracket.upper <= 0.0 {
            from_body.lower
        } else {
            // The nearest point of the piece, which is off by a little.
            distance(body, to_piece.point_on_a).bracket.lower - to_piece.point_error
        };
        greatest.offer((index, cell), lower, upper);
    };
    let mut greatest = Greatest::new();
    for (index, part) in pieces.parts().iter().enumerate() {
        if let Core::Convex(hull) = part.shape.core() {
            // Of most pieces a corner is farthest.
            for corner in hull.points() {
                greatest.lower = greatest.lower.max(distance(body, *corner).bracket.lower);
            }
            promise(&mut greatest, index, hull.bounds());
        }
    }
    greatest.settle(goal, |greatest, (index, cell)| {
        let axis = cell.half_extents().imax();
        let (mut low, mut high) = (cell, cell);
        low.max[axis] = cell.center()[axis];
        high.min[axis] = cell.center()[axis];
        promise(greatest, index, low);
        promise(greatest, index, high);
    })
}

/// A sum of lengths near a place, rounded up.
fn outward(length_so_far: f64, at: Vec3) -> f64 {
    length_so_far + 64.0 * UNIT_ROUNDOFF * (length_so_far + length(at))
}

fn placed(at: Vec3) -> Placement {
    Pose::new(at, Quaternion::IDENTITY).map_or_else(|_| Placement::identity(), |pose| pose.placement())
}

/// From a shape at the origin to a point.
fn distance(shape: &Shape, point: Vec3) -> Separation {
    let goal = Goal { depth: Depth::Distance, ..Goal::penetration() };
    // A point has bounds and no solver is asked for by name, so there is an answer.
    separation(shape, &Shape::point(), &Placement::identity(), &placed(point), &goal)
        .unwrap_or_else(|error| unreachable!("{error}"))
}
