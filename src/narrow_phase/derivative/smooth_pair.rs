//! Two smooth, strictly convex pieces: their normal made as exact as rounding lets it be, and their radii of curvature there.
//!
//! The normal is right where the vector between both support points, y(n) = x2(-n) - x1(n), is along it. Across n its change is -(RA + RB) dn,
//! and with d = n . y Newton's step is dn = M^-1 P y, M = d I + RA + RB, the same M that tells the derivatives: where it is positive the steps
//! converge quadratically, to the same stationary point that the separation was near, apart and in an overlap.

use super::super::patch::TouchingPiece;
use super::super::smooth::tangents;
use super::response::inverted;
use super::side::{Mat2, Vec2};
use crate::geometry::tolerance::UNIT_ROUNDOFF;
use crate::geometry::{Core, Vec3};

/// Steps at most: what a separation leaves is small, and digits double.
const MAX_STEPS: usize = 8;

/// Tensors serve until the normal has turned by more than this, radians: their own error is in proportion.
const STALE: f64 = 1e-9;

/// A step that turns the normal by more than this leaves what the separation found; radians.
const LARGEST_STEP: f64 = 0.3;

/// What is told of a normal.
pub(super) struct Polished {
    pub normal: Vec3,
    /// Two axes across it.
    pub axes: [Vec3; 2],
    /// From the separation's witness on A.
    pub points: [Vec3; 2],
    pub signed_distance: f64,
    /// How far from the normal's line the vector between both points ends; metres.
    pub residual: f64,
    /// Radii of curvature of both, in the plane of the axes.
    pub radii: [Mat2; 2],
}

/// A ball or an ellipsoid, grown by a ball.
struct Smooth<'a> {
    /// Zero of a point.
    radii: Vec3,
    piece: &'a TouchingPiece<'a>,
}

/// A support point, and what its tensor is made of.
#[derive(Clone, Copy)]
struct Supported {
    /// From the piece's witness.
    at: Vec3,
    /// Height of the core over its origin, and its point there; the core's axes.
    height: f64,
    on_core: Vec3,
}

impl<'a> Smooth<'a> {
    fn of(piece: &'a TouchingPiece<'a>) -> Option<Self> {
        match *piece.core {
            Core::Point if piece.is_placed => Some(Self { radii: Vec3::zeros(), piece }),
            Core::Ellipsoid { radii } if radii.min() > 0.0 => Some(Self { radii, piece }),
            Core::Point
            | Core::Ellipsoid { .. }
            | Core::Cuboid { .. }
            | Core::AxialSegment { .. }
            | Core::Cylinder { .. }
            | Core::Cone { .. }
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
            | Core::Block(_) => None,
        }
    }

    /// With A = diag(radii) the support function is h(d) = |A d|, and its point A^2 d / h.
    #[inline]
    fn support(&self, outward: Vec3) -> Supported {
        let piece = self.piece;
        let scaled = self.radii.component_mul(&piece.rotation.tr_mul(&outward));
        let height = scaled.norm();
        let on_core = if height > 0.0 { self.radii.component_mul(&scaled) / height } else { Vec3::zeros() };
        let at = piece.position + piece.rotation * on_core + outward * piece.swept_radius;
        Supported { at, height, on_core }
    }

    /// No change of the tensor is larger than twice this times the turn of the direction: the third derivative of |A d| along tangents u of length
    /// one is -3 (p . u) (u . H u) / h, with |p| and h between the least and the greatest radius and H up to the greatest's square by h.
    #[inline]
    fn bend_of_tensor(&self) -> f64 {
        let (least, greatest) = (self.radii.min(), self.radii.max());
        if least > 0.0 { 1.5 * greatest * greatest * greatest / (least * least) } else { 0.0 }
    }

