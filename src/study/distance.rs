//! The distance: what does each solver take for which error, and does the default dominate?

use crate::narrow_phase::{Depth, Solver};

use super::families::Family;
use super::plot::{Point, Series, plot};
use super::race::ratio;
use super::random::Random;
use super::scale::{Axis, Unit, short, time};
use super::section::{Figure, Section};
use super::study::{NoStudy, Study};
use super::sweep::{Group, Measured, NOTHING, Setting, Start, Sweep, TOLERANCES, mark, table};

/// Of the time.
pub(super) const SHARE: f64 = 0.28;

/// Metres apart.
const GAPS: [f64; 4] = [1.0, 0.1, 0.01, 0.001];

/// Of the drawings that have no room for all.
const SHOWN_GAP: f64 = 0.01;

/// Tolerances of what is slow and there for comparison.
const FEW: [f64; 4] = [1e-1, 1e-2, 1e-6, 1e-12];

/// Beyond so many corners an interior point method takes tens of milliseconds; the lecture's table has those.
const MOST_QP_CORNERS: usize = 64;

/// Those that start from a cache.
const WARM: [Solver; 5] =
    [Solver::Default, Solver::Gjk, Solver::GjkPolyak, Solver::GjkNesterov, Solver::GjkNesterovNormalised];

fn settings(family: Family) -> Vec<Setting> {
    let mut all = Vec::new();
    for solver in Solver::ALL {
        let tolerances: &[f64] = match solver {
            Solver::FrankWolfe => &FEW,
            // The tolerance does not change what it does.
            Solver::Exact => &FEW[3..],
            Solver::Qp if family.corners() > MOST_QP_CORNERS => &[],
            Solver::Qp => &FEW,
            Solver::Default
            | Solver::Gjk
            | Solver::GjkPolyak
            | Solver::GjkNesterov
            | Solver::GjkNesterovNormalised
            | Solver::Sat => &TOLERANCES,
        };
        let warm = WARM.contains(&solver);
        for tolerance in tolerances {
            all.push(Setting { solver, start: Start::Cold, tolerance: *tolerance });
            if warm {
                all.push(Setting { solver, start: Start::Warm, tolerance: *tolerance });
            }
        }
    }
    all
}

pub(super) fn section(study: &Study, advance: &mut dyn FnMut(f64)) -> Result<Section, NoStudy> {
    let groups_in_all = Family::ALL.len() * GAPS.len();
    let sweep = Sweep {
        depth: Depth::Distance,
        pairs: study.effort.of(100, 5),
        rounds: study.effort.share(SHARE, groups_in_all),
    };
    let mut random = Random(20);
    let mut groups = Vec::new();
    for family in Family::ALL {
        for gap in GAPS {
            let before = groups.len() as f64;
            let mut told = |part: f64| advance((before + part) / groups_in_all as f64);
            groups.push(sweep.group(family, gap, &settings(family), &mut random, &mut told));
        }
    }
    let beaten: Vec<Beaten> = groups.iter().flat_map(better_than_default).collect();
    Ok(Section {
        title: "Distance",
        what: format!(
            "Pairs of shapes of about a metre, turned at random, {} to {} m apart; every solver by relative tolerance, 1e-1 to 1e-12, \
             cold and from the pair's cache. Errors are held against a truth at least a thousand times tighter; what has no such truth \
             is left out.",
            GAPS[3], GAPS[0]
        ),
        readings: readings(&groups, &beaten),
        advice: advice(&groups),
        figures: vec![by_solver(&groups), by_gap(&groups)],
        summary: Some(summary(&groups, &beaten)),
        table: table("distance", &groups),
    })
}

fn legend() -> Vec<(String, usize)> {
    Solver::ALL.iter().map(|solver| (solver.name().to_owned(), mark(*solver))).collect()
}

pub(super) fn of<'a>(group: &'a Group, solver: Solver, start: Start) -> impl Iterator<Item = &'a Measured> + use<'a> {
    group.measured.iter().filter(move |m| m.setting.solver == solver && m.setting.start == start)
}

/// Two drawings of a group: by measured error, and by certified width.
pub(super) fn two_drawings(group: &Group) -> String {
    let title = group.family.name();
    let series = |x: &dyn Fn(&Measured) -> f64| -> Vec<Series> {
        let of_solver = |solver: &Solver| Series {
            mark: mark(*solver),
            joined: true,
            points: of(group, *solver, Start::Cold)
                .map(|m| {
                    if *solver == Solver::Default {
                        Point::with_tail(x(m), m.raced.median, m.raced.p99)
                    } else {
                        Point::new(x(m), m.raced.median)
                    }
                })
                .collect(),
        };
        // The default last, on top of the others.
        Solver::ALL.iter().skip(1).chain(&Solver::ALL[..1]).map(of_solver).collect()
    };
    let time = Axis::log("", Unit::Seconds);
    let measured = Axis::log("measured error, m", Unit::Plain);
    let certified = Axis::log("certified width, m", Unit::Plain);
    let both = [
        plot(&format!("{title}: time by error"), &measured, &time, &series(&|m| m.error(0.99)), NOTHING),
        plot(&format!("{title}: time by width"), &certified, &time, &series(&|m| m.width(0.99)), NOTHING),
    ];
    both.concat()
}

