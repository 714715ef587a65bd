//! Where should two bodies touch, and how does one of them get there?
//!
//! The lecture's example of what derivatives of collision detection are for: with A held fast, B's place T is moved until the nearest points x1,
//! x2 are where they are wanted on both bodies, and one in the other,
//!
//! ```text
//! min over T of  |x1(T) - t1|^2 + |x2(T) - T t2|^2 + |x1(T) - x2(T)|^2,
//! ```
//!
//! t1 in the world, t2 in B's frame. Steps are Levenberg's and Marquardt's, on twists of B about its own origin, lengths in sizes of the bodies.

use nalgebra::{SMatrix, SVector};

use super::families::placed;
use super::random::Random;
use crate::geometry::{Placement, Pose, Quaternion, Shape, Vec3};
use crate::narrow_phase::{
    DerivativeGoal, DerivativeMethod, Derivatives, EpsilonSchedule, Goal, Separation, derivatives, separation,
};

/// Damping at the start, and beyond which no step is left that helps; parts of the largest diagonal entry. Where smoothing may tell something else
/// next time, it is asked sooner.
const DAMPING: f64 = 1e-3;
const MOST_DAMPING: f64 = 1e9;
const MOST_SMOOTHED_DAMPING: f64 = 1e2;

/// A step's length at most, parts of the size.
const LONGEST_STEP: f64 = 1.0;

/// A step helps if the cost is below one of so many before it (Grippo, Lampariello and Lucidi 1986): what leaps from feature to feature
/// does not fall from step to step.
const MEMORY: usize = 5;

/// Derivatives asked at most: an attempt ends also where no step is worth a separation.
const MOST_TRIES: u64 = 2000;

/// Reached: every residual is below this part of the size.
pub(super) const REACHED: f64 = 1e-3;

/// Two bodies, and where they should touch.
#[derive(Clone, Debug)]
pub struct ContactTarget {
    /// The one that stays.
    pub a: Shape,
    /// The one that is moved.
    pub b: Shape,
    /// Where A is.
    pub at_a: Placement,
    /// Where the nearest point of A should be, in the world; metres.
    pub on_a: Vec3,
    /// Where that of B should be, in B's frame; metres.
    pub on_b: Vec3,
    /// Of the smaller body, metres.
    pub size: f64,
}

/// How an attempt is made.
#[derive(Clone, Copy, Debug)]
pub struct Attempt {
    /// How derivatives are made.
    pub method: DerivativeMethod,
    /// Pairs of samples of random methods.
    pub samples: u32,
    /// Separations at most, those that derivatives ask again among them.
    pub budget: u64,
    /// Of random methods.
    pub seed: u64,
}

/// How an attempt ended.
#[derive(Clone, Copy, Debug)]
pub struct Course {
    /// Every residual is below a thousandth of the size.
    pub reached: bool,
    /// Steps that were taken.
    pub steps: u64,
    /// Separations that were asked.
    pub queries: u64,
    /// The root of the cost at the end, parts of the size.
    pub left: f64,
}

/// A place of B, and what is wrong with it.
struct State {
    pose: Pose,
    at_b: Placement,
    found: Separation,
    residuals: SVector<f64, 9>,
}

impl ContactTarget {
    /// A target that can be reached: the witness where B, on its way from `at_b` towards A, touches it. None where that is no single point.
    #[must_use]
    pub fn of_an_approach([a, b]: [Shape; 2], size: f64, at_a: Placement, mut at_b: Placement) -> Option<Self> {
        for _ in 0..60 {
            let found = separation(&a, &b, &at_a, &at_b, &Goal::penetration()).ok()?;
            if found.signed_distance.abs() < 1e-9 * size {
                let goal = DerivativeGoal::default();
                let told = derivatives(&a, &b, &at_a, &at_b, &found, &goal, &Goal::penetration()).ok()?;
                let on_b = at_b.rotation.tr_mul(&(found.point_on_b - at_b.translation));
                let is_one_point = told.is_valid && !told.on_border;
                return is_one_point.then_some(Self { a, b, at_a, on_a: found.point_on_a, on_b, size });
            }
            at_b.translation -= found.normal * found.signed_distance;
        }
        None
    }

    /// The same for an approach at random.
    pub(super) fn random(shapes: [Shape; 2], size: f64, random: &mut Random) -> Option<Self> {
        let at_a = placed(Vec3::zeros(), random.rotation())?;
        let at_b = placed(random.direction() * (4.0 * size), random.rotation())?;
        Self::of_an_approach(shapes, size, at_a, at_b)
    }

    /// A place to start from, apart from A.
    pub(super) fn start(&self, random: &mut Random) -> Option<Pose> {
        Pose::new(self.at_a.translation + random.direction() * (3.0 * self.size), random.rotation()).ok()
    }

    fn state(&self, pose: Pose) -> Option<State> {
        let at_b = pose.placement();
        let found = separation(&self.a, &self.b, &self.at_a, &at_b, &Goal::penetration()).ok()?;
        let wanted = at_b.translation + at_b.rotation * self.on_b;
        let (x1, x2) = (found.point_on_a, found.point_on_b);
        let of = [x1 - self.on_a, x2 - wanted, x1 - x2].map(|part| part / self.size);
        Some(State { pose, at_b, found, residuals: SVector::from_fn(|row, _| of[row / 3][row % 3]) })
    }

