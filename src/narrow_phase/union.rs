//! Shapes made of many convex pieces: meshes, compounds, and whatever stands against them.
//!
//! The signed distance is the minimum over pairs of pieces. Everything is in the first shape's frame, so that a pair far
//! from the origin is as accurate as one near it. Pairs of tree nodes are opened in the order of the distance
//! of their boxes, until no box is near enough to matter: what is left unopened is proved farther than the answer, so
//! the bracket of the minimum is the minimum of the brackets.

use std::borrow::Cow;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::convex::{self, Convex};
use super::goal::{Depth, Goal};
use super::outcome::{Bracket, Cost, Separation, Termination};
use super::support::radius;
use super::unbounded::{self, Unbounded};
use crate::geometry::tolerance::{SUPPORT_ERROR_ULPS, UNIT_ROUNDOFF};
use crate::geometry::{Aabb, Core, Mat3, Part, Placement, Shape, TriangleMesh, Vec3};

/// Something that has a place and is convex, unbounded, or a mesh: what is left when a compound is taken apart.
#[derive(Clone, Copy)]
pub(super) struct Piece<'a> {
    pub shape: &'a Shape,
    /// Swept radius of the piece and of the compound around it, metres.
    pub swept_radius: f64,
    pub at: Placement,
    /// How far a point may be from where `at` says, by the composing of the compound's pose and the part's; metres.
    pub placement_error: f64,
    /// Its place in the compound.
    pub part: u32,
}

/// The pieces of a placed shape, in order.
pub(super) fn pieces<'a>(shape: &'a Shape, at: &Placement) -> Vec<Piece<'a>> {
    let Core::Compound(compound) = shape.core() else {
        return vec![Piece { shape, swept_radius: shape.swept_radius(), at: *at, placement_error: 0.0, part: 0 }];
    };
    let piece = |(part, p): (u32, &'a Part)| {
        let inner = p.pose.placement();
        // Composing rounds no more than relating two poses does, which the error of a support value covers once.
        let reach = radius(p.shape.core()) + inner.translation.norm() + at.translation.norm();
        Piece {
            placement_error: SUPPORT_ERROR_ULPS * UNIT_ROUNDOFF * reach,
            shape: &p.shape,
            swept_radius: p.shape.swept_radius() + shape.swept_radius(),
            at: Placement { rotation: at.rotation * inner.rotation, translation: at.point(inner.translation) },
            part,
        }
    };
    (0u32..).zip(compound.parts()).map(piece).collect()
}

/// The least over all pairs of pieces, as far as the goal needs it; none for a pair of unbounded pieces.
pub(super) fn separation(a: &[Piece], b: &[Piece], goal: &Goal) -> Option<Separation> {
    let mut least = Least::new(goal);
    for pa in a {
        for pb in b {
            match deepest_possible(pa, pb) {
                // What is left out may be deeper than what was found, but no deeper than this.
                Some(depth) if least.is_settled() => least.lower = least.lower.min(-depth),
                _ => pair_of_pieces(pa, pb, &mut least),
            }
        }
    }
    least.finish()
}

fn pair_of_pieces(a: &Piece, b: &Piece, least: &mut Least) {
    match (mesh_of(a), mesh_of(b)) {
        (None, None) => least.take(simple_pair(a, b, &least.goal()), a.part, b.part),
        _ => walk(a, b, least),
    }
}

fn mesh_of<'a>(piece: &Piece<'a>) -> Option<&'a TriangleMesh> {
    if let Core::Mesh(mesh) = piece.shape.core() { Some(mesh) } else { None }
}

fn unbounded_of<'a>(piece: &'a Piece) -> Option<Unbounded<'a>> {
    let (normal, offset, thin) = match piece.shape.core() {
        Core::HalfSpace { normal, offset } => (*normal, *offset, false),
        Core::Plane { normal, offset } => (*normal, *offset, true),
        Core::Point
        | Core::Cuboid { .. }
        | Core::AxialSegment { .. }
        | Core::Cylinder { .. }
        | Core::Cone { .. }
        | Core::Ellipsoid { .. }
        | Core::Convex(_)
        | Core::Triangle(_)
        | Core::Segment(_)
        | Core::Mesh(_)
        | Core::Compound(_) => return None,
    };
    Some(Unbounded {
        normal,
        offset,
        thin,
        swept_radius: piece.swept_radius,
        at: &piece.at,
        placement_error: piece.placement_error,
    })
}

