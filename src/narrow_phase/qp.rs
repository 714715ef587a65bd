//! The distance of two polytopes as a quadratic program, solved by the interior-point method of the crate `clarabel`.
//!
//! ```text
//! minimise |w|^2 / 2   over w, l, m   subject to   w = sum l_i a_i - sum m_j b_j,  sum l = sum m = 1,  l, m >= 0
//! ```
//! The program is over the weights of the corners a_i and b_j. The other form, over two points that satisfy the inequalities
//! of the faces, has six unknowns whatever the shapes, but needs faces, which flat and thin hulls do not have, and its
//! solution is a pair of points that are in the shapes only to the solver's tolerance. Weights can be set right: negative
//! ones are set to zero and the rest divided by their sum, and so they mix points that surely are in the shapes.
//!
//! Apart only. An optimum near zero goes on to EPA. The solver allocates, and a solve is not interrupted when time runs out.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, ZeroConeT};

use super::bracketing::Target;
use super::epa::Epa;
use super::minkowski::{Difference, Vertex};
use super::outcome::{Cost, Termination};
use super::support::{corners, unit};
use crate::geometry::Vec3;
use crate::geometry::tolerance::UNIT_ROUNDOFF;

/// Gap and infeasibility at which the solver is content, on data of unit size. It is not exact enough for less.
const TOLERANCE: f64 = 1e-12;

/// Rounds of the interior-point method at most; it needs 10 to 20.
const MAX_ITERATIONS: u32 = 100;

/// What the solver makes of the pair, as a bracket that holds whatever it made of it.
pub(super) fn qp(difference: &mut Difference, target: &Target, cost: &mut Cost) -> Epa {
    let error = difference.error;
    let direction = unit(difference.centers()).unwrap_or_else(Vec3::x);
    let nearest = difference.lowest(direction);
    cost.supports += 1;
    let mut found = Epa {
        lower: direction.dot(&nearest.w) - error,
        upper: nearest.w.norm() + error,
        direction,
        nearest,
        termination: Termination::IterationLimit,
    };
    if target.is_decided(&target.bracket(found.lower, found.upper)) {
        return Epa { termination: Termination::Decided, ..found };
    }
    if target.must_stop() {
        return Epa { termination: Termination::TimeLimit, ..found };
    }
    let of_a = corners(difference.a);
    let of_b: Vec<Vec3> = corners(difference.b).iter().map(|p| difference.b_in_a.point(*p)).collect();
    let Some((weights_a, weights_b)) = weights(&of_a, &of_b, difference.extent, cost) else { return found };
    let (Some(on_a), Some(on_b)) = (mixed(&of_a, weights_a), mixed(&of_b, weights_b)) else { return found };
    let w = on_a - on_b;
    // Each weight rounds once when it is divided, each product and sum once, on either side.
    let mixing = 4.0 * (of_a.len() + of_b.len()) as f64 * UNIT_ROUNDOFF * difference.extent;
    let upper = w.norm() + error + mixing;
    if upper < found.upper {
        (found.upper, found.nearest) = (upper, Vertex { w, on_a, ..nearest });
    }
    if let Some(direction) = unit(w) {
        let lower = direction.dot(&difference.lowest(direction).w) - error;
        cost.supports += 1;
        if lower > found.lower {
            (found.lower, found.direction) = (lower, direction);
        }
    }
    let bracket = target.bracket(found.lower, found.upper);
    found.termination = if target.is_decided(&bracket) {
        Termination::Decided
    } else if target.is_met(&bracket) {
        Termination::Converged
    } else {
        Termination::IterationLimit
    };
    found
}

/// The weights of the corners of A and of B, as the solver gives them; none when it gives up.
fn weights(of_a: &[Vec3], of_b: &[Vec3], extent: f64, cost: &mut Cost) -> Option<(Vec<f64>, Vec<f64>)> {
    let (count_a, count) = (of_a.len(), of_a.len() + of_b.len());
    // Rows: three for w, two for the sums, one for each weight not to be negative. Columns: w, weights of A, of B.
    let (mut column_starts, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
    let mut column = |entries: &[(usize, f64)]| {
        for &(row, value) in entries {
            rows.push(row);
            values.push(value);
        }
        column_starts.push(rows.len());
    };
    for axis in 0..3 {
        column(&[(axis, 1.0)]);
    }
    let signed = of_a.iter().map(|a| (-a, 3)).chain(of_b.iter().map(|b| (*b, 4)));
    for (n, (p, sum)) in signed.enumerate() {
        let p = p / extent;
        column(&[(0, p.x), (1, p.y), (2, p.z), (sum, 1.0), (5 + n, -1.0)]);
    }
    let constraints = CscMatrix::new(5 + count, 3 + count, column_starts, rows, values);
    let mut bounds = vec![0.0; 5 + count];
    (bounds[3], bounds[4]) = (1.0, 1.0);
    let squares_end: Vec<usize> = (0..=3 + count).map(|n| n.min(3)).collect();
    let objective = CscMatrix::new(3 + count, 3 + count, squares_end, vec![0, 1, 2], vec![1.0; 3]);
    let settings = DefaultSettings {
        verbose: false,
        max_iter: MAX_ITERATIONS,
        tol_gap_abs: TOLERANCE,
        tol_gap_rel: TOLERANCE,
        tol_feas: TOLERANCE,
        ..DefaultSettings::default()
    };
    let cones = [ZeroConeT(5), NonnegativeConeT(count)];
    let mut solver =
        DefaultSolver::new(&objective, &vec![0.0; 3 + count], &constraints, &bounds, &cones, settings).ok()?;
    solver.solve();
    // Whatever its status: the weights of the last round are the best there are, and the bracket says what they are worth.
    cost.gjk_iterations += u64::from(solver.solution.iterations);
    let weights = solver.solution.x.get(3..)?;
    Some((weights[..count_a].to_vec(), weights[count_a..].to_vec()))
}

/// The mean of the points, in the proportion of those weights that are positive; none when no sum can be made of them.
fn mixed(points: &[Vec3], weights: Vec<f64>) -> Option<Vec3> {
    let positive = weights.iter().map(|weight| weight.max(0.0));
    let sum: f64 = positive.clone().sum();
    // The negation also refuses a sum that is no number.
    if !(sum > 0.5 && sum < 2.0) {
        return None;
    }
    Some(points.iter().zip(positive).map(|(p, weight)| p * (weight / sum)).sum())
}
