//! What happens to a pair that doubles leave open: the next rungs of the precision ladder.
//!
//! Nearly every bracket decides what was asked of it, and pays one comparison here. One that straddles contact or the margin
//! is worked out again in double-doubles, and where those straddle it too and both cores are polytopes, in exact
//! arithmetic. What is far wider than doubles have to leave it is first looked at as bodies of revolution.

use super::convex::Convex;
use super::goal::{Depth, Goal};
use super::outcome::{Bracket, Separation, Termination};
use super::solver::Solver;
use super::support::radius;
use super::unbounded::{Height, Unbounded};
use super::{double_double, exact, revolution};
use crate::geometry::tolerance::{PROVED, SUPPORT_ERROR_ULPS, UNIT_ROUNDOFF};

/// Whether the question is open, the bracket too wide, or the exact answer asked for by name.
#[inline]
pub(super) fn needs_more(a: &Convex, b: &Convex, goal: &Goal, bracket: &Bracket, termination: Termination) -> bool {
    PROVED
        && (is_open(goal, bracket, termination)
            || is_wide(a, b, goal, bracket, termination)
            || goal.solver == Solver::Exact)
}

/// Whether a verdict is missing that more digits could give.
#[inline]
fn is_open(goal: &Goal, bracket: &Bracket, termination: Termination) -> bool {
    is_undecided(goal, bracket) && termination != Termination::TimeLimit
}

/// Whether the bracket is wider than asked, and several times wider than the errors of doubles have to leave it. A solver
/// that was chosen for comparison keeps its own end.
#[inline]
fn is_wide(a: &Convex, b: &Convex, goal: &Goal, bracket: &Bracket, termination: Termination) -> bool {
    let gave_up = matches!(termination, Termination::IterationLimit | Termination::RoundingFloor);
    let measured = goal.depth != Depth::Verdict && goal.solver == Solver::Default;
    gave_up && measured && !goal.accuracy.is_met(bracket) && {
        let error = SUPPORT_ERROR_ULPS * UNIT_ROUNDOFF * (radius(a.core) + radius(b.core) + bracket.lower.abs());
        bracket.width() > 8.0 * (error + a.placement_error + b.placement_error)
    }
}

/// Whether the bracket leaves the verdict open. When the cut-off is not positive a contact is known already, and another one would
/// change no verdict.
#[inline]
pub(super) fn is_undecided(goal: &Goal, bracket: &Bracket) -> bool {
    !goal.gives_a_verdict(bracket) && bracket.lower <= goal.cut_off && goal.cut_off > 0.0
}

/// `found`, or something narrower.
#[cold]
pub(super) fn escalate(a: &Convex, b: &Convex, goal: &Goal, mut found: Separation) -> Separation {
    found.cost.escalations += 1;
    if is_wide(a, b, goal, &found.bracket, found.termination) {
        found = revolution::narrowed(a, b, goal, found);
    }
    if is_undecided(goal, &found.bracket)
        && let Some(more) = double_double::separation(a, b, found.normal, goal)
    {
        found = merged(found, more);
    }
    if needs_more(a, b, goal, &found.bracket, found.termination)
        && let Some(more) = exact::separation(a, b, found.normal, goal)
    {
        found = merged(found, more);
    }
    found
}

/// Both are proved: the narrower end of each, and the rest from the one that is narrower.
fn merged(found: Separation, more: Separation) -> Separation {
    let mut cost = found.cost;
    cost.supports += more.cost.supports;
    if more.bracket.width() <= found.bracket.width() {
        let bracket = more.bracket.intersection(&found.bracket);
        return Separation { cost, ..more.within(bracket) };
    }
    let bracket = found.bracket.intersection(&more.bracket);
    Separation { cost, termination: more.termination, ..found.within(bracket) }
}

/// The same for a body and a wall, where a few more digits cost little: `found` is kept only if it is all that was asked for.
#[inline]
pub(super) fn settle_wall(a: &Convex, wall: &Unbounded, goal: &Goal, found: Separation) -> Separation {
    if is_enough_of_a_wall(goal, &found) { found } else { escalate_wall(a, wall, goal, found) }
}

fn is_enough_of_a_wall(goal: &Goal, found: &Separation) -> bool {
    match goal.depth {
        Depth::Verdict => !is_open(goal, &found.bracket, found.termination),
        Depth::Distance | Depth::Penetration => goal.is_met(&found.bracket) || goal.is_decided(&found.bracket),
    }
}

#[cold]
fn escalate_wall(a: &Convex, wall: &Unbounded, goal: &Goal, mut found: Separation) -> Separation {
    found.cost.escalations += 1;
    if let Some(height) = double_double::height(a, wall) {
        found = at_height(a, wall, &found, &height);
    }
    if is_undecided(goal, &found.bracket)
        && let Some(height) = exact::height(a, wall)
    {
        found = Separation { termination: Termination::Exact, ..at_height(a, wall, &found, &height) };
    }
    found
}

fn at_height(a: &Convex, wall: &Unbounded, found: &Separation, height: &Height) -> Separation {
    // Down to the wall, or up to a plane from below.
    let normal = wall.at.direction(wall.upright().0) * -height.side;
    let bracket = height.bracket.intersection(&found.bracket);
    let signed_distance = bracket.lower + 0.5 * bracket.width();
    let point_on_a = a.at.point(height.point) + normal * a.swept_radius;
    let point_on_b = point_on_a + normal * signed_distance;
    Separation { bracket, signed_distance, normal, point_on_a, point_on_b, ..*found }
}
