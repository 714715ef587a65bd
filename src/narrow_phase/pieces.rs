//! Placed shapes taken apart into pieces that are convex, unbounded or a mesh, and what their boxes alone say of a pair.

use super::convex::{self, Convex};
use super::given::Given;
use super::goal::Goal;
use super::outcome::Separation;
use super::support::radius;
use super::unbounded::{self, Unbounded};
use crate::geometry::tolerance::{SUPPORT_ERROR_ULPS, UNIT_ROUNDOFF};
use crate::geometry::{Aabb, Core, Placement, Shape, TriangleMesh, length};

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
    /// What `at` and the radius were rounded from.
    pub given: Given<'a>,
}

/// The pieces of a placed shape, in order.
pub(super) struct Pieces<'a> {
    shape: &'a Shape,
    at: Placement,
    /// What `at` was computed from.
    given: &'a Placement,
    /// Whether the poses of one of the two shapes' parts are composed with its own, which rounds in the placement of both.
    composed: bool,
}

impl<'a> Pieces<'a> {
    pub fn new(shape: &'a Shape, at: Placement, given: &'a Placement, composed: bool) -> Self {
        Self { shape, at, given, composed }
    }

    /// The only piece of a shape that is no compound.
    pub fn alone(shape: &'a Shape, at: Placement, given: &'a Placement) -> Piece<'a> {
        Self::new(shape, at, given, false).piece(0)
    }

    pub fn len(&self) -> usize {
        if let Core::Compound(compound) = self.shape.core() { compound.parts().len() } else { 1 }
    }

    pub fn iter(&self) -> impl Iterator<Item = Piece<'a>> {
        (0..self.len()).map(|index| self.piece(index))
    }

    fn piece(&self, index: usize) -> Piece<'a> {
        let (shape, at) = (self.shape, &self.at);
        // Composing rounds no more than relating two poses does, which the error of a support value covers once.
        let error = |reach: f64| if self.composed { SUPPORT_ERROR_ULPS * UNIT_ROUNDOFF * reach } else { 0.0 };
        let Core::Compound(compound) = shape.core() else {
            let reach = radius(shape.core()) + length(at.translation);
            let (swept_radius, placement_error) = (shape.swept_radius(), error(reach));
            let given = Given::alone(shape, self.given);
            return Piece { shape, swept_radius, at: *at, placement_error, part: 0, given };
        };
        let part = &compound.parts()[index];
        let inner = part.pose.placement();
        Piece {
            shape: &part.shape,
            swept_radius: part.shape.swept_radius() + shape.swept_radius(),
            at: Placement::computed(at.rotation * inner.rotation, at.point(inner.translation)),
            placement_error: error(radius(part.shape.core()) + length(inner.translation) + length(at.translation)),
            part: index as u32,
            given: Given { at: self.given, whole: shape, part: Some(part) },
        }
    }
}

pub(super) fn mesh_of<'a>(piece: &Piece<'a>) -> Option<&'a TriangleMesh> {
    if let Core::Mesh(mesh) = piece.shape.core() { Some(mesh) } else { None }
}

pub(super) fn unbounded_of<'a>(piece: &'a Piece) -> Option<Unbounded<'a>> {
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
        | Core::Compound(_)
        | Core::HeightField(_)
        | Core::PointCloud(_)
        | Core::Voxels(_)
        | Core::Column(_)
        | Core::Block(_) => return None,
    };
    Some(Unbounded {
        normal,
        offset,
        thin,
        swept_radius: piece.swept_radius,
        at: &piece.at,
        placement_error: piece.placement_error,
        given: piece.given,
    })
}

/// Two pieces that are not meshes: the only place where kinds of shapes meet. Order is swapped here, once.
pub(super) fn simple_pair(a: &Piece, b: &Piece, goal: &Goal) -> Option<Separation> {
    match (unbounded_of(a), unbounded_of(b)) {
        (Some(_), Some(_)) => None,
        (None, Some(wall)) => Some(unbounded::separation(whole(a), wall, goal)),
        (Some(wall), None) => Some(swapped(unbounded::separation(whole(b), wall, goal))),
        (None, None) => Some(convex::separation(whole(a), whole(b), goal)),
    }
}

fn whole<'a>(piece: &'a Piece) -> Convex<'a> {
    Convex {
        core: piece.shape.core(),
        swept_radius: piece.swept_radius,
        at: &piece.at,
        placement_error: piece.placement_error,
        given: piece.given,
    }
}

/// The same answer with the sides exchanged.
pub(super) fn swapped(s: Separation) -> Separation {
    Separation {
        normal: -s.normal,
        point_on_a: s.point_on_b,
        point_on_b: s.point_on_a,
        subshape_a: s.subshape_b,
        subshape_b: s.subshape_a,
        ..s
    }
}

/// A lower bound of the signed distance of two pieces, by their boxes; metres.
pub(super) fn least_of_pieces(a: &Piece, b: &Piece) -> f64 {
    least_of_boxes(a, a.shape.core().bounds(), b, b.shape.core().bounds(), &Placement::relative(&a.at, &b.at))
}

/// A lower bound of the signed distance of what is in two boxes, swept radii included; metres. The boxes are in the pieces'
/// own frames and around parts of their cores; an unbounded piece has none. Boxes that meet cannot be deeper in one another
/// than the translation along an axis that parts them; against a wall it is the lowest corner that counts.
pub(super) fn least_of_boxes(
    a: &Piece,
    box_a: Option<Aabb>,
    b: &Piece,
    box_b: Option<Aabb>,
    b_in_a: &Placement,
) -> f64 {
    let radii = a.swept_radius + b.swept_radius;
    let errors = a.placement_error + b.placement_error;
    let (least, size) = match (box_a, box_b) {
        (Some(box_a), Some(box_b)) => {
            let half = b_in_a.rotation.abs() * box_b.half_extents();
            let in_a = Aabb::centred(b_in_a.point(box_b.center()), half);
            let freeing = (box_a.max - in_a.min).min().min((in_a.max - box_a.min).min());
            let least = if freeing < 0.0 { box_a.distance(&in_a) } else { -freeing };
            (least, size_of(&box_a) + size_of(&box_b) + size_of(&in_a))
        }
        (Some(bounds), None) => box_and_wall(&bounds, a, b),
        (None, Some(bounds)) => box_and_wall(&bounds, b, a),
        (None, None) => return f64::NEG_INFINITY,
    };
    // Some 20 roundings of lengths up to the size, and the error of the matrix.
    let slack = SUPPORT_ERROR_ULPS * UNIT_ROUNDOFF * (size + radii + length(b_in_a.translation)) + errors;
    least - slack - radii
}

/// The bound, and the size of the numbers in it, for a box in a piece's frame against an unbounded piece.
fn box_and_wall(bounds: &Aabb, piece: &Piece, wall: &Piece) -> (f64, f64) {
    let wall_in_piece = Placement::relative(&piece.at, &wall.at);
    let Some(wall) = unbounded_of(wall) else { return (f64::NEG_INFINITY, 0.0) };
    let (normal, offset) = wall.upright();
    let up = wall_in_piece.direction(normal);
    let height = up.dot(&(bounds.center() - wall_in_piece.translation)) - offset;
    let half = up.abs().dot(&bounds.half_extents());
    let (low, high) = (height - half, height + half);
    let size = size_of(bounds) + length(wall_in_piece.translation) + offset.abs();
    // A plane has two sides: of what sticks through it the lesser part counts.
    (if wall.thin { low.max(-high) } else { low }, size)
}

fn size_of(b: &Aabb) -> f64 {
    length(b.min.abs().sup(&b.max.abs()))
}
