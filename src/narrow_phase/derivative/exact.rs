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
) -> Result<Derivatives, NoDerivatives> {
    let piece_a = TouchingPiece::of(a, found.subshape_a, at_a, found.point_on_a)?;
    let piece_b = TouchingPiece::of(b, found.subshape_b, at_b, found.point_on_b)?;
    let arms = [found.point_on_a - at_a.translation, found.point_on_b - at_b.translation];
    let normal = found.normal;
    let between = normal * found.signed_distance;
    let smooth = if may_polish { polished(&piece_a, &piece_b, normal, between) } else { None };
    if let Some(at) = smooth {
        let response = Response::smooth(at.normal, at.axes, at.signed_distance, at.radii);
        let arms = [arms[0] + at.points[0], arms[1] + at.points[1] - between];
        let mut told = Derivatives { residual: at.residual, ..Derivatives::unknown(DerivativeMethod::Exact) };
        response.tell(arms, &mut told);
        return Ok(told);
    }
    if is_wall(&piece_a.core) && is_wall(&piece_b.core) {
        return Err(NoPatch::Unbounded { a: a.kind(), b: b.kind() }.into());
    }
    let (axes, tilt) = (across(normal), tilt(found.normal_error));
    let [x, y] = axes;
    let sides = [Side::of(&piece_a, [x, y, normal], tilt), Side::of(&piece_b, [x, y, -normal], tilt)];
    let response = Response::new(normal, axes, found.signed_distance, [&sides[0], &sides[1]]);
    let mut told = Derivatives { residual: found.point_error, ..Derivatives::unknown(DerivativeMethod::ExactCell) };
    response.tell(arms, &mut told);
    told.on_border = response.is_shared || sides.iter().any(|side| side.on_border);
    Ok(told)
}
