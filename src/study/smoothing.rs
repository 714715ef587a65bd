//! What is wrong with smoothed derivatives, and what do all kinds cost? Bias by epsilon, spread by samples, and times beside the distance alone.

use super::families::{Family, Pair};
use super::plot::{Point, Series, plot};
use super::race::{Raced, Way, quantile, race};
use super::random::Random;
use super::scale::{Axis, Unit, time};
use super::section::{Figure, Section};
use super::study::{NoStudy, Study};
use super::table::{Table, nanoseconds, number};
use crate::narrow_phase::{
    Accuracy, Depth, DerivativeGoal, DerivativeMethod, Derivatives, Goal, Separation, TwistMatrix, derivatives,
    separation,
};

/// Of the time.
pub(super) const SHARE: f64 = 0.04;

/// How far pairs are apart, metres.
const GAP: f64 = 0.05;

/// Epsilons from the first to the last, by halves.
const WIDEST: f64 = 0.4;
const HALVES: u32 = 8;

/// Numbers of samples, by factors of four.
const SAMPLES: [u32; 5] = [4, 16, 64, 256, 1024];

/// Samples where the bias is looked for, and in a mean.
const MANY: u32 = 2048;

/// So narrow that there is no bias. Equal seeds draw equal numbers, so that what an estimate is off it is bias alone: chance is in both.
const NARROW: f64 = 1e-4;

/// Where the spread is looked at.
const EPSILON: f64 = 0.1;

const SMOOTHED: [(DerivativeMethod, &str); 3] = [
    (DerivativeMethod::Smoothed0, "order 0"),
    (DerivativeMethod::Smoothed1Gaussian, "order 1, Gaussian"),
    (DerivativeMethod::Smoothed1Gumbel, "order 1, Gumbel"),
];

/// What is raced, and pairs of samples.
const PRICED: [(DerivativeMethod, &str, u32); 6] = [
    (DerivativeMethod::Exact, "exact", 1),
    (DerivativeMethod::ExactCell, "exact_cell", 1),
    (DerivativeMethod::Smoothed1Gumbel, "order 1, Gumbel", 1),
    (DerivativeMethod::Smoothed1Gaussian, "order 1, Gaussian, 64 samples", 64),
    (DerivativeMethod::Smoothed0, "order 0, 64 samples", 64),
    (DerivativeMethod::FiniteDifference, "finite differences", 1),
];

const FAMILIES: [Family; 3] = [Family::Ellipsoid, Family::Hull(64), Family::Hull(250)];

/// Pairs whose figures are drawn, and whose derivatives away from borders are those of the formula.
const SHOWN: [Family; 2] = [Family::Ellipsoid, Family::Hull(64)];

/// One measured figure of a method at a family.
struct Figured {
    family: Family,
    method: usize,
    epsilon: f64,
    samples: u32,
    /// Of the largest entry of the change of the normal; per metre, as a part of the exact one.
    value: f64,
}

fn narrow() -> Goal<'static> {
    Goal { depth: Depth::Distance, accuracy: Accuracy { absolute: 0.0, relative: 1e-12 }, ..Goal::penetration() }
}

fn found(pair: &Pair, goal: &Goal) -> Option<Separation> {
    separation(&pair.a, &pair.b, &pair.at_a, &pair.at_b, goal).ok()
}

fn told(pair: &Pair, goal: &DerivativeGoal) -> Option<Derivatives> {
    let found = found(pair, &narrow())?;
    derivatives(&pair.a, &pair.b, &pair.at_a, &pair.at_b, &found, goal, &narrow()).ok()
}

/// The part of the change of the normal that follows B's velocity: nine numbers that all methods have to find.
fn bent(told: &Derivatives) -> TwistMatrix {
    told.normal[1]
}

fn off(one: &Derivatives, other: &Derivatives) -> f64 {
    (bent(one) - bent(other)).norm() / bent(other).norm()
}

