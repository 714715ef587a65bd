//! When do doubles not tell any more? Verdicts as the gap shrinks from a metre to a step of doubles, on each rung of precision.

use crate::geometry::{Quaternion, Shape, Vec3};
use crate::narrow_phase::{Accuracy, Goal, Separation, Solver, Termination, separation};

use super::families::{Family, Pair, placed};
use super::plot::{Point, Series, plot};
use super::race::{Raced, Way, quantile, race};
use super::random::Random;
use super::scale::{Axis, Unit, short, time};
use super::section::{Figure, Section};
use super::study::{NoStudy, Study};
use super::table::{Table, nanoseconds, number};

/// Of the time.
pub(super) const SHARE: f64 = 0.1;

/// Metres apart: down to about a step of doubles at a metre, 2.2e-16, and none.
const GAPS: [f64; 15] =
    [1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-13, 3e-14, 1e-14, 2e-15, f64::EPSILON, 0.0];

/// Where a gap of nothing is drawn.
const TOUCHING: f64 = 1e-18;

/// How the verdict is asked.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Precision {
    /// Doubles, and what they leave open stays open.
    Doubles,
    /// As always: doubles first, then twice the digits, then whole numbers, each only for what the one before left open.
    AsNeeded,
    /// Whole numbers for every pair.
    Exact,
}

const ALL: [Precision; 3] = [Precision::Doubles, Precision::AsNeeded, Precision::Exact];

impl Precision {
    fn name(self) -> &'static str {
        match self {
            Self::Doubles => "doubles alone",
            Self::AsNeeded => "as needed (the library)",
            Self::Exact => "exact for every pair",
        }
    }

    fn mark(self) -> usize {
        match self {
            Self::Doubles => 1,
            Self::AsNeeded => 0,
            Self::Exact => 8,
        }
    }

    fn goal(self) -> Goal<'static> {
        match self {
            // Where nothing beyond zero is of interest, nothing is worked out again.
            Self::Doubles => Goal { cut_off: 0.0, ..Goal::verdict() },
            Self::AsNeeded => Goal::verdict(),
            Self::Exact => Goal { solver: Solver::Exact, ..Goal::verdict() },
        }
    }
}

/// Who had the last word on a pair.
#[derive(Clone, Copy, Debug, Default)]
struct Deciders {
    doubles: usize,
    double_doubles: usize,
    exact: usize,
    nobody: usize,
}

impl Deciders {
    fn of(answers: &[Separation]) -> Self {
        let mut all = Self::default();
        for found in answers {
            let decided = found.bracket.lower > 0.0 || found.bracket.upper <= 0.0;
            let count = match (decided, found.termination == Termination::Exact, found.cost.escalations > 0) {
                (false, _, _) => &mut all.nobody,
                (true, true, _) => &mut all.exact,
                (true, false, true) => &mut all.double_doubles,
                (true, false, false) => &mut all.doubles,
            };
            *count += 1;
        }
        all
    }
}

/// Pairs at a gap, and what was measured.
struct Row {
    gap: f64,
    /// The middle of the gaps that came out, metres: by exact arithmetic where the shapes allow it.
    reached: f64,
    pairs: usize,
    raced: Vec<(Precision, Raced)>,
    undecided: Vec<(Precision, usize)>,
    deciders: Deciders,
}

/// Moves B along the normal until the gap, as told by the narrowest bracket there is, is within half of what is wanted.
fn adjusted(mut pair: Pair, gap: f64) -> Pair {
    let exact = Solver::Exact.claims(&pair.a, &pair.b).is_ok();
    let goal = Goal {
        accuracy: Accuracy { absolute: 0.0, relative: 0.0 },
        solver: if exact { Solver::Exact } else { Solver::Default },
        ..Goal::penetration()
    };
    let mut best = (f64::INFINITY, pair.at_b);
    for _ in 0..12 {
        let Ok(found) = separation(&pair.a, &pair.b, &pair.at_a, &pair.at_b, &goal) else { break };
        let off = found.signed_distance - gap;
        if off.abs() < best.0 {
            best = (off.abs(), pair.at_b);
        }
        let Some(rotation) = pair.at_b.quaternion else { break };
        let Some(next) = placed(pair.at_b.translation - found.normal * off, rotation) else { break };
        if off.abs() <= 1e-3 * gap || next == pair.at_b {
            break;
        }
        pair.at_b = next;
    }
    pair.at_b = best.1;
    pair
}

