//! Solvers by tolerance on pairs whose truth is known: how long, how far off, how wide the proof.

use crate::geometry::tolerance::{SUPPORT_ERROR_ULPS, UNIT_ROUNDOFF};
use crate::narrow_phase::{
    Accuracy, Depth, Goal, PairCache, Separation, Solver, Termination, separation, separation_again,
};

use super::families::{Family, Pair};
use super::race::{Raced, Rounds, Way, quantile, race};
use super::random::Random;
use super::table::{Table, nanoseconds, number};
use super::truth::Truth;

/// Relative tolerances.
pub(super) const TOLERANCES: [f64; 12] = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12];

/// Where the search starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Start {
    /// Nothing is known of the pair.
    Cold,
    /// From the cache of the same pair a moment ago.
    Warm,
}

impl Start {
    pub fn name(self) -> &'static str {
        match self {
            Self::Cold => "cold",
            Self::Warm => "warm",
        }
    }
}

/// One solver at one tolerance.
#[derive(Clone, Copy, Debug)]
pub(super) struct Setting {
    pub solver: Solver,
    pub start: Start,
    pub tolerance: f64,
}

/// What was measured of a setting.
#[derive(Clone, Debug)]
pub(super) struct Measured {
    pub setting: Setting,
    pub raced: Raced,
    /// Pairs, and those whose truth is narrow enough to judge them.
    pub pairs: usize,
    pub compared: usize,
    /// Of those: how far the estimate is from the truth, metres.
    pub errors: Vec<f64>,
    /// Upper ends minus lower ends, metres.
    pub widths: Vec<f64>,
    /// What was asked of the widest, and the least width that rounding lets through; metres.
    pub asked: f64,
    pub floor: f64,
    /// Pairs whose error is beyond their width, and whose bracket does not hold the truth: none, if the proof holds.
    pub beyond: usize,
    pub outside: usize,
    /// Pairs that met a cap before they were as narrow as asked.
    pub short: usize,
    /// Pairs whose width is what rounding left.
    pub rounded: usize,
    /// Mean support calls.
    pub supports: f64,
}

impl Measured {
    pub fn error(&self, part: f64) -> f64 {
        quantile(&self.errors, part)
    }

    pub fn width(&self, part: f64) -> f64 {
        quantile(&self.widths, part)
    }
}

/// Pairs of a family at a gap, with what was measured of each setting.
#[derive(Clone, Debug)]
pub(super) struct Group {
    pub family: Family,
    pub gap: f64,
    /// 64 roundings of the largest extent, metres: errors below count as equal.
    pub noise: f64,
    /// Who told the truths.
    pub truth_by: &'static str,
    pub measured: Vec<Measured>,
}

/// What is asked of pairs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sweep {
    pub depth: Depth,
    pub pairs: usize,
    pub rounds: Rounds,
}

impl Sweep {
    /// Races the settings that take such pairs.
    pub fn group(
        &self,
        family: Family,
        gap: f64,
        settings: &[Setting],
        random: &mut Random,
        advance: &mut dyn FnMut(f64),
    ) -> Group {
        let pairs = family.pairs(gap, self.pairs, random);
        let truths: Vec<Option<Truth>> = pairs.iter().map(Truth::of).collect();
        let takes = |s: &&Setting| pairs.iter().all(|pair| s.solver.claims(&pair.a, &pair.b).is_ok());
        let settings: Vec<Setting> = settings.iter().filter(takes).copied().collect();
        let answers: Vec<Vec<Separation>> =
            settings.iter().map(|s| pairs.iter().filter_map(|pair| self.answer(s, pair)).collect()).collect();
        let raced = self.raced(&settings, &pairs, advance);
        let extent = pairs.iter().map(|pair| pair.extent).fold(0.0, f64::max);
        let judged = |((setting, raced), answers): ((&Setting, Raced), Vec<Separation>)| {
            judge(*setting, raced, &answers, &truths, extent)
        };
        Group {
            family,
            gap,
            noise: 64.0 * UNIT_ROUNDOFF * extent,
            truth_by: truths.iter().flatten().map(|truth| truth.by).next().unwrap_or("none"),
            measured: settings.iter().zip(raced).zip(answers).map(judged).collect(),
        }
    }

