//! Two convex, bounded shapes: GJK on the cores, EPA where the cores meet or nearly do, swept radii taken off last.

use super::bracketing::Target;
use super::epa::{Epa, epa};
use super::escalation;
use super::given::Given;
use super::gjk::{End, Gjk, first, gjk};
use super::goal::{Depth, Goal};
use super::minkowski::Difference;
use super::momentum::Steering;
use super::outcome::{Bracket, Cost, Separation, Termination};
use super::pair_cache::PairCache;
use super::segments::Segments;
use super::solver::Solver;
use super::support::radius;
use super::witness::{self, WITNESS_ERROR_ULPS};
use super::{ladder, line_of_centers};
use crate::geometry::tolerance::{PROVED, UNIT_ROUNDOFF, UNSCALED_EXTENT};
use crate::geometry::vector::opposite;
use crate::geometry::{Core, Placement, Vec3, length};

/// A convex, bounded core in its place, with the radius of the ball swept over it.
#[derive(Clone, Copy)]
pub(super) struct Convex<'a> {
    pub core: &'a Core,
    pub swept_radius: f64,
    pub at: &'a Placement,
    /// How far a point may be from where `at` says, by roundings that went into `at`; metres.
    pub placement_error: f64,
    /// What `at` and the radius were rounded from.
    pub given: Given<'a>,
}

/// What is known about A and B when the goal is reached.
#[inline]
pub(super) fn separation(a: Convex, b: Convex, goal: &Goal) -> Separation {
    separation_again(a, b, goal, &mut PairCache::new())
}

/// The same, starting where the last query of the pair ended.
#[inline]
pub(super) fn separation_again(a: Convex, b: Convex, goal: &Goal, cache: &mut PairCache) -> Separation {
    if goal.solver == Solver::Default
        && let Some(pair) = Segments::of(&a, &b)
    {
        return pair.separation(goal, || by_search(&a, &b, goal, cache));
    }
    by_search(&a, &b, goal, cache)
}

/// Where no formula will do.
fn by_search(a: &Convex, b: &Convex, goal: &Goal, cache: &mut PairCache) -> Separation {
    let b_in_a = Placement::relative(a.at, b.at);
    let extent = radius(a.core) + radius(b.core) + length(b_in_a.translation);
    let placement_error = a.placement_error + b.placement_error;
    if !(UNSCALED_EXTENT.0..=UNSCALED_EXTENT.1).contains(&extent) {
        return scaled_separation(a, b, goal, b_in_a, extent, cache);
    }
    // Below the normal numbers roundings are absolute.
    let denormal = 64.0 * f64::MIN_POSITIVE;
    let difference = Difference::new(a.core, b.core, &b_in_a, extent, placement_error + denormal, cache);
    solved(a, b, goal, difference, 1.0)
}

/// Pairs of extreme size are brought near 1 by a power of two, which rounds nothing.
#[cold]
fn scaled_separation(
    a: &Convex,
    b: &Convex,
    goal: &Goal,
    b_in_a: Placement,
    extent: f64,
    cache: &mut PairCache,
) -> Separation {
    let scale = scale_of(extent);
    let scaled = |core: &Core| core.scaled(scale).expect("no larger than the extent, which is scaled to 1");
    let (core_a, core_b) = (scaled(a.core), scaled(b.core));
    let b_in_a = Placement { translation: b_in_a.translation * scale, ..b_in_a };
    // A pair of nothing but zeros rounds nothing.
    let denormal = if extent == 0.0 { 0.0 } else { 64.0 * f64::MIN_POSITIVE };
    let placement_error = (a.placement_error + b.placement_error + denormal) * scale;
    let extent = radius(&core_a) + radius(&core_b) + length(b_in_a.translation);
    solved(a, b, goal, Difference::new(&core_a, &core_b, &b_in_a, extent, placement_error, cache), scale)
}

/// What the goal's solver finds out about the difference, as an answer about the shapes.
#[inline]
fn solved(a: &Convex, b: &Convex, goal: &Goal, mut difference: Difference, scale: f64) -> Separation {
    let target = Target::new(goal, a.swept_radius + b.swept_radius, scale);
    let mut cost = Cost { pairs: 1, ..Cost::default() };
    let found = ladder::solve(&mut difference, &target, &mut cost);
    let bracket = target.bracket(found.lower, found.upper);
    if escalation::needs_more(a, b, goal, &bracket, found.termination) {
        return escalation::escalate(a, b, goal, place(&found, bracket, a, &target, difference.error, cost));
    }
    place(&found, bracket, a, &target, difference.error, cost)
}

