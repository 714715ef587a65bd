//! From batch to answer: how many states a second does the service check, by the size of the batch, and what does a door add?

use std::sync::Arc;

use serde_json::Value;

use crate::query::{CheckStates, Context, Mode, Wants};
use crate::scene::SceneOptions;
use crate::service::{Change, Config, Patience, Service, ServiceError, Target};

use super::planner::ROBOT;
use super::plot::{Point, Series, plot};
use super::race::{Raced, Rounds, Way, race};
use super::scale::{Axis, Unit, time};
use super::section::{Figure, Section};
use super::study::{NoStudy, Study, read};
use super::table::{Table, nanoseconds, number};

/// Of the time.
pub(super) const SHARE: f64 = 0.04;

/// States of a question.
const SIZES: [usize; 7] = [1, 4, 16, 64, 256, 1024, 4096];

/// How a question is asked.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Asking {
    /// On the calling thread.
    Here,
    /// By the threads that answer questions.
    Threads,
}

const ASKINGS: [(Asking, &str); 2] =
    [(Asking::Here, "on the calling thread"), (Asking::Threads, "on the service's threads")];

const WANTS: [(Wants, &str); 2] =
    [(Wants::VERDICT, "verdict"), (Wants { distance: true, ..Wants::VERDICT }, "distance")];

struct Row {
    asking: Asking,
    asking_name: &'static str,
    wants_name: &'static str,
    size: usize,
    raced: Raced,
}

impl Row {
    fn per_second(&self) -> f64 {
        self.size as f64 / self.raced.median
    }
}

/// A figure of a door, as “clearance bench transports --json” tells it.
struct DoorRow {
    door: String,
    items: f64,
    through: f64,
    within: f64,
}

fn questions(states: &[Vec<f64>], size: usize, wants: Wants) -> CheckStates {
    let positions = states.iter().cycle().take(size).flatten().copied().collect();
    CheckStates {
        robot: ROBOT.to_owned(),
        positions,
        mode: Mode::All,
        context: Context { wants, ..Context::default() },
    }
}

pub(super) fn section(study: &Study, advance: &mut dyn FnMut(f64)) -> Result<Section, NoStudy> {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_time().build().map_err(NoStudy::own)?;
    let service = Service::new(&Config::default()).map_err(NoStudy::own)?;
    let scene = study.planner.scenes.first().ok_or_else(|| NoStudy::own("the planner has no scene"))?;
    service.create_scene(&scene.name, &SceneOptions::default()).map_err(NoStudy::own)?;
    let edits = study.planner.edits(scene);
    let change = Change { edits, expected_epoch: None, expected_revision: None, key: None };
    let applied = service.apply(&scene.name, Patience::default(), move || Ok(change));
    runtime.block_on(applied).map_err(NoStudy::own)?;
    let target = Target { scene: scene.name.clone(), ..Target::default() };
    let rows = rows(study, &service, &runtime, &target, &scene.states, advance)?;
    let doors = study.doors.as_deref().map(door_rows).transpose()?;
    let mut table =
        Table::new("batches", &["way", "want", "states", "time_median_ns", "time_p99_ns", "states_per_second"]);
    for row in &rows {
        table.push(vec![
            row.asking_name.to_owned(),
            row.wants_name.to_owned(),
            row.size.to_string(),
            nanoseconds(row.raced.median),
            nanoseconds(row.raced.p99),
            number(row.per_second()),
        ]);
    }
    for row in doors.iter().flatten() {
        for (way, seconds) in
            [(row.door.clone(), row.through), (format!("{}: the same in process", row.door), row.within)]
        {
            let (items, per_second) = (number(row.items), number(row.items / seconds));
            table.push(vec![way, "door".to_owned(), items, nanoseconds(seconds), String::new(), per_second]);
        }
    }
    let mut figures = vec![figure(&rows)];
    figures.extend(doors.as_deref().map(figure_of_doors));
    Ok(Section {
        title: "End to end",
        what: format!(
            "States of the {} in “{}” asked of the service in this process, by the number of states in a question; {} threads answer. {}",
            study.planner.name,
            scene.name,
            service.threads(),
            if doors.is_some() {
                "Below, the doors as “clearance bench transports --json” measured them, with states of a robot with one small shape, so that the door is \
                 most of it."
            } else {
                "The library only: figures of the doors are shown when they are given (clearance bench transports --json > FILE, then --doors FILE)."
            }
        ),
        readings: readings(&rows, doors.as_deref()),
        advice: advice(&rows),
        figures,
        summary: None,
        table,
    })
}

