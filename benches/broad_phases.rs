//! Which broad phase wins when? Tree, sweep and prune and exhaustive search on the same boxes: what a step of changes costs
//! with the version that is published after it, what all pairs cost, and what one box query costs.
//!
//! `cargo bench --no-default-features --bench broad_phases`, about a minute; prints the table of `docs/broad_phase.md`.
//! Medians of five rounds, the three by turns. A number after `--` is the largest N.

use std::hint::black_box;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use clearance::broad_phase::{BroadPhase, BroadPhaseKind, ProxyId};
use clearance::geometry::{Aabb, Vec3};

const KINDS: [BroadPhaseKind; 3] = [BroadPhaseKind::Tree, BroadPhaseKind::SweepAndPrune, BroadPhaseKind::Exhaustive];

/// More pairs than this are not looked at one by one.
const MOST_PAIRS: usize = 200_000_000;

const ROUNDS: usize = 5;
const QUERIES: usize = 50;

/// Numbers in 0..1 from a linear congruential generator (Knuth's MMIX constants), the same in every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn vector(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next())
    }
}

/// Where boxes of side 0.5 to 1.5 are, about half a pair each.
#[derive(Clone, Copy, Debug)]
enum Layout {
    /// At random in a cube.
    Uniform,
    /// Half of them in a hundredth of the cube.
    Clustered,
    /// One after the other, as on a belt.
    Row,
}

impl Layout {
    fn place(self, count: usize, random: &mut Random) -> Vec3 {
        let side = 1.6 * libm::cbrt(count as f64);
        match self {
            Self::Clustered if random.next() < 0.5 => random.vector() * (0.2154 * side),
            Self::Uniform | Self::Clustered => random.vector() * side,
            Self::Row => random.vector().component_mul(&Vec3::new(2.0 * count as f64, 2.0, 2.0)),
        }
    }

    fn boxed(self, count: usize, random: &mut Random) -> Aabb {
        let center = self.place(count, random);
        Aabb::centred(center, 0.25 * Vec3::repeat(1.0) + 0.5 * random.vector())
    }
}

/// What happens between two questions.
#[derive(Clone, Copy, Debug)]
enum Life {
    /// Nothing.
    Still,
    /// Every box moves by up to 0.05.
    Moving,
    /// One in ten leaves and another comes elsewhere.
    Churning,
}

struct World {
    phase: BroadPhase,
    proxies: Vec<ProxyId>,
    published: BroadPhase,
}

struct Timed {
    step: Vec<Duration>,
    pairs: Vec<Duration>,
    query: Vec<Duration>,
}

fn median(times: &mut [Duration], over: usize) -> f64 {
    times.sort_unstable();
    times.get(times.len() / 2).map_or(f64::NAN, |time| time.as_secs_f64() * 1e6 / over as f64)
}

fn timed<T>(into: &mut Vec<Duration>, work: impl FnOnce() -> T) -> T {
    let begun = Instant::now();
    let result = black_box(work());
    into.push(begun.elapsed());
    result
}

fn pairs(phase: &BroadPhase) -> usize {
    let mut count = 0;
    phase.self_pairs(|_, _| {
        count += 1;
        ControlFlow::Continue(())
    });
    count
}

fn step(world: &mut World, life: Life, next: &[(usize, Aabb)]) {
    for (i, aabb) in next {
        if matches!(life, Life::Churning) {
            world.phase.remove(world.proxies[*i]);
            world.proxies[*i] = world.phase.insert(*aabb, *i as u64);
        } else {
            world.phase.move_to(world.proxies[*i], *aabb);
        }
    }
    world.phase.settle();
    world.published = world.phase.clone();
}

fn row(layout: Layout, life: Life, count: usize) {
    let mut random = Random(count as u64);
    let mut boxes: Vec<Aabb> = (0..count).map(|_| layout.boxed(count, &mut random)).collect();
    let mut worlds = KINDS.map(|kind| {
        let mut phase = BroadPhase::new(kind);
        let proxies = (0..).zip(&boxes).map(|(i, aabb)| phase.insert(*aabb, i)).collect();
        phase.settle();
        World { published: phase.clone(), phase, proxies }
    });
    let mut times = KINDS.map(|_| Timed { step: Vec::new(), pairs: Vec::new(), query: Vec::new() });
    for _ in 0..ROUNDS {
        let next: Vec<(usize, Aabb)> = match life {
            Life::Still => Vec::new(),
            Life::Moving => {
                let moved = |(i, aabb): (usize, &Aabb)| {
                    let by = (random.vector() - Vec3::repeat(0.5)) * 0.1;
                    (i, Aabb { min: aabb.min + by, max: aabb.max + by })
                };
                boxes.iter().enumerate().map(moved).collect()
            }
            Life::Churning => (0..count.div_ceil(10))
                .map(|_| ((random.next() * count as f64) as usize % count, layout.boxed(count, &mut random)))
                .collect(),
        };
        next.iter().for_each(|(i, aabb)| boxes[*i] = *aabb);
        let queries: Vec<Aabb> = (0..QUERIES).map(|_| layout.boxed(count, &mut random)).collect();
        let mut found = Vec::new();
        for (world, times) in worlds.iter_mut().zip(&mut times) {
            timed(&mut times.step, || step(world, life, &next));
            let exhaustive = world.phase.kind() == BroadPhaseKind::Exhaustive;
            let quick = !exhaustive || count * count / 2 <= MOST_PAIRS;
            let pairs = quick.then(|| timed(&mut times.pairs, || pairs(&world.phase)));
            let met = timed(&mut times.query, || {
                let mut met = 0;
                for query in &queries {
                    world.phase.overlap(query, |_| {
                        met += 1;
                        ControlFlow::Continue(())
                    });
                }
                met
            });
            found.push((pairs, met));
        }
        let agree = found.iter().all(|(pairs, met)| *met == found[0].1 && (pairs.is_none() || *pairs == found[0].0));
        assert!(agree, "the broad phases do not agree: {found:?}");
    }
    let figures = times
        .map(|mut times| [median(&mut times.step, 1), median(&mut times.pairs, 1), median(&mut times.query, QUERIES)]);
    let column = |figure: usize| {
        let least = figures.iter().map(|of| of[figure]).fold(f64::INFINITY, f64::min);
        let shown = figures.map(|of| match of[figure] {
            micros if micros.is_nan() => "-".to_owned(),
            micros if micros <= 1.1 * least => format!("**{}**", digits(micros)),
            micros => digits(micros),
        });
        shown.join(" / ")
    };
    println!("| {count} | {layout:?} | {life:?} | {} | {} | {} |", column(0), column(1), column(2));
}

/// Three digits are more than a loaded machine can tell.
fn digits(micros: f64) -> String {
    match micros {
        m if m < 1.0 => format!("{m:.2}"),
        m if m < 10.0 => format!("{m:.1}"),
        m => format!("{m:.0}"),
    }
}

fn main() {
    let largest = std::env::args().filter_map(|argument| argument.parse::<usize>().ok()).next().unwrap_or(100_000);
    println!("Microseconds, tree / sweep and prune / exhaustive; bold: within a tenth of the best.\n");
    println!("| N | boxes | life | a step, published | all pairs | a box query |");
    println!("| --- | --- | --- | --- | --- | --- |");
    for count in [10, 100, 1_000, 10_000, 100_000].into_iter().filter(|count| *count <= largest) {
        for layout in [Layout::Uniform, Layout::Clustered, Layout::Row] {
            for life in [Life::Still, Life::Moving, Life::Churning] {
                row(layout, life, count);
            }
        }
    }
}
