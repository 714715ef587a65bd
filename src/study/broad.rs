//! Which boxes meet? Broad phases by the number of bodies and what changes, other bounding volumes, and boxes kept too large.

use std::ops::ControlFlow;

use std::time::Instant;

use crate::broad_phase::{
    BoundingSphere, BoundingVolume, BroadPhase, BroadPhaseKind, Dop18, Dop26, DynamicTree, ProxyId,
};
use crate::geometry::{Aabb, OrientedBox, Vec3};

use super::plot::{Point, Series, plot};
use super::race::quantile;
use super::random::Random;
use super::scale::{Axis, Unit, time};
use super::section::{Figure, Section};
use super::study::{NoStudy, Study};
use super::table::{Table, nanoseconds, number};

/// Of the time.
pub(super) const SHARE: f64 = 0.08;

const COUNTS: [usize; 5] = [10, 100, 1000, 10_000, 100_000];

/// More pairs than this are not looked at one by one.
const MOST_PAIRS: usize = 50_000_000;

/// Box queries in a round.
const QUERIES: usize = 50;

/// Parts of a body's side that a box is grown by.
const MARGINS: [f64; 4] = [0.0, 1.0 / 32.0, 1.0 / 16.0, 1.0 / 8.0];

const KINDS: [(BroadPhaseKind, &str, usize); 3] = [
    (BroadPhaseKind::Tree, "tree", 0),
    (BroadPhaseKind::SweepAndPrune, "sweep and prune", 1),
    (BroadPhaseKind::Exhaustive, "exhaustive", 2),
];

/// What happens between two questions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Life {
    Still,
    /// Every box moves by up to 5 cm.
    Moving,
    /// One in ten leaves, and another comes elsewhere.
    Churning,
}

const LIVES: [(Life, &str); 3] = [(Life::Still, "still"), (Life::Moving, "moving"), (Life::Churning, "churning")];

/// Sides of 0.5 to 1.5 m in a cube where half a pair a box meets.
fn boxed(count: usize, random: &mut Random) -> Aabb {
    let side = 1.6 * libm::cbrt(count as f64);
    let center = random.within(Vec3::zeros(), Vec3::repeat(side));
    Aabb::centred(center, random.within(Vec3::repeat(0.25), Vec3::repeat(0.75)))
}

/// Boxes in one broad phase, with the version that readers see.
struct World {
    phase: BroadPhase,
    proxies: Vec<ProxyId>,
    published: BroadPhase,
}

/// Seconds of each round.
#[derive(Clone, Default)]
struct Times {
    step: Vec<f64>,
    pairs: Vec<f64>,
    query: Vec<f64>,
}

fn timed<T>(into: &mut Vec<f64>, over: usize, work: impl FnOnce() -> T) {
    let begun = Instant::now();
    let _ = std::hint::black_box(work());
    into.push(begun.elapsed().as_secs_f64() / over as f64);
}

impl World {
    fn new(kind: BroadPhaseKind, boxes: &[Aabb]) -> Self {
        let mut phase = BroadPhase::new(kind);
        let proxies = (0..).zip(boxes).map(|(i, aabb)| phase.insert(*aabb, i)).collect();
        phase.settle();
        Self { published: phase.clone(), phase, proxies }
    }

    fn step(&mut self, life: Life, next: &[(usize, Aabb)]) {
        for (i, aabb) in next {
            match life {
                Life::Still => {}
                Life::Moving => _ = self.phase.move_to(self.proxies[*i], *aabb),
                Life::Churning => {
                    self.phase.remove(self.proxies[*i]);
                    self.proxies[*i] = self.phase.insert(*aabb, *i as u64);
                }
            }
        }
        self.phase.settle();
        self.published = self.phase.clone();
    }

    fn pairs(&self) -> usize {
        let mut count = 0;
        self.phase.self_pairs(|_, _| {
            count += 1;
            ControlFlow::Continue(())
        });
        count
    }