/// Two bodies that touch exactly: unturned, B above A along z, all lengths multiples of 2^-20 m so that nothing is rounded.
fn touching(family: Family, random: &mut Random) -> Option<Pair> {
    let round = |x: f64| (x * 1_048_576.0).round() / 1_048_576.0;
    let mut body = || {
        let radii = random.radii().map(round);
        let shape = match family {
            Family::Box => Shape::cuboid(radii),
            Family::Ellipsoid => Shape::ellipsoid(radii),
            Family::Hull(_) | Family::Capsule | Family::BallAndHull | Family::CylinderAndCone => {
                let corner = |_| random.direction().component_mul(&radii).map(round);
                // With the poles, so that the highest point of A and the lowest of B are one above the other.
                let poles = [Vec3::z() * radii.z, -Vec3::z() * radii.z];
                let points: Vec<Vec3> = (0..family.corners()).map(corner).chain(poles).collect();
                Shape::convex(&points)
            }
        };
        shape.ok().map(|shape| (shape, radii.z))
    };
    let ((a, top), (b, bottom)) = (body()?, body()?);
    let at_a = placed(Vec3::zeros(), Quaternion::IDENTITY)?;
    let at_b = placed(Vec3::z() * (top + bottom), Quaternion::IDENTITY)?;
    Some(Pair { a, b, at_a, at_b, before: at_b, extent: 4.0 })
}

fn row(family: Family, gap: f64, study: &Study, random: &mut Random, rows: usize) -> Row {
    let count = study.effort.of(60, 6);
    let pairs: Vec<Pair> = if gap > 0.0 {
        family.pairs(gap.max(1e-6), count, random).into_iter().map(|pair| adjusted(pair, gap)).collect()
    } else {
        std::iter::repeat_with(|| touching(family, random)).take(count).flatten().collect()
    };
    let takes = |precision: &Precision| {
        let solver = precision.goal().solver;
        pairs.iter().all(|pair| solver.claims(&pair.a, &pair.b).is_ok())
    };
    let precisions: Vec<Precision> = ALL.into_iter().filter(takes).collect();
    let answer = |pair: &Pair, goal: &Goal| separation(&pair.a, &pair.b, &pair.at_a, &pair.at_b, goal).ok();
    let answers = |precision: Precision| -> Vec<Separation> {
        pairs.iter().filter_map(|pair| answer(pair, &precision.goal())).collect()
    };
    let mut ways: Vec<Way> = precisions
        .iter()
        .map(|precision| {
            let goal = precision.goal();
            let pairs = &pairs;
            Way::new(pairs.len(), move |item| _ = std::hint::black_box(answer(&pairs[item], &goal)))
        })
        .collect();
    let raced = race(&mut ways, study.effort.share(SHARE, rows), &mut |_| ());
    let exact = |pair: &Pair| {
        let solver = if takes(&Precision::Exact) { Solver::Exact } else { Solver::Default };
        answer(pair, &Goal { solver, ..Goal::penetration() }).map(|found| found.signed_distance)
    };
    Row {
        gap,
        reached: quantile(&pairs.iter().filter_map(exact).collect::<Vec<f64>>(), 0.5),
        pairs: pairs.len(),
        raced: precisions.iter().copied().zip(raced).collect(),
        undecided: precisions.iter().map(|p| (*p, Deciders::of(&answers(*p)).nobody)).collect(),
        deciders: Deciders::of(&answers(Precision::AsNeeded)),
    }
}