    fn goal(&self, setting: &Setting) -> Goal<'static> {
        let accuracy = Accuracy { absolute: 0.0, relative: setting.tolerance };
        Goal { depth: self.depth, accuracy, solver: setting.solver, ..Goal::penetration() }
    }

    /// None for what the solver does not take, which was asked before.
    fn answer(&self, setting: &Setting, pair: &Pair) -> Option<Separation> {
        let Pair { a, b, at_a, at_b, before, .. } = pair;
        let goal = self.goal(setting);
        match setting.start {
            Start::Cold => separation(a, b, at_a, at_b, &goal).ok(),
            Start::Warm => {
                let mut cache = PairCache::new();
                separation_again(a, b, at_a, before, &goal, &mut cache).ok()?;
                separation_again(a, b, at_a, at_b, &goal, &mut cache).ok()
            }
        }
    }

    fn raced(&self, settings: &[Setting], pairs: &[Pair], advance: &mut dyn FnMut(f64)) -> Vec<Raced> {
        let way = |setting: &Setting| {
            let goal = self.goal(setting);
            let start = setting.start;
            // To and fro between two places, each time from where the last one ended.
            let mut caches = vec![(PairCache::new(), false); pairs.len()];
            Way::new(pairs.len(), move |item| {
                let Pair { a, b, at_a, at_b, before, .. } = &pairs[item];
                let answer = match start {
                    Start::Cold => separation(a, b, at_a, at_b, &goal),
                    Start::Warm => {
                        let (cache, there) = &mut caches[item];
                        *there = !*there;
                        separation_again(a, b, at_a, if *there { before } else { at_b }, &goal, cache)
                    }
                };
                let _ = std::hint::black_box(answer);
            })
        };
        race(&mut settings.iter().map(way).collect::<Vec<Way>>(), self.rounds, advance)
    }
}

fn judge(setting: Setting, raced: Raced, answers: &[Separation], truths: &[Option<Truth>], extent: f64) -> Measured {
    let ended = |how| answers.iter().filter(|found| found.termination == how).count();
    let mut measured = Measured {
        setting,
        raced,
        pairs: answers.len(),
        compared: 0,
        errors: Vec::new(),
        widths: answers.iter().map(|found| found.bracket.width()).collect(),
        asked: 0.0,
        // Two errors from each end of a bracket (`narrow_phase`), and what is rounded on the way from cores to shapes.
        floor: 4.0 * (SUPPORT_ERROR_ULPS + 16.0) * UNIT_ROUNDOFF * extent,
        beyond: 0,
        outside: 0,
        short: ended(Termination::IterationLimit),
        rounded: ended(Termination::RoundingFloor),
        supports: answers.iter().map(|found| found.cost.supports as f64).sum::<f64>() / answers.len().max(1) as f64,
    };
    for (found, truth) in answers.iter().zip(truths) {
        let Some(truth) = truth else { continue };
        let asked = setting.tolerance * found.bracket.lower.abs().min(found.bracket.upper.abs());
        measured.asked = measured.asked.max(asked);
        measured.outside += usize::from(truth.is_outside(&found.bracket));
        if truth.judges(setting.tolerance * truth.value.abs()) {
            let error = truth.error_of(found.signed_distance);
            measured.compared += 1;
            measured.errors.push(error);
            // The truth is known to a step of doubles, and so is the width.
            let step = 2.0 * f64::EPSILON * truth.value.abs();
            measured.beyond += usize::from(error > found.bracket.width() + truth.half_width + step);
        }
    }
    measured
}

const COLUMNS: [&str; 25] = [
    "family",
    "signed_distance_m",
    "solver",
    "start",
    "relative_tolerance",
    "pairs",
    "time_median_ns",
    "time_p99_ns",
    "rounds",
    "support_calls_mean",
    "truth_by",
    "compared_with_truth",
    "error_median_m",
    "error_p99_m",
    "error_max_m",
    "width_median_m",
    "width_p99_m",
    "width_max_m",
    "width_asked_m",
    "width_floor_m",
    "errors_beyond_width",
    "brackets_beside_truth",
    "stopped_by_cap",
    "stopped_by_rounding",
    "noise_m",
];

/// The groups as a table.
pub(super) fn table(name: &'static str, groups: &[Group]) -> Table {
    let mut table = Table::new(name, &COLUMNS);
    for group in groups {
        for m in &group.measured {
            table.push(vec![
                group.family.name(),
                number(group.gap),
                m.setting.solver.name().to_owned(),
                m.setting.start.name().to_owned(),
                format!("{:e}", m.setting.tolerance),
                m.pairs.to_string(),
                nanoseconds(m.raced.median),
                nanoseconds(m.raced.p99),
                m.raced.rounds.len().to_string(),
                number(m.supports),
                group.truth_by.to_owned(),
                m.compared.to_string(),
                number(m.error(0.5)),
                number(m.error(0.99)),
                number(m.error(1.0)),
                number(m.width(0.5)),
                number(m.width(0.99)),
                number(m.width(1.0)),
                number(m.asked),
                number(m.floor),
                m.beyond.to_string(),
                m.outside.to_string(),
                m.short.to_string(),
                m.rounded.to_string(),
                number(group.noise),
            ]);
        }
    }
    table
}

/// Where an error of nothing is drawn, metres: below a step of doubles at a millimetre.
pub(super) const NOTHING: f64 = 1e-20;

/// Number of a solver's mark.
pub(super) fn mark(solver: Solver) -> usize {
    match solver {
        Solver::Default => 0,
        Solver::FrankWolfe => 9,
        Solver::Gjk => 1,
        Solver::GjkPolyak => 2,
        Solver::GjkNesterov => 3,
        Solver::GjkNesterovNormalised => 4,
        Solver::Sat => 6,
        Solver::Qp => 7,
        Solver::Exact => 8,
    }
}
