//! Answers about rays, motions, regions and neighbours. Sorted and deterministic, as all answers.

use super::answer::{Indeterminacy, PairAnswer, Verdict};
use super::declared::Coverage;
use crate::geometry::Vec3;
use crate::narrow_phase::{Cost, Termination};
use crate::scene::{BodyId, Epoch, Revision};

/// What was proved of a ray or a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CastVerdict {
    /// It meets nothing, all the way.
    Clear,
    /// It meets something.
    Hit,
    /// Neither was proved.
    Indeterminate(Indeterminacy),
    /// Not looked at: the time ran out.
    NotRun,
    /// The item cannot be asked.
    InvalidInput,
}

/// A body that is met. Places on the way are metres along a ray, parts of a motion in `0..=1`.
#[derive(Clone, Debug, PartialEq)]
pub struct CastHit {
    /// Which.
    pub body: BodyId,
    /// Its triangle or part; 0 for a single convex shape.
    pub subshape: u32,
    /// That of the moving shape; of a ray 0.
    pub own_subshape: u32,
    /// It is proved not to be met before.
    pub lower: f64,
    /// It is proved to be met by then.
    pub upper: f64,
    /// It is met from the beginning: a solid holds the origin of the ray, or the bodies are within the margin at the start.
    pub at_start: bool,
    /// On the body, world, metres: the best estimate.
    pub point: Vec3,
    /// Unit vector out of the body, to where the ray or the moving shape comes from; world.
    pub normal: Vec3,
}

/// A body that may be met, or passed by a hair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grazed {
    /// Which.
    pub body: BodyId,
    /// It is proved not to be met before.
    pub lower: f64,
    /// After this it is proved to be apart again, as far as the answer reaches.
    pub upper: f64,
    /// Why it could not be decided.
    pub why: Indeterminacy,
}

/// The answer to one ray, motion or moving pair.
#[derive(Clone, Debug, PartialEq)]
pub struct CastItem {
    /// Over all bodies.
    pub verdict: CastVerdict,
    /// Nothing is met before this, proved; the whole way when clear. Zero where any hit was asked for and there is one.
    pub free_until: f64,
    /// As the mode asks, in the order of their upper ends, then of their bodies. The first one is bracketed with all others: the earliest hit of
    /// all is in `free_until..=hits[0].upper`.
    pub hits: Vec<CastHit>,
    /// Bodies that may be met before the hit that is told, or, without one or where all are told, anywhere; in the order of their lower
    /// ends, then of their bodies.
    pub grazed: Vec<Grazed>,
    /// There were more hits or grazed bodies than the limit lets through.
    pub truncated: bool,
    /// Of an invalid item: which field, and what is wrong with it.
    pub problem: Option<String>,
    /// What it cost.
    pub cost: Cost,
}

impl CastItem {
    pub(super) fn without_work(verdict: CastVerdict) -> Self {
        Self {
            verdict,
            free_until: 0.0,
            hits: Vec::new(),
            grazed: Vec::new(),
            truncated: false,
            problem: None,
            cost: Cost::default(),
        }
    }

    pub(super) fn invalid(problem: String) -> Self {
        Self { problem: Some(problem), ..Self::without_work(CastVerdict::InvalidInput) }
    }
}

/// A body in a region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overlapping {
    /// Which.
    pub body: BodyId,
    /// `Collision`, `Margin` or `Indeterminate`; by bounds alone `NotRun`.
    pub verdict: Verdict,
}

/// The answer to one region.
#[derive(Clone, Debug, PartialEq)]
pub struct OverlapItem {
    /// The first that applies to any body in the order collision, indeterminate, margin, free; by bounds alone `NotRun` where any are told.
    pub verdict: Verdict,
    /// In the order of their ids.
    pub bodies: Vec<Overlapping>,
    /// There were more than the limit lets through.
    pub truncated: bool,
    /// Of an invalid item: which field, and what is wrong with it.
    pub problem: Option<String>,
    /// What it cost.
    pub cost: Cost,
}

impl OverlapItem {
    pub(super) fn without_work(verdict: Verdict) -> Self {
        Self { verdict, bodies: Vec::new(), truncated: false, problem: None, cost: Cost::default() }
    }
}

/// The answer to one question for the nearest.
#[derive(Clone, Debug, PartialEq)]
pub struct NearestItem {
    /// Over all bodies that are told.
    pub verdict: Verdict,
    /// In the order of their signed distances, then of their sides.
    pub nearest: Vec<PairAnswer>,
    /// Every body that is not told is proved to be no nearer than any that is.
    pub set_is_proved: bool,
    /// No two of those told could change places: their brackets do not overlap.
    pub order_is_proved: bool,
    /// Of an invalid item: which field, and what is wrong with it.
    pub problem: Option<String>,
    /// What it cost.
    pub cost: Cost,
}

impl NearestItem {
    pub(super) fn without_work(verdict: Verdict) -> Self {
        Self {
            verdict,
            nearest: Vec::new(),
            set_is_proved: false,
            order_is_proved: false,
            problem: None,
            cost: Cost::default(),
        }
    }
}

/// The answers to a batch.
#[derive(Clone, Debug, PartialEq)]
pub struct Answers<T> {
    /// Which life of the scene was asked.
    pub epoch: Epoch,
    /// Which state of it.
    pub revision: Revision,
    /// One for each item, in order.
    pub items: Vec<T>,
    /// The time ran out before every item was looked at; those are not run.
    pub out_of_time: bool,
    /// How many items were looked at.
    pub answered: usize,
    /// What none of the items says anything about.
    pub coverage: Coverage,
}

/// Why something was left open, by what ended the work.
pub(super) fn why(termination: Termination) -> Indeterminacy {
    match termination {
        Termination::TimeLimit => Indeterminacy::TimeLimit,
        Termination::IterationLimit => Indeterminacy::IterationLimit,
        Termination::ClosedForm
        | Termination::Converged
        | Termination::Decided
        | Termination::RoundingFloor
        | Termination::Exact => Indeterminacy::Rounding,
    }
}
