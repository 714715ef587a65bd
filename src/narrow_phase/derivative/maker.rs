//! Derivatives of a pair, by the method that was asked for.

use super::super::goal::Goal;
use super::super::outcome::Separation;
use super::derivatives::{DerivativeGoal, DerivativeMethod, Derivatives, NoDerivatives};
use super::differences::differences;
use super::exact::exact;
use super::runner_up::is_contested;
use super::smoothed_places::smoothed_places;
use super::smoothed_supports::smoothed_supports;
use crate::geometry::{Placement, Shape};

/// The derivatives of what `found` says of two shapes in these places.
///
/// `found` has to be what [`separation`](crate::narrow_phase::separation) says of them, asked for a distance or, in an overlap, a
/// penetration. Of shapes of several pieces the exact methods and those of order one are about the two pieces that it names; differences and order
/// zero are about the whole shapes. `again` is how separations in moved places are asked, and when to stop.
///
/// # Errors
/// [`NoDerivatives`].
pub fn derivatives(
    a: &Shape,
    b: &Shape,
    at_a: &Placement,
    at_b: &Placement,
    found: &Separation,
    goal: &DerivativeGoal,
    again: &Goal,
) -> Result<Derivatives, NoDerivatives> {
    goal.check()?;
    let pair = [(a, at_a), (b, at_b)];
    // Filled where it is: a thousand bytes are not handed from one to the other.
    let mut told = Derivatives::unknown(goal.method);
    match goal.method {
        DerivativeMethod::Exact => exact(pair, found, true, &mut told),
        DerivativeMethod::ExactCell => exact(pair, found, false, &mut told),
        DerivativeMethod::FiniteDifference => differences(pair, found, again, &mut told),
        DerivativeMethod::Smoothed0 => smoothed_places(pair, found, goal, again, &mut told),
        DerivativeMethod::Smoothed1Gaussian | DerivativeMethod::Smoothed1Gumbel => {
            smoothed_supports(pair, found, goal, again, &mut told)
        }
    }?;
    told.is_contested = is_contested(pair, found, again, &mut told.cost)?;
    Ok(told)
}
