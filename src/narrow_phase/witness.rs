//! How far the witness points and the normal may be from the truth; derived in `docs/derivations/bracket.md`.

use super::convex::Convex;
use super::epa::Epa;
use super::support::radius;
use crate::geometry::length;
use crate::geometry::tolerance::{SUPPORT_ERROR_ULPS, UNIT_ROUNDOFF};

/// Roundings of a witness point after the cores are done with, in units of the radii and of how far A is from the origin: two
/// products with the normal and two sums, and the turn of the normal into the frame of both.
pub(super) const WITNESS_ERROR_ULPS: f64 = 64.0;

/// By how much the direction that proved `lower` may be turned from the nearest vector x* of the cores, radians.
///
/// `n . x* >= L` for the direction n, and `|x*| <= U`, so the cosine of the angle is at least L / U: it is below a right
/// angle, and below its own tangent. `from_nearest`: what [`from_nearest`] gives.
#[inline]
pub(super) fn normal_error(lower: f64, from_nearest: f64) -> f64 {
    // Comparison order matters: bounds that are not there yet are infinite, or their difference not a number.
    if !(lower > 0.0 && from_nearest.is_finite()) {
        return std::f64::consts::PI;
    }
    // The direction itself, and its turn into the frame of both placements, is off by some 40 roundings.
    (from_nearest / lower).min(std::f64::consts::FRAC_PI_2) + WITNESS_ERROR_ULPS * f64::EPSILON
}

/// How far at most a witness point is from its core, metres; apart also how far the vector between them is from x*.
///
/// The points are `on_a` and `on_a - distance * direction`, `distance` being that of the cores as reported: the second is off its
/// core by what that vector is short of w, the point of the difference. And w is no farther from x* than the root of `U^2 - L^2`.
#[inline]
pub(super) fn point_error(found: &Epa, distance: f64, from_nearest: f64, error: f64) -> f64 {
    let short = (found.nearest.w - found.direction * distance).norm();
    short + from_nearest + 2.0 * error
}

/// How far a witness point of a higher precision may be off by its way back into doubles, metres: found in the frame of A's core
/// it is rounded, turned, shifted, and moved along the normal by the radius and the distance.
pub(super) fn rounding_of_points(a: &Convex, b: &Convex, signed_distance: f64) -> f64 {
    let extent = radius(a.core) + radius(b.core) + length(b.at.translation - a.at.translation);
    let lengths = a.swept_radius + b.swept_radius + length(a.at.translation) + signed_distance.abs();
    UNIT_ROUNDOFF * (SUPPORT_ERROR_ULPS * extent + WITNESS_ERROR_ULPS * lengths)
}

/// How far a point of the difference no farther than `upper` may be from x*, when the cores are proved apart.
#[inline]
pub(super) fn from_nearest(lower: f64, upper: f64) -> f64 {
    if lower > 0.0 { gap(lower, upper) } else { 0.0 }
}

/// The root of `U^2 - L^2`, as a product that does not cancel. One root, so that powers of two scale it without rounding;
/// bounds of scaled cores are far from where the product would under- or overflow.
#[inline]
fn gap(lower: f64, upper: f64) -> f64 {
    ((upper - lower).max(0.0) * (upper + lower)).sqrt()
}