    /// Its Hessian there, (A^2 - p p^T) / h, and the swept radius, for two axes across the direction.
    #[inline]
    fn tensor(&self, there: &Supported, axes: [Vec3; 2]) -> Mat2 {
        let swept = self.piece.swept_radius;
        if there.height == 0.0 {
            return Mat2::new(swept, 0.0, 0.0, swept);
        }
        let rotation = &self.piece.rotation;
        let (x, y) = (rotation.tr_mul(&axes[0]), rotation.tr_mul(&axes[1]));
        let (ax, ay) = (self.radii.component_mul(&x), self.radii.component_mul(&y));
        let (px, py) = (there.on_core.dot(&x), there.on_core.dot(&y));
        let share = 1.0 / there.height;
        let mixed = (ax.dot(&ay) - px * py) * share;
        Mat2::new((ax.dot(&ax) - px * px) * share + swept, mixed, mixed, (ay.dot(&ay) - py * py) * share + swept)
    }
}

/// A normal that is tried.
#[derive(Clone, Copy)]
struct Tried {
    normal: Vec3,
    supports: [Supported; 2],
    signed_distance: f64,
    off: Vec3,
    residual: f64,
}

impl Tried {
    /// Goes on by a step so small that nothing but what is of first order counts.
    fn follow(&mut self, turn: Vec3, bent: [Vec2; 2], axes: [Vec3; 2], residual: f64) {
        self.normal = (self.normal + turn).normalize();
        self.supports[0].at += axes[0] * bent[0].x + axes[1] * bent[0].y;
        self.supports[1].at -= axes[0] * bent[1].x + axes[1] * bent[1].y;
        self.residual = residual;
    }
}

/// What of a unit vector is across another one that is nearly perpendicular to it; as long, to second order.
#[inline]
fn across(axis: Vec3, normal: Vec3) -> Vec3 {
    axis - normal * normal.dot(&axis)
}

/// From the normal of a separation, and its vector from the witness on A to that on B. None where a piece is not smooth, or where steps lead
/// away.
pub(super) fn polished(a: &TouchingPiece, b: &TouchingPiece, normal: Vec3, between: Vec3) -> Option<Polished> {
    let pair = [Smooth::of(a)?, Smooth::of(b)?];
    let at = |normal: Vec3| {
        let supports = [pair[0].support(normal), pair[1].support(-normal)];
        let between = between + supports[1].at - supports[0].at;
        let signed_distance = normal.dot(&between);
        let off = between - normal * signed_distance;
        Tried { normal, supports, signed_distance, off, residual: off.norm() }
    };
    let bent = |tried: &Tried| {
        let axes = tangents(tried.normal);
        (axes, [pair[0].tensor(&tried.supports[0], axes), pair[1].tensor(&tried.supports[1], axes)])
    };
    let size = a.position.norm() + a.swept_radius + b.position.norm() + b.swept_radius;
    let rounding = 2.0 * UNIT_ROUNDOFF * size;
    let mut best = at(normal);
    let (mut axes, mut radii) = bent(&best);
    let mut turned = 0.0;
    for _ in 0..MAX_STEPS {
        if best.residual <= rounding {
            break;
        }
        if turned > STALE {
            ((axes, radii), turned) = (bent(&best), 0.0);
        }
        let bend = Mat2::identity() * best.signed_distance + radii[0] + radii[1];
        let step = inverted(&bend) * Vec2::new(axes[0].dot(&best.off), axes[1].dot(&best.off));
        let length = step.norm();
        if length > LARGEST_STEP {
            return None;
        }
        let turn = axes[0] * step.x + axes[1] * step.y;
        // What such a step leaves is of the second order. Where that is below rounding, the points may follow the tensors, too.
        let left = length * length * (pair[0].bend_of_tensor() + pair[1].bend_of_tensor() + best.signed_distance.abs());
        if left <= rounding {
            best.follow(turn, [radii[0] * step, radii[1] * step], axes, left + rounding);
            turned += length;
            break;
        }
        let next = at((best.normal + turn).normalize());
        if next.residual >= best.residual {
            break;
        }
        turned += length;
        best = next;
    }
    if turned > STALE {
        (axes, radii) = bent(&best);
    } else if turned > 0.0 {
        // They have to be across the very normal; tensors in them are off by no more than it has turned.
        axes = [across(axes[0], best.normal), across(axes[1], best.normal)];
    }
    let points = [best.supports[0].at, between + best.supports[1].at];
    let Tried { normal, signed_distance, residual, .. } = best;
    Some(Polished { normal, axes, points, signed_distance, residual, radii })
}