    /// Follows derivatives from `start` until the target is reached, no step helps any more, or the budget is used up. None of shapes that have no
    /// separation.
    #[must_use]
    pub fn reach(&self, start: Pose, attempt: &Attempt) -> Option<Course> {
        let mut schedule = EpsilonSchedule::default();
        let mut state = self.state(start)?;
        let mut costs = vec![state.residuals.norm_squared()];
        let (mut queries, mut damping, mut tries) = (1, DAMPING, 0);
        let is_smoothed = attempt.is_smoothed();
        let most_damping = if is_smoothed { MOST_SMOOTHED_DAMPING } else { MOST_DAMPING };
        'steps: while !state.is_reached() && queries < attempt.budget && tries < MOST_TRIES {
            tries += 1;
            let goal = DerivativeGoal {
                method: attempt.method,
                epsilon: schedule.epsilon(),
                samples: attempt.samples,
                seed: attempt.seed,
                stream: tries,
            };
            let (a, b, found) = (&self.a, &self.b, &state.found);
            let told = derivatives(a, b, &self.at_a, &state.at_b, found, &goal, &Goal::penetration()).ok()?;
            queries += attempt.separations();
            schedule.progressed(state.residuals.norm());
            let jacobian = self.jacobian(&state, &told);
            let (square, slope) = (jacobian.tr_mul(&jacobian), jacobian.tr_mul(&state.residuals));
            let largest = square.diagonal().max().max(f64::MIN_POSITIVE);
            let worst = costs.iter().rev().take(MEMORY).copied().fold(0.0, f64::max);
            while damping <= most_damping && queries < attempt.budget {
                let damped = square + SMatrix::<f64, 6, 6>::identity() * (damping * largest);
                let step = damped.cholesky().map(|factors| -factors.solve(&slope));
                if let Some(step) = step.filter(|step| step.norm() > 1e-12) {
                    let step = step * (LONGEST_STEP / step.norm()).min(1.0);
                    let next = self.state(moved(&state.pose, &step, self.size)?)?;
                    queries += 1;
                    if next.residuals.norm_squared() < worst {
                        costs.push(next.residuals.norm_squared());
                        (state, damping) = (next, (damping * 0.3).max(1e-12));
                        continue 'steps;
                    }
                }
                damping *= 4.0;
            }
            // What a formula says of this place it will say again; other samples, and less smoothing, may say something else.
            if !is_smoothed {
                break;
            }
            damping = DAMPING;
        }
        let steps = costs.len() as u64 - 1;
        Some(Course { reached: state.is_reached(), steps, queries, left: state.residuals.norm() })
    }

    /// Of the residuals, with respect to B's twist: velocities in sizes, turns in radians.
    fn jacobian(&self, state: &State, told: &Derivatives) -> SMatrix<f64, 9, 6> {
        let arm = state.at_b.rotation * self.on_b;
        let mut jacobian = SMatrix::<f64, 9, 6>::zeros();
        for column in 0..6 {
            let axis = Vec3::ith(column % 3, 1.0);
            let (wanted, scale) = if column < 3 { (axis, 1.0) } else { (axis.cross(&arm), 1.0 / self.size) };
            let (x1, x2) = (told.point_on_a[1].column(column), told.point_on_b[1].column(column));
            for row in 0..3 {
                jacobian[(row, column)] = x1[row] * scale;
                jacobian[(3 + row, column)] = (x2[row] - wanted[row]) * scale;
                jacobian[(6 + row, column)] = (x1[row] - x2[row]) * scale;
            }
        }
        jacobian
    }
}

impl Attempt {
    /// How often derivatives ask both bodies again. Their counter also has the pairs of pieces among which they look for a rival of the deciding one.
    fn separations(&self) -> u64 {
        match self.method {
            DerivativeMethod::FiniteDifference => 25,
            DerivativeMethod::Smoothed0 => 2 * u64::from(self.samples),
            DerivativeMethod::Exact
            | DerivativeMethod::ExactCell
            | DerivativeMethod::Smoothed1Gaussian
            | DerivativeMethod::Smoothed1Gumbel => 0,
        }
    }

    /// Whether another epsilon, or other samples, may say something else of the same place.
    fn is_smoothed(&self) -> bool {
        match self.method {
            DerivativeMethod::Exact | DerivativeMethod::ExactCell | DerivativeMethod::FiniteDifference => false,
            DerivativeMethod::Smoothed0 | DerivativeMethod::Smoothed1Gaussian | DerivativeMethod::Smoothed1Gumbel => {
                true
            }
        }
    }
}

impl State {
    fn is_reached(&self) -> bool {
        (0..3).all(|part| self.residuals.fixed_rows::<3>(3 * part).norm() < REACHED)
    }
}

/// B after a twist, its velocity in sizes.
fn moved(pose: &Pose, step: &SVector<f64, 6>, size: f64) -> Option<Pose> {
    let (v, w) = (step.fixed_rows::<3>(0) * size, step.fixed_rows::<3>(3).into_owned());
    let angle = w.norm();
    let turn = if angle > 0.0 { Quaternion::about_axis(w / angle, angle) } else { Quaternion::IDENTITY };
    Pose::new(pose.translation() + v, turn.compose(pose.rotation())).ok()
}