pub(super) fn section(study: &Study, advance: &mut dyn FnMut(f64)) -> Result<Section, NoStudy> {
    let mut random = Random(90);
    let count = study.effort.of(12, 2);
    let (mut bias, mut spread) = (Vec::new(), Vec::new());
    for (done, family) in SHOWN.into_iter().enumerate() {
        let pairs: Vec<Pair> = of_one_cell(family, count, &mut random);
        for method in 0..SMOOTHED.len() {
            advance(0.5 * (done as f64 + method as f64 / SMOOTHED.len() as f64) / SHOWN.len() as f64);
            bias.extend((0..HALVES).filter_map(|half| biased(family, &pairs, method, WIDEST / f64::from(1 << half))));
            spread.extend(SAMPLES.iter().filter_map(|samples| spread_out(family, &pairs, method, *samples)));
        }
    }
    let prices = prices(study, &mut random, &mut |part| advance(0.5 + 0.5 * part));
    Ok(Section {
        title: "Derivatives",
        what: format!(
            "Pairs 5 cm apart, inside of one cell. Bias: how far a smoothed change of the normal is from one with the same random numbers and next to no smoothing, as a part of \
             it; spread: how far single estimates are from their mean, at epsilon {EPSILON}. Prices: distance and derivatives beside the \
             distance alone, in turns."
        ),
        readings: readings(&bias, &spread, &prices),
        advice: None,
        figures: vec![
            figure("bias", "Bias by epsilon", "epsilon", &bias, |f| f.epsilon),
            figure("spread", "Spread by pairs of samples", "pairs of samples", &spread, |f| f64::from(f.samples)),
        ],
        summary: Some(summary(&prices)),
        table: table(&bias, &spread, &prices),
    })
}

/// Pairs whose exact derivatives hold as far as smoothing looks at the ends of the plots: not on a border, and well conditioned.
fn of_one_cell(family: Family, count: usize, random: &mut Random) -> Vec<Pair> {
    let exact = DerivativeGoal::default();
    let bends = |pair: &Pair| {
        told(pair, &exact).is_some_and(|told| {
            told.is_valid && !told.on_border && told.conditioning > 0.02 && bent(&told).norm() > 1e-3
        })
    };
    family.pairs(GAP, 4 * count, random).into_iter().filter(bends).take(count).collect()
}

/// The median over the pairs.
fn biased(family: Family, pairs: &[Pair], method: usize, epsilon: f64) -> Option<Figured> {
    let of_pair = |pair: &Pair| {
        let goal = |epsilon| DerivativeGoal {
            method: SMOOTHED[method].0,
            epsilon,
            samples: MANY,
            ..DerivativeGoal::default()
        };
        Some(off(&told(pair, &goal(epsilon))?, &told(pair, &goal(NARROW))?))
    };
    let values: Vec<f64> = pairs.iter().filter_map(of_pair).collect();
    let samples = if SMOOTHED[method].0 == DerivativeMethod::Smoothed1Gumbel { 0 } else { MANY };
    (!values.is_empty()).then(|| Figured { family, method, epsilon, samples, value: quantile(&values, 0.5) })
}

/// The root of the mean square over seeds, the median over the pairs. None of what is not random.
fn spread_out(family: Family, pairs: &[Pair], method: usize, samples: u32) -> Option<Figured> {
    let method_of = SMOOTHED[method].0;
    if method_of == DerivativeMethod::Smoothed1Gumbel {
        return None;
    }
    let of_pair = |pair: &Pair| {
        let goal = |seed, samples| DerivativeGoal { method: method_of, epsilon: EPSILON, samples, seed, stream: 0 };
        let mean = told(pair, &goal(1000, MANY))?;
        let squares: Vec<f64> =
            (0..16).filter_map(|seed| Some(off(&told(pair, &goal(seed, samples))?, &mean))).collect();
        Some((squares.iter().map(|x| x * x).sum::<f64>() / squares.len().max(1) as f64).sqrt())
    };
    let values: Vec<f64> = pairs.iter().filter_map(of_pair).collect();
    (!values.is_empty()).then(|| Figured { family, method, epsilon: EPSILON, samples, value: quantile(&values, 0.5) })
}

