//! Which derivatives lead two bodies to where they should touch? The lecture's optimisation, from a thousand places for each kind of shape.

use std::time::Instant;

use super::body::mug;
use super::contact_target::{Attempt, ContactTarget, Course, REACHED};
use super::families::{hull, radius};
use super::plot::{Point, Series, plot};
use super::race::quantile;
use super::random::Random;
use super::scale::{Axis, Unit, time};
use super::section::{Figure, Section};
use super::study::{NoStudy, Study};
use super::table::{Table, number};
use crate::geometry::{InvalidShape, Pose, Shape};
use crate::narrow_phase::DerivativeMethod;

/// Of the time; the attempts take as long as they take.
pub(super) const SHARE: f64 = 0.06;

/// Places to start from, of a full study.
const STARTS: usize = 1000;

/// Separations that an attempt may ask, those in moved places among them.
const BUDGET: u64 = 600;

/// Pairs of samples: as many separations as central differences ask, and as much noise as that leaves.
const SAMPLES: u32 = 12;

/// Directions there and back; they ask for support points only.
const DIRECTIONS: u32 = 32;

const METHODS: [(DerivativeMethod, &str, u32); 5] = [
    (DerivativeMethod::Exact, "exact", 1),
    (DerivativeMethod::FiniteDifference, "finite differences", 1),
    (DerivativeMethod::Smoothed0, "smoothed, order 0", SAMPLES),
    (DerivativeMethod::Smoothed1Gaussian, "smoothed, order 1, Gaussian", DIRECTIONS),
    (DerivativeMethod::Smoothed1Gumbel, "smoothed, order 1, Gumbel", 1),
];

const KINDS: [Kind; 3] = [Kind::Ellipsoids, Kind::Hulls, Kind::HullAndMesh];

#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Ellipsoids,
    Hulls,
    HullAndMesh,
}

impl Kind {
    const fn name(self) -> &'static str {
        match self {
            Self::Ellipsoids => "ellipsoids",
            Self::Hulls => "hulls of 20",
            Self::HullAndMesh => "mug (a mesh) and hull of 20",
        }
    }

    fn shapes(self, random: &mut Random) -> Result<[Shape; 2], InvalidShape> {
        Ok(match self {
            Self::Ellipsoids => [Shape::ellipsoid(random.radii())?, Shape::ellipsoid(random.radii())?],
            Self::Hulls => [hull(20, random)?, hull(20, random)?],
            // As large as one another: a mug is 10 cm high.
            Self::HullAndMesh => [Shape::mesh(mug(24)?).scaled(10.0)?, hull(20, random)?],
        })
    }

    /// A target that can be reached, and a place to start from.
    fn problem(self, random: &mut Random) -> Option<(ContactTarget, Pose)> {
        let shapes = self.shapes(random).ok()?;
        let size = radius(&shapes[0]).min(radius(&shapes[1]));
        let target = ContactTarget::random(shapes, size, random)?;
        let start = target.start(random)?;
        Some((target, start))
    }
}

/// All attempts of one method at one kind of shapes.
struct Row {
    kind: Kind,
    method: usize,
    courses: Vec<Course>,
    /// Of each attempt.
    seconds: Vec<f64>,
}

impl Row {
    fn reached(&self) -> f64 {
        self.courses.iter().filter(|course| course.reached).count() as f64 / self.courses.len() as f64
    }

    /// Wilson's 95 % interval of the share that is reached.
    fn interval(&self) -> [f64; 2] {
        let (z, n, p) = (1.96, self.courses.len() as f64, self.reached());
        let middle = (p + z * z / (2.0 * n)) / (1.0 + z * z / n);
        let half = z / (1.0 + z * z / n) * (p * (1.0 - p) / n + z * z / (4.0 * n * n)).sqrt();
        [middle - half, middle + half]
    }

    fn mean_seconds(&self) -> f64 {
        self.seconds.iter().sum::<f64>() / self.seconds.len() as f64
    }

    fn per_second(&self) -> f64 {
        self.reached() / self.mean_seconds()
    }

    fn median(&self, of: impl Fn(&Course) -> u64) -> f64 {
        quantile(&self.courses.iter().map(|course| of(course) as f64).collect::<Vec<f64>>(), 0.5)
    }

    /// The part that is reached within so many separations.
    fn reached_within(&self, queries: f64) -> f64 {
        let counts = |course: &&Course| course.reached && course.queries as f64 <= queries;
        self.courses.iter().filter(counts).count() as f64 / self.courses.len() as f64
    }
}

