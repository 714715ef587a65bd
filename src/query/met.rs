//! What a ray or a moving shape meets, collected body by body in any order.
//!
//! Hits after the first one are only looked for where all are asked for. What is kept does not depend on the order: a body is
//! passed over only if it is proved to be met later than a hit that stays.

use super::answer::Indeterminacy;
use super::cast_answer::{CastHit, CastItem, CastVerdict, Grazed};
use super::cast_request::CastMode;
use crate::narrow_phase::{Cost, Outcome};
use crate::scene::BodyId;

/// The hits so far.
pub(super) struct MetBodies {
    mode: CastMode,
    /// The end of the way.
    end: f64,
    most: usize,
    hits: Vec<CastHit>,
    grazed: Vec<Grazed>,
    /// The earliest time by which something is met.
    soonest: f64,
    pub cost: Cost,
}

impl MetBodies {
    pub fn new(mode: CastMode, end: f64, most: usize) -> Self {
        Self { mode, end, most, hits: Vec::new(), grazed: Vec::new(), soonest: f64::INFINITY, cost: Cost::default() }
    }

    /// What comes later on the way than this does not matter; negative when nothing does any more.
    pub fn reach(&self) -> f64 {
        match self.mode {
            CastMode::All => self.end,
            CastMode::First => self.end.min(self.soonest),
            CastMode::Any if self.soonest <= self.end => -1.0,
            CastMode::Any => self.end,
        }
    }

    /// Takes what is known of one body.
    pub fn take(&mut self, outcome: Outcome, hit: CastHit, why: Indeterminacy) {
        match outcome {
            Outcome::Clear => {}
            Outcome::Hit => {
                self.soonest = self.soonest.min(hit.upper);
                self.hits.push(hit);
            }
            Outcome::Undecided => {
                self.grazed.push(Grazed { body: hit.body, lower: hit.lower, upper: hit.upper, why });
            }
        }
    }

    #[inline(never)]
    pub fn finish(self) -> CastItem {
        let Self { mode, end, most, mut hits, mut grazed, soonest, cost } = self;
        let free = CastItem { free_until: end, cost, ..CastItem::without_work(CastVerdict::Clear) };
        if hits.is_empty() && grazed.is_empty() {
            return free;
        }
        hits.sort_by(|one, two| one.upper.total_cmp(&two.upper).then(one.body.cmp(&two.body)));
        grazed.sort_by(|one, two| one.lower.total_cmp(&two.lower).then(one.body.cmp(&two.body)));
        let is_hit = !hits.is_empty();
        if mode == CastMode::Any && is_hit {
            return CastItem { verdict: CastVerdict::Hit, free_until: 0.0, ..free };
        }
        if mode == CastMode::First && is_hit {
            // Whatever may be met before the first one is surely met, whether it is met later or not: how far a body was followed beyond that
            // depends on the order.
            let others = hits.drain(1..).map(|hit| (hit.body, hit.lower));
            let others: Vec<(BodyId, f64)> = others.chain(grazed.iter().map(|one| (one.body, one.lower))).collect();
            let before = others.into_iter().filter(|(_, lower)| *lower <= soonest);
            let why = Indeterminacy::Rounding;
            grazed = before.map(|(body, lower)| Grazed { body, lower, upper: soonest, why }).collect();
            grazed.sort_by(|one, two| one.lower.total_cmp(&two.lower).then(one.body.cmp(&two.body)));
        }
        let lowers = hits.iter().map(|hit| hit.lower).chain(grazed.iter().map(|one| one.lower));
        let free_until = lowers.fold(end, f64::min);
        let verdict = match grazed.first() {
            Some(one) if !is_hit => CastVerdict::Indeterminate(one.why),
            _ => CastVerdict::Hit,
        };
        let told = if mode == CastMode::First { 1 } else { most };
        let truncated = (mode == CastMode::All && hits.len() > told) || grazed.len() > most;
        hits.truncate(told);
        grazed.truncate(most);
        CastItem { verdict, free_until, hits, grazed, truncated, ..free }
    }
}
