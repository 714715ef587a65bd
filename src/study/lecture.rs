//! The table of the lecture: a quadratic program, GJK and accelerated GJK on hulls of 8, 250 and 940 corners; and other libraries.

use crate::narrow_phase::{Depth, Solver};

use super::distance::of;
use super::families::Family;
use super::peers::{self, PeerRow};
use super::race::Rounds;
use super::random::Random;
use super::rungs::{Rung, rungs};
use super::scale::{Axis, Unit, time};
use super::section::{Figure, Section};
use super::study::{NoStudy, Study};
use super::sweep::{Group, Setting, Start, Sweep, mark};
use super::table::{Table, nanoseconds, number};

/// Of the time.
pub(super) const SHARE: f64 = 0.02;

const CORNERS: [usize; 3] = [8, 250, 940];

/// Metres apart.
const GAP: f64 = 0.01;

/// Relative: what a quadratic program reaches.
const TOLERANCE: f64 = 1e-6;

const SOLVERS: [Solver; 4] = [Solver::Qp, Solver::Gjk, Solver::GjkNesterov, Solver::Default];

/// Microseconds of the lecture, on its machine, in the order of [`CORNERS`]: ProxQP, GJK, accelerated GJK.
const LECTURE: [(&str, [&str; 3]); 3] = [
    ("ProxQP (lecture)", ["5.3 ± 2.7 µs", "2000 ± 600 µs", "20 000 ± 14 000 µs"]),
    ("GJK (lecture)", ["0.2 ± 0.03 µs", "0.8 ± 0.3 µs", "2.1 ± 0.5 µs"]),
    ("accelerated GJK (lecture)", ["0.2 ± 0.05 µs", "0.7 ± 0.2 µs", "1.4 ± 0.3 µs"]),
];

/// Rows of the peers' file that stand beside ours.
const PEER_ROWS: [&str; 3] = ["hull8 distance near", "hull250 distance near", "hull940 distance near"];

pub(super) fn section(study: &Study, advance: &mut dyn FnMut(f64)) -> Result<Section, NoStudy> {
    let mut random = Random(70);
    let mut groups = Vec::new();
    for (i, corners) in CORNERS.into_iter().enumerate() {
        let share = study.effort.share(SHARE, CORNERS.len());
        let group = |solvers: &[Solver], pairs: usize, rounds: Rounds, random: &mut Random| {
            let settings: Vec<Setting> = solvers
                .iter()
                .map(|solver| Setting { solver: *solver, start: Start::Cold, tolerance: TOLERANCE })
                .collect();
            Sweep { depth: Depth::Distance, pairs, rounds }.group(
                Family::Hull(corners),
                GAP,
                &settings,
                random,
                &mut |_| (),
            )
        };
        let mut own = group(&SOLVERS[1..], study.effort.of(100, 8), share, &mut random);
        // A program of two thousand unknowns takes a while: few pairs, once or twice.
        let few = Rounds { least: 1, most: 5, ..share };
        let pairs = if corners > 100 { study.effort.of(12, 2) } else { study.effort.of(100, 8) };
        own.measured.extend(group(&SOLVERS[..1], pairs, few, &mut random).measured);
        groups.push(own);
        advance((i + 1) as f64 / CORNERS.len() as f64);
    }
    let peers = study.peers.as_deref().map(peers::rows).transpose()?;
    let beside: Vec<PeerRow> =
        peers.iter().flatten().filter(|row| PEER_ROWS.contains(&row.row.as_str())).cloned().collect();
    let mut figures = vec![figure(&groups)];
    if !beside.is_empty() {
        figures.push(figure_of_peers(&beside));
    }
    Ok(Section {
        title: "The lecture's table",
        what: format!(
            "The distance of two hulls {GAP} m apart to a relative {TOLERANCE:e}, by the number of corners of each. The quadratic program has a weight for each corner, \
             solved by an interior point method (Clarabel, in place of the lecture's ProxQP). {}",
            peers_told(study, &beside)
        ),
        readings: readings(&groups, &beside),
        advice: None,
        figures,
        summary: Some(summary(&groups, &beside)),
        table: table(&groups, &beside),
    })
}

