//! Which part of one motion is proved free? Bisection in time, coarse to fine, until every pair is settled everywhere.
//!
//! States are measured at both ends of an interval. A pair is proved on the whole of it when its two distances together
//! are more than its parts can move in that time (Schwarzer, Saha, Latombe 2005, with proved lower bounds of distances);
//! it is then not looked at again in there. The others go on to both halves. Intervals wait in a queue: all of one
//! length before the shorter ones, earlier ones first, so that a contact that lasts is met after a few states.

use std::collections::VecDeque;

use super::motion_measure::{Gauge, Measured};

/// How far proofs have to go.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rules {
    /// Metres: see [`super::CheckMotions::resolution`].
    pub resolution: f64,
    pub max_states: u64,
    /// Contacts are bracketed; else the first that is met ends the work.
    pub locate: bool,
}

/// Why something was left open.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Open {
    Resolution,
    Rounding,
    States,
}

/// A state that ends the way, and the pair that does it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Event {
    pub t: f64,
    pub subject: u32,
}

/// What is known of a motion.
#[derive(Clone, Copy, Debug)]
pub(super) struct Outcome {
    /// All before this is proved farther than the margin.
    pub free_until: f64,
    /// All before this is proved apart.
    pub apart_until: f64,
    /// The earliest state known to be in collision.
    pub collision: Option<Event>,
    /// The earliest state known to be within a margin, or in collision.
    pub within: Option<Event>,
    /// The first interval that is not proved apart; without a collision it is what makes the motion undecided.
    pub not_apart: Option<Undecided>,
    /// The first interval that is not proved farther than the margin.
    pub not_free: Option<Undecided>,
    pub states: u64,
    pub intervals: u64,
}

/// An interval that was given up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Undecided {
    pub t: [f64; 2],
    pub subject: u32,
    pub why: Open,
}

/// A stretch of time whose ends were measured.
struct Interval {
    t: [f64; 2],
    pairs: Vec<Waiting>,
}

/// A pair that is not proved on an interval yet.
#[derive(Clone, Copy)]
pub(super) struct Waiting {
    pub subject: u32,
    /// How fast its parts move towards each other at most in the interval, metres per unit of t.
    pub speed: f64,
    /// How far apart they are at both ends at least, less what rounding may hide; metres.
    pub apart: [f64; 2],
    /// The same less the margin.
    pub free: [f64; 2],
}

/// Below this length halves of an interval are no longer told apart safely.
const SHORTEST: f64 = 1.0 / (1u64 << 40) as f64;

/// Products of a speed and a time are rounded up by this factor.
const ROUNDING_UP: f64 = 1.0 + 4.0 * f64::EPSILON;

/// Finds out. None: the gauge was told to stop.
pub(super) fn explore(gauge: &mut Gauge, rules: &Rules) -> Option<Outcome> {
    let mut course = Course {
        rules,
        queue: VecDeque::new(),
        outcome: Outcome {
            free_until: 1.0,
            apart_until: 1.0,
            collision: None,
            within: None,
            not_apart: None,
            not_free: None,
            states: 0,
            intervals: 0,
        },
    };
    course.begin(gauge)?;
    while let Some(interval) = course.queue.pop_front() {
        if course.is_decided() || course.outcome.states >= rules.max_states {
            course.leave(&interval, Open::States);
        } else if course.needs_apart(interval.t[0]) {
            course.halve(&interval, gauge)?;
        }
    }
    Some(course.finish())
}

struct Course<'r> {
    rules: &'r Rules,
    queue: VecDeque<Interval>,
    outcome: Outcome,
}