    fn round(&mut self, life: Life, next: &[(usize, Aabb)], queries: &[Aabb], times: &mut Times) {
        timed(&mut times.step, 1, || self.step(life, next));
        let count = self.proxies.len();
        if self.phase.kind() != BroadPhaseKind::Exhaustive || count * count / 2 <= MOST_PAIRS {
            timed(&mut times.pairs, 1, || self.pairs());
        }
        timed(&mut times.query, queries.len(), || {
            let mut met = 0_u64;
            for query in queries {
                self.phase.overlap(query, |_| {
                    met += 1;
                    ControlFlow::Continue(())
                });
            }
            met
        });
    }
}

/// Rounds of one life with so many boxes, the kinds by turns; ends after `seconds`.
fn lived(life: Life, count: usize, seconds: f64) -> [Times; 3] {
    let mut random = Random(count as u64);
    let mut boxes: Vec<Aabb> = (0..count).map(|_| boxed(count, &mut random)).collect();
    let mut worlds = KINDS.map(|(kind, ..)| World::new(kind, &boxes));
    let mut all: [Times; 3] = std::array::from_fn(|_| Times::default());
    let begun = Instant::now();
    for round in 0..51 {
        if round >= 3 && begun.elapsed().as_secs_f64() > seconds {
            break;
        }
        let next: Vec<(usize, Aabb)> = match life {
            Life::Still => Vec::new(),
            Life::Moving => {
                let mut moved = |aabb: &Aabb| {
                    let by = random.within(Vec3::repeat(-0.05), Vec3::repeat(0.05));
                    Aabb { min: aabb.min + by, max: aabb.max + by }
                };
                boxes.iter().map(&mut moved).enumerate().collect()
            }
            Life::Churning => {
                (0..count.div_ceil(10)).map(|_| (random.below(count), boxed(count, &mut random))).collect()
            }
        };
        next.iter().for_each(|(i, aabb)| boxes[*i] = *aabb);
        let queries: Vec<Aabb> = (0..QUERIES).map(|_| boxed(count, &mut random)).collect();
        for turn in 0..worlds.len() {
            let index = (turn + round) % worlds.len();
            worlds[index].round(life, &next, &queries, &mut all[index]);
        }
    }
    all
}

/// One way to bound bodies, measured: names and figures for the table.
struct Bounded {
    name: String,
    build: Vec<f64>,
    step: Vec<f64>,
    pairs: Vec<f64>,
    reported: usize,
    /// Moves that changed nothing in the tree.
    unchanged: f64,
}

/// What a way does in one round with bodies and their moves.
type Bounding = Box<dyn Fn(&[OrientedBox], &[(usize, OrientedBox)], &mut Bounded)>;

fn corners(of: &OrientedBox) -> [Vec3; 8] {
    let sign = |i: usize, bit: usize| if i >> bit & 1 == 0 { -1.0 } else { 1.0 };
    std::array::from_fn(|i| {
        of.center + of.axes * of.half_extents.component_mul(&Vec3::new(sign(i, 0), sign(i, 1), sign(i, 2)))
    })
}

fn bounding<V: BoundingVolume + 'static>(
    around: impl Fn(&OrientedBox) -> V + 'static,
    keeps: impl Fn(&V, &OrientedBox) -> bool + 'static,
) -> Bounding {
    Box::new(move |bodies, moved, into| {
        let volumes: Vec<V> = bodies.iter().map(&around).collect();
        let begun = Instant::now();
        let (mut tree, proxies): (DynamicTree<V>, Vec<ProxyId>) =
            DynamicTree::build(volumes.len(), |i| (volumes[i], i as u64));
        into.build.push(begun.elapsed().as_secs_f64());
        let mut stayed = 0;
        let begun = Instant::now();
        for (i, to) in moved {
            if keeps(&volumes[*i], to) {
                stayed += 1;
            } else {
                tree.move_to(proxies[*i], around(to));
            }
        }
        tree.settle();
        into.step.push(begun.elapsed().as_secs_f64());
        let begun = Instant::now();
        let mut reported = 0;
        std::hint::black_box(&tree).self_pairs(|_, _| {
            reported += 1;
            ControlFlow::Continue(())
        });
        into.pairs.push(begun.elapsed().as_secs_f64());
        into.reported = reported;
        into.unchanged = f64::from(stayed) / moved.len().max(1) as f64;
    })
}

