//! The search that every query is: look at pairs as long as one more can change the answer.
//!
//! The caller walks the broad phase and offers pairs together with a lower bound of their distance; the search says how
//! far the walk still has to reach. What is never offered, or never measured, is proved to be farther than what was
//! found, so the bracket of the minimum is the minimum of the brackets, whatever the order of the walk.

use super::answer::{PairAnswer, Side, Verdict, Witness};
use super::request::{Context, Wants};
use crate::geometry::{Placement, Shape};
use crate::narrow_phase::{Bracket, Cost, Depth, Goal, Separation, separation};

/// A placed shape and the side of a pair it stands for. The side's subshape is filled in from what is found.
#[derive(Clone)]
pub(super) struct Party<'a> {
    pub side: Side,
    pub shape: &'a Shape,
    pub at: &'a Placement,
}

/// What a request asks of every pair.
pub(super) struct Plan<'a> {
    pub context: &'a Context,
    pub wants: Wants,
    /// No pair has a larger margin; metres.
    pub largest_margin: f64,
    pub stop: &'a dyn Fn() -> bool,
}

impl<'a> Plan<'a> {
    pub fn new(context: &'a Context, wants: Wants, largest_scene_margin: f64, stop: &'a dyn Fn() -> bool) -> Self {
        let largest_margin = context.margin.max(largest_scene_margin);
        Self { context, wants: wants.closed(), largest_margin, stop }
    }

    fn depth(&self) -> Depth {
        match (self.wants.depth, self.wants.distance) {
            (true, _) => Depth::Penetration,
            (false, true) => Depth::Distance,
            (false, false) => Depth::Verdict,
        }
    }

    fn cut_off(&self) -> f64 {
        if self.wants.distance { self.context.cut_off.unwrap_or(f64::INFINITY) } else { 0.0 }
    }
}

/// What has been found among the pairs offered so far.
pub(super) struct Search<'a> {
    plan: &'a Plan<'a>,
    /// The pair of least signed distance, by its sides among equals.
    nearest: Option<PairAnswer>,
    /// Bracket of the minimum over all pairs measured.
    bracket: Bracket,
    verdict: Verdict,
    /// Gravest verdict, then least sides: what decided when only a verdict was wanted.
    decider: Option<PairAnswer>,
    pairs: Vec<PairAnswer>,
    pub cost: Cost,
}

/// What a search ends with.
pub(super) struct Found {
    pub verdict: Verdict,
    pub nearest: Option<PairAnswer>,
    pub pairs: Vec<PairAnswer>,
    pub cost: Cost,
}

impl<'a> Search<'a> {
    pub fn new(plan: &'a Plan<'a>) -> Self {
        Self {
            plan,
            nearest: None,
            bracket: Bracket { lower: f64::INFINITY, upper: f64::INFINITY },
            verdict: Verdict::Free,
            decider: None,
            pairs: Vec::new(),
            cost: Cost::default(),
        }
    }

    /// Pairs whose boxes are farther apart than this need not be offered, metres; negative when nothing can change the
    /// answer any more.
    pub fn reach(&self) -> f64 {
        if self.is_settled() {
            return -1.0;
        }
        let for_distance = self.plan.cut_off().min(self.bracket.upper).max(0.0);
        // A collision outranks every margin; only a list of pairs still needs them.
        let margins_matter = self.plan.wants.pairs || self.verdict != Verdict::Collision;
        if margins_matter { for_distance.max(self.plan.largest_margin) } else { for_distance }
    }

    /// Whether more pairs cannot change the answer, or the time for them has run out: an item that was cut short is not
    /// answered at all.
    pub fn is_settled(&self) -> bool {
        let only_verdict = !self.plan.wants.distance && !self.plan.wants.pairs;
        (only_verdict && self.verdict == Verdict::Collision) || (self.plan.stop)()
    }

