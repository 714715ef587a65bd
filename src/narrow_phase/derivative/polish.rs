//! Newton's method on the normal of two smooth, strictly convex shapes, apart or in an overlap.
//!
//! The normal is right where the vector between both support points, y(n) = x2(-n) - x1(n), is along it. Across n its change is -(RA + RB) dn,
//! and with d = n . y the step is dn = M^-1 P y, M = d I + RA + RB, the same M that tells the derivatives: where it is positive the steps
//! converge quadratically, to the same stationary point that the separation was near.

use super::super::patch::{TouchingPiece, across};
use super::super::support::support;
use super::side::{Mat2, Vec2};
use crate::geometry::Vec3;
use crate::geometry::tolerance::UNIT_ROUNDOFF;

/// Steps at most: what a separation leaves is small, and digits double.
const MAX_STEPS: usize = 8;

/// A step that turns the normal by more than this leaves what the separation found; radians.
const LARGEST_STEP: f64 = 0.3;

/// A normal with its points, relative to the witness on A.
#[derive(Clone, Copy, Debug)]
pub(super) struct Polished {
    pub normal: Vec3,
    pub points: [Vec3; 2],
    pub signed_distance: f64,
    /// How far from the normal's line the vector between both points ends; metres.
    pub residual: f64,
}

/// From what a separation found; none where steps lead away. `radii` gives the sum of both tensors for a normal, in the axes [`across`] it.
pub(super) fn polish(
    a: &TouchingPiece,
    b: &TouchingPiece,
    given: &Polished,
    radii: impl Fn(Vec3) -> Mat2,
) -> Option<Polished> {
    let at = |normal: Vec3| {
        // Each piece is placed from its own witness.
        let points = [given.points[0] + point(a, normal), given.points[1] + point(b, -normal)];
        let between = points[1] - points[0];
        let signed_distance = normal.dot(&between);
        let off = between - normal * signed_distance;
        (Polished { normal, points, signed_distance, residual: off.norm() }, off)
    };
    let (mut best, mut off) = at(given.normal);
    let size = [a, b].map(|piece| piece.position.norm() + piece.swept_radius).iter().sum::<f64>();
    for _ in 0..MAX_STEPS {
        if best.residual <= 2.0 * UNIT_ROUNDOFF * size {
            break;
        }
        let [x, y] = across(best.normal);
        let bend = Mat2::identity() * best.signed_distance + radii(best.normal);
        let step = bend.try_inverse()? * Vec2::new(x.dot(&off), y.dot(&off));
        let turn = x * step.x + y * step.y;
        if turn.norm() > LARGEST_STEP {
            return None;
        }
        let (next, next_off) = at((best.normal + turn).normalize());
        if next.residual >= best.residual {
            break;
        }
        (best, off) = (next, next_off);
    }
    Some(best)
}

/// The support point in a direction, swept radius included, from the piece's witness.
fn point(piece: &TouchingPiece, direction: Vec3) -> Vec3 {
    let on_core = support(&piece.core, piece.rotation.tr_mul(&direction));
    piece.position + piece.rotation * on_core + direction * piece.swept_radius
}