fn by_solver(groups: &[Group]) -> Figure {
    let near = groups.iter().filter(|group| group.gap == SHOWN_GAP);
    Figure {
        caption: format!(
            "Each solver, {SHOWN_GAP} m apart, cold, a point for each tolerance. Left of each pair: by the measured error (p99; \
             nothing at the left edge), right: by the certified width (p99). The default's p99 of the time is the thin line up."
        ),
        legend: legend(),
        drawings: near.map(two_drawings).collect(),
    }
}

/// The default by gap: cold filled, warm hollow.
fn by_gap(groups: &[Group]) -> Figure {
    let marks = |i: usize, start: Start| match start {
        Start::Cold => i + 1,
        Start::Warm => i + 5,
    };
    let both = [Start::Cold, Start::Warm];
    let draw = |family: Family| {
        let of_family = groups.iter().filter(|group| group.family == family).enumerate();
        let one = |i: usize, group: &Group, start: Start| Series {
            mark: marks(i, start),
            joined: true,
            points: of(group, Solver::Default, start)
                .map(|m| Point::new(m.setting.tolerance, m.raced.median))
                .collect(),
        };
        let series: Vec<Series> = of_family.flat_map(|(i, group)| both.map(|start| one(i, group, start))).collect();
        let (x, y) = (Axis::log("relative tolerance", Unit::Plain), Axis::log("", Unit::Seconds));
        plot(&format!("{}: time by tolerance", family.name()), &x, &y, &series, NOTHING)
    };
    let legend = both.into_iter().flat_map(|start| {
        GAPS.iter().enumerate().map(move |(i, gap)| (format!("{gap} m apart, {}", start.name()), marks(i, start)))
    });
    Figure {
        caption: "The default by tolerance, at each distance, cold and from the pair's cache".to_owned(),
        legend: legend.collect(),
        drawings: Family::ALL.into_iter().map(draw).collect(),
    }
}

/// A point of another solver that the default does not keep up with.
struct Beaten {
    family: Family,
    gap: f64,
    by: Solver,
    tolerance: f64,
    ratio: [f64; 3],
}

/// Points at least 10 % faster than the default's fastest point of no larger error, by the whole interval of the ratio.
/// Errors below 64 roundings count as equal.
fn better_than_default(group: &Group) -> Option<Beaten> {
    let own: Vec<&Measured> = of(group, Solver::Default, Start::Cold).filter(|m| m.compared > 0).collect();
    let others = group.measured.iter().filter(|m| {
        m.setting.start == Start::Cold && m.setting.solver != Solver::Default && m.compared > 0 && m.short == 0
    });
    let beaten = others.filter_map(|other| {
        let allowed = other.error(0.99).max(group.noise);
        let fits = own.iter().filter(|m| m.error(0.99) <= allowed);
        let best = fits.min_by(|a, b| a.raced.median.total_cmp(&b.raced.median))?;
        let ratio = ratio(&other.raced, &best.raced);
        let (by, tolerance) = (other.setting.solver, other.setting.tolerance);
        (ratio[2] < 0.9).then_some(Beaten { family: group.family, gap: group.gap, by, tolerance, ratio })
    });
    beaten.min_by(|a, b| a.ratio[1].total_cmp(&b.ratio[1]))
}

