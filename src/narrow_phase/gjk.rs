//! Distance between two convex cores: the Gilbert-Johnson-Keerthi algorithm on their Minkowski difference.
//!
//! The loop keeps the feature (vertex, edge or face) of a simplex nearest the origin, asks for the support point
//! opposite to it, and reduces the enlarged simplex to its nearest feature again. Every direction that was asked about
//! bounds the distance from below, the nearest point bounds it from above; the best of both are kept, never the last.
//! Sources: Gilbert, Johnson, Keerthi 1988; van den Bergen 1999. Departures: the bracket decides when to stop, and the
//! search direction is the feature's own (see [`Simplex::direction`]), which near a contact is far better than the
//! nearest point's.
//!
//! It ends when
//! - the bracket is as narrow as asked, or decides what was asked;
//! - a tetrahedron encloses the origin, by an exact test (the cores overlap: EPA's work);
//! - no further progress can be made in `f64`;
//! - the cap on rounds is reached, or the caller's time.

use super::bracketing::Target;
use super::goal::Depth;
use super::minkowski::Difference;
use super::momentum::Steering;
use super::outcome::Cost;
use super::pair_cache::rebuilt;
use super::simplex::{Simplex, Step};
use super::support::with_length;
use crate::geometry::Vec3;

/// Rounds at most. Smooth pairs need some 50 for a relative width of 1e-9; the most seen in the test corpus is below
/// 100, on cones and ellipsoids of extreme proportions.
const MAX_ITERATIONS: u32 = 160;

/// What GJK found out about the difference C of two cores.
pub(super) struct Gjk {
    /// The signed distance of the cores is at least this, metres.
    pub lower: f64,
    /// The unit direction that proves it: `direction . c >= lower` for all c in C.
    pub direction: Vec3,
    /// The nearest feature found, also when the origin is enclosed (then the last before).
    pub simplex: Simplex,
    /// `|x|` of the nearest point plus its error, metres.
    pub upper: f64,
    /// How it ended.
    pub end: End,
}

/// How GJK ended.
#[derive(Clone, Copy)]
pub(super) enum End {
    /// The bracket is as narrow as asked.
    Converged,
    /// The bracket decides what was asked.
    Decided,
    /// The origin is strictly inside of the simplex and its last vertex.
    Enclosed,
    /// No progress in `f64`; the bracket may still be wide next to a small distance.
    Stalled,
    /// The cap on rounds.
    Limit,
    /// The caller's time ran out.
    OutOfTime,
}

/// Runs GJK on `difference` from where [`first`] begins, and remembers where it ends.
#[inline]
pub(super) fn gjk(
    found: &mut Gjk,
    difference: &mut Difference,
    mut steering: impl Steering,
    target: &Target,
    cost: &mut Cost,
) {
    search(found, difference, &mut steering, target, cost);
    difference.memory.note(&found.simplex, matches!(found.end, End::Enclosed), found.direction);
}

/// The simplex of the last query of the pair, or the first vertex along `start`, a direction from the origin to the difference.
#[inline]
pub(super) fn first(difference: &mut Difference, start: Vec3, target: &Target, cost: &mut Cost) -> Gjk {
    let error = difference.error;
    let (toward, length) = with_length(start).unwrap_or((Vec3::new(1.0, 0.0, 0.0), 1.0));
    // To be told apart again a pair needs no more than the direction that told it last time.
    let is_axis_enough = target.goal.depth == Depth::Verdict && difference.memory.len < 4;
    if difference.memory.len > 0
        && !is_axis_enough
        && let Some((simplex, encloses)) = rebuilt(&difference.remembered(), difference.extent + error)
    {
        let upper = simplex.square.sqrt() + error;
        let end = if encloses { End::Enclosed } else { End::Limit };
        // Not asked about any direction yet; but no point of C is farther from the origin than S, so no m(n) is below -S.
        let lower = -2.0 * difference.extent - error;
        return Gjk { lower, direction: toward / length, simplex, upper, end };
    }
    let first = difference.lowest(toward);
    cost.supports += 1;
    let (lower, simplex) = (toward.dot(&first.w) / length - error, Simplex::point(first));
    Gjk { lower, direction: toward / length, upper: simplex.square.sqrt() + error, simplex, end: End::Limit }
}

#[inline]
fn search(best: &mut Gjk, difference: &mut Difference, steering: &mut impl Steering, target: &Target, cost: &mut Cost) {
    let error = difference.error;
    if matches!(best.end, End::Enclosed) {
        return;
    }
    if let Some(end) = settled(best, target) {
        best.end = end;
        return;
    }
    steering.begin(best.lower, best.upper);
    let mut last = best.simplex.x;
    for _ in 0..MAX_ITERATIONS {
        if target.must_stop() {
            best.end = End::OutOfTime;
            break;
        }
        let steered = steering.direction(best.simplex.x, last).and_then(with_length);
        // Not of unit length: so the root and the quotient are worked out beside the search for the vertex.
        let Some((toward, length)) = steered.or_else(|| with_length(best.simplex.direction())) else {
            best.end = End::Stalled; // The origin is on the feature.
            break;
        };
        let vertex = difference.lowest(toward);
        last = vertex.w;
        cost.supports += 1;
        cost.gjk_iterations += 1;
        let value = toward.dot(&vertex.w) / length - error;
        if value > best.lower {
            best.lower = value;
            best.direction = toward / length;
        }
        // Here the best of both sides meet: the point of the last round, and the direction it led to.
        if let Some(end) = settled(best, target) {
            best.end = end;
            break;
        }
        let is_old = best.simplex.has(vertex.w);
        let step = if is_old { Step::NoNearer } else { best.simplex.add(&vertex, difference.extent + error) };
        match step {
            Step::Reduced => best.upper = best.simplex.square.sqrt() + error,
            // What a steered direction found was not what lies farthest against x: that is no reason to end.
            Step::NoNearer if steering.gave_up() => (),
            Step::NoNearer => {
                best.end = End::Stalled;
                break;
            }
            Step::Enclosed => {
                best.end = End::Enclosed;
                break;
            }
        }
    }
}

#[inline(always)]
fn settled(best: &Gjk, target: &Target) -> Option<End> {
    if !target.may_be_enough(best.lower, best.upper) {
        return None;
    }
    let bracket = target.bracket(best.lower, best.upper);
    if target.is_decided(&bracket) {
        return Some(End::Decided);
    }
    target.is_met(&bracket).then_some(End::Converged)
}
