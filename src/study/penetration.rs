//! How deep is an overlap? EPA by tolerance, separating axes, exact arithmetic.

use crate::narrow_phase::{Depth, Solver};

use super::distance::{of, two_drawings};
use super::families::Family;
use super::random::Random;
use super::scale::time;
use super::section::{Figure, Section};
use super::study::{NoStudy, Study};
use super::sweep::{Group, Measured, Setting, Start, Sweep, TOLERANCES, mark, table};

/// Of the time.
pub(super) const SHARE: f64 = 0.1;

/// Signed distances, metres.
const DEPTHS: [f64; 3] = [-0.001, -0.01, -0.1];

const SHOWN_DEPTH: f64 = -0.01;

const FAMILIES: [Family; 6] =
    [Family::Box, Family::Hull(8), Family::Hull(64), Family::Hull(250), Family::CylinderAndCone, Family::Ellipsoid];

/// GJK stands for EPA, which measures what it finds to overlap.
const SOLVERS: [Solver; 4] = [Solver::Default, Solver::Gjk, Solver::Sat, Solver::Exact];

fn name(solver: Solver) -> String {
    if solver == Solver::Gjk { "gjk, then epa".to_owned() } else { solver.name().to_owned() }
}

fn settings() -> Vec<Setting> {
    let of_solver = |solver: Solver| {
        let tolerances: &[f64] = if solver == Solver::Exact { &TOLERANCES[11..] } else { &TOLERANCES };
        tolerances.iter().map(move |tolerance| Setting { solver, start: Start::Cold, tolerance: *tolerance })
    };
    SOLVERS.into_iter().flat_map(of_solver).collect()
}

pub(super) fn section(study: &Study, advance: &mut dyn FnMut(f64)) -> Result<Section, NoStudy> {
    let count = FAMILIES.len() * DEPTHS.len();
    let sweep =
        Sweep { depth: Depth::Penetration, pairs: study.effort.of(60, 4), rounds: study.effort.share(SHARE, count) };
    let mut random = Random(50);
    let mut groups: Vec<Group> = Vec::new();
    for family in FAMILIES {
        for depth in DEPTHS {
            let before = groups.len() as f64;
            let mut told = |part: f64| advance((before + part) / count as f64);
            groups.push(sweep.group(family, depth, &settings(), &mut random, &mut told));
        }
    }
    let shown = groups.iter().filter(|group| group.gap == SHOWN_DEPTH);
    let drawings = shown.map(two_drawings).collect();
    Ok(Section {
        title: "Penetration",
        what: "The same shapes 1 mm, 1 cm and 10 cm deep in one another: the least translation that frees them, by relative tolerance. Of \
               polytopes the truth is exact; cylinders, cones and ellipsoids have no truth in an overlap that is tighter than doubles, so \
               that only tolerances that it still judges have a measured error."
            .to_owned(),
        readings: readings(&groups),
        advice: Some(
            "ask for the depth only where it is needed, such as for a way out of a contact; a verdict or a distance proves an overlap and stops there."
                .to_owned(),
        ),
        figures: vec![Figure {
            caption: "1 cm deep, a point for each tolerance. Left of each pair: by the measured error (p99), right: by the certified width \
                      (p99)"
                .to_owned(),
            legend: SOLVERS.iter().map(|solver| (name(*solver), mark(*solver))).collect(),
            drawings,
        }],
        summary: Some(summary(&groups)),
        table: table("penetration", &groups),
    })
}

fn at(group: &Group, solver: Solver, tolerance: f64) -> Option<&Measured> {
    of(group, solver, Start::Cold).find(|m| m.setting.tolerance == tolerance)
}

fn readings(groups: &[Group]) -> Vec<String> {
    let shown = |family: Family| groups.iter().find(|group| group.family == family && group.gap == SHOWN_DEPTH);
    let times = |family: Family, solver: Solver, tolerance: f64| {
        shown(family).and_then(|group| at(group, solver, tolerance)).map_or(f64::NAN, |m| m.raced.median)
    };
    let polytope = |family: Family| {
        format!(
            "{}: separating axes {}, epa {}, exact {}",
            family.name(),
            time(times(family, Solver::Sat, 1e-6)),
            time(times(family, Solver::Gjk, 1e-6)),
            time(times(family, Solver::Exact, 1e-12))
        )
    };
    let round = |family: Family| {
        let price = times(family, Solver::Gjk, 1e-6) / times(family, Solver::Gjk, 1e-1);
        format!("{} {price:.1} times", family.name())
    };
    let (beyond, outside) =
        groups.iter().flat_map(|g| &g.measured).fold((0, 0), |(b, o), m| (b + m.beyond, o + m.outside));
    let short = groups.iter().flat_map(|g| of(g, Solver::Default, Start::Cold)).map(|m| m.short).sum::<usize>();
    vec![
        format!(
            "To 1e-6, 1 cm deep: {}. Between boxes there is no reason for anything but axes.",
            [Family::Box, Family::Hull(8), Family::Hull(64)].map(polytope).join("; ")
        ),
        format!(
            "A round surface is dear to EPA, since its polytope has to come near it everywhere the depth might be: 1e-6 takes, as a multiple of 1e-1, {}.",
            [Family::CylinderAndCone, Family::Ellipsoid].map(round).join(", ")
        ),
        format!(
            "The proof holds in overlaps, too: {beyond} errors beyond their width, {outside} brackets beside the truth. The default met \
             its cap before the tolerance {short} times; those brackets are valid and wider than asked."
        ),
    ]
}

fn summary(groups: &[Group]) -> (Vec<String>, Vec<Vec<String>>) {
    let columns = [
        "pairs of",
        "depth, m",
        "default, 1e-3",
        "default, 1e-6",
        "default, 1e-9",
        "epa, 1e-6",
        "sat",
        "exact",
        "truth by",
    ];
    let rows = groups.iter().map(|group| {
        let cell =
            |solver, tolerance| at(group, solver, tolerance).map_or_else(|| "-".to_owned(), |m| time(m.raced.median));
        vec![
            group.family.name(),
            (-group.gap).to_string(),
            cell(Solver::Default, 1e-3),
            cell(Solver::Default, 1e-6),
            cell(Solver::Default, 1e-9),
            cell(Solver::Gjk, 1e-6),
            cell(Solver::Sat, 1e-6),
            cell(Solver::Exact, 1e-12),
            group.truth_by.to_owned(),
        ]
    });
    (columns.map(str::to_owned).to_vec(), rows.collect())
}
