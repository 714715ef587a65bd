//! The derivatives of a pair where they exist, from the features that face one another.

use super::super::outcome::Separation;
use super::super::patch::{NoPatch, TouchingPiece, across, is_wall};
use super::derivatives::{DerivativeMethod, Derivatives, NoDerivatives};
use super::response::Response;
use super::side::{Side, tilt};
use super::smooth_pair::polished;
use crate::geometry::{Placement, Shape};

/// By formula: of smooth pairs, if `may_polish`, at a normal that is made more exact first; else from the features that face each other.
pub(super) fn exact(
    [(a, at_a), (b, at_b)]: [(&Shape, &Placement); 2],
    found: &Separation,
    may_polish: bool,
    told: &mut Derivatives,
) -> Result<(), NoDerivatives> {
    let piece_a = TouchingPiece::of(a, found.subshape_a, at_a, found.point_on_a)?;
    let piece_b = TouchingPiece::of(b, found.subshape_b, at_b, found.point_on_b)?;
    let arms = [found.point_on_a - at_a.translation, found.point_on_b - at_b.translation];
    let normal = found.normal;
    let between = normal * found.signed_distance;
    let smooth = if may_polish { polished(&piece_a, &piece_b, normal, between) } else { None };
    if let Some(at) = smooth {
        let response = Response::smooth(at.normal, at.axes, at.signed_distance, at.radii);
        let arms = [arms[0] + at.points[0], arms[1] + at.points[1] - between];
        response.tell(arms, told);
        told.residual = at.residual;
        return Ok(());
    }
    if is_wall(&piece_a.core) && is_wall(&piece_b.core) {
        return Err(NoPatch::Unbounded { a: a.kind(), b: b.kind() }.into());
    }
    let (axes, tilt) = (across(normal), tilt(found.normal_error));
    let [x, y] = axes;
    let mut side = |piece: &TouchingPiece, up| Side::of(piece, [x, y, up], tilt, &mut told.cost);
    let sides = [side(&piece_a, normal), side(&piece_b, -normal)];
    let response = Response::new(normal, axes, found.signed_distance, [&sides[0], &sides[1]]);
    response.tell(arms, told);
    (told.method, told.residual) = (DerivativeMethod::ExactCell, found.point_error);
    told.on_border = response.is_shared || sides[0].on_border || sides[1].on_border;
    Ok(())
}