fn boundings() -> Vec<(String, Bounding)> {
    let never = |_: &_, _: &OrientedBox| false;
    let mut all: Vec<(String, Bounding)> = vec![
        ("upright box".to_owned(), bounding(|of| Aabb::around(corners(of)), never)),
        (
            "sphere".to_owned(),
            bounding(|of| BoundingSphere { center: of.center, radius: of.half_extents.norm() }, |_, _| false),
        ),
        ("turned box".to_owned(), bounding(|of| *of, |_, _| false)),
        ("18-DOP".to_owned(), bounding(|of| Dop18::around(corners(of)), |_, _| false)),
        ("26-DOP".to_owned(), bounding(|of| Dop26::around(corners(of)), |_, _| false)),
    ];
    for margin in MARGINS.into_iter().filter(|margin| *margin > 0.0) {
        let grown = move |of: &OrientedBox| Aabb::around(corners(of)).grown(margin * 2.0 * of.half_extents.max());
        let keeps = |kept: &Aabb, to: &OrientedBox| kept.contains(&Aabb::around(corners(to)));
        all.push((format!("upright box, margin 1/{:.0}", 1.0 / margin), bounding(grown, keeps)));
    }
    all
}

/// Bodies turned at random, and all of them a little later.
fn bodies(count: usize, half_extents: Vec3, random: &mut Random) -> (Vec<OrientedBox>, Vec<(usize, OrientedBox)>) {
    let side = 1.6 * libm::cbrt(count as f64);
    let body = |random: &mut Random| OrientedBox {
        center: random.within(Vec3::zeros(), Vec3::repeat(side)),
        axes: random.rotation().matrix(),
        half_extents,
    };
    let bodies: Vec<OrientedBox> = (0..count).map(|_| body(random)).collect();
    let moved = bodies.iter().enumerate().map(|(i, of)| {
        let by = random.within(Vec3::repeat(-0.05), Vec3::repeat(0.05));
        (i, OrientedBox { center: of.center + by, ..*of })
    });
    let moved = moved.collect();
    (bodies, moved)
}

fn bounded(count: usize, half_extents: Vec3, seconds: f64) -> Vec<Bounded> {
    let mut random = Random(count as u64 + 7);
    let (bodies, moved) = bodies(count, half_extents, &mut random);
    let ways = boundings();
    let empty = |(name, _): &(String, Bounding)| Bounded {
        name: name.clone(),
        build: Vec::new(),
        step: Vec::new(),
        pairs: Vec::new(),
        reported: 0,
        unchanged: 0.0,
    };
    let mut all: Vec<Bounded> = ways.iter().map(empty).collect();
    let begun = Instant::now();
    for round in 0..31 {
        if round >= 2 && begun.elapsed().as_secs_f64() > seconds {
            break;
        }
        for ((_, way), into) in ways.iter().zip(&mut all) {
            way(&bodies, &moved, into);
        }
    }
    all
}

