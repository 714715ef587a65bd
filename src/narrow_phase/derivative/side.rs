//! How does the support point of a shape move when the direction turns?
//!
//! Seen along the normal, in the plane across it. The Hessian of the support function there is the tensor of the radii of curvature:
//! zero at a corner, `r` on a ball, infinite along an edge or on a face, where the direction cannot turn at all without
//! leaving the feature, and the witness may slide. So a side is what is flat about it and a finite tensor across that.

use arrayvec::ArrayVec;

use super::super::patch::{Face, PatchCost, TouchingPiece, View, face, is_wall};
use super::derivatives::DerivativeCost;
use crate::geometry::tolerance::UNIT_ROUNDOFF;
use crate::geometry::{Core, Vec3, length};

/// In the plane across a normal.
pub(super) type Vec2 = nalgebra::Vector2<f64>;

/// A tensor there.
pub(super) type Mat2 = nalgebra::Matrix2<f64>;

/// Directions that are turned by less than this are one; radians. An edge that is this near to level is an edge between two cells whichever
/// way it is looked at, and normals of overlaps are about so exact.
const TILT: f64 = 1e-7;

/// However little is known of a normal.
const WIDEST_TILT: f64 = 1e-5;

/// How far a normal may be turned from that of a feature which holds it.
pub(super) fn tilt(normal_error: f64) -> f64 {
    if normal_error < 1.0 { TILT.max(4.0 * normal_error).min(WIDEST_TILT) } else { TILT }
}

/// Roundings of the largest length of a side within which corners are as high as one another.
const SLACK_ULPS: f64 = 64.0;

/// A witness that is nearer to the end of its edge or face than this part of it is on the border of two cells.
const BORDER: f64 = 1e-7;

/// One side of a pair, in the plane across the normal.
pub(super) struct Side {
    /// Unit vectors along which the witness may slide: none, one, or two that span the plane.
    pub flat: ArrayVec<Vec2, 2>,
    /// The radii of curvature, metres; across what is flat.
    pub radii: Mat2,
    /// Whether the witness is where two features meet, so that a move may lead to either.
    pub on_border: bool,
}

impl Side {
    /// `axes`: x and y of the plane and the direction towards the other shape, in the axes of both placements. The piece is placed
    /// from its own witness point; `tilt`: how far the normal may be off.
    pub fn of(piece: &TouchingPiece, axes: [Vec3; 3], tilt: f64, cost: &mut DerivativeCost) -> Self {
        let swept = Mat2::identity() * piece.swept_radius;
        if is_wall(&piece.core) {
            return Self { flat: whole_plane(), radii: Mat2::zeros(), on_border: false };
        }
        let in_core = axes.map(|axis| piece.rotation.tr_mul(&axis));
        // From the core's origin to the witness on the core itself, in its axes.
        let at = piece.rotation.tr_mul(&(-piece.position - axes[2] * piece.swept_radius));
        if let Core::Ellipsoid { radii } = *piece.core
            && radii.min() > 0.0
        {
            let radii = ellipsoid(radii, in_core) + swept;
            return Self { flat: ArrayVec::new(), radii, on_border: false };
        }
        if matches!(*piece.core, Core::Point) {
            return Self { flat: ArrayVec::new(), radii: swept, on_border: false };
        }
        let extent = length(piece.position) + piece.swept_radius;
        let slack = SLACK_ULPS * UNIT_ROUNDOFF * extent;
        let view = View::new(&piece.rotation, piece.position, axes, piece.swept_radius, 1.0).within(tilt, slack);
        let mut looked_at = PatchCost::default();
        let face = face(&piece.core, &view, &mut looked_at);
        cost.corners += looked_at.corners;
        let flat = flat_of(&face, slack);
        let round = round(&piece.core, in_core, at, flat.len());
        let radii = without(round + swept, &flat);
        let on_border = !face.complete || is_at_end(&face, flat.len(), slack);
        Self { flat, radii, on_border }
    }
}

fn whole_plane() -> ArrayVec<Vec2, 2> {
    [Vec2::x(), Vec2::y()].into_iter().collect()
}