fn rows(
    study: &Study,
    service: &Arc<Service>,
    runtime: &tokio::runtime::Runtime,
    target: &Target,
    states: &[Vec<f64>],
    advance: &mut dyn FnMut(f64),
) -> Result<Vec<Row>, NoStudy> {
    let mut kinds = Vec::new();
    for (asking, asking_name) in ASKINGS {
        for (wants, wants_name) in WANTS {
            let sizes = SIZES.into_iter().filter(|size| study.effort.part >= 1.0 || *size <= 1024);
            kinds.extend(sizes.map(|size| (asking, asking_name, questions(states, size, wants), wants_name, size)));
        }
    }
    let failed = std::cell::RefCell::new(None::<ServiceError>);
    let mut ways: Vec<Way> = kinds
        .iter()
        .map(|(asking, _, question, ..)| {
            let failed = &failed;
            Way::new(1, move |_| {
                let answer = match asking {
                    Asking::Here => {
                        service.ask_here(target, Patience::default(), |view| view.check_states(question)).transpose()
                    }
                    Asking::Threads => {
                        let question = question.clone();
                        let asked = service.ask(target, Patience::default(), move |view| view.check_states(&question));
                        runtime.block_on(asked).map(Some)
                    }
                };
                if let Err(error) = std::hint::black_box(answer) {
                    failed.replace(Some(error));
                }
            })
        })
        .collect();
    let share = study.effort.share(SHARE, 1);
    // One item each, so that the tail is that of the rounds: more of them.
    let raced = race(&mut ways, Rounds { most: 301, ..share }, advance);
    drop(ways);
    if let Some(error) = failed.into_inner() {
        return Err(NoStudy::own(error));
    }
    let row = |((asking, asking_name, _, wants_name, size), raced): (
        (Asking, &'static str, CheckStates, &'static str, usize),
        Raced,
    )| {
        // The 99th percentile over the rounds of the one item.
        let p99 = super::race::quantile(&raced.rounds, 0.99);
        Row { asking, asking_name, wants_name, size, raced: Raced { p99, ..raced } }
    };
    Ok(kinds.into_iter().zip(raced).map(row).collect())
}

/// Lines of JSON; those about doors count.
fn door_rows(path: &std::path::Path) -> Result<Vec<DoorRow>, NoStudy> {
    let text = read(path)?;
    let mut rows = Vec::new();
    for line in text.lines().filter(|line| !line.trim().is_empty()) {
        let broken = |what: String| NoStudy::Content { path: path.to_owned(), what };
        let value: Value = serde_json::from_str(line).map_err(|error| broken(error.to_string()))?;
        if value["what"] != "door" {
            continue;
        }
        let number = |value: &Value| value.as_f64().ok_or_else(|| broken(format!("a number is missing in {line}")));
        rows.push(DoorRow {
            door: value["door"].as_str().unwrap_or("unnamed").to_owned(),
            items: number(&value["items"])?,
            through: number(&value["through"]["p50"])?,
            within: number(&value["within"]["p50"])?,
        });
    }
    if rows.is_empty() {
        let what = "no line of a door: it is to be made by clearance bench transports --json".to_owned();
        return Err(NoStudy::Content { path: path.to_owned(), what });
    }
    Ok(rows)
}

fn figure(rows: &[Row]) -> Figure {
    let mark = |asking: Asking, wants: usize| match asking {
        Asking::Here => 1 + 5 * wants,
        Asking::Threads => 2 + 5 * wants,
    };
    let mut series = Vec::new();
    let mut legend = Vec::new();
    for (asking, asking_name) in ASKINGS {
        for (wants, (_, wants_name)) in WANTS.iter().enumerate() {
            let own = rows.iter().filter(|row| row.asking == asking && row.wants_name == *wants_name);
            let points = own.map(|row| Point::new(row.size as f64, row.per_second())).collect();
            series.push(Series { mark: mark(asking, wants), joined: true, points });
            legend.push((format!("{wants_name}, {asking_name}"), mark(asking, wants)));
        }
    }
    let (x, y) = (Axis::log("states in a question", Unit::Plain), Axis::log("", Unit::Plain));
    let drawings = vec![plot("states a second", &x, &y, &series, 1.0)];
    Figure { caption: "Throughput of one caller, one question at a time".to_owned(), legend, drawings }
}

/// Each door once, in the order that they come first.
fn doors_of(rows: &[DoorRow]) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for row in rows {
        if !names.contains(&row.door.as_str()) {
            names.push(&row.door);
        }
    }
    names
}