pub(super) fn section(study: &Study, advance: &mut dyn FnMut(f64)) -> Result<Section, NoStudy> {
    let quick = study.effort.part < 1.0;
    let counts: Vec<usize> = COUNTS.into_iter().filter(|count| !quick || *count <= 10_000).collect();
    let rows = (counts.len() * LIVES.len() + 4) as f64;
    let seconds = study.effort.seconds * SHARE / rows;
    let columns = [
        "experiment",
        "bodies",
        "life_or_shape",
        "way",
        "step_median_ns",
        "all_pairs_median_ns",
        "box_query_median_ns",
        "build_median_ns",
        "pairs_reported",
        "moves_that_change_nothing",
    ];
    let mut table = Table::new("broad_phase", &columns);
    let mut done = 0.0;
    let mut all: Vec<(Life, usize, [Times; 3])> = Vec::new();
    for (life, life_name) in LIVES {
        for count in &counts {
            let times = lived(life, *count, seconds);
            for ((_, name, _), times) in KINDS.iter().zip(&times) {
                let median = |values: &[f64]| nanoseconds(quantile(values, 0.5));
                table.push(vec![
                    "broad phase".to_owned(),
                    count.to_string(),
                    life_name.to_owned(),
                    (*name).to_owned(),
                    median(&times.step),
                    median(&times.pairs),
                    median(&times.query),
                    String::new(),
                    String::new(),
                    String::new(),
                ]);
            }
            all.push((life, *count, times));
            done += 1.0;
            advance(done / rows);
        }
    }
    let count = if quick { 2000 } else { 10_000 };
    let shapes = [("cubes of 1 m", Vec3::repeat(0.5)), ("needles of 2 m", Vec3::new(1.0, 0.02, 0.02))];
    let mut by_shape = Vec::new();
    for (name, half_extents) in shapes {
        let bounded = bounded(count, half_extents, 2.0 * seconds);
        for one in &bounded {
            let median = |values: &[f64]| nanoseconds(quantile(values, 0.5));
            table.push(vec![
                "bounding volume".to_owned(),
                count.to_string(),
                name.to_owned(),
                one.name.clone(),
                median(&one.step),
                median(&one.pairs),
                String::new(),
                median(&one.build),
                one.reported.to_string(),
                number(one.unchanged),
            ]);
        }
        by_shape.push((name, bounded));
        done += 2.0;
        advance(done / rows);
    }
    Ok(Section {
        title: "Broad phase",
        what: format!(
            "Boxes of 0.5 to 1.5 m, half a pair each, that stand still, all move by up to 5 cm, or of which one in ten is taken out and another put in: a \
             step of changes with the version that is published after it, all pairs, and one box query. Below, {count} turned bodies in trees over other bounding \
             volumes, and in boxes kept larger than they are so that small moves change nothing."
        ),
        readings: readings(&all, &by_shape),
        advice: advice(&all),
        figures: vec![by_count(&all)],
        summary: Some(summary(&by_shape)),
        table,
    })
}

/// Which times of a row.
type Picked = fn(&Times) -> &Vec<f64>;

fn by_count(all: &[(Life, usize, [Times; 3])]) -> Figure {
    let picks: [(&str, Picked); 3] = [
        ("a step, published", |times| &times.step),
        ("all pairs", |times| &times.pairs),
        ("a box query", |times| &times.query),
    ];
    let draw = |life: Life, life_name: &str, (name, pick): (&str, Picked)| {
        let series = KINDS.iter().enumerate().map(|(i, (_, _, mark))| {
            let own = all.iter().filter(|(of, ..)| *of == life);
            let point = |(_, count, times): &(Life, usize, [Times; 3])| {
                Point::new(*count as f64, quantile(pick(&times[i]), 0.5))
            };
            Series { mark: *mark, joined: true, points: own.map(point).collect() }
        });
        let (x, y) = (Axis::log("bodies", Unit::Plain), Axis::log("", Unit::Seconds));
        plot(&format!("{life_name}: {name}"), &x, &y, &series.collect::<Vec<_>>(), 1.0)
    };
    let mut drawings = Vec::new();
    for (life, life_name) in LIVES {
        let shown = picks.iter().filter(|(name, _)| life != Life::Still || *name != picks[0].0);
        drawings.extend(shown.map(|pick| draw(life, life_name, *pick)));
    }
    Figure {
        caption: "Time by the number of bodies".to_owned(),
        legend: KINDS.iter().map(|(_, name, mark)| ((*name).to_owned(), *mark)).collect(),
        drawings,
    }
}

