//! Shapes made of many convex pieces: meshes, compounds, and whatever stands against them.
//!
//! The signed distance is the minimum over pairs of pieces. Everything is in the first shape's frame, so that a pair far
//! from the origin is as accurate as one near it. What boxes prove to be farther than the answer is not looked at, so the
//! bracket of the minimum is the minimum of the brackets.

use super::goal::{Depth, Goal};
use super::outcome::{Bracket, Cost, Separation, Termination};
use super::pieces::{Piece, least_of_pieces, mesh_of, simple_pair};
use super::solid::with_containment;
use super::walk::walk;

/// The least over all pairs of pieces, as far as the goal needs it; none for a pair of unbounded pieces.
pub(super) fn separation(a: &[Piece], b: &[Piece], goal: &Goal) -> Option<Separation> {
    let mut least = Least::new(goal);
    for pa in a {
        for pb in b {
            if least.leaves_out(least_of_pieces(pa, pb)) {
                continue;
            }
            let asked = least.goal();
            let surfaces = if mesh_of(pa).is_some() || mesh_of(pb).is_some() {
                walk(pa, pb, &asked)
            } else {
                simple_pair(pa, pb, &asked)
            };
            let Some(found) = surfaces.map(|surfaces| with_containment(surfaces, pa, pb, goal)) else { continue };
            // Of a compound the part is named, of a lone mesh the triangle.
            let name = |pieces: &[Piece], part, subshape| if pieces.len() > 1 { part } else { subshape };
            let (subshape_a, subshape_b) = (name(a, pa.part, found.subshape_a), name(b, pb.part, found.subshape_b));
            least.take(Separation { subshape_a, subshape_b, ..found });
        }
    }
    least.finish()
}

/// The least separation seen so far, and what is proved of the pairs that were not looked at.
pub(super) struct Least<'a> {
    asked: &'a Goal<'a>,
    best: Option<Separation>,
    lower: f64,
    upper: f64,
    pub cost: Cost,
    /// The gravest limit that any pair met: time after the cap on iterations.
    limit: Option<Termination>,
}

impl<'a> Least<'a> {
    pub fn new(asked: &'a Goal<'a>) -> Self {
        Self { asked, best: None, lower: f64::INFINITY, upper: f64::INFINITY, cost: Cost::default(), limit: None }
    }

    /// What the next pair is asked: nothing more, once it is proved farther than the best.
    pub fn goal(&self) -> Goal<'a> {
        Goal { cut_off: self.asked.cut_off.min(self.upper), ..*self.asked }
    }

    /// Whether a pair with that lower bound need not be looked at, because it is farther than what matters, a contact that
    /// suffices was found, or the time is over. The bound goes into the bracket. Until one pair has been looked at none is
    /// left out: its witness is the proof from above.
    pub fn leaves_out(&mut self, lower: f64) -> bool {
        if self.best.is_none() {
            return false;
        }
        let contact_suffices = match self.asked.depth {
            Depth::Verdict | Depth::Distance => self.upper <= 0.0,
            Depth::Penetration => false,
        };
        if lower > self.goal().cut_off || contact_suffices {
            self.lower = self.lower.min(lower);
            return true;
        }
        let stopped = (self.asked.stop)();
        if stopped {
            self.limit = Some(Termination::TimeLimit);
            self.lower = self.lower.min(lower);
        }
        stopped
    }

    pub fn take(&mut self, found: Separation) {
        self.cost += found.cost;
        if matches!(found.termination, Termination::IterationLimit | Termination::TimeLimit) {
            self.limit = self.limit.max(Some(found.termination));
        }
        self.lower = self.lower.min(found.bracket.lower);
        self.upper = self.upper.min(found.bracket.upper);
        if self.best.as_ref().is_none_or(|best| found.signed_distance < best.signed_distance) {
            self.best = Some(found);
        }
    }

    pub fn finish(self) -> Option<Separation> {
        let best = self.best?;
        let bracket = Bracket { lower: self.lower, upper: self.upper };
        let termination = self.limit.unwrap_or(best.termination);
        Some(Separation { bracket, termination, cost: self.cost, ..best })
    }
}