pub(super) fn section(study: &Study, advance: &mut dyn FnMut(f64)) -> Result<Section, NoStudy> {
    let families = [Family::Box, Family::Hull(64), Family::Ellipsoid];
    let mut random = Random(40);
    let columns = [
        "family",
        "gap_wanted_m",
        "gap_median_m",
        "pairs",
        "precision",
        "time_median_ns",
        "time_p99_ns",
        "undecided",
        "decided_by_doubles",
        "decided_by_double_doubles",
        "decided_by_exact",
    ];
    let mut table = Table::new("precision", &columns);
    let (mut drawings, mut readings) = (Vec::new(), Vec::new());
    let count = families.len() * GAPS.len();
    for (f, family) in families.into_iter().enumerate() {
        let mut rows = Vec::new();
        for (g, gap) in GAPS.into_iter().enumerate() {
            rows.push(row(family, gap, study, &mut random, count));
            advance((f * GAPS.len() + g + 1) as f64 / count as f64);
        }
        for row in &rows {
            for ((precision, raced), (_, undecided)) in row.raced.iter().zip(&row.undecided) {
                let needed = *precision == Precision::AsNeeded;
                let by = |count: usize| if needed { count.to_string() } else { String::new() };
                table.push(vec![
                    family.name(),
                    number(row.gap),
                    number(row.reached),
                    row.pairs.to_string(),
                    precision.name().to_owned(),
                    nanoseconds(raced.median),
                    nanoseconds(raced.p99),
                    undecided.to_string(),
                    by(row.deciders.doubles),
                    by(row.deciders.double_doubles),
                    by(row.deciders.exact),
                ]);
            }
        }
        drawings.push(drawn(family, &rows).concat());
        readings.extend(reading(family, &rows));
    }
    Ok(Section {
        title: "Precision",
        what: "Is this pair apart? Asked of pairs nearer and nearer to contact, down to a step of doubles, and last of pairs that touch exactly (left edge). Doubles alone leave open \
               what lies within their errors; the library then works with twice the digits, and of polytopes with whole numbers, where nothing \
               stays open."
            .to_owned(),
        readings,
        advice: Some(
            "nothing to choose: what doubles cannot tell is worked out with more digits by itself, and costs time only there.".to_owned(),
        ),
        figures: vec![Figure {
            caption: "Time of a verdict (p99: thin line up) and the share that stays undecided".to_owned(),
            legend: ALL.iter().map(|precision| (precision.name().to_owned(), precision.mark())).collect(),
            drawings,
        }],
        summary: None,
        table,
    })
}

fn drawn(family: Family, rows: &[Row]) -> [String; 2] {
    let gap = Axis::log("apart, m", Unit::Plain);
    let series = |point: &dyn Fn(&Row, usize) -> Option<Point>| -> Vec<Series> {
        let of = |precision: Precision| {
            let index = |row: &Row| row.raced.iter().position(|(p, _)| *p == precision);
            let points = rows.iter().filter_map(|row| point(row, index(row)?)).collect();
            Series { mark: precision.mark(), joined: true, points }
        };
        ALL.map(of).into_iter().filter(|series| !series.points.is_empty()).collect()
    };
    let timed = |row: &Row, i: usize| {
        let raced = &row.raced[i].1;
        Some(Point::with_tail(row.reached, raced.median, raced.p99))
    };
    let open = |row: &Row, i: usize| Some(Point::new(row.reached, row.undecided[i].1 as f64 / row.pairs.max(1) as f64));
    let share = Axis { around: Some((0.0, 1.0)), ..Axis::linear("", Unit::Part) };
    [
        plot(
            &format!("{}: time by gap", family.name()),
            &gap,
            &Axis::log("", Unit::Seconds),
            &series(&timed),
            TOUCHING,
        ),
        plot(&format!("{}: undecided by gap", family.name()), &gap, &share, &series(&open), TOUCHING),
    ]
}

fn reading(family: Family, rows: &[Row]) -> Option<String> {
    let raced = |row: &Row, precision: Precision| {
        row.raced.iter().find(|(p, _)| *p == precision).map(|(_, raced)| raced.median)
    };
    let open =
        |row: &Row, precision: Precision| row.undecided.iter().find(|(p, _)| *p == precision).map(|(_, count)| *count);
    let first_open = rows.iter().find(|row| open(row, Precision::Doubles).is_some_and(|count| count > 0));
    let apart: Vec<&Row> = rows.iter().filter(|row| row.gap > 0.0).collect();
    let (far, near, touching) = (apart.first()?, apart.last()?, rows.iter().find(|row| row.gap == 0.0)?);
    let left: usize = apart.iter().filter_map(|row| open(row, Precision::AsNeeded)).sum();
    let pairs: usize = apart.iter().map(|row| row.pairs).sum();
    let begins = first_open.map_or_else(
        || "decide every gap".to_owned(),
        |row| format!("leave verdicts open from {} m on", short(row.reached)),
    );
    Some(format!(
        "{}: doubles alone {begins}; as needed, {left} of {pairs} pairs that are apart stay open. A verdict takes {} far apart and {} at {} m, where \
         {} of {} pairs went to double-doubles and {} to exact arithmetic. Of {} that touch exactly, exact arithmetic decided {} and {} stay open ({}).",
        family.name(),
        time(raced(far, Precision::AsNeeded)?),
        time(raced(near, Precision::AsNeeded)?),
        short(near.reached),
        near.deciders.double_doubles,
        near.pairs,
        near.deciders.exact,
        touching.pairs,
        touching.deciders.exact,
        touching.deciders.nobody,
        time(raced(touching, Precision::AsNeeded)?),
    ))
}
