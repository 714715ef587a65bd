//! Which solver does a pair of cores: the one that was asked for, or the one that suits their kinds.

use super::bracketing::Target;
use super::convex::by_gjk;
use super::epa::{Epa, epa};
use super::frank_wolfe::frank_wolfe;
use super::goal::Depth;
use super::minkowski::Difference;
use super::momentum::{Momentum, Plain, Rule};
use super::outcome::{Cost, Termination};
use super::qp::qp;
use super::sat::{Sat, boxes, parted, sat};
use super::sat_boxes::Faces;
use super::smooth::{self, Smooth};
use super::solver::Solver;
use crate::geometry::Core;

/// What the goal's solver finds out about the difference.
#[inline]
pub(super) fn solve(difference: &mut Difference, target: &Target, cost: &mut Cost) -> Epa {
    match target.goal.solver {
        // The exact solver sets out from what doubles find.
        Solver::Default | Solver::Exact => by_default(difference, target, cost),
        Solver::Gjk => by_gjk(difference, difference.start(), Plain, target, cost),
        chosen @ (Solver::FrankWolfe
        | Solver::GjkPolyak
        | Solver::GjkNesterov
        | Solver::GjkNesterovNormalised
        | Solver::Sat
        | Solver::Qp) => by_choice(chosen, difference, target, cost),
    }
}

/// The fastest way for the kinds of the cores; `docs/queries.md` gives the reasons.
#[inline]
fn by_default(difference: &mut Difference, target: &Target, cost: &mut Cost) -> Epa {
    if let Some(pair) = Smooth::of(difference)
        && let Some(found) = smooth::newton(&pair, difference, target, cost)
    {
        return found;
    }
    if let (Core::Cuboid { half_extents: a }, Core::Cuboid { half_extents: b }) = (difference.a, difference.b)
        && !difference.memory.was_apart()
    {
        // The axes part boxes and tell their depth, but not their distance: that is GJK's, which gets there sooner from the
        // centres than from the face or the edges that part them.
        let (a, b) = (*a, *b);
        let is_verdict = target.goal.depth == Depth::Verdict;
        let faces = Faces::of(a, b, difference.b_in_a);
        if is_verdict && let Some(answer) = parted(&faces, difference, target) {
            return answer;
        }
        if is_verdict || faces.value <= 0.0 {
            // That they are apart is an answer only if no more is wanted than some distance.
            let is_enough = is_verdict || target.goal.cut_off < f64::INFINITY;
            let parted = if is_enough { f64::INFINITY } else { 2.0 * difference.error };
            match boxes(a, b, faces, parted, difference, target, cost) {
                Sat::Answer(answer) => return answer,
                Sat::Start(direction) if is_verdict => return by_gjk(difference, direction, Plain, target, cost),
                Sat::Start(_) => (),
            }
        }
        let centers = difference.centers();
        return match at_once(target) {
            Some(rule) => by_gjk(difference, centers, Momentum::by_distance([None, Some(rule)], centers), target, cost),
            None => by_gjk(difference, centers, Plain, target, cost),
        };
    }
    // A search that starts where the last one ended has no long way to save rounds on.
    let rules =
        if difference.memory.is_empty() { rules_that_suit(difference.a, difference.b, target) } else { [None; 2] };
    if let [None, None] = rules {
        return by_gjk(difference, difference.start(), Plain, target, cost);
    }
    let centers = difference.centers();
    by_gjk(difference, centers, Momentum::by_distance(rules, centers), target, cost)
}

/// Hulls of at least so many corners have rounds enough near contact for momentum to save some. On hulls of eight it costs half a
/// round.
const ROUND_HULL: usize = 16;

/// From so many on it costs nothing farther apart, either.
const ROUNDER_HULL: usize = 64;

/// From so many on directions are better mixed as long as they are than at one length.
const ROUNDEST_HULL: usize = 200;

/// How directions are mixed that save time with two kinds of cores: near one another, and far apart (`docs/acceleration.md` has the
/// counts).
#[inline]
fn rules_that_suit(a: &Core, b: &Core, target: &Target) -> [Option<Rule>; 2] {
    let is_ellipsoid = |core: &Core| matches!(core, Core::Ellipsoid { .. });
    let corners = |core: &Core| if let Core::Convex(hull) = core { hull.points().len() } else { 0 };
    let is_box = |core: &Core| matches!(core, Core::Cuboid { .. });
    if is_ellipsoid(a) && is_ellipsoid(b) {
        return [Some(Rule::Nesterov); 2];
    }
    if (is_ellipsoid(a) && !is_box(b)) || (is_ellipsoid(b) && !is_box(a)) {
        // Against a point Nesterov's momentum takes half as many rounds again, Polyak's a fifth fewer.
        return [Some(Rule::Polyak); 2];
    }
    match corners(a).min(corners(b)) {
        ROUNDEST_HULL.. => [Some(Rule::Nesterov); 2],
        ROUNDER_HULL.. => [Some(Rule::NesterovNormalised), Some(Rule::Nesterov)],
        ROUND_HULL.. => [Some(Rule::NesterovNormalised), at_once(target)],
        // A ball's first direction is good enough.
        _ if matches!((a, b), (Core::Point, _) | (_, Core::Point)) => [None; 2],
        _ => [None, at_once(target)],
    }
}

/// Where a tenth of the distance will do, and the first direction tells half of it, one between that and the next is often enough.
const ROUGH: f64 = 0.05;

fn at_once(target: &Target) -> Option<Rule> {
    (target.goal.accuracy.relative >= ROUGH).then_some(Rule::PolyakOnce)
}

/// Apart from the common way, so that it does not grow by what is seldom asked for.
#[cold]
fn by_choice(chosen: Solver, difference: &mut Difference, target: &Target, cost: &mut Cost) -> Epa {
    let centers = difference.centers();
    match chosen {
        Solver::FrankWolfe => overlap_measured(frank_wolfe(difference, target, cost), difference, target, cost),
        Solver::Qp => overlap_measured(qp(difference, target, cost), difference, target, cost),
        Solver::Sat => match sat(difference, target, cost) {
            Some(Sat::Answer(answer)) => answer,
            Some(Sat::Start(direction)) => by_gjk(difference, direction, Plain, target, cost),
            None => by_gjk(difference, centers, Plain, target, cost),
        },
        Solver::GjkPolyak | Solver::GjkNesterov | Solver::GjkNesterovNormalised => {
            by_gjk(difference, centers, Momentum::new(chosen, centers), target, cost)
        }
        Solver::Default | Solver::Exact | Solver::Gjk => by_gjk(difference, centers, Plain, target, cost),
    }
}

/// What a solver found that knows nothing of overlaps: where it has not parted the cores EPA goes on, and finds a direction and
/// a nearest point of its own.
fn overlap_measured(found: Epa, difference: &mut Difference, target: &Target, cost: &mut Cost) -> Epa {
    let is_open = found.termination == Termination::IterationLimit && found.lower <= 0.0;
    if !is_open {
        return found;
    }
    // Below any bound a direction can give, so that the first one counts; finite, because it may be the last.
    let lower = -2.0 * difference.extent - difference.error;
    epa(difference, &[], Epa { lower, ..found }, target, cost)
}
