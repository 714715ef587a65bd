//! What does each answer cost, on one and the same set of pairs? From the bare verdict up to the patch and the time of impact.

#[cfg(feature = "effect-motion")]
use crate::geometry::{Placement, Pose, Quaternion, RigidMotion, Vec3};
use crate::narrow_phase::{Accuracy, Depth, Goal, PairCache, Separation, separation, separation_again};
#[cfg(feature = "effect-derivatives")]
use crate::narrow_phase::{DerivativeGoal, derivatives};
#[cfg(feature = "effect-motion")]
use crate::narrow_phase::{ImpactGoal, impact};
#[cfg(feature = "effect-patch")]
use crate::narrow_phase::{PatchGoal, contact_patch};

use super::families::{Family, Pair};
use super::race::{Raced, Way, quantile, race};
use super::random::Random;
use super::rungs::{Rung, rungs};
use super::scale::{Axis, Unit, time};
use super::section::{Figure, Section};
use super::study::{NoStudy, Study};
use super::table::{Table, nanoseconds, number};

/// Of the time.
pub(super) const SHARE: f64 = 0.08;

/// Signed distances, metres: as many pairs of each.
const GAPS: [f64; 5] = [0.1, 0.01, 0.001, -0.001, -0.01];

/// Within which a pair is `MARGIN`, metres.
const MARGIN: f64 = 0.02;

/// An output: its name, what it is, and whether overlaps are asked, too.
struct Output {
    name: &'static str,
    ask: Ask,
    /// Of pairs that overlap there is nothing to ask.
    apart_only: bool,
}

