//! The search that every query is: look at pairs as long as one more can change the answer.
//!
//! The caller walks the broad phase and offers pairs; the search says how far the walk still has to reach. What is never offered, or never measured, is proved to be farther than what was
//! found, so the bracket of the minimum is the minimum of the brackets, whatever the order of the walk.

use super::answer::{PairAnswer, Side, Verdict, Witness};
use super::derivatives::{DerivativesOf, derivatives_of};
use super::patch::{PatchOf, patch_of};
use super::request::{Context, Wants};
use super::stage::Stage;
use crate::geometry::{Placement, Shape};
use crate::narrow_phase::{Bracket, Cost, Depth, Goal, NoSeparation, Separation, Unclaimed, separation};

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
    /// Every pair that is not proved farther than this is measured and listed; metres.
    within: Option<f64>,
    /// What makes patches, where they are wanted.
    patch: Option<PatchOf>,
    /// What makes derivatives, where they are wanted.
    derivatives: Option<DerivativesOf>,
    pub stop: &'a dyn Fn() -> bool,
}

impl<'a> Plan<'a> {
    pub fn new(context: &'a Context, wants: Wants, largest_scene_margin: f64, stop: &'a dyn Fn() -> bool) -> Self {
        let largest_margin = context.margin.max(largest_scene_margin);
        let wants = wants.closed();
        let (patch, derivatives) = (patch_of(wants), derivatives_of(wants));
        Self { context, wants, largest_margin, within: None, patch, derivatives, stop }
    }

    /// The same, with every pair listed that is not proved farther than `within` metres, if that is said.
    pub fn listing(self, within: Option<f64>) -> Self {
        Self { within, ..self }
    }

    /// Gives derivatives to pairs that are told, where they are wanted. Those of pairs that were told before, as nearest ones, are theirs.
    pub fn derive(&self, pairs: &mut [PairAnswer], told: [Option<&PairAnswer>; 2], stage: &Stage, cost: &mut Cost) {
        let Some(derivatives) = self.derivatives else { return };
        for pair in pairs {
            let before = told.into_iter().flatten().find(|before| sides(before) == sides(pair));
            pair.derivatives = match before {
                Some(before) => before.derivatives.clone(),
                None => derivatives(pair, stage, self.context, self.stop, cost),
            };
        }
    }

    fn depth(&self) -> Depth {
        match (self.wants.depth, self.wants.distance) {
            (true, _) => Depth::Penetration,
            (false, true) => Depth::Distance,
            (false, false) => Depth::Verdict,
        }
    }