fn advice(all: &[(Life, usize, [Times; 3])]) -> Option<String> {
    let (_, count, times) = all.iter().rfind(|(life, ..)| *life == Life::Still)?;
    Some(format!(
        "leave the broad phase a tree, as it is: among {count} boxes a box query takes {}.",
        time(quantile(&times[0].query, 0.5))
    ))
}

fn readings(all: &[(Life, usize, [Times; 3])], by_shape: &[(&str, Vec<Bounded>)]) -> Vec<String> {
    let mut texts = Vec::new();
    let faster = |pick: Picked| {
        let own = all.iter().filter(|(life, ..)| *life == Life::Moving);
        let tree_wins = |(_, _, times): &&(Life, usize, [Times; 3])| {
            let [tree, sweep, every] = [0, 1, 2].map(|i| quantile(pick(&times[i]), 0.5));
            tree <= sweep && !(every < tree)
        };
        own.filter(tree_wins).map(|(_, count, _)| *count).min()
    };
    let from =
        |count: Option<usize>| count.map_or_else(|| "at no number here".to_owned(), |n| format!("from {n} bodies on"));
    if let Some((_, count, times)) = all.iter().rfind(|(life, ..)| *life == Life::Moving) {
        let ratio = |pick: Picked, i: usize| quantile(pick(&times[i]), 0.5) / quantile(pick(&times[0]), 0.5);
        texts.push(format!(
            "The tree is the quickest of the three for a box query {} and for all pairs {}; at {count} moving bodies a box query takes sweep and prune {:.0} times and exhaustive \
             search {:.0} times as long.",
            from(faster(|times| &times.query)),
            from(faster(|times| &times.pairs)),
            ratio(|times| &times.query, 1),
            ratio(|times| &times.query, 2),
        ));
        texts.push(format!(
            "A step of changes is what order costs: with all {count} moving and published it takes the tree {}, sorted boxes {}, a list {}.",
            time(quantile(&times[0].step, 0.5)),
            time(quantile(&times[1].step, 0.5)),
            time(quantile(&times[2].step, 0.5)),
        ));
    }
    for (name, bounded) in by_shape {
        let find = |wanted: &str| bounded.iter().find(|one| one.name == wanted);
        let (Some(upright), Some(dop), Some(margin)) =
            (find("upright box"), find("18-DOP"), find("upright box, margin 1/16"))
        else {
            continue;
        };
        texts.push(format!(
            "{name}: an 18-DOP reports {:.2} of the upright boxes' pairs in {:.1} times their time; a margin of 1/16 spares {:.0} % of the moves and reports {:.2} times \
             the pairs.",
            dop.reported as f64 / upright.reported.max(1) as f64,
            quantile(&dop.pairs, 0.5) / quantile(&upright.pairs, 0.5),
            100.0 * margin.unchanged,
            margin.reported as f64 / upright.reported.max(1) as f64,
        ));
    }
    texts
}

fn summary(by_shape: &[(&str, Vec<Bounded>)]) -> (Vec<String>, Vec<Vec<String>>) {
    let columns =
        ["bodies", "bounds", "build", "all moved", "all pairs", "pairs reported", "moves that change nothing"];
    let rows = by_shape.iter().flat_map(|(name, bounded)| {
        bounded.iter().map(move |one| {
            vec![
                (*name).to_owned(),
                one.name.clone(),
                time(quantile(&one.build, 0.5)),
                time(quantile(&one.step, 0.5)),
                time(quantile(&one.pairs, 0.5)),
                one.reported.to_string(),
                format!("{:.0} %", 100.0 * one.unchanged),
            ]
        })
    });
    (columns.map(str::to_owned).to_vec(), rows.collect())
}
