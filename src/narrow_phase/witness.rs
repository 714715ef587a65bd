//! How far the witness points and the normal may be from the truth; derived in `docs/derivations/bracket.md`.

use super::epa::Epa;

/// Roundings of a witness point after the cores are done with, in units of the radii and of how far A is from the origin: two
/// products with the normal and two sums, and the turn of the normal into the frame of both.
pub(super) const WITNESS_ERROR_ULPS: f64 = 64.0;

/// By how much the direction that proved `lower` may be turned from the nearest vector x* of the cores, radians.
///
/// `n . x* >= L` for the direction n, and `|x*| <= U`, so the cosine of the angle is at least L / U: it is below a right
/// angle, and below its own tangent.
pub(super) fn normal_error(lower: f64, upper: f64) -> f64 {
    // Comparison order matters: bounds that are not there yet are infinite, or their difference not a number.
    if !(lower > 0.0 && upper.is_finite()) {
        return std::f64::consts::PI;
    }
    // The direction itself, and its turn into the frame of both placements, is off by some 40 roundings.
    (gap(lower, upper) / lower).min(std::f64::consts::FRAC_PI_2) + WITNESS_ERROR_ULPS * f64::EPSILON
}

/// How far at most a witness point is from its core, metres; apart also how far the vector between them is from x*.
///
/// The points are `on_a` and `on_a - distance * direction`, `distance` being that of the cores as reported: the second is off its
/// core by what that vector is short of w, the point of the difference. And w is no farther from x* than the root of `U^2 - L^2`.
pub(super) fn point_error(found: &Epa, distance: f64, error: f64) -> f64 {
    let short = (found.nearest.w - found.direction * distance).norm();
    short + from_nearest(found.lower, found.upper) + 2.0 * error
}

/// How far a point of the difference no farther than `upper` may be from x*, when the cores are proved apart.
pub(super) fn from_nearest(lower: f64, upper: f64) -> f64 {
    if lower > 0.0 { gap(lower, upper) } else { 0.0 }
}

/// The root of `U^2 - L^2`, as a product that does not cancel. One root, so that powers of two scale it without rounding;
/// bounds of scaled cores are far from where the product would under- or overflow.
#[inline]
pub(super) fn gap(lower: f64, upper: f64) -> f64 {
    ((upper - lower).max(0.0) * (upper + lower)).sqrt()
}