/// Along what the face extends. The witness is at the origin of the plane.
fn flat_of(face: &Face, slack: f64) -> ArrayVec<Vec2, 2> {
    let corner = |i: usize| Vec2::new(face.outline[i].at.x, face.outline[i].at.y);
    match face.outline.len() {
        0 | 1 => ArrayVec::new(),
        2 => {
            let along = corner(1) - corner(0);
            let far = along.norm();
            (far > slack).then(|| along / far).into_iter().collect()
        }
        _ => whole_plane(),
    }
}

/// Whether the witness is at the end of an edge or on the outline of a face.
fn is_at_end(face: &Face, dimensions: usize, slack: f64) -> bool {
    let outline = &face.outline;
    let corner = |i: usize| Vec2::new(outline[i % outline.len()].at.x, outline[i % outline.len()].at.y);
    match dimensions {
        0 => false,
        1 => {
            let (one, other) = (corner(0).norm(), corner(1).norm());
            one.min(other) <= BORDER * (one + other) + slack
        }
        _ => (0..outline.len()).any(|i| {
            let (from, side) = (corner(i), corner(i + 1) - corner(i));
            // The witness is the origin: how far it is to the left of the side.
            let inside = side.x * -from.y + side.y * from.x;
            inside <= (BORDER * side.norm() + slack) * side.norm()
        }),
    }
}

/// The tensor across what is flat: nothing along it.
fn without(radii: Mat2, flat: &[Vec2]) -> Mat2 {
    match flat {
        [] => radii,
        [along] => {
            let across = Vec2::new(-along.y, along.x);
            across * across.transpose() * (across.dot(&(radii * across)))
        }
        _ => Mat2::zeros(),
    }
}

/// With `A = diag(radii)` the support function is `h(d) = |A d|`, its point `p = A^2 d / h`, its Hessian `(A^2 - p p^T) / h`.
fn ellipsoid(radii: Vec3, [x, y, up]: [Vec3; 3]) -> Mat2 {
    let scaled = |v: Vec3| radii.component_mul(&v);
    let (ax, ay, au) = (scaled(x), scaled(y), scaled(up));
    let h = au.norm();
    let (px, py) = (au.dot(&ax) / h, au.dot(&ay) / h);
    let mixed = (ax.dot(&ay) - px * py) / h;
    Mat2::new((ax.dot(&ax) - px * px) / h, mixed, mixed, (ay.dot(&ay) - py * py) / h)
}

/// Of a cylinder or a cone where it is round; zero for everything with corners. `dimensions` of what is flat about it.
fn round(core: &Core, [x, y, up]: [Vec3; 3], at: Vec3, dimensions: usize) -> Mat2 {
    let across = libm::hypot(up.x, up.y);
    if dimensions == 2 || across == 0.0 {
        return Mat2::zeros();
    }
    // Along the rim, and how far the point is from the axis.
    let around = Vec3::new(-up.y, up.x, 0.0) / across;
    let from_axis = libm::hypot(at.x, at.y);
    let radius = match core {
        // The rim is the disc's, whose support function is the radius times what of the direction is across the axis; on the side
        // of a cylinder that is all of it.
        Core::Cylinder { radius, .. } => radius / across,
        // On the side of a cone a ruling is flat, and the circle around the axis through the witness tells the other radius (Meusnier).
        Core::Cone { .. } if dimensions == 1 => from_axis / across,
        // The apex is a corner.
        Core::Cone { radius, half_length } if at.z < *half_length * (1.0 - 1e-12) => radius / across,
        Core::Cone { .. }
        | Core::Ellipsoid { .. }
        | Core::Point
        | Core::Cuboid { .. }
        | Core::AxialSegment { .. }
        | Core::Convex(_)
        | Core::Triangle(_)
        | Core::Segment(_)
        | Core::HalfSpace { .. }
        | Core::Plane { .. }
        | Core::Mesh(_)
        | Core::Compound(_)
        | Core::HeightField(_)
        | Core::PointCloud(_)
        | Core::Voxels(_)
        | Core::Column(_)
        | Core::Block(_) => 0.0,
    };
    let along = Vec2::new(around.dot(&x), around.dot(&y));
    along * along.transpose() * radius
}