    fn cut_off(&self) -> f64 {
        let asked = if self.wants.distance { self.context.cut_off.unwrap_or(f64::INFINITY) } else { 0.0 };
        self.within.unwrap_or(asked)
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
    /// Gravest verdict, then least sides: what decided when only a verdict was wanted. A collision ends such a search, so
    /// it is the first one met: boxes in the order of their distance, then of their bodies' ids.
    decider: Option<PairAnswer>,
    pairs: Vec<PairAnswer>,
    truncated: bool,
    /// The first pair that the solver does not take: then there is no answer.
    unclaimed: Option<Unclaimed>,
    pub cost: Cost,
}

/// What a search ends with.
pub(super) struct Found {
    pub verdict: Verdict,
    /// The solver does not take one of the pairs, so there is no answer.
    pub unclaimed: Option<Unclaimed>,
    /// Of the minimum over all pairs measured.
    bracket: Bracket,
    /// The pair of the minimum, or the one that decided.
    pub nearest: Option<PairAnswer>,
    pub pairs: Vec<PairAnswer>,
    pub truncated: bool,
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
            truncated: false,
            unclaimed: None,
            cost: Cost::default(),
        }
    }

    /// Pairs whose boxes are farther apart than this need not be offered, metres; negative when nothing can change the
    /// answer any more.
    pub fn reach(&self) -> f64 {
        if self.is_settled() {
            return -1.0;
        }
        let for_distance = self.matters_up_to().max(0.0);
        if self.margins_matter() { for_distance.max(self.plan.largest_margin) } else { for_distance }
    }

    /// Whether what is found may shorten the reach: not where every pair within a distance is listed.
    pub fn may_narrow(&self) -> bool {
        self.plan.within.is_none()
    }

    /// Whether more pairs cannot change the answer, or the time for them has run out: an item that was cut short is not
    /// answered at all.
    pub fn is_settled(&self) -> bool {
        let only_verdict = !self.plan.wants.distance && !self.plan.wants.pairs;
        (only_verdict && self.verdict == Verdict::Collision) || self.unclaimed.is_some() || (self.plan.stop)()
    }

    /// Measures a pair as far as it matters. `margin` is the pair's own.
    ///
    /// Pairs are not put off to be sorted by their kinds: what one answer says narrows the next question, and where it does
    /// not, as in a list without distances, the next pair of a body finds it in the caches, which saves more than equal kinds
    /// do (`docs/queries.md`).
    pub fn offer(&mut self, a: &Party, b: &Party, margin: f64) {
        if self.is_settled() {
            return;
        }
        let matters_up_to = self.matters_up_to();
        let goal = Goal {
            depth: self.plan.depth(),
            accuracy: self.plan.context.accuracy,
            solver: self.plan.context.solver,
            margin,
            // Beyond its own margin a pair needs no more than the proof that it is beyond. A cut-off that is not positive
            // would say that the pair's own contact is of no interest.
            cut_off: if self.margins_matter() {
                matters_up_to.max(margin).max(f64::MIN_POSITIVE)
            } else {
                matters_up_to
            },
            stop: self.plan.stop,
        };
        match separation(a.shape, b.shape, a.at, b.at, &goal) {
            Ok(found) => self.take(&found, a, b, margin),
            // A pair of two unbounded shapes has no distance, nor has one with nothing in it, and is left out.
            Err(NoSeparation::Unbounded { .. } | NoSeparation::Empty { .. }) => (),
            Err(NoSeparation::Unclaimed(unclaimed)) => self.unclaimed = Some(unclaimed),
        }
    }

    /// What is proved farther than this needs no distance, metres.
    fn matters_up_to(&self) -> f64 {
        match self.plan.within {
            Some(within) => within,
            None => self.plan.cut_off().min(self.bracket.upper),
        }
    }

    /// A collision outranks every margin; only a list of pairs still needs them.
    fn margins_matter(&self) -> bool {
        self.plan.wants.pairs || self.verdict != Verdict::Collision
    }

    fn take(&mut self, found: &Separation, a: &Party, b: &Party, margin: f64) {
        self.cost += found.cost;
        let verdict = Verdict::of(&found.bracket, margin, found.termination);
        // Points of an overlap that was only proved are not where it is deepest.
        let measured = self.plan.wants.depth || found.bracket.upper > 0.0;
        let mut answer = PairAnswer {
            a: a.side.with_subshape(found.subshape_a),
            b: b.side.with_subshape(found.subshape_b),
            verdict,
            bracket: found.bracket,
            signed_distance: found.signed_distance,
            witness: (self.plan.wants.witness && measured).then_some(Witness {
                point_on_a: found.point_on_a,
                point_on_b: found.point_on_b,
                normal: found.normal,
                point_error: found.point_error,
                normal_error: found.normal_error,
            }),
            patch: None,
            derivatives: None,
            termination: found.termination,
        };
        self.bracket = union(self.bracket, found.bracket);
        self.verdict = self.verdict.and(verdict);
        let listed = match self.plan.within {
            Some(within) => found.bracket.lower <= within,
            None => self.plan.wants.pairs && verdict != Verdict::Free,
        };
        let (best, comes_first): (_, fn(&PairAnswer, &PairAnswer) -> bool) =
            if self.plan.wants.distance { (&self.nearest, is_nearer) } else { (&self.decider, is_graver) };
        let leads = best.as_ref().is_none_or(|best| comes_first(&answer, best));
        // Only of a pair that may be told, and now, while its shapes are at hand.
        if let Some(patch) = self.plan.patch
            && verdict != Verdict::Free
            && (listed || leads)
        {
            answer.patch = patch([(a.shape, a.at), (b.shape, b.at)], found, margin, self.plan.context, &mut self.cost);
        }
        if listed {
            self.list(answer.clone());
        }
        if leads {
            *(if self.plan.wants.distance { &mut self.nearest } else { &mut self.decider }) = Some(answer);
        }
    }

    /// Keeps a pair for the list; those that the limit will cut off are dropped now and then, so that the list stays short.
    fn list(&mut self, pair: PairAnswer) {
        self.pairs.push(pair);
        if self.pairs.len().saturating_sub(64) / 2 > self.plan.context.max_pairs {
            self.shorten();
        }
    }

    /// The list in the order of its sides, cut to the limit.
    fn shorten(&mut self) {
        self.truncated |= shorten(&mut self.pairs, self.plan.context.max_pairs);
    }

    /// The verdict, and what was wanted beside it. With a stage the nearest pair has its derivatives; [`Plan::derive`] gives them to those of the
    /// list, once that is cut.
    pub fn finish(mut self, stage: Option<&Stage>) -> Found {
        self.shorten();
        let bracket = self.bracket;
        let nearest = if self.plan.wants.distance {
            // Only what is proved to be beyond the cut-off is left away.
            let within = bracket.lower <= self.plan.cut_off();
            // The minimum is bracketed by all pairs together; the pair it is told by has its own proof in it.
            let mut nearest = self.nearest.filter(|_| within);
            if let (Some(pair), Some(stage), None) = (&mut nearest, stage, &self.unclaimed) {
                self.plan.derive(std::slice::from_mut(pair), [None; 2], stage, &mut self.cost);
            }
            nearest.map(|pair| PairAnswer { bracket, ..pair })
        } else {
            self.decider.filter(|pair| pair.verdict != Verdict::Free)
        };
        let (verdict, pairs, truncated, cost) = (self.verdict, self.pairs, self.truncated, self.cost);
        Found { verdict, unclaimed: self.unclaimed, bracket, nearest, pairs, truncated, cost }
    }
}

