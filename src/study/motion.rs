//! Is a motion free? A robot's motions checked at fixed steps, and proved free all along by conservative advancement.

use std::sync::Arc;

use crate::query::{CheckMotions, CheckStates, Context, Find, Mode, Motions, Prepared, Verdict};
use crate::scene::{Epoch, Scene, Snapshot};

use super::planner::{Planner, PlannerScene, ROBOT};
use super::plot::{Point, Series, plot};
use super::race::{Raced, Way, quantile, race};
use super::scale::{Axis, Unit, time};
use super::section::{Figure, Section};
use super::study::{NoStudy, Study};
use super::table::{Table, nanoseconds, number};

/// Of the time.
pub(super) const SHARE: f64 = 0.1;

/// States of a motion at fixed steps, both ends included.
const STEPS: [usize; 8] = [2, 4, 8, 16, 32, 64, 128, 256];

/// What is missed is held against the proof and against so many steps.
const DENSE: usize = 1024;

/// A motion in a scene.
struct Motion {
    snapshot: Arc<Snapshot>,
    start: Vec<f64>,
    goal: Vec<f64>,
}

/// What became of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Told {
    Free,
    Blocked,
    Undecided,
}

/// How it is checked.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Check {
    Steps(usize),
    Proof(Find),
}

impl Check {
    fn name(self) -> String {
        match self {
            Self::Steps(steps) => format!("{steps} states"),
            Self::Proof(Find::AnyContact) => "proof, any contact".to_owned(),
            Self::Proof(Find::FirstContact) => "proof, first contact bracketed".to_owned(),
        }
    }

    fn ask(self, motion: &Motion) -> Told {
        match self {
            Self::Steps(steps) => at_steps(motion, steps),
            Self::Proof(find) => proved(motion, find),
        }
    }
}

fn at_steps(motion: &Motion, steps: usize) -> Told {
    let state = |i: usize| {
        let t = i as f64 / (steps - 1) as f64;
        motion.start.iter().zip(&motion.goal).map(move |(start, goal)| start + t * (goal - start))
    };
    let positions = (0..steps).flat_map(state).collect();
    let question =
        CheckStates { robot: ROBOT.to_owned(), positions, mode: Mode::StopAtFirst, context: Context::default() };
    let Ok(prepared) = Prepared::check_states(&*motion.snapshot, &question) else { return Told::Undecided };
    let answer = prepared.answer(&|| false);
    match answer.stopped_at.and_then(|index| answer.items.get(index)).map(|item| item.verdict) {
        None => Told::Free,
        Some(Verdict::Collision) => Told::Blocked,
        Some(_) => Told::Undecided,
    }
}

fn proved(motion: &Motion, find: Find) -> Told {
    let question = CheckMotions {
        robot: ROBOT.to_owned(),
        positions: [motion.start.as_slice(), &motion.goal].concat(),
        motions: Motions::Edges,
        mode: Mode::All,
        find,
        resolution: CheckMotions::DEFAULT_RESOLUTION,
        max_states: CheckMotions::DEFAULT_MAX_STATES,
        context: Context::default(),
    };
    let Ok(prepared) = Prepared::check_motions(&*motion.snapshot, &question) else { return Told::Undecided };
    match prepared.answer(&|| false).items.first().map(|item| item.verdict) {
        Some(Verdict::Free) => Told::Free,
        Some(Verdict::Collision) => Told::Blocked,
        Some(_) | None => Told::Undecided,
    }
}

fn snapshot(planner: &Planner, scene: &PlannerScene) -> Result<Arc<Snapshot>, NoStudy> {
    let mut made = Scene::new(Epoch(1));
    made.apply(&planner.edits(scene), None).map_err(NoStudy::own)?;
    Ok(made.snapshot())
}