fn peers_told(study: &Study, beside: &[PeerRow]) -> String {
    if study.peers.is_none() {
        return "Other libraries: benches/peers/compare --save measures them, and --peers FILE shows them here."
            .to_owned();
    }
    let missing: Vec<&str> = ["Coal", "parry", "FCL", "ProxQP"]
        .into_iter()
        .filter(|name| !beside.iter().any(|row| row.contender.to_lowercase().contains(&name.to_lowercase())))
        .collect();
    let missing =
        if missing.is_empty() { String::new() } else { format!(" It has no figures of {}.", missing.join(" and ")) };
    format!(
        "Other libraries stand below as the file of peers has them: other pairs of the same kind, measured in one run of their own, ours among them.{missing}"
    )
}

fn name(solver: Solver) -> &'static str {
    match solver {
        Solver::Qp => "quadratic program",
        Solver::Gjk => "GJK",
        Solver::GjkNesterov => "accelerated GJK (Nesterov)",
        Solver::Default => "default",
        Solver::FrankWolfe | Solver::GjkPolyak | Solver::GjkNesterovNormalised | Solver::Sat | Solver::Exact => {
            solver.name()
        }
    }
}

fn figure(groups: &[Group]) -> Figure {
    let rung = |group: &Group| Rung {
        name: format!("{}: {}", group.family.name(), told(group)),
        values: group.measured.iter().map(|m| (mark(m.setting.solver), m.raced.median, m.raced.p99)).collect(),
    };
    let all: Vec<Rung> = groups.iter().map(rung).collect();
    Figure {
        caption: "Median over the pairs; the line leads to the 99th percentile".to_owned(),
        legend: SOLVERS.iter().map(|solver| (name(*solver).to_owned(), mark(*solver))).collect(),
        drawings: vec![rungs("the lecture's table, here", &Axis::log("time a pair", Unit::Seconds), &all)],
    }
}

fn told(group: &Group) -> String {
    let of_solver = |solver: Solver| of(group, solver, Start::Cold).next().map(|m| time(m.raced.median));
    let [qp, gjk, nesterov, default] = SOLVERS.map(of_solver).map(Option::unwrap_or_default);
    format!("{qp} / {gjk} / {nesterov} / {default}")
}

/// Of each contender the fastest way it was set up.
fn fastest(beside: &[PeerRow], row: &str) -> Vec<PeerRow> {
    let mut best: Vec<PeerRow> = Vec::new();
    for one in beside.iter().filter(|one| one.row == row) {
        match best.iter_mut().find(|other| other.contender == one.contender) {
            Some(other) if other.median <= one.median => {}
            Some(other) => *other = one.clone(),
            None => best.push(one.clone()),
        }
    }
    best
}

/// Number of a contender's mark.
fn peer_mark(contenders: &[String], contender: &str) -> usize {
    if contender == "ours" {
        return 0;
    }
    contenders.iter().filter(|name| *name != "ours").position(|name| name == contender).map_or(9, |index| index + 1)
}

/// Everybody who was measured, in the order of their names.
fn contenders_of(beside: &[PeerRow]) -> Vec<String> {
    let mut contenders: Vec<String> = beside.iter().map(|row| row.contender.clone()).collect();
    contenders.sort();
    contenders.dedup();
    contenders
}

fn figure_of_peers(beside: &[PeerRow]) -> Figure {
    let contenders = contenders_of(beside);
    let rung = |row: &&str| {
        let best = fastest(beside, row);
        let values = best.iter().map(|one| (peer_mark(&contenders, &one.contender), one.median, one.p99)).collect();
        Rung { name: row.split(' ').next().unwrap_or(row).to_owned(), values }
    };
    let all: Vec<Rung> = PEER_ROWS.iter().map(rung).collect();
    Figure {
        caption: "Other libraries, the fastest of the ways each was set up; pairs of hulls near one another".to_owned(),
        legend: contenders.iter().map(|name| (name.clone(), peer_mark(&contenders, name))).collect(),
        drawings: vec![rungs("peers", &Axis::log("time a pair", Unit::Seconds), &all)],
    }
}