/// How it is asked.
enum Ask {
    /// One question to a pair.
    Pair(Goal<'static>),
    /// The same from the cache of a moment ago.
    Again(Goal<'static>),
    /// The same, and the patch that its answer leads to.
    #[cfg(feature = "effect-patch")]
    Patch(Goal<'static>, PatchGoal),
    /// The same, and how it changes when the bodies move.
    #[cfg(feature = "effect-derivatives")]
    Derivatives(Goal<'static>, DerivativeGoal),
    /// B comes along the line between the origins until it touches.
    #[cfg(feature = "effect-motion")]
    Impact(ImpactGoal<'static>),
}

fn outputs() -> Vec<Output> {
    let relative = |relative| Accuracy { absolute: 0.0, relative };
    let distance = |tolerance| Goal { depth: Depth::Distance, accuracy: relative(tolerance), ..Goal::penetration() };
    let depth = Goal { accuracy: relative(1e-6), ..Goal::penetration() };
    let one = |name, ask| Output { name, ask, apart_only: false };
    vec![
        one("verdict, from the cache", Ask::Again(Goal::verdict())),
        one("verdict", Ask::Pair(Goal::verdict())),
        one("verdict with a margin of 2 cm", Ask::Pair(Goal { margin: MARGIN, ..Goal::verdict() })),
        one("bracket to 10 %", Ask::Pair(distance(1e-1))),
        one("distance to 1e-6", Ask::Pair(distance(1e-6))),
        one("distance and witness to 1e-12", Ask::Pair(distance(1e-12))),
        one("depth, too, to 1e-6", Ask::Pair(depth)),
        #[cfg(feature = "effect-patch")]
        one("depth and patch to 1e-6", Ask::Patch(depth, PatchGoal::default())),
        #[cfg(feature = "effect-derivatives")]
        one("depth and exact derivatives to 1e-6", Ask::Derivatives(depth, DerivativeGoal::default())),
        #[cfg(feature = "effect-motion")]
        Output { name: "time of impact to 1e-9", ask: Ask::Impact(ImpactGoal::touch()), apart_only: true },
    ]
}

/// A set of pairs of one family.
struct Set {
    family: Family,
    pairs: Vec<Pair>,
    /// As many of them are apart: the first ones.
    apart: usize,
    /// B on its way through A.
    #[cfg(feature = "effect-motion")]
    motions: Vec<(RigidMotion, RigidMotion)>,
}

impl Set {
    fn new(family: Family, of_each: usize, random: &mut Random) -> Self {
        let pairs: Vec<Pair> = GAPS.iter().flat_map(|gap| family.pairs(*gap, of_each, random)).collect();
        let apart = pairs.iter().filter(|pair| is_apart(pair)).count();
        #[cfg(feature = "effect-motion")]
        let motions = pairs.iter().take(apart).filter_map(motions).collect();
        Self {
            family,
            pairs,
            apart,
            #[cfg(feature = "effect-motion")]
            motions,
        }
    }

    fn items(&self, output: &Output) -> usize {
        if output.apart_only { self.apart } else { self.pairs.len() }
    }

    fn answer(&self, item: usize, goal: &Goal) -> Option<Separation> {
        let Pair { a, b, at_a, at_b, .. } = &self.pairs[item];
        separation(a, b, at_a, at_b, goal).ok()
    }

    fn way<'a>(&'a self, output: &'a Output) -> Way<'a> {
        let items = self.items(output);
        match &output.ask {
            Ask::Pair(goal) => Way::new(items, move |item| _ = std::hint::black_box(self.answer(item, goal))),
            Ask::Again(goal) => {
                let mut caches = vec![(PairCache::new(), false); items];
                Way::new(items, move |item| {
                    let Pair { a, b, at_a, at_b, before, .. } = &self.pairs[item];
                    let (cache, there) = &mut caches[item];
                    *there = !*there;
                    let at_b = if *there { before } else { at_b };
                    let _ = std::hint::black_box(separation_again(a, b, at_a, at_b, goal, cache));
                })
            }
            #[cfg(feature = "effect-patch")]
            Ask::Patch(goal, patch) => Way::new(items, move |item| {
                let Pair { a, b, at_a, at_b, .. } = &self.pairs[item];
                let found = self.answer(item, goal);
                let _ = std::hint::black_box(found.map(|found| contact_patch(a, b, at_a, at_b, &found, patch)));
            }),
            #[cfg(feature = "effect-derivatives")]
            Ask::Derivatives(goal, wanted) => Way::new(items, move |item| {
                let Pair { a, b, at_a, at_b, .. } = &self.pairs[item];
                let found = self.answer(item, goal);
                let _ = std::hint::black_box(found.map(|found| derivatives(a, b, at_a, at_b, &found, wanted, goal)));
            }),
            #[cfg(feature = "effect-motion")]
            Ask::Impact(goal) => Way::new(items, move |item| {
                let (Pair { a, b, .. }, (motion_a, motion_b)) = (&self.pairs[item], &self.motions[item]);
                let _ = std::hint::black_box(impact(a, b, motion_a, motion_b, goal));
            }),
        }
    }

    /// Mean support calls of an output that is asked of pairs at rest; the part of witness points that are good to a micrometre.
    fn work(&self, output: &Output) -> (f64, f64) {
        let Ask::Pair(goal) = &output.ask else { return (f64::NAN, f64::NAN) };
        let found: Vec<Separation> = (0..self.pairs.len()).filter_map(|item| self.answer(item, goal)).collect();
        let count = found.len().max(1) as f64;
        let apart: Vec<&Separation> = found.iter().take(self.apart).collect();
        let good = apart.iter().filter(|found| found.point_error <= 1e-6).count();
        let supports = found.iter().map(|found| found.cost.supports as f64).sum::<f64>();
        let is_measured = goal.depth != Depth::Verdict;
        (supports / count, if is_measured { good as f64 / apart.len().max(1) as f64 } else { f64::NAN })
    }
}

fn is_apart(pair: &Pair) -> bool {
    let found = separation(&pair.a, &pair.b, &pair.at_a, &pair.at_b, &Goal::verdict());
    found.is_ok_and(|found| found.bracket.lower > 0.0)
}

/// A stands still; B goes on by its distance to A's origin, and turns by a tenth of a turn on the way.
#[cfg(feature = "effect-motion")]
fn motions(pair: &Pair) -> Option<(RigidMotion, RigidMotion)> {
    let still = |at: &Placement| {
        let rotation = at.quaternion.unwrap_or(Quaternion::IDENTITY);
        Pose::new(at.translation, rotation).ok()
    };
    let (a, b) = (still(&pair.at_a)?, still(&pair.at_b)?);
    let turn = Vec3::new(0.0, 0.0, 0.1 * std::f64::consts::TAU);
    Some((RigidMotion::still(a), RigidMotion::by(b, -pair.at_b.translation, turn).ok()?))
}

pub(super) fn section(study: &Study, advance: &mut dyn FnMut(f64)) -> Result<Section, NoStudy> {
    let families = [Family::Box, Family::Hull(64), Family::Ellipsoid];
    let of_each = study.effort.of(40, 2);
    let mut random = Random(30);
    let outputs = outputs();
    let mut table = Table::new(
        "outputs",
        &["family", "output", "pairs", "time_median_ns", "time_p99_ns", "support_calls_mean", "witness_within_1um"],
    );
    let (mut drawings, mut readings) = (Vec::new(), Vec::new());
    for (i, family) in families.into_iter().enumerate() {
        let set = Set::new(family, of_each, &mut random);
        let mut ways: Vec<Way> = outputs.iter().map(|output| set.way(output)).collect();
        let share = study.effort.share(SHARE, families.len());
        let raced = race(&mut ways, share, &mut |part| advance((i as f64 + part) / families.len() as f64));
        drop(ways);
        for (output, raced) in outputs.iter().zip(&raced) {
            let (supports, good) = set.work(output);
            table.push(vec![
                family.name(),
                output.name.to_owned(),
                set.items(output).to_string(),
                nanoseconds(raced.median),
                nanoseconds(raced.p99),
                number(supports),
                number(good),
            ]);
        }
        drawings.push(drawing(&set, &outputs, &raced));
        readings.extend(reading(&set, &outputs, &raced));
    }
    Ok(Section {
        title: "Outputs",
        what: format!(
            "The same pairs asked for more and more: {} m of signed distance, {of_each} of each. Overlaps are among them, so that \
             the depth has something to do; a verdict or a distance proves them and stops. Of the pairs apart B then moves into A, for the time of impact.",
            GAPS.map(|gap| gap.to_string()).join(", ")
        ),
        readings,
        advice: None,
        figures: vec![Figure {
            caption: "Median over the pairs; the line leads to the 99th percentile".to_owned(),
            legend: Vec::new(),
            drawings,
        }],
        summary: None,
        table,
    })
}

fn drawing(set: &Set, outputs: &[Output], raced: &[Raced]) -> String {
    let rung = |(output, raced): (&Output, &Raced)| Rung {
        name: format!("{}: {} (p99 {})", output.name, time(raced.median), time(raced.p99)),
        values: vec![(1, raced.median, raced.p99)],
    };
    let all: Vec<Rung> = outputs.iter().zip(raced).map(rung).collect();
    rungs(&format!("{}: time of each output", set.family.name()), &Axis::log("time a pair", Unit::Seconds), &all)
}

fn reading(set: &Set, outputs: &[Output], raced: &[Raced]) -> Option<String> {
    let of = |name: &str| {
        let index = outputs.iter().position(|output| output.name == name)?;
        Some(raced[index].median)
    };
    let verdict = of("verdict")?;
    let times = |name: &str| Some(format!("{:.1}", of(name)? / verdict));
    let others: String =
        [("that with the patch", "depth and patch to 1e-6"), ("the time of impact", "time of impact to 1e-9")]
            .into_iter()
            .filter_map(|(what, name)| Some(format!(", {what} {}", times(name)?)))
            .collect();
    let apart = set.pairs.len() - set.apart;
    let overlapping: Vec<f64> = (set.apart..set.pairs.len())
        .filter_map(|item| set.answer(item, &Goal::penetration()))
        .map(|found| found.cost.supports as f64)
        .collect();
    Some(format!(
        "{}: as multiples of a verdict ({}), the distance to 1e-6 takes {}, with the witness to 1e-12 {}, with the depth of the {} \
         overlaps {} (there {:.0} support calls in the median){}; from the cache a verdict takes {}.",
        set.family.name(),
        time(verdict),
        times("distance to 1e-6")?,
        times("distance and witness to 1e-12")?,
        apart,
        times("depth, too, to 1e-6")?,
        quantile(&overlapping, 0.5),
        others,
        times("verdict, from the cache")?,
    ))
}