fn readings(groups: &[Group], beaten: &[Beaten]) -> Vec<String> {
    let mut texts = Vec::new();
    let at = |family: Family, tolerance: f64, start: Start| {
        let group = groups.iter().find(|group| group.family == family && group.gap == SHOWN_GAP)?;
        of(group, Solver::Default, start).find(|m| m.setting.tolerance == tolerance).map(|m| m.raced.median)
    };
    let ratio = |family: Family| Some(at(family, 1e-12, Start::Cold)? / at(family, 1e-1, Start::Cold)?);
    let shown = |family: Family| ratio(family).map_or_else(String::new, |r| format!("{} {r:.2} times", family.name()));
    texts.push(format!(
        "The price of digits: what 1e-12 takes of the default, as a multiple of 1e-1, at {SHOWN_GAP} m: {}. Polytopes end on \
         the exact feature, so there is no reason to ask less of them; round shapes pay for each digit.",
        [Family::Box, Family::Hull(64), Family::Hull(940), Family::CylinderAndCone, Family::Ellipsoid].map(shown).join(", ")
    ));
    let warm = |family: Family| {
        let part = at(family, 1e-6, Start::Warm)? / at(family, 1e-6, Start::Cold)?;
        Some(format!("{} {part:.2}", family.name()))
    };
    let warm: Vec<String> =
        [Family::Box, Family::Hull(64), Family::Hull(940), Family::Ellipsoid].into_iter().filter_map(warm).collect();
    texts.push(format!(
        "A pair's cache, after a turn of half a degree, leaves this part of the cold time at 1e-6: {}.",
        warm.join(", ")
    ));
    let all = groups.iter().flat_map(|group| &group.measured);
    let (compared, beyond, outside, pairs) =
        all.fold((0, 0, 0, 0), |(c, b, o, p), m| (c + m.compared, b + m.beyond, o + m.outside, p + m.pairs));
    texts.push(format!(
        "The proof holds: of {compared} answers that have a truth a thousand times tighter, {beyond} are farther off than their \
         certified width; of all {pairs} brackets {outside} miss the truth. The measured error is mostly far below the width, \
         which is what a guarantee costs."
    ));
    if beaten.is_empty() {
        texts.push(format!(
            "The default dominates in all {} groups: no other solver is at least 10 % faster with an error no larger, by the interval \
             of interleaved rounds.",
            groups.len()
        ));
    } else {
        let mut worst: Vec<&Beaten> = beaten.iter().collect();
        worst.sort_by(|a, b| a.ratio[1].total_cmp(&b.ratio[1]));
        let worst: Vec<String> = worst
            .into_iter()
            .take(3)
            .map(|b| format!("{} at {} m ({}, {:.2} of its time)", b.family.name(), b.gap, b.by, b.ratio[1]))
            .collect();
        texts.push(format!(
            "The default does not dominate everywhere: in {} of {} groups another solver is at least 10 % faster with an error no \
             larger (the table below has all); the most in {}.",
            beaten.len(),
            groups.len(),
            worst.join("; ")
        ));
    }
    texts
}

/// What a tolerance of a millionth takes, and what looser ones would save.
fn advice(groups: &[Group]) -> Option<String> {
    let at = |family: Family, tolerance: f64, start: Start| {
        let group = groups.iter().find(|group| group.family == family && group.gap == SHOWN_GAP)?;
        let found = of(group, Solver::Default, start).find(|m| m.setting.tolerance == tolerance)?;
        Some(time(found.raced.median))
    };
    let cold = |family: Family| at(family, 1e-6, Start::Cold);
    let beside = |tolerance: f64| at(Family::CylinderAndCone, tolerance, Start::Cold);
    Some(format!(
        "leave the solver to the library and ask for a relative 1e-6, which is {} nm at 1 cm: between polytopes it costs hardly more than 1e-1 ({} for boxes, {} for \
         hulls of 64 corners, {} of 940). Only of ellipsoids, cylinders and cones do looser tolerances pay ({} for 1e-6 and {} for 1e-1 between a cylinder and a cone). Keep a \
         cache for each pair that moves in small steps: hulls of 64 then take {}.",
        short(1e-6 * SHOWN_GAP * 1e9),
        cold(Family::Box)?,
        cold(Family::Hull(64))?,
        cold(Family::Hull(940))?,
        beside(1e-6)?,
        beside(1e-1)?,
        at(Family::Hull(64), 1e-6, Start::Warm)?,
    ))
}

fn summary(groups: &[Group], beaten: &[Beaten]) -> (Vec<String>, Vec<Vec<String>>) {
    let mut columns: Vec<String> = ["pairs of", "m apart"].map(str::to_owned).to_vec();
    columns.extend(["1e-1", "1e-3", "1e-6", "1e-9", "1e-12"].map(|t| format!("default, {t}")));
    columns.extend(["from cache, 1e-6", "p99, 1e-6", "truth by", "faster at no larger error"].map(str::to_owned));
    let rows = groups.iter().map(|group| {
        let at = |tolerance: f64, start| {
            of(group, Solver::Default, start).find(|m| m.setting.tolerance == tolerance).map(|m| &m.raced)
        };
        let median = |tolerance, start| at(tolerance, start).map_or_else(String::new, |raced| time(raced.median));
        let mut row = vec![group.family.name(), group.gap.to_string()];
        row.extend([1e-1, 1e-3, 1e-6, 1e-9, 1e-12].map(|tolerance| median(tolerance, Start::Cold)));
        row.push(median(1e-6, Start::Warm));
        row.push(at(1e-6, Start::Cold).map_or_else(String::new, |raced| time(raced.p99)));
        row.push(group.truth_by.to_owned());
        let by = beaten.iter().find(|b| b.family == group.family && b.gap == group.gap);
        row.push(by.map_or_else(
            || "none".to_owned(),
            |b| format!("{} {:e}: {:.2} [{:.2}, {:.2}]", b.by, b.tolerance, b.ratio[1], b.ratio[0], b.ratio[2]),
        ));
        row
    });
    (columns, rows.collect())
}
