//! Which solver does a pair of cores: the one that was asked for, or the one that suits their kinds.

use super::bracketing::Target;
use super::convex::by_gjk;
use super::epa::{Epa, epa};
use super::frank_wolfe::frank_wolfe;
use super::minkowski::Difference;
use super::momentum::{Momentum, Plain};
use super::outcome::{Cost, Termination};
use super::qp::qp;
use super::sat::{Sat, sat};
use super::solver::Solver;

/// What the goal's solver finds out about the difference.
#[inline]
pub(super) fn solve(difference: &mut Difference, target: &Target, cost: &mut Cost) -> Epa {
    match target.goal.solver {
        Solver::Default | Solver::Gjk => by_gjk(difference, difference.centers(), Plain, target, cost),
        chosen @ (Solver::FrankWolfe
        | Solver::GjkPolyak
        | Solver::GjkNesterov
        | Solver::GjkNesterovNormalised
        | Solver::Sat
        | Solver::Qp) => by_choice(chosen, difference, target, cost),
    }
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
            by_gjk(difference, centers, Momentum::new(chosen), target, cost)
        }
        Solver::Default | Solver::Gjk => by_gjk(difference, centers, Plain, target, cost),
    }
}

/// What a solver found that knows nothing of overlaps: where it has not parted the cores EPA goes on, and finds a direction and
/// a nearest point of its own.
fn overlap_measured(found: Epa, difference: &mut Difference, target: &Target, cost: &mut Cost) -> Epa {
    let is_open = found.termination == Termination::IterationLimit && found.lower <= 0.0;
    if !is_open {
        return found;
    }
    epa(difference, &[], Epa { lower: f64::NEG_INFINITY, ..found }, target, cost)
}