/// From each state of a scene to the next, over the scenes by turns.
fn motions(planner: &Planner, count: usize) -> Result<Vec<Motion>, NoStudy> {
    let snapshots: Vec<Arc<Snapshot>> =
        planner.scenes.iter().map(|scene| snapshot(planner, scene)).collect::<Result<_, _>>()?;
    let longest = planner.scenes.iter().map(|scene| scene.states.len()).max().unwrap_or(0);
    let mut all = Vec::new();
    for i in 0..longest.saturating_sub(1) {
        for (scene, snapshot) in planner.scenes.iter().zip(&snapshots) {
            if let Some([start, goal]) = scene.states.get(i..i + 2) {
                all.push(Motion { snapshot: Arc::clone(snapshot), start: start.clone(), goal: goal.clone() });
            }
        }
    }
    // Spread over all of them, so that a short run has every kind, too.
    let step = (all.len() as f64 / count.max(1) as f64).max(1.0);
    let mut next = 0.0;
    let mut index = 0.0;
    all.retain(|_| {
        let taken = index >= next;
        index += 1.0;
        if taken {
            next += step;
        }
        taken
    });
    Ok(all)
}

struct Row {
    check: Check,
    raced: Raced,
    /// The same over the free motions and over the blocked ones.
    by_truth: [f64; 2],
    missed: usize,
    undecided: usize,
}

pub(super) fn section(study: &Study, advance: &mut dyn FnMut(f64)) -> Result<Section, NoStudy> {
    let planner = &study.planner;
    let motions = motions(planner, study.effort.of(400, 24))?;
    let proof = Check::Proof(Find::AnyContact);
    let truth: Vec<bool> = motions
        .iter()
        .map(|motion| proof.ask(motion) == Told::Blocked || at_steps(motion, DENSE) == Told::Blocked)
        .collect();
    advance(0.2);
    let blocked = truth.iter().filter(|blocked| **blocked).count();
    let checks: Vec<Check> =
        STEPS.into_iter().map(Check::Steps).chain([Find::AnyContact, Find::FirstContact].map(Check::Proof)).collect();
    let order: Vec<usize> = (0..motions.len()).collect();
    let mut ways: Vec<Way> = checks
        .iter()
        .map(|check| {
            let (motions, order) = (&motions, &order);
            Way::new(order.len(), move |item| _ = std::hint::black_box(check.ask(&motions[order[item]])))
        })
        .collect();
    let raced = race(&mut ways, study.effort.share(SHARE, 1), &mut |part| advance(0.2 + 0.8 * part));
    drop(ways);
    let rows: Vec<Row> = checks
        .iter()
        .zip(raced)
        .map(|(check, raced)| {
            let told: Vec<Told> = motions.iter().map(|motion| check.ask(motion)).collect();
            let missed = told.iter().zip(&truth).filter(|(told, blocked)| **blocked && **told == Told::Free).count();
            let of = |wanted: bool| {
                let own = motions.iter().zip(&truth).filter(|(_, blocked)| **blocked == wanted);
                let once = |(motion, _): (&Motion, &bool)| {
                    let begun = std::time::Instant::now();
                    let _ = std::hint::black_box(check.ask(motion));
                    begun.elapsed().as_secs_f64()
                };
                quantile(&own.map(once).collect::<Vec<f64>>(), 0.5)
            };
            let by_truth = [of(false), of(true)];
            let undecided = told.iter().filter(|told| **told == Told::Undecided).count();
            Row { check: *check, raced, by_truth, missed, undecided }
        })
        .collect();
    Ok(Section {
        title: "Motion checks",
        what: format!(
            "{} motions of the {} in {} scenes (straight lines between joint positions, {blocked} of them blocked): looked at in so many states, \
             or proved free all along. A miss is a blocked motion that is told to be free; the truth is the proof, and {DENSE} states.",
            motions.len(),
            planner.name,
            planner.scenes.len()
        ),
        readings: readings(&rows, motions.len(), blocked),
        advice: advice(&rows),
        figures: vec![figure(&rows, blocked)],
        summary: Some(summary(&rows)),
        table: table(&rows, motions.len(), blocked),
    })
}