/// Two pieces that are not meshes: the only place where kinds of shapes meet. Order is swapped here, once.
pub(super) fn simple_pair(a: &Piece, b: &Piece, goal: &Goal) -> Option<Separation> {
    match (unbounded_of(a), unbounded_of(b)) {
        (Some(_), Some(_)) => None,
        (None, Some(wall)) => Some(unbounded::separation(whole(a), wall)),
        (Some(wall), None) => Some(swapped(unbounded::separation(whole(b), wall))),
        (None, None) => Some(convex::separation(whole(a), whole(b), goal)),
    }
}

fn whole<'a>(piece: &'a Piece) -> Convex<'a> {
    Convex {
        core: piece.shape.core(),
        swept_radius: piece.swept_radius,
        at: &piece.at,
        placement_error: piece.placement_error,
    }
}

/// The same answer with the sides exchanged.
fn swapped(s: Separation) -> Separation {
    Separation {
        normal: -s.normal,
        point_on_a: s.point_on_b,
        point_on_b: s.point_on_a,
        subshape_a: s.subshape_b,
        subshape_b: s.subshape_a,
        ..s
    }
}

/// The least separation seen so far.
struct Least<'a> {
    asked: &'a Goal<'a>,
    best: Option<Separation>,
    lower: f64,
    upper: f64,
    cost: Cost,
    limited: bool,
}

impl<'a> Least<'a> {
    fn new(asked: &'a Goal<'a>) -> Self {
        Self { asked, best: None, lower: f64::INFINITY, upper: f64::INFINITY, cost: Cost::default(), limited: false }
    }

    /// What the next pair is asked: nothing more, once it is proved farther than the best.
    fn goal(&self) -> Goal<'a> {
        Goal { cut_off: self.asked.cut_off.min(self.upper), ..*self.asked }
    }

    /// Whether more pairs cannot change what was asked.
    fn is_settled(&self) -> bool {
        let overlap_suffices = match self.asked.depth {
            Depth::Verdict | Depth::Distance => true,
            Depth::Penetration => false,
        };
        overlap_suffices && self.upper <= 0.0
    }

    fn take(&mut self, found: Option<Separation>, subshape_a: u32, subshape_b: u32) {
        let Some(found) = found else { return };
        self.cost += found.cost;
        self.limited |= found.termination == Termination::IterationLimit;
        self.lower = self.lower.min(found.bracket.lower);
        self.upper = self.upper.min(found.bracket.upper);
        let nearer = self.best.as_ref().is_none_or(|best| found.signed_distance < best.signed_distance);
        if nearer {
            self.best = Some(Separation { subshape_a, subshape_b, ..found });
        }
    }

    fn finish(self) -> Option<Separation> {
        let best = self.best?;
        let bracket = Bracket { lower: self.lower, upper: self.upper };
        let termination = if self.limited { Termination::IterationLimit } else { best.termination };
        let signed_distance = best.signed_distance.clamp(bracket.lower, bracket.upper);
        Some(Separation { bracket, signed_distance, termination, cost: self.cost, ..best })
    }
}

/// A pair of tree nodes to be opened, by the distance of their boxes. A piece without a tree is its own single node.
#[derive(PartialEq)]
struct Open {
    distance: f64,
    a: usize,
    b: usize,
}

impl Eq for Open {}

impl Ord for Open {
    /// Nearest first; equals by their indices.
    fn cmp(&self, other: &Self) -> Ordering {
        other.distance.total_cmp(&self.distance).then((other.a, other.b).cmp(&(self.a, self.b)))
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
    /// Bounds of the piece in its own frame when it has no tree; none when unbounded.
    bounds: Option<Aabb>,
}

impl<'a> Side<'a> {
    fn new(piece: &'a Piece<'a>) -> Self {
        Self { piece, mesh: mesh_of(piece), bounds: piece.shape.core().bounds() }
    }