/// What a method took, beside the distance alone.
struct Price {
    family: Family,
    name: &'static str,
    raced: Raced,
    ratio: f64,
    separations: f64,
}

fn prices(study: &Study, random: &mut Random, advance: &mut dyn FnMut(f64)) -> Vec<Price> {
    let mut all = Vec::new();
    let goal = Goal { depth: Depth::Distance, ..Goal::penetration() };
    for (done, family) in FAMILIES.into_iter().enumerate() {
        let pairs = family.pairs(0.01, study.effort.of(100, 4), random);
        let ask = |item: usize, method: Option<(DerivativeMethod, u32)>| {
            let Pair { a, b, at_a, at_b, .. } = &pairs[item];
            let found = found(&pairs[item], &goal)?;
            let (method, samples) = method?;
            let wanted = DerivativeGoal { method, samples, ..DerivativeGoal::default() };
            derivatives(a, b, at_a, at_b, &found, &wanted, &goal).ok()
        };
        let methods = [None].into_iter().chain(PRICED.map(|(method, _, samples)| Some((method, samples))));
        let ask = &ask;
        let mut ways: Vec<Way> = methods
            .map(|method| Way::new(pairs.len(), move |item| _ = std::hint::black_box(ask(item, method))))
            .collect();
        let raced = race(&mut ways, study.effort.share(0.5 * SHARE, FAMILIES.len()), &mut |part| {
            advance((done as f64 + part) / FAMILIES.len() as f64);
        });
        for ((method, name, samples), own) in PRICED.into_iter().zip(&raced[1..]) {
            let cost = (0..pairs.len()).filter_map(|item| ask(item, Some((method, samples))));
            let separations = cost.map(|told| told.cost.separations as f64).sum::<f64>() / pairs.len().max(1) as f64;
            let [_, ratio, _] = super::race::ratio(own, &raced[0]);
            all.push(Price { family, name, raced: own.clone(), ratio, separations });
        }
    }
    all
}

/// By how much a figure changes when its argument is multiplied by a number: the slope of both logarithms, by least squares.
fn slope(points: &[(f64, f64)]) -> f64 {
    let logs: Vec<(f64, f64)> =
        points.iter().filter(|(_, y)| *y > 0.0).map(|(x, y)| (libm::log(*x), libm::log(*y))).collect();
    let n = logs.len().max(1) as f64;
    let (mx, my) = (logs.iter().map(|p| p.0).sum::<f64>() / n, logs.iter().map(|p| p.1).sum::<f64>() / n);
    let (num, den) =
        logs.iter().fold((0.0, 0.0), |(num, den), (x, y)| (num + (x - mx) * (y - my), den + (x - mx) * (x - mx)));
    num / den
}

fn of(figures: &[Figured], family: Family, method: usize) -> impl Iterator<Item = &Figured> {
    figures.iter().filter(move |figure| figure.family == family && figure.method == method)
}

