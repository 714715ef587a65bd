//! The derivatives of a pair by the implicit function theorem, with smoothed Hessians of the support functions.
//!
//! The same equations as the exact ones (`response`), where nothing of a bounded side is flat and each has a finite tensor: the smoothed one.
//! The signed distance needs no tensor: it is the least (or, negated, the greatest) of something over the normal, so to first order a turned normal
//! does not change it (the envelope theorem), and its derivatives are exact. The others are taken at the true witness points and normal, not at those
//! that smoothed shapes would have.
//!
//! In an overlap M = d I + H_A + H_B is positive on the plane only where the smoothed radii of curvature outgrow the depth. Where it is not,
//! the stationary normal is not the one of least depth any more, and the answer is marked as not valid.

use super::super::goal::Goal;
use super::super::outcome::Separation;
use super::super::patch::{NoPatch, TouchingPiece, across, is_wall};
use super::adaptive_epsilon::epsilon;
use super::counter_random::CounterRandom;
use super::derivatives::{DerivativeGoal, Derivatives, NoDerivatives};
use super::moved_pair::{Pair, core_radius, size};
use super::response::Response;
use super::smoothed_hessian::Smoothing;

/// Smoothing of order one, with the noise that the goal's method names.
pub(super) fn smoothed_supports(
    pair: Pair,
    found: &Separation,
    goal: &DerivativeGoal,
    again: &Goal,
    all: &mut Derivatives,
) -> Result<(), NoDerivatives> {
    let [(a, at_a), (b, at_b)] = pair;
    let piece_a = TouchingPiece::of(a, found.subshape_a, at_a, found.point_on_a)?;
    let piece_b = TouchingPiece::of(b, found.subshape_b, at_b, found.point_on_b)?;
    if is_wall(&piece_a.core) && is_wall(&piece_b.core) {
        return Err(NoPatch::Unbounded { a: a.kind(), b: b.kind() }.into());
    }
    let radius = |piece: &TouchingPiece| core_radius(piece).map(|core| core + piece.swept_radius);
    let size = size([radius(&piece_a), radius(&piece_b)], found.signed_distance);
    let smoothing = Smoothing {
        method: goal.method,
        epsilon: epsilon(goal, size, found.signed_distance),
        samples: goal.samples,
        random: CounterRandom::new(goal.seed, goal.stream),
        again,
    };
    let [x, y] = across(found.normal);
    let one = smoothing.side(&piece_a, [x, y, found.normal], 0, &mut all.cost)?;
    let other = smoothing.side(&piece_b, [x, y, -found.normal], 1, &mut all.cost)?;
    let response = Response::new(found.normal, [x, y], found.signed_distance, [&one.side, &other.side]);
    let arms = [found.point_on_a - at_a.translation, found.point_on_b - at_b.translation];
    response.tell(arms, all);
    all.residual = one.error + other.error;
    all.epsilon = smoothing.epsilon;
    if one.is_sampled || other.is_sampled {
        (all.samples, all.seed) = (goal.samples, goal.seed);
    }
    all.is_valid &= all.are_finite();
    Ok(())
}
