//! Which bodies are held against a ray, a moving shape or a region, and with which margin: the filter, layers, masks and the
//! allowed-collision matrix.

use super::answer::Refused;
use super::context::Sieve;
use super::declared::{Coverage, declared_empty, effects_of};
use super::request::Context;
use crate::geometry::Shape;
use crate::narrow_phase::Solver;
use crate::scene::{Asker, Body, BodyId, Effects, Snapshot};

/// A request's context, checked against the scene.
pub(super) struct Opponents<'a> {
    pub snapshot: &'a Snapshot,
    pub context: &'a Context,
    sieve: Sieve<'a>,
}

impl<'a> Opponents<'a> {
    #[inline(never)]
    pub fn new(snapshot: &'a Snapshot, context: &'a Context) -> Result<Self, Refused> {
        Ok(Self { snapshot, context, sieve: Sieve::new(snapshot, context)? })
    }

    /// For questions in which pairs are not measured by one solver.
    pub fn without_solver(snapshot: &'a Snapshot, context: &'a Context) -> Result<Self, Refused> {
        if context.solver != Solver::Default {
            let problem = "has to be the default one: rays and motions are not measured by one solver".to_owned();
            return Err(Refused::Invalid { field: "context.solver".to_owned(), problem });
        }
        Self::new(snapshot, context)
    }

    /// Checks what the scene declares of these bodies, for a question that wants these effects beside what its context says.
    pub fn coverage(&self, bodies: impl Iterator<Item = BodyId>, besides: Effects) -> Result<Coverage, Refused> {
        if !self.snapshot.declares_effects() {
            return Ok(Coverage::default());
        }
        let bodies: Vec<BodyId> = bodies.collect();
        if bodies.is_empty() {
            return Ok(Coverage::default());
        }
        let wanted = effects_of(self.context.wants, self.context.margin).and(besides);
        let empty = declared_empty(self.snapshot, &Asker::Bodies(&bodies), self.context, wanted)?;
        Ok(Coverage::of(empty, self.context.max_pairs))
    }

    /// Whether the body takes part and may meet another one.
    pub fn may_meet(&self, own: &Body) -> bool {
        own.enabled && !self.snapshot.meets_no_body(own.member())
    }

    /// No pair has a larger margin; metres.
    pub fn largest_margin(&self, own: Option<&Body>) -> f64 {
        let of_scene = if own.is_some() { self.snapshot.largest_margin() } else { 0.0 };
        self.context.margin.max(of_scene)
    }

    /// The margin of a body against something that is not in the scene, or against the body `own`, if the pair is looked at; metres.
    #[inline(never)]
    pub fn margin(&self, own: Option<&Body>, other: &Body) -> Option<f64> {
        if !self.sieve.passes(other) {
            return None;
        }
        let Some(own) = own else {
            let filter = &self.context.filter;
            let (layers, mask) = (filter.layers.unwrap_or(u32::MAX), filter.mask.unwrap_or(u32::MAX));
            return other.meets(layers, mask).then_some(self.context.margin);
        };
        let admitted = if self.sieve.disregards_allowed_collisions() {
            let declared_empty = self.snapshot.is_declared_empty(own.member(), other.member());
            other.enabled && own.meets(other.layers, other.mask) && !declared_empty
        } else {
            self.snapshot.admits(own, other)
        };
        let margin = || self.snapshot.margin(own.member(), other.member()).unwrap_or(self.context.margin);
        (own.id != other.id && admitted).then(margin)
    }

    /// Why a shape without bounds cannot be held against the scene: a body without bounds that it would meet.
    pub fn unbounded_problem(&self, shape: &Shape, own: Option<&Body>) -> Option<String> {
        if shape.bounds().is_some() || own.is_some() {
            return None; // Two bodies without bounds are not a pair.
        }
        let met = |id: &&BodyId| self.snapshot.body(**id).is_some_and(|body| self.margin(None, body).is_some());
        let id = self.snapshot.unbounded().iter().find(met)?;
        let kind = shape.kind();
        Some(format!("a {kind} is unbounded, and so is body {id}: they have no signed distance"))
    }
}
