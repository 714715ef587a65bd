//! When do two moving elements first touch? Conservative advancement: from now to a time until which they are proved apart, again
//! and again, until they are shown to touch or the motion is over.
//!
//! Each round measures the elements as they are, with certified bounds, and looks ahead along the direction that parts them
//! ([`super::forecast`]). Time never passes a contact, whatever rounds: only proved lower bounds move it. The end of it is proved from the other
//! side: a little later, where they overlap by more than rounding, an upper bound shows it. What neither bound can decide,
//! a touch in passing above all, is reported as a stretch of time, and what comes after is looked at all the same.

use super::approach::{Approach, Instant};
use super::element::{Element, measure};
use super::forecast::Forecast;
use super::goal::{Accuracy, Depth, Goal};
use super::outcome::{Cost, Separation, Termination};
use super::solver::Solver;
use crate::geometry::Vec3;
use crate::geometry::tolerance::UNIT_ROUNDOFF;

/// Rounds on one pair of elements at most. Usual are 3 to 8; motions that turn many times around need the most.
pub const MOST_ROUNDS: usize = 512;

/// Rounds on a pair of boxes: enough to tell most that are missed.
#[cfg(feature = "effect-motion")]
const BOX_ROUNDS: usize = 4;

/// A gap of fewer than this many times what rounding hides is taken for a contact to come: steps within it would not end.
const NOISES: f64 = 8.0;

/// Distances are measured to this, relatively: the direction matters more than the number.
const MEASURED_TO: f64 = 1e-3;

/// What is asked of every pair.
#[derive(Clone, Copy)]
pub(super) struct Asked<'a> {
    /// Times nearer than this to one another need not be told apart; a part of the motion.
    pub resolution: f64,
    pub stop: &'a dyn Fn() -> bool,
}

impl Asked<'_> {
    fn goal(&self, depth: Depth) -> Goal<'_> {
        Goal {
            depth,
            accuracy: Accuracy { absolute: 0.0, relative: MEASURED_TO },
            solver: Solver::Default,
            margin: 0.0,
            cut_off: f64::INFINITY,
            stop: self.stop,
        }
    }
}

/// When two elements meet. Times are parts of the motion; infinite: not within what was asked.
#[derive(Clone, Debug)]
pub(super) struct Timing {
    /// Proved apart before.
    pub free_until: f64,
    /// Proved to touch at this time.
    pub touching_at: f64,
    /// Where there is no contact: neither proved apart nor touching up to this time.
    pub open_until: f64,
    /// What was measured at `free_until`, and where the frame of its points is.
    pub last: Option<Seen>,
    /// A limit that ended the work.
    pub limit: Option<Termination>,
    pub cost: Cost,
}

/// The elements at a time when they were measured.
#[derive(Clone, Debug)]
pub(super) struct Seen {
    pub separation: Separation,
    /// Of the frame of its points in the world, metres.
    #[cfg_attr(not(feature = "effect-motion"), expect(dead_code, reason = "only motions tell it"))]
    pub origin: Vec3,
}

impl Timing {
    fn never(cost: Cost) -> Self {
        let never = f64::INFINITY;
        Self { free_until: never, touching_at: never, open_until: never, last: None, limit: None, cost }
    }
}

/// Two elements on their way.
pub(super) struct Pair<'a> {
    approach: &'a Approach<'a>,
    a: &'a Element<'a>,
    b: &'a Element<'a>,
    /// How far the points of each that matter are from their origins: of a wall, those of the other as seen from its origin.
    reaches: [f64; 2],
}

impl<'a> Pair<'a> {
    pub fn new(approach: &'a Approach<'a>, a: &'a Element<'a>, b: &'a Element<'a>) -> Self {
        let reach_a = if a.plane().is_some() { approach.farthest + b.reach } else { a.reach };
        let reach_b = if b.plane().is_some() { approach.farthest + a.reach } else { b.reach };
        Self { approach, a, b, reaches: [reach_a, reach_b] }
    }

    #[inline(never)]
    fn measure(&self, now: &Instant, goal: &Goal, cost: &mut Cost) -> Option<Separation> {
        let found = measure(self.a, self.b, now, self.reaches, goal)?;
        *cost += found.cost;
        Some(found)
    }

    /// For how long from `time` the elements are proved to stay apart, given what was measured then.
    #[inline(never)]
    fn free_for(&self, time: f64, now: &Instant, found: &Separation) -> (f64, Option<Forecast<'a>>) {
        let rest = rest_of(time);
        let forecast = Forecast::new(self.a, self.b, self.approach, now, self.reaches, found.normal);
        let planned = forecast.as_ref().map_or(0.0, |forecast| forecast.free_for(rest));
        // Whatever the direction, no two points close in faster than this.
        let anyhow = found.bracket.lower / self.approach.speed(self.reaches) * (1.0 - 8.0 * UNIT_ROUNDOFF);
        // Comparison order matters: bodies at rest have a quotient of infinity, or of zero and zero.
        let free = if anyhow > planned { anyhow } else { planned };
        (free.min(rest), forecast)
    }

