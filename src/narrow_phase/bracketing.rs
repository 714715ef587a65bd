//! From bounds on two cores to a bracket on the shapes, and whether that is enough.

use crate::geometry::tolerance::{PROVED, UNIT_ROUNDOFF};

use super::goal::{Depth, Goal};
use super::outcome::Bracket;

/// What is asked of a pair, with what has been taken off its cores.
pub(super) struct Target<'a> {
    pub goal: &'a Goal<'a>,
    /// Sum of the swept radii: the shapes' signed distance is that of the cores less this. Metres.
    pub radii: f64,
    /// The cores are the shapes' times this power of two, so that no product over- or underflows.
    pub scale: f64,
    /// 1 / scale, exactly.
    pub unscale: f64,
    /// No bound of the (scaled) cores says anything final unless `lower` is above `far`, `upper` not above `near`, or their
    /// difference at most `wide + relative * |upper|`: three comparisons that spare most rounds the rest.
    far: f64,
    near: f64,
    wide: f64,
}

impl<'a> Target<'a> {
    /// `radii`: the sum of the swept radii, metres. `scale`: a power of two.
    #[inline]
    pub fn new(goal: &'a Goal<'a>, radii: f64, scale: f64) -> Self {
        let far = match goal.depth {
            Depth::Verdict => goal.cut_off.min(0.0),
            Depth::Distance | Depth::Penetration => goal.cut_off,
        };
        let near = if goal.depth == Depth::Penetration { f64::NEG_INFINITY } else { radii * scale };
        let wide = (goal.accuracy.absolute + goal.accuracy.relative * radii) * scale;
        Self { goal, radii, scale, unscale: 1.0 / scale, far: (far + radii) * scale, near, wide }
    }

    /// Whether these bounds of the (scaled) cores may be enough; where not, they are not. Rounding outwards makes the bracket of
    /// the shapes wider than the difference of the bounds by more than these sums round.
    #[inline]
    pub fn may_be_enough(&self, lower: f64, upper: f64) -> bool {
        lower > self.far || upper <= self.near || upper - lower <= self.wide + self.goal.accuracy.relative * upper.abs()
    }

    /// Bracket of the shapes, metres, from bounds on the (scaled) cores. Rounded outwards: the sum of the radii, the
    /// difference and the product round once each; four units in the last place cover them.
    #[inline]
    pub fn bracket(&self, lower: f64, upper: f64) -> Bracket {
        if !PROVED {
            let on_shapes = |bound: f64| bound * self.unscale - self.radii;
            return Bracket { lower: on_shapes(lower), upper: on_shapes(upper) };
        }
        let denormal = if self.scale == 1.0 { 0.0 } else { f64::MIN_POSITIVE };
        let slack = |bound: f64| 4.0 * UNIT_ROUNDOFF * (bound.abs() + self.radii) + denormal;
        let (lower, upper) = (lower * self.unscale, upper * self.unscale);
        Bracket { lower: lower - self.radii - slack(lower), upper: upper - self.radii + slack(upper) }
    }

    /// Cores farther apart than this are far enough for what is asked, but for rounding; metres, of the scaled cores.
    pub fn enough(&self) -> f64 {
        let apart = match self.goal.depth {
            Depth::Verdict => self.goal.margin.min(self.goal.cut_off),
            Depth::Distance | Depth::Penetration => self.goal.cut_off,
        };
        (apart + self.radii) * self.scale
    }

    #[inline]
    pub fn is_decided(&self, bracket: &Bracket) -> bool {
        self.goal.is_decided(bracket)
    }

    #[inline]
    pub fn is_met(&self, bracket: &Bracket) -> bool {
        match self.goal.depth {
            Depth::Verdict => false,
            Depth::Distance | Depth::Penetration => self.goal.is_met(bracket),
        }
    }

    pub fn must_stop(&self) -> bool {
        (self.goal.stop)()
    }
}