/// The distance by GJK, starting along `start`, a direction from the origin to the difference; where that ends without one,
/// by EPA.
#[inline]
pub(super) fn by_gjk(
    difference: &mut Difference,
    start: Vec3,
    steering: impl Steering,
    target: &Target,
    cost: &mut Cost,
) -> Epa {
    let mut found = first(difference, start, target, cost);
    // A solver that was asked for by name does its own work.
    let by_default = matches!(target.goal.solver, Solver::Default | Solver::Exact);
    if by_default
        && difference.memory.is_empty()
        && let Some(upper) = line_of_centers::overlap(difference, target, found.lower)
    {
        return Epa { upper, ..known(&found, Termination::Decided) };
    }
    gjk(&mut found, difference, steering, target, cost);
    let stopped = |termination| known(&found, termination);
    // Two errors, one from each end of the bracket, are as near as they can come.
    let at_floor = found.upper - found.lower <= 4.0 * difference.error;
    match found.end {
        End::Converged => stopped(Termination::Converged),
        End::Decided => stopped(Termination::Decided),
        End::Stalled if at_floor || !PROVED => stopped(Termination::RoundingFloor),
        End::Stalled => epa(difference, &found.simplex.vertices(), stopped(Termination::IterationLimit), target, cost),
        End::Limit => stopped(Termination::IterationLimit),
        End::OutOfTime => stopped(Termination::TimeLimit),
        End::Enclosed => {
            // The ball around the origin that no face of the tetrahedron cuts.
            let ball =
                if PROVED { found.simplex.inner_ball(difference.extent + difference.error) } else { f64::MIN_POSITIVE };
            let upper = difference.error - ball.max(0.0);
            let overlap = Epa { upper, ..stopped(Termination::Decided) };
            let measured = target.goal.depth == Depth::Penetration;
            if !measured && target.is_decided(&target.bracket(overlap.lower, overlap.upper)) {
                return overlap;
            }
            epa(difference, &found.simplex.enclosing(), overlap, target, cost)
        }
    }
}

fn known(found: &Gjk, termination: Termination) -> Epa {
    Epa {
        lower: found.lower,
        upper: found.upper,
        direction: found.direction,
        nearest: found.simplex.nearest(),
        termination,
    }
}

/// From the scaled frame of A to the frame of both placements, swept radii included.
///
/// Out of line, so that the answer is written where it goes: copies of fresh structures wait for their parts.
#[inline(never)]
pub(super) fn place(found: &Epa, bracket: Bracket, a: &Convex, target: &Target, error: f64, cost: Cost) -> Separation {
    // The witness pair measures best what has converged. What has not is measured by its best direction: on round
    // shapes a support value is exact where a polytope is still coarse.
    let of_cores = match found.termination {
        Termination::Converged | Termination::RoundingFloor => found.direction.dot(&found.nearest.w),
        Termination::Decided
        | Termination::IterationLimit
        | Termination::TimeLimit
        | Termination::ClosedForm
        | Termination::Exact => found.lower + error,
    };
    let signed_distance = (of_cores * target.unscale - target.radii).max(bracket.lower).min(bracket.upper);
    // The direction leads from the origin to C = A - B, the normal from A to B.
    let normal = a.at.direction(opposite(found.direction));
    let point_on_a = a.at.point(found.nearest.on_a * target.unscale) + normal * a.swept_radius;
    let point_on_b = point_on_a + normal * signed_distance;
    let (normal_error, point_error) =
        if PROVED { witness_errors(found, signed_distance, a, target, error) } else { (0.0, 0.0) };
    Separation {
        bracket,
        signed_distance,
        normal,
        point_on_a,
        point_on_b,
        point_error,
        normal_error,
        termination: found.termination,
        subshape_a: 0,
        subshape_b: 0,
        cost,
    }
}

/// How far the normal and the witness points may be off: radians, and metres.
#[inline(always)]
fn witness_errors(found: &Epa, signed_distance: f64, a: &Convex, target: &Target, error: f64) -> (f64, f64) {
    let from_nearest = witness::from_nearest(found.lower, found.upper);
    let normal_error = witness::normal_error(found.lower, from_nearest);
    let distance = (signed_distance + target.radii) * target.scale;
    let cores = witness::point_error(found, distance, from_nearest, error) * target.unscale;
    let rounding = WITNESS_ERROR_ULPS * UNIT_ROUNDOFF * (target.radii + length(a.at.translation));
    (normal_error, cores + target.radii * normal_error.min(2.0) + rounding)
}

/// The power of two that brings the extent near 1; 1 for an extent of zero.
pub(super) fn scale_of(extent: f64) -> f64 {
    if extent == 0.0 {
        return 1.0;
    }
    let exponent = -libm::log2(extent).floor();
    libm::exp2(exponent.clamp(-1000.0, 1000.0))
}
