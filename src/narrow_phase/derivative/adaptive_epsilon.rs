//! How far should smoothing reach?

use super::derivatives::DerivativeGoal;

/// Of pairs that touch. Smoothing errs by the square of it (or in proportion, with corners), and has nothing to learn from afar there.
const LEAST: f64 = 0.01;

/// Of pairs far apart.
const MOST: f64 = 0.2;

/// What was asked; zero: chosen from how far apart a pair is.
///
/// A gap (or depth) d next to the size r: `epsilon = max(LEAST, MOST d / (d + r))`. What a derivative is followed for is some d away:
/// a witness will slide by about as much before bodies touch, so features within that are what smoothing should see: a part of
/// the size that grows with d / r. Far apart that is everything, and more than `MOST` would blur the shape into a ball. Near contact the
/// end is near, and the bias should be small; but not zero, or of a corner nothing would be seen but the corner.
pub(super) fn epsilon(goal: &DerivativeGoal, size: f64, signed_distance: f64) -> f64 {
    if goal.epsilon > 0.0 {
        return goal.epsilon;
    }
    let gap = signed_distance.abs();
    // The negation also catches 0/0.
    let reach = MOST * (gap / (gap + size));
    if !(reach > LEAST) { LEAST } else { reach }
}

/// How an outer optimiser lets smoothing die out: wide at first, so that it sees beyond the features that face each other, and
/// narrower as its cost falls.
///
/// With each cost epsilon is multiplied by cost / cost before, but by no less than [`Self::FASTEST`], as one lucky step tells little of how
/// near the end is, and by no more than [`Self::SLOWEST`], as a cost that stays where it is may do so because of the smoothing itself. It
/// never falls below its floor. The bounds and the default start are those that led the most contacts of hulls to their targets in the study's
/// optimisation (`clearance study --only alignment`): when epsilon may halve in a step, two thirds of those per unit of time are lost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EpsilonSchedule {
    epsilon: f64,
    floor: f64,
    cost: Option<f64>,
}

impl EpsilonSchedule {
    /// It shrinks by no more than this in a step.
    pub const FASTEST: f64 = 0.95;

    /// It shrinks by this at least.
    pub const SLOWEST: f64 = 0.995;

    /// From `start` (0.1 to 0.3 of the size serves most) down to `floor`. A floor above the start is the start.
    #[must_use]
    pub fn new(start: f64, floor: f64) -> Self {
        Self { epsilon: start, floor: floor.min(start), cost: None }
    }

    /// What to ask with now.
    #[must_use]
    pub fn epsilon(&self) -> f64 {
        self.epsilon
    }

    /// The optimiser's cost after a step; what to ask with next. The first one only tells from where progress is counted. Costs that are not
    /// finite or negative tell nothing.
    pub fn progressed(&mut self, cost: f64) -> f64 {
        if !(cost.is_finite() && cost >= 0.0) {
            return self.epsilon;
        }
        if let Some(before) = self.cost.replace(cost) {
            let ratio = if before > 0.0 { cost / before } else { Self::SLOWEST };
            self.epsilon = (self.epsilon * ratio.clamp(Self::FASTEST, Self::SLOWEST)).max(self.floor);
        }
        self.epsilon
    }
}

impl Default for EpsilonSchedule {
    /// From 0.3 to 0.001.
    fn default() -> Self {
        Self::new(0.3, 1e-3)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chosen(size: f64, signed_distance: f64) -> f64 {
        epsilon(&DerivativeGoal::default(), size, signed_distance)
    }

    #[test]
    fn what_is_asked_is_used() {
        let goal = DerivativeGoal { epsilon: 0.3, ..DerivativeGoal::default() };
        assert_eq!(epsilon(&goal, 1.0, 100.0), 0.3);
    }

    #[test]
    fn far_pairs_are_smoothed_more_than_touching_ones_at_any_scale() {
        for scale in [1e-6, 1.0, 1e6] {
            let along: Vec<f64> = [0.0, 0.01, 0.1, 1.0, 10.0, 1e9].map(|gap| chosen(scale, gap * scale)).into();
            assert!(along.windows(2).all(|pair| pair[0] <= pair[1]), "{along:?}");
            assert_eq!((along[0], along[3]), (LEAST, MOST / 2.0));
            assert!((along[5] - MOST).abs() < 1e-9);
            assert_eq!(chosen(scale, -0.1 * scale), along[2]);
        }
        assert_eq!(chosen(0.0, 0.0), LEAST);
    }

    #[test]
    fn a_schedule_shrinks_by_the_progress_of_the_cost_within_its_bounds() {
        let mut schedule = EpsilonSchedule::new(0.2, 0.01);
        assert_eq!(schedule.progressed(8.0), 0.2);
        assert_eq!(schedule.progressed(7.84), 0.2 * 0.98);
        assert_eq!(schedule.progressed(0.6), 0.2 * 0.98 * EpsilonSchedule::FASTEST);
        let stalled = schedule.epsilon();
        assert_eq!(schedule.progressed(0.7), stalled * EpsilonSchedule::SLOWEST);
        assert_eq!(schedule.progressed(f64::NAN), stalled * EpsilonSchedule::SLOWEST);
        for _ in 0..2000 {
            schedule.progressed(0.0);
        }
        assert_eq!(schedule.epsilon(), 0.01);
        assert_eq!(EpsilonSchedule::new(0.1, 0.5).epsilon(), 0.1);
    }
}