impl Found {
    /// The answer over the pairs of both searches, which asked the same.
    pub fn and(self, other: Self, plan: &Plan) -> Self {
        let bracket = union(self.bracket, other.bracket);
        let comes_first = if plan.wants.distance { is_nearer } else { is_graver };
        let nearest = match (self.nearest, other.nearest) {
            (Some(one), Some(two)) => Some(if comes_first(&two, &one) { two } else { one }),
            (one, two) => one.or(two),
        };
        let nearest = nearest.map(|pair| if plan.wants.distance { PairAnswer { bracket, ..pair } } else { pair });
        let mut pairs = self.pairs;
        pairs.extend(other.pairs);
        let truncated = shorten(&mut pairs, plan.context.max_pairs) | self.truncated | other.truncated;
        let mut cost = self.cost;
        cost += other.cost;
        let unclaimed = self.unclaimed.or(other.unclaimed);
        Self { verdict: self.verdict.and(other.verdict), unclaimed, bracket, nearest, pairs, truncated, cost }
    }
}

/// Bracket of the lesser of two distances.
fn union(one: Bracket, two: Bracket) -> Bracket {
    Bracket { lower: one.lower.min(two.lower), upper: one.upper.min(two.upper) }
}

/// Less signed distance, then lesser sides.
fn is_nearer(one: &PairAnswer, two: &PairAnswer) -> bool {
    let order = one.signed_distance.total_cmp(&two.signed_distance);
    order.then_with(|| sides(one).cmp(&sides(two))).is_lt()
}

/// Graver verdict, then lesser sides.
fn is_graver(one: &PairAnswer, two: &PairAnswer) -> bool {
    if one.verdict == two.verdict { sides(one) < sides(two) } else { one.verdict.and(two.verdict) == one.verdict }
}

fn sides(pair: &PairAnswer) -> (&Side, &Side) {
    (&pair.a, &pair.b)
}

/// Sorts pairs by their sides and cuts them to `most`; says whether that cut any off.
fn shorten(pairs: &mut Vec<PairAnswer>, most: usize) -> bool {
    pairs.sort_by(|one, two| sides(one).cmp(&sides(two)));
    let cut = pairs.len() > most;
    pairs.truncate(most);
    cut
}