impl Course<'_> {
    /// Both ends of the whole motion.
    fn begin(&mut self, gauge: &mut Gauge) -> Option<()> {
        gauge.stand(0.0, 1.0, None);
        let mut pairs: Vec<Waiting> = Vec::new();
        for subject in gauge.subjects() {
            let speed = gauge.speed(subject);
            let measured = self.measure(gauge, 0.0, subject, speed * ROUNDING_UP, true)?;
            let pair = Waiting {
                subject,
                speed,
                apart: [measured.apart, f64::NEG_INFINITY],
                free: [measured.free, f64::NEG_INFINITY],
            };
            if !(pair.free[0] > speed * ROUNDING_UP) {
                pairs.push(pair);
            }
            if !self.needs_apart(0.0) {
                break; // In collision at the start: there is no way to look at.
            }
        }
        self.outcome.states += 1;
        let mut whole = Interval { t: [0.0, 1.0], pairs };
        if self.needs_apart(0.0) && !whole.pairs.is_empty() {
            gauge.stand(1.0, 1.0, Some(&whole.pairs));
            self.outcome.states += 1;
            for pair in &mut whole.pairs {
                if self.is_decided() {
                    break;
                }
                pair.speed = pair.speed.min(gauge.speed(pair.subject));
                let need = pair.speed * ROUNDING_UP - pair.free[0].max(0.0);
                let measured = self.measure(gauge, 1.0, pair.subject, need, true)?;
                (pair.apart[1], pair.free[1]) = (measured.apart, measured.free);
            }
        }
        self.settle(whole);
        Some(())
    }

    /// Measures the middle of an interval, and passes on what is left of it.
    fn halve(&mut self, interval: &Interval, gauge: &mut Gauge) -> Option<()> {
        let [a, b] = interval.t;
        let m = 0.5 * (a + b);
        let half = 0.5 * (b - a);
        gauge.stand(m, half, Some(&interval.pairs));
        self.outcome.states += 1;
        let (mut left, mut right) = (Vec::new(), Vec::new());
        for pair in &interval.pairs {
            if self.is_decided() {
                // The rest of the pairs is not proved anywhere in the interval.
                left.push(*pair);
                right.push(*pair);
                continue;
            }
            let speed = pair.speed.min(gauge.speed(pair.subject));
            let with_margin = self.needs_free(a);
            let known = if with_margin { pair.free } else { pair.apart };
            let need = speed * half * ROUNDING_UP - known[0].min(known[1]).max(0.0);
            let measured = self.measure(gauge, m, pair.subject, need, with_margin)?;
            left.push(Waiting {
                speed,
                apart: [pair.apart[0], measured.apart],
                free: [pair.free[0], measured.free],
                ..*pair
            });
            right.push(Waiting {
                speed,
                apart: [measured.apart, pair.apart[1]],
                free: [measured.free, pair.free[1]],
                ..*pair
            });
        }
        self.settle(Interval { t: [a, m], pairs: left });
        self.settle(Interval { t: [m, b], pairs: right });
        Some(())
    }

    fn measure(&mut self, gauge: &mut Gauge, t: f64, subject: u32, need: f64, with_margin: bool) -> Option<Measured> {
        let measured = gauge.measure(subject, need, with_margin)?;
        let event = Event { t, subject };
        let earlier = |known: Option<Event>| known.filter(|known| known.t <= t).or(Some(event));
        if measured.collides {
            self.outcome.collision = earlier(self.outcome.collision);
        }
        if measured.collides || measured.within {
            self.outcome.within = earlier(self.outcome.within);
        }
        Some(measured)
    }

    /// Takes away what is proved on an interval or has to be left open there, and queues it if there is more.
    fn settle(&mut self, mut interval: Interval) {
        self.outcome.intervals += 1;
        let [a, b] = interval.t;
        if !self.needs_apart(a) {
            return;
        }
        let needs_free = self.needs_free(a);
        let mut pairs = std::mem::take(&mut interval.pairs);
        pairs.retain(|pair| {
            let moved = pair.speed * (b - a) * ROUNDING_UP;
            let proved =
                |known: [f64; 2]| known[0].max(0.0) + known[1].max(0.0) > moved && known[0].max(known[1]) > 0.0;
            if proved(pair.free) {
                return false;
            }
            let apart = proved(pair.apart);
            let given_up = moved <= self.rules.resolution || b - a <= SHORTEST;
            if !given_up && (needs_free || !apart) {
                return true;
            }
            let why = |known: [f64; 2]| {
                if known[0].max(known[1]) <= 0.0 || moved > self.rules.resolution {
                    Open::Rounding
                } else {
                    Open::Resolution
                }
            };
            let undecided = |known| Undecided { t: [a, b], subject: pair.subject, why: why(known) };
            earliest(&mut self.outcome.not_free, undecided(pair.free));
            if !apart {
                earliest(&mut self.outcome.not_apart, undecided(pair.apart));
            }
            false
        });
        if !pairs.is_empty() {
            self.queue.push_back(Interval { pairs, ..interval });
        }
    }

    /// Notes an interval that is not looked at any more.
    fn leave(&mut self, interval: &Interval, why: Open) {
        let Some(pair) = interval.pairs.first() else { return };
        let undecided = Undecided { t: interval.t, subject: pair.subject, why };
        earliest(&mut self.outcome.not_free, undecided);
        earliest(&mut self.outcome.not_apart, undecided);
    }

    /// Whether a contact ends the work.
    fn is_decided(&self) -> bool {
        !self.rules.locate && self.outcome.collision.is_some()
    }

    /// Whether it matters that the time after `a` is proved apart.
    fn needs_apart(&self, a: f64) -> bool {
        self.outcome.collision.is_none_or(|hit| a < hit.t.min(start_of(self.outcome.not_apart)))
    }

    /// Whether it matters that the time after `a` is proved farther than the margin.
    fn needs_free(&self, a: f64) -> bool {
        let bracketed = |within: Event| self.rules.locate && a < within.t.min(start_of(self.outcome.not_free));
        self.outcome.within.is_none_or(bracketed)
    }

    fn finish(self) -> Outcome {
        let mut outcome = self.outcome;
        let at = |event: Option<Event>| event.map_or(1.0, |event| event.t);
        outcome.free_until = start_of(outcome.not_free).min(at(outcome.within)).min(1.0);
        outcome.apart_until = start_of(outcome.not_apart).min(at(outcome.collision)).min(1.0);
        outcome
    }
}

fn start_of(undecided: Option<Undecided>) -> f64 {
    undecided.map_or(f64::INFINITY, |undecided| undecided.t[0])
}

fn earliest(known: &mut Option<Undecided>, undecided: Undecided) {
    if undecided.t[0] < start_of(*known) {
        *known = Some(undecided);
    }
}