    /// Bounds of a node without swept radius, in the piece's frame.
    fn bounds(&self, node: usize) -> Option<Aabb> {
        self.mesh.map_or(self.bounds, |mesh| Some(mesh.tree().nodes()[node].bounds))
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

/// No point of two bounded pieces is deeper than this in the other, metres: a translation of this length along an axis
/// of A's frame separates their bounds. None when one is unbounded.
pub(super) fn deepest_possible(a: &Piece, b: &Piece) -> Option<f64> {
    let own_frame = Placement { rotation: Mat3::identity(), translation: Vec3::zeros() };
    let box_a = a.shape.placed_bounds(&own_frame)?;
    let box_b = b.shape.placed_bounds(&Placement::relative(&a.at, &b.at))?;
    let (one_way, other_way) = (box_a.max - box_b.min, box_b.max - box_a.min);
    Some((one_way.min().min(other_way.min()) + a.swept_radius + b.swept_radius).max(0.0))
}

/// Opens pairs of nodes, nearest first, until what is left is farther than the best found.
fn walk(a: &Piece, b: &Piece, least: &mut Least) {
    let (side_a, side_b) = (Side::new(a), Side::new(b));
    let b_in_a = Placement::relative(&a.at, &b.at);
    let radii = a.swept_radius + b.swept_radius;
    let distance = |na: usize, nb: usize| node_distance(&side_a, na, &side_b, nb, &b_in_a) - radii;
    let mut open = BinaryHeap::from([Open { distance: distance(0, 0), a: 0, b: 0 }]);
    while let Some(Open { distance: nearest, a: na, b: nb }) = open.pop() {
        // An overlap of boxes says nothing about depth, so it is never far enough. One pair of items is looked at in any
        // case: its witness is the proof from above.
        if least.best.is_some() {
            if nearest > 0.0 && nearest > least.goal().cut_off {
                least.lower = least.lower.min(nearest);
                return;
            }
            let stopped = (least.asked.stop)();
            if let (true, Some(depth)) = (stopped || least.is_settled(), deepest_possible(a, b)) {
                least.lower = least.lower.min(if nearest > 0.0 { nearest } else { -depth });
                least.limited |= stopped;
                return;
            }
        }
        least.cost.nodes += 1;
        let size = |side: &Side, n: usize| side.bounds(n).map_or(f64::INFINITY, |b| b.half_area());
        match (side_a.children(na), side_b.children(nb)) {
            (None, None) => leaf_pair(&side_a, na, &side_b, nb, least),
            // The larger one is opened: its boxes say least.
            (Some(children), other) if other.is_none() || size(&side_a, na) >= size(&side_b, nb) => {
                open.extend(children.map(|c| Open { distance: distance(c, nb), a: c, b: nb }));
            }
            (_, Some(children)) => open.extend(children.map(|c| Open { distance: distance(na, c), a: na, b: c })),
            (Some(_), None) => unreachable!("covered by the second arm"),
        }
    }
}

fn leaf_pair(a: &Side, na: usize, b: &Side, nb: usize, least: &mut Least) {
    for &i in a.items(na) {
        let (shape_a, number_a) = a.item(i);
        let item_a = Piece { shape: &shape_a, part: number_a, ..*a.piece };
        for &j in b.items(nb) {
            let (shape_b, number_b) = b.item(j);
            let item_b = Piece { shape: &shape_b, part: number_b, ..*b.piece };
            let found = simple_pair(&item_a, &item_b, &least.goal());
            least.take(found, number_a, number_b);
        }
    }
}

/// A lower bound of the distance of what is in two nodes, without swept radii; zero when their boxes meet, metres.
fn node_distance(a: &Side, na: usize, b: &Side, nb: usize, b_in_a: &Placement) -> f64 {
    let (Some(box_a), Some(box_b)) = (a.bounds(na), b.bounds(nb)) else {
        return 0.0;
    };
    let center = b_in_a.point(box_b.center());
    let half = b_in_a.rotation.abs() * box_b.half_extents();
    let slack = 64.0
        * f64::EPSILON
        * (center.amax() + half.amax() + b_in_a.translation.amax() + size_of(&box_b) + size_of(&box_a));
    (box_a.distance(&Aabb::centred(center, half)) - slack).max(0.0)
}

fn size_of(b: &Aabb) -> f64 {
    b.min.abs().sup(&b.max.abs()).amax()
}