    /// A time before which what is in two boxes is proved apart, at least `from` and infinite where it stays apart until `bound`.
    #[cfg(feature = "effect-motion")]
    pub fn arrival(&self, from: f64, bound: f64, asked: &Asked, cost: &mut Cost) -> f64 {
        let goal = asked.goal(Depth::Verdict);
        let mut time = from;
        for _ in 0..BOX_ROUNDS {
            let now = self.approach.at(time);
            let Some(found) = self.measure(&now, &goal, cost) else { return f64::INFINITY };
            if found.bracket.lower <= 0.0 {
                return time;
            }
            let (free, _) = self.free_for(time, &now, &found);
            if free >= rest_of(time) || time + free > bound {
                return f64::INFINITY;
            }
            let next = earlier(time + free).max(time);
            // What is gained gets less with every round.
            if next - time < 0.25 * (time - from) {
                return next;
            }
            time = next;
        }
        time
    }

    /// When they first touch, from a time on before which they are proved apart. Contacts later than `bound` do not matter.
    #[inline(never)]
    pub fn first_contact(&self, from: f64, bound: f64, asked: &Asked) -> Timing {
        let goal = asked.goal(Depth::Distance);
        let mut timing = Timing::never(Cost::default());
        let mut time = from;
        // A stretch that could not be decided.
        let mut open: Option<[f64; 2]> = None;
        // No early look for a contact before this time: the last one saw none.
        let mut looked_until = f64::NEG_INFINITY;
        let mut rounds = 0;
        while rounds < MOST_ROUNDS {
            rounds += 1;
            let now = self.approach.at(time);
            let Some(found) = self.measure(&now, &goal, &mut timing.cost) else { return timing };
            if found.termination == Termination::TimeLimit || (asked.stop)() {
                timing.limit = Some(Termination::TimeLimit);
                break;
            }
            if open.is_none() {
                timing.last = Some(Seen { separation: found, origin: now.origin });
            }
            if found.bracket.upper <= 0.0 {
                timing.touching_at = time;
                break;
            }
            let mut stride = asked.resolution;
            if found.bracket.lower > 0.0 {
                let (free, forecast) = self.free_for(time, &now, &found);
                if free >= rest_of(time) {
                    return closed(timing, open);
                }
                let next = earlier(time + free).max(time);
                if next > bound {
                    return closed(timing, open);
                }
                if next - time >= asked.resolution {
                    time = next;
                    continue;
                }
                // As far ahead as the gap and what rounding hides take to close, twice over.
                let noise = forecast.as_ref().map_or(0.0, Forecast::noise);
                let closing = forecast.as_ref().map_or(0.0, Forecast::closing);
                let ahead = 2.0 * (found.bracket.lower + NOISES * noise) / closing;
                stride = if ahead > 0.0 && ahead < 1.0 { ahead } else { asked.resolution };
                // With a gap that rounding does not hide, small steps are steps all the same.
                if found.bracket.lower > NOISES * noise && next > later(time, 0.0) {
                    if time >= looked_until {
                        let look = later(time, stride.min(asked.resolution));
                        rounds += 1;
                        let then = self.approach.at(look);
                        let Some(ahead) = self.measure(&then, &goal, &mut timing.cost) else { return timing };
                        if ahead.bracket.upper <= 0.0 {
                            timing.touching_at = look;
                            break;
                        }
                        looked_until = look;
                    }
                    time = next;
                    continue;
                }
            }
            // Nothing moves time any more: look on, in longer and longer strides, until one of the bounds decides.
            let start = open.map_or(time, |[start, _]| start);
            loop {
                let look = later(time, stride);
                open = Some([start, look]);
                rounds += 1;
                let then = self.approach.at(look);
                let Some(found) = self.measure(&then, &goal, &mut timing.cost) else { return timing };
                if found.bracket.upper <= 0.0 {
                    timing.touching_at = look;
                    break;
                }
                if found.bracket.lower > 0.0 || look >= 1.0 || look > bound || rounds >= MOST_ROUNDS {
                    time = look;
                    break;
                }
                stride *= 4.0;
            }
            if timing.touching_at <= 1.0 {
                break;
            }
            if time >= 1.0 || time > bound {
                return closed(timing, open);
            }
        }
        if timing.touching_at > 1.0 && timing.limit.is_none() {
            timing.limit = Some(Termination::IterationLimit);
        }
        timing.free_until = open.map_or(time, |[start, _]| start);
        // What a limit left undone may hold a contact, to the end.
        timing.open_until = if timing.limit.is_some() { 1.0 } else { timing.free_until };
        timing
    }
}

/// No contact was found: all is free but a stretch that may not be.
fn closed(timing: Timing, open: Option<[f64; 2]>) -> Timing {
    let Some([start, end]) = open else { return Timing { last: None, ..timing } };
    Timing { free_until: start, open_until: end, ..timing }
}

/// What is left of the motion, rounded up.
fn rest_of(time: f64) -> f64 {
    (1.0 - time).next_up()
}

/// A sum of times rounded down.
fn earlier(time: f64) -> f64 {
    time * (1.0 - 2.0 * UNIT_ROUNDOFF)
}

/// A time after this one by about `stride`, and by more than rounding.
fn later(time: f64, stride: f64) -> f64 {
    (time + stride.max(4.0 * f64::EPSILON * time)).min(1.0)
}