pub(super) fn section(study: &Study, advance: &mut dyn FnMut(f64)) -> Result<Section, NoStudy> {
    let starts = study.effort.of(STARTS, 12);
    let mut rows = Vec::new();
    for (done, kind) in KINDS.into_iter().enumerate() {
        let mut random = Random(700 + done as u64);
        let tries = std::iter::repeat_with(|| kind.problem(&mut random));
        let problems: Vec<(ContactTarget, Pose)> = tries.take(100 * starts).flatten().take(starts).collect();
        let mut own: Vec<Row> =
            (0..METHODS.len()).map(|method| Row { kind, method, courses: Vec::new(), seconds: Vec::new() }).collect();
        for (number, (target, start)) in problems.iter().enumerate() {
            advance((done as f64 + number as f64 / starts as f64) / KINDS.len() as f64);
            for row in &mut own {
                let (method, _, samples) = METHODS[row.method];
                let attempt = Attempt { method, samples, budget: BUDGET, seed: number as u64 };
                let begun = Instant::now();
                let course = target.reach(*start, &attempt);
                row.seconds.push(begun.elapsed().as_secs_f64());
                row.courses.push(course.ok_or_else(|| NoStudy::own("a pair has no separation"))?);
            }
        }
        rows.append(&mut own);
    }
    Ok(Section {
        title: "Following derivatives",
        what: format!(
            "The lecture's optimisation: B is moved until the nearest points of both bodies are where they are wanted and in one another, by \
             Levenberg's and Marquardt's method on the residuals. {starts} targets and starts at random of each kind; every target is the one \
             point of a real contact. Reached: every residual below {REACHED} of the size, within {BUDGET} separations (those that differences \
             and order 0 ask in moved places among them). Smoothing shrinks with the cost."
        ),
        readings: KINDS.iter().map(|kind| reading(&rows, *kind)).collect(),
        advice: advice(&rows),
        figures: vec![figure(&rows)],
        summary: Some(summary(&rows)),
        table: table(&rows),
    })
}

fn of_kind(rows: &[Row], kind: Kind) -> impl Iterator<Item = &Row> {
    rows.iter().filter(move |row| row.kind == kind)
}

fn best(rows: &[Row], kind: Kind) -> Option<&Row> {
    of_kind(rows, kind).max_by(|one, other| one.per_second().total_cmp(&other.per_second()))
}

fn percent(part: f64) -> String {
    format!("{:.0} %", part * 100.0)
}

fn reading(rows: &[Row], kind: Kind) -> String {
    let told =
        |row: &Row| format!("{} {} in {}", METHODS[row.method].1, percent(row.reached()), time(row.mean_seconds()));
    let all: Vec<String> = of_kind(rows, kind).map(told).collect();
    let most = best(rows, kind).map_or("none", |row| METHODS[row.method].1);
    format!("{}: {}. Most targets in the same time: {most}.", kind.name(), all.join("; "))
}

fn advice(rows: &[Row]) -> Option<String> {
    let name = |kind: Kind| best(rows, kind).map(|row| METHODS[row.method].1);
    Some(format!(
        "derivatives to follow: {} for smooth shapes, {} for hulls, {} for meshes.",
        name(Kind::Ellipsoids)?,
        name(Kind::Hulls)?,
        name(Kind::HullAndMesh)?
    ))
}

fn figure(rows: &[Row]) -> Figure {
    let (x, y) = (Axis::log("separations asked", Unit::Plain), Axis::linear("", Unit::Plain));
    let marks = |row: &Row| {
        let steps = (0..=24).map(|step| libm::pow(BUDGET as f64, f64::from(step) / 24.0));
        let points = steps.map(|queries| Point::new(queries, row.reached_within(queries))).collect();
        Series { mark: row.method, joined: true, points }
    };
    let drawing = |kind: Kind| plot(kind.name(), &x, &y, &of_kind(rows, kind).map(marks).collect::<Vec<_>>(), 1.0);
    Figure {
        caption: "The part of targets that are reached, by the separations that were asked".to_owned(),
        legend: METHODS.iter().enumerate().map(|(mark, (_, name, _))| ((*name).to_owned(), mark)).collect(),
        drawings: KINDS.into_iter().map(drawing).collect(),
    }
}

fn summary(rows: &[Row]) -> (Vec<String>, Vec<Vec<String>>) {
    let columns =
        ["shapes", "derivatives", "reached", "steps", "separations", "time of an attempt", "reached a second"];
    let row = |row: &Row| {
        vec![
            row.kind.name().to_owned(),
            METHODS[row.method].1.to_owned(),
            percent(row.reached()),
            number(row.median(|course| course.steps)),
            number(row.median(|course| course.queries)),
            time(row.mean_seconds()),
            format!("{:.0}", row.per_second()),
        ]
    };
    (columns.map(str::to_owned).to_vec(), rows.iter().map(row).collect())
}

fn table(rows: &[Row]) -> Table {
    let columns = [
        "shapes",
        "method",
        "starts",
        "reached",
        "reached_low",
        "reached_high",
        "steps_median",
        "separations_median",
        "left_median",
        "seconds_mean",
        "reached_per_second",
    ];
    let mut table = Table::new("alignment", &columns);
    for row in rows {
        let left: Vec<f64> = row.courses.iter().map(|course| course.left).collect();
        let [low, high] = row.interval();
        table.push(vec![
            row.kind.name().to_owned(),
            METHODS[row.method].1.to_owned(),
            row.courses.len().to_string(),
            number(row.reached()),
            number(low),
            number(high),
            number(row.median(|course| course.steps)),
            number(row.median(|course| course.queries)),
            number(quantile(&left, 0.5)),
            number(row.mean_seconds()),
            number(row.per_second()),
        ]);
    }
    table
}