    /// Measures a pair as far as it matters. `margin` is the pair's own. A pair of two unbounded shapes is left out.
    pub fn offer(&mut self, a: &Party, b: &Party, margin: f64) {
        let matters_up_to = self.plan.cut_off().min(self.bracket.upper);
        let goal = Goal {
            depth: self.plan.depth(),
            accuracy: self.plan.context.accuracy,
            margin,
            // Beyond its own margin a pair needs no more than the proof that it is beyond.
            cut_off: matters_up_to.max(if self.margin_matters() { margin } else { f64::NEG_INFINITY }),
            stop: self.plan.stop,
        };
        if let Ok(found) = separation(a.shape, b.shape, a.at, b.at, &goal) {
            self.take(&found, a, b, margin);
        }
    }

    fn margin_matters(&self) -> bool {
        self.plan.wants.pairs || self.verdict != Verdict::Collision
    }

    fn take(&mut self, found: &Separation, a: &Party, b: &Party, margin: f64) {
        self.cost += found.cost;
        let verdict = Verdict::of(&found.bracket, margin, found.termination);
        let answer = || PairAnswer {
            a: a.side.with_subshape(found.subshape_a),
            b: b.side.with_subshape(found.subshape_b),
            verdict,
            bracket: found.bracket,
            signed_distance: found.signed_distance,
            witness: self.plan.wants.witness.then_some(Witness {
                point_on_a: found.point_on_a,
                point_on_b: found.point_on_b,
                normal: found.normal,
            }),
            termination: found.termination,
        };
        self.bracket.lower = self.bracket.lower.min(found.bracket.lower);
        self.bracket.upper = self.bracket.upper.min(found.bracket.upper);
        if self.plan.wants.distance {
            let is_nearer = |best: &PairAnswer| {
                let order = found.signed_distance.total_cmp(&best.signed_distance);
                order.then_with(|| (&a.side, &b.side).cmp(&(&best.a, &best.b))).is_lt()
            };
            if self.nearest.as_ref().is_none_or(is_nearer) {
                self.nearest = Some(answer());
            }
        } else if verdict != Verdict::Free {
            let graver = |best: &PairAnswer| verdict != best.verdict && best.verdict.and(verdict) == verdict;
            if self.decider.as_ref().is_none_or(graver) {
                self.decider = Some(answer());
            }
        }
        if self.plan.wants.pairs && verdict != Verdict::Free {
            let answer = answer();
            self.pairs.push(answer);
        }
        self.verdict = self.verdict.and(verdict);
    }

    /// The verdict, and what was wanted beside it.
    pub fn finish(self) -> Found {
        let within = |p: &PairAnswer| p.signed_distance <= self.plan.cut_off();
        let nearest = match self.nearest.filter(within) {
            // The minimum is bracketed by all pairs together; the pair by which it is told has its own proof in it.
            Some(pair) => Some(PairAnswer {
                signed_distance: pair.signed_distance.clamp(self.bracket.lower, self.bracket.upper),
                bracket: self.bracket,
                ..pair
            }),
            None => self.decider,
        };
        Found { verdict: self.verdict, nearest, pairs: self.pairs, cost: self.cost }
    }
}

impl Found {
    /// The answer over the pairs of both searches.
    pub fn and(self, other: Self) -> Self {
        let verdict = self.verdict.and(other.verdict);
        let nearest = match (self.nearest, other.nearest) {
            (Some(one), Some(two)) => Some(nearer(one, two)),
            (one, two) => one.or(two),
        };
        let mut pairs = self.pairs;
        pairs.extend(other.pairs);
        let mut cost = self.cost;
        cost += other.cost;
        Self { verdict, nearest, pairs, cost }
    }
}

/// The nearer of two minima over different pairs, with the bracket of both together.
fn nearer(one: PairAnswer, two: PairAnswer) -> PairAnswer {
    let bracket =
        Bracket { lower: one.bracket.lower.min(two.bracket.lower), upper: one.bracket.upper.min(two.bracket.upper) };
    let order = one.signed_distance.total_cmp(&two.signed_distance);
    let first = if order.then_with(|| (&one.a, &one.b).cmp(&(&two.a, &two.b))).is_le() { one } else { two };
    PairAnswer { signed_distance: first.signed_distance.clamp(bracket.lower, bracket.upper), bracket, ..first }
}