fn readings(bias: &[Figured], spread: &[Figured], prices: &[Price]) -> Vec<String> {
    // Where sampling is not what is left: the wide end.
    let wide = |method: usize| {
        let points: Vec<(f64, f64)> =
            of(bias, Family::Ellipsoid, method).filter(|f| f.epsilon >= 0.05).map(|f| (f.epsilon, f.value)).collect();
        format!("{} {:.1}", SMOOTHED[method].1, slope(&points))
    };
    let thin = |method: usize| {
        let points: Vec<(f64, f64)> =
            of(spread, Family::Ellipsoid, method).map(|f| (f64::from(f.samples), f.value)).collect();
        format!("{} {:.2}", SMOOTHED[method].1, slope(&points))
    };
    let at = |family: Family, epsilon: f64| {
        of(bias, family, 2).find(|f| f.epsilon == epsilon).map_or(f64::NAN, |f| f.value * 100.0)
    };
    let price = |family: Family, name: &str| {
        prices.iter().find(|p| p.family == family && p.name == name).map_or(f64::NAN, |p| p.ratio)
    };
    vec![
        format!(
            "On ellipsoids the bias goes with epsilon to the power of: {}, {} (2 is what theory says of smooth shapes); the spread with samples to the power \
             of: {}, {} (-0.5).",
            wide(0),
            wide(1),
            thin(0),
            thin(1)
        ),
        format!(
            "On hulls of 64 smoothing is meant to see beyond the feature that the exact derivative is about: at epsilon {WIDEST} Gumbel's is {:.0} % off \
             it, at {} {:.2} %.",
            at(Family::Hull(64), WIDEST),
            WIDEST / 128.0,
            at(Family::Hull(64), WIDEST / 128.0)
        ),
        format!(
            "Distance and derivatives, as multiples of the distance: ellipsoids exact {:.2}, differences {:.0}; hulls of 250 exact_cell {:.2}, Gumbel \
             {:.2}, Gaussian of 64 samples {:.1}, differences {:.0}, order 0 of 64 samples {:.0}.",
            price(Family::Ellipsoid, "exact"),
            price(Family::Ellipsoid, "finite differences"),
            price(Family::Hull(250), "exact_cell"),
            price(Family::Hull(250), "order 1, Gumbel"),
            price(Family::Hull(250), "order 1, Gaussian, 64 samples"),
            price(Family::Hull(250), "finite differences"),
            price(Family::Hull(250), "order 0, 64 samples")
        ),
    ]
}

fn figure(title: &str, caption: &str, axis: &str, figures: &[Figured], x_of: impl Fn(&Figured) -> f64) -> Figure {
    let (x, y) = (Axis::log(axis, Unit::Plain), Axis::log("", Unit::Plain));
    let drawing = |family: Family| {
        let series: Vec<Series> = (0..SMOOTHED.len())
            .map(|method| Series {
                mark: method,
                joined: true,
                points: of(figures, family, method).map(|figure| Point::new(x_of(figure), figure.value)).collect(),
            })
            .collect();
        plot(&format!("{title}, {}", family.name()), &x, &y, &series, 1e-3)
    };
    let is_there = |method: &usize| figures.iter().any(|figure| figure.method == *method);
    Figure {
        caption: caption.to_owned(),
        legend: (0..SMOOTHED.len()).filter(is_there).map(|method| (SMOOTHED[method].1.to_owned(), method)).collect(),
        drawings: SHOWN.into_iter().map(drawing).collect(),
    }
}

fn summary(prices: &[Price]) -> (Vec<String>, Vec<Vec<String>>) {
    let columns = ["pairs of", "distance and", "time, median", "to the distance alone", "separations in moved places"];
    let row = |price: &Price| {
        vec![
            price.family.name(),
            price.name.to_owned(),
            time(price.raced.median),
            format!("{:.2}", price.ratio),
            number(price.separations),
        ]
    };
    (columns.map(str::to_owned).to_vec(), prices.iter().map(row).collect())
}

fn table(bias: &[Figured], spread: &[Figured], prices: &[Price]) -> Table {
    let columns = ["what", "pairs", "method", "epsilon", "samples", "value", "time_median_ns", "separations"];
    let mut table = Table::new("derivatives", &columns);
    for (what, figures) in [("bias", bias), ("spread", spread)] {
        for figure in figures {
            table.push(vec![
                what.to_owned(),
                figure.family.name(),
                SMOOTHED[figure.method].1.to_owned(),
                number(figure.epsilon),
                figure.samples.to_string(),
                number(figure.value),
                String::new(),
                String::new(),
            ]);
        }
    }
    for price in prices {
        table.push(vec![
            "price".to_owned(),
            price.family.name(),
            price.name.to_owned(),
            String::new(),
            String::new(),
            number(price.ratio),
            nanoseconds(price.raced.median),
            number(price.separations),
        ]);
    }
    table
}