fn figure_of_doors(rows: &[DoorRow]) -> Figure {
    let names = doors_of(rows);
    let mut series = Vec::new();
    let mut legend = Vec::new();
    for (i, name) in names.iter().enumerate() {
        let own = rows.iter().filter(|row| row.door == *name);
        let points = own.map(|row| Point::new(row.items, row.through)).collect();
        series.push(Series { mark: i + 1, joined: true, points });
        legend.push(((*name).to_owned(), i + 1));
    }
    let first = rows.iter().filter(|row| names.first().is_some_and(|name| row.door == **name));
    series.push(Series { mark: 0, joined: true, points: first.map(|row| Point::new(row.items, row.within)).collect() });
    legend.push(("the same in process".to_owned(), 0));
    let (x, y) = (Axis::log("states in a question", Unit::Plain), Axis::log("", Unit::Seconds));
    let drawings = vec![plot("doors: time of a question", &x, &y, &series, 1.0)];
    Figure { caption: "Through the doors".to_owned(), legend, drawings }
}

fn advice(rows: &[Row]) -> Option<String> {
    let verdicts: Vec<&Row> =
        rows.iter().filter(|row| row.asking == Asking::Threads && row.wants_name == "verdict").collect();
    let best = verdicts.iter().map(|row| row.per_second()).fold(0.0, f64::max);
    let enough = verdicts.iter().find(|row| row.per_second() >= 0.8 * best)?;
    Some(format!(
        "put at least {} states into a question: {:.0} verdicts a second, within a fifth of the best.",
        enough.size,
        enough.per_second()
    ))
}

fn readings(rows: &[Row], doors: Option<&[DoorRow]>) -> Vec<String> {
    let best = |asking: Asking, wants: &str| {
        let own = rows.iter().filter(|row| row.asking == asking && row.wants_name == wants);
        own.max_by(|a, b| a.per_second().total_cmp(&b.per_second()))
    };
    let mut texts = Vec::new();
    if let (Some(verdict), Some(distance), Some(one)) = (
        best(Asking::Threads, "verdict"),
        best(Asking::Threads, "distance"),
        rows.iter().find(|row| row.asking == Asking::Threads && row.wants_name == "verdict" && row.size == 1),
    ) {
        texts.push(format!(
            "{:.0} verdicts or {:.0} distances a second at best, with {} and {} states in a question. A question with one state takes {} through the threads, so \
             small questions pay for the hand-over ({:.0} a second).",
            verdict.per_second(),
            distance.per_second(),
            verdict.size,
            distance.size,
            time(one.raced.median),
            one.per_second()
        ));
    }
    if let Some(doors) = doors {
        let largest = doors.iter().map(|row| row.items).fold(0.0, f64::max);
        let beyond = doors
            .iter()
            .filter(|row| row.items == largest)
            .map(|row| format!("{} {}", row.door, time((row.through - row.within).max(0.0))));
        texts.push(format!(
            "What a door takes beyond the work, with {largest} states in a question: {}.",
            beyond.collect::<Vec<_>>().join(", ")
        ));
    }
    texts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_door_has_one_line_though_sizes_come_by_turns() {
        let row = |door: &str, items: f64| DoorRow { door: door.to_owned(), items, through: 1e-4, within: 1e-5 };
        let rows = [row("grpc", 1.0), row("zenoh", 1.0), row("grpc", 64.0), row("zenoh", 64.0)];
        assert_eq!(doors_of(&rows), ["grpc", "zenoh"]);
        let names: Vec<String> = figure_of_doors(&rows).legend.into_iter().map(|(name, _)| name).collect();
        assert_eq!(names, ["grpc", "zenoh", "the same in process"]);
    }

    #[test]
    fn lines_about_doors_are_read_and_others_passed_over() {
        let folder = std::env::temp_dir().join(format!("clearance-study-doors-{}", std::process::id()));
        let line = r#"{"what":"door","door":"grpc","items":64,"through":{"p50":1e-4},"within":{"p50":2e-5}}"#;
        std::fs::write(&folder, format!("{{\"what\":\"begin\"}}\n{line}\n")).unwrap();
        let rows = door_rows(&folder).unwrap();
        assert_eq!((rows.len(), rows[0].door.as_str(), rows[0].items, rows[0].through), (1, "grpc", 64.0, 1e-4));
        std::fs::write(&folder, "{\"what\":\"begin\"}\n").unwrap();
        assert!(door_rows(&folder).is_err());
        std::fs::remove_file(&folder).unwrap();
    }
}