fn readings(groups: &[Group], beside: &[PeerRow]) -> Vec<String> {
    let median = |group: &Group, solver| of(group, solver, Start::Cold).next().map_or(f64::NAN, |m| m.raced.median);
    let ratio = |one: Solver, other: Solver| {
        groups.iter().map(|g| format!("{:.3}", median(g, one) / median(g, other))).collect::<Vec<_>>().join(", ")
    };
    let times = |one: Solver, other: Solver| {
        groups.iter().map(|g| format!("{:.0}", median(g, one) / median(g, other))).collect::<Vec<_>>().join(", ")
    };
    let mut texts = vec![
        format!(
            "The quadratic program takes {} times as long as GJK on hulls of 8, 250 and 940 corners: it works on all corners in every round, GJK on four.",
            times(Solver::Qp, Solver::Gjk)
        ),
        format!(
            "Nesterov's momentum takes this part of plain GJK's time: {}; the library's choice {}.",
            ratio(Solver::GjkNesterov, Solver::Gjk),
            ratio(Solver::Default, Solver::Gjk)
        ),
    ];
    for row in PEER_ROWS {
        let best = fastest(beside, row);
        let (Some(ours), Some(peer)) = (
            best.iter().find(|one| one.contender == "ours"),
            best.iter()
                .filter(|one| one.contender != "ours" && !one.contender.contains("f32"))
                .min_by(|a, b| a.median.total_cmp(&b.median)),
        ) else {
            continue;
        };
        texts.push(format!(
            "{row}: ours ({}) takes {:.2} of the fastest peer's time ({}, {}).",
            ours.config,
            ours.median / peer.median,
            peer.contender,
            peer.config
        ));
    }
    texts
}

fn summary(groups: &[Group], beside: &[PeerRow]) -> (Vec<String>, Vec<Vec<String>>) {
    let mut columns = vec!["solver".to_owned()];
    columns.extend(CORNERS.map(|corners| format!("{corners} corners")));
    let row = |solver: Solver| {
        let cell = |group: &Group| {
            let found = of(group, solver, Start::Cold).next();
            found.map_or_else(String::new, |m| format!("{} (p99 {})", time(m.raced.median), time(m.raced.p99)))
        };
        std::iter::once(format!("{} (here)", name(solver))).chain(groups.iter().map(cell)).collect()
    };
    let mut rows: Vec<Vec<String>> = SOLVERS.map(row).into();
    rows.extend(
        LECTURE.map(|(name, cells)| std::iter::once(name.to_owned()).chain(cells.map(str::to_owned)).collect()),
    );
    // One row of the file for each number of corners.
    let of_peers = PEER_ROWS.map(|row| fastest(beside, row));
    rows.extend(contenders_of(beside).into_iter().map(|name| {
        let cell = |best: &Vec<PeerRow>| {
            let found = best.iter().find(|one| one.contender == name);
            found.map_or_else(String::new, |one| format!("{} (p99 {})", time(one.median), time(one.p99)))
        };
        std::iter::once(format!("{name} (peers' run)")).chain(of_peers.iter().map(cell)).collect()
    }));
    (columns, rows)
}

fn table(groups: &[Group], beside: &[PeerRow]) -> Table {
    let columns = ["source", "pairs_of", "solver", "config", "pairs", "time_median_ns", "time_p99_ns", "error_p99_m"];
    let mut table = Table::new("lecture", &columns);
    for group in groups {
        for m in &group.measured {
            table.push(vec![
                "this run".to_owned(),
                group.family.name(),
                m.setting.solver.name().to_owned(),
                format!("{TOLERANCE:e}"),
                m.pairs.to_string(),
                nanoseconds(m.raced.median),
                nanoseconds(m.raced.p99),
                number(m.error(0.99)),
            ]);
        }
    }
    for row in beside {
        table.push(vec![
            "peers".to_owned(),
            row.row.clone(),
            row.contender.clone(),
            row.config.clone(),
            String::new(),
            nanoseconds(row.median),
            nanoseconds(row.p99),
            number(row.error_p99),
        ]);
    }
    table
}
