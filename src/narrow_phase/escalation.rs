//! What happens to a pair that doubles leave open: the next rungs of the precision ladder.
//!
//! Nearly every bracket decides what was asked of it, and pays one comparison here. One that straddles contact or the
//! margin, or that met the cap on iterations, is worked out again in exact arithmetic where both cores are polytopes.

use super::convex::Convex;
use super::exact;
use super::goal::{Depth, Goal};
use super::outcome::{Bracket, Separation, Termination};
use super::unbounded::Unbounded;

/// `found`, or something narrower where that leaves the question open.
#[inline]
pub(super) fn settle(a: &Convex, b: &Convex, goal: &Goal, found: Separation) -> Separation {
    if is_open(goal, &found) { escalate(a, b, goal, found) } else { found }
}

/// Whether a verdict is missing that more digits could give, or the bracket is wider than doubles have to leave it. When the
/// cut-off is not positive a contact is known already, and another one would change no verdict.
fn is_open(goal: &Goal, found: &Separation) -> bool {
    let undecided = !goal.gives_a_verdict(&found.bracket) && found.bracket.lower <= goal.cut_off && goal.cut_off > 0.0;
    (undecided && found.termination != Termination::TimeLimit) || found.termination == Termination::IterationLimit
}

/// The same for a body and a wall, where a few more digits cost little: `found` is kept only if it is all that was asked for.
#[inline]
pub(super) fn settle_wall(a: &Convex, wall: &Unbounded, goal: &Goal, found: Separation) -> Separation {
    let is_enough = match goal.depth {
        Depth::Verdict => !is_open(goal, &found),
        Depth::Distance | Depth::Penetration => goal.is_met(&found.bracket) || goal.is_decided(&found.bracket),
    };
    if is_enough { found } else { escalate_wall(a, wall, found) }
}

#[cold]
fn escalate_wall(a: &Convex, wall: &Unbounded, mut found: Separation) -> Separation {
    found.cost.escalations += 1;
    let Some(exact::Height { bracket, corner, side }) = exact::height(a, wall) else { return found };
    // Down to the wall, or up to a plane from below.
    let (up, _) = wall.upright();
    let normal = wall.at.direction(up) * -side;
    let signed_distance = bracket.lower + 0.5 * bracket.width();
    let point_on_a = a.at.point(corner) + normal * a.swept_radius;
    let point_on_b = point_on_a + normal * signed_distance;
    Separation { bracket, signed_distance, normal, point_on_a, point_on_b, termination: Termination::Exact, ..found }
}

#[cold]
fn escalate(a: &Convex, b: &Convex, goal: &Goal, mut found: Separation) -> Separation {
    found.cost.escalations += 1;
    match exact::separation(a, b, found.normal, goal) {
        Some(exact) => merged(found, exact, goal),
        None => found,
    }
}

/// Both are proved: the narrower end of each, and the rest from the one that knows more.
fn merged(found: Separation, more: Separation, goal: &Goal) -> Separation {
    let bracket = Bracket {
        lower: found.bracket.lower.max(more.bracket.lower),
        upper: found.bracket.upper.min(more.bracket.upper),
    };
    let mut cost = found.cost;
    cost.supports += more.cost.supports;
    if goal.accuracy.is_met(&more.bracket) || more.bracket.width() <= found.bracket.width() {
        return Separation { bracket, cost, ..more };
    }
    let signed_distance = found.signed_distance.clamp(bracket.lower, bracket.upper);
    let point_on_b = found.point_on_a + found.normal * signed_distance;
    Separation { bracket, signed_distance, point_on_b, cost, termination: more.termination, ..found }
}