fn figure(rows: &[Row], blocked: usize) -> Figure {
    let share = |row: &Row| row.missed as f64 / blocked.max(1) as f64;
    let series = |mark: usize, wanted: &dyn Fn(Check) -> bool| Series {
        mark,
        joined: mark == 1,
        points: rows
            .iter()
            .filter(|row| wanted(row.check))
            .map(|row| Point::with_tail(share(row), row.raced.median, row.raced.p99))
            .collect(),
    };
    let all = [
        series(1, &|check| matches!(check, Check::Steps(_))),
        series(0, &|check| check == Check::Proof(Find::AnyContact)),
        series(8, &|check| check == Check::Proof(Find::FirstContact)),
    ];
    let drawing = plot(
        "time of a motion by missed collisions",
        &Axis::linear("blocked motions told to be free", Unit::Part),
        &Axis::log("", Unit::Seconds),
        &all,
        0.0,
    );
    Figure {
        caption: "Fixed steps from 2 (right) to 256 states (left), and the proof; p99: thin lines up".to_owned(),
        legend: vec![
            ("fixed steps".to_owned(), 1),
            ("proof, any contact".to_owned(), 0),
            ("proof, first contact bracketed".to_owned(), 8),
        ],
        drawings: vec![drawing],
    }
}

fn advice(rows: &[Row]) -> Option<String> {
    let proof = rows.iter().find(|row| row.check == Check::Proof(Find::AnyContact))?;
    let steps = rows.iter().rfind(|row| matches!(row.check, Check::Steps(_)) && row.raced.median <= proof.raced.median);
    let beside = steps
        .map_or_else(String::new, |row| format!(", about as much as {} and without their doubt", row.check.name()));
    Some(format!(
        "check edges with CheckMotions, which proves them: {} in the median, {} a free one{beside}.",
        time(proof.raced.median),
        time(proof.by_truth[0])
    ))
}

fn readings(rows: &[Row], motions: usize, blocked: usize) -> Vec<String> {
    let proof = rows.iter().find(|row| row.check == Check::Proof(Find::AnyContact));
    let steps = rows.iter().filter(|row| matches!(row.check, Check::Steps(_)));
    let missing: Vec<String> = steps
        .clone()
        .filter(|row| row.missed > 0)
        .map(|row| format!("{} miss {}", row.check.name(), row.missed))
        .collect();
    let mut texts = Vec::new();
    if let Some(proof) = proof {
        let dearer = steps.clone().find(|row| row.raced.median > proof.raced.median);
        let beside = dearer.map_or_else(
            || "which is more than any number of steps here".to_owned(),
            |row| format!("less than {} take ({})", row.check.name(), time(row.raced.median)),
        );
        texts.push(format!(
            "The proof takes {} a motion in the median, {beside}; it misses {} of {blocked} and leaves {} of {motions} undecided.",
            time(proof.raced.median),
            proof.missed,
            proof.undecided
        ));
    }
    texts.push(if missing.is_empty() {
        "No number of steps misses one of these motions; on others they may.".to_owned()
    } else {
        format!(
            "Of fixed steps, {}. That more steps miss none here is no promise for the next motion.",
            missing.join(", ")
        )
    });
    texts
}

fn summary(rows: &[Row]) -> (Vec<String>, Vec<Vec<String>>) {
    let columns = ["check", "median", "p99", "a free motion", "a blocked one", "missed", "undecided"];
    let row = |row: &Row| {
        vec![
            row.check.name(),
            time(row.raced.median),
            time(row.raced.p99),
            time(row.by_truth[0]),
            time(row.by_truth[1]),
            row.missed.to_string(),
            row.undecided.to_string(),
        ]
    };
    (columns.map(str::to_owned).to_vec(), rows.iter().map(row).collect())
}

fn table(rows: &[Row], motions: usize, blocked: usize) -> Table {
    let columns = [
        "check",
        "motions",
        "blocked",
        "missed",
        "undecided",
        "missed_share",
        "time_median_ns",
        "time_p99_ns",
        "time_free_median_ns",
        "time_blocked_median_ns",
    ];
    let mut table = Table::new("motion", &columns);
    for row in rows {
        table.push(vec![
            row.check.name(),
            motions.to_string(),
            blocked.to_string(),
            row.missed.to_string(),
            row.undecided.to_string(),
            number(row.missed as f64 / blocked.max(1) as f64),
            nanoseconds(row.raced.median),
            nanoseconds(row.raced.p99),
            nanoseconds(row.by_truth[0]),
            nanoseconds(row.by_truth[1]),
        ]);
    }
    table
}
