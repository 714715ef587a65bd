//! What do other bounding volumes cost? Upright boxes, spheres, turned boxes and polytopes of fixed directions around the
//! same bodies: building the tree, moving 1 % of them, all pairs, and how many pairs are left to the narrow phase.
//!
//! `cargo bench --no-default-features --bench volumes`, some seconds; prints the table of `docs/broad_phase.md`. Least of
//! nine rounds, the volumes by turns. A number after `--` is N.

use std::hint::black_box;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use clearance::broad_phase::{BoundingSphere, BoundingVolume, Dop18, Dop26, DynamicTree, ProxyId};
use clearance::geometry::{Aabb, OrientedBox, Quaternion, Vec3};

const ROUNDS: usize = 9;

/// Numbers in 0..1 from a linear congruential generator (Knuth's MMIX constants), the same in every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn vector(&mut self, side: f64) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next()) * side
    }

    /// Turned about an axis at random, by any angle.
    fn turned(&mut self, center: Vec3, half_extents: Vec3) -> OrientedBox {
        let axis = (self.vector(2.0) - Vec3::repeat(1.0)).normalize();
        let turn = Quaternion::about_axis(axis, std::f64::consts::TAU * self.next());
        OrientedBox { center, axes: turn.matrix(), half_extents }
    }
}

fn corners(of: &OrientedBox) -> [Vec3; 8] {
    let sign = |i: usize, bit: usize| if i >> bit & 1 == 0 { -1.0 } else { 1.0 };
    std::array::from_fn(|i| {
        let x = Vec3::new(sign(i, 0), sign(i, 1), sign(i, 2));
        of.center + of.axes * of.half_extents.component_mul(&x)
    })
}

/// What a round takes and finds.
#[derive(Clone, Copy, Default)]
struct Figures {
    build: Duration,
    step: Duration,
    pairs: Duration,
    found: usize,
    /// Pairs of bounds that met.
    bounds_met: u64,
}

/// Measures one round for one kind of volume.
type Round = Box<dyn Fn(&[OrientedBox], &[(usize, OrientedBox)]) -> Figures>;

fn round_of<V: BoundingVolume + 'static>(around: impl Fn(&OrientedBox) -> V + 'static) -> Round {
    Box::new(move |bodies, moved| {
        let volumes: Vec<V> = bodies.iter().map(&around).collect();
        let moved: Vec<(usize, V)> = moved.iter().map(|(i, to)| (*i, around(to))).collect();
        let begun = Instant::now();
        let (mut tree, names): (DynamicTree<V>, Vec<ProxyId>) =
            DynamicTree::build(volumes.len(), |i| (volumes[i], i as u64));
        let build = begun.elapsed();
        let begun = Instant::now();
        moved.iter().for_each(|(i, volume)| {
            tree.move_to(names[*i], *volume);
        });
        tree.settle();
        let step = begun.elapsed();
        let begun = Instant::now();
        let mut found = 0;
        let stats = black_box(&tree).self_pairs(|_, _| {
            found += 1;
            ControlFlow::Continue(())
        });
        Figures { build, step, pairs: begun.elapsed(), found, bounds_met: stats.leaves }
    })
}

fn kinds() -> [(&'static str, Round); 5] {
    let ball = |of: &OrientedBox| BoundingSphere { center: of.center, radius: of.half_extents.norm() };
    [
        ("upright box", round_of(|of| Aabb::around(corners(of)))),
        ("sphere", round_of(ball)),
        ("turned box", round_of(|of| *of)),
        ("18-DOP", round_of(|of| Dop18::around(corners(of)))),
        ("26-DOP", round_of(|of| Dop26::around(corners(of)))),
    ]
}

/// One kind of body: the whole table of it.
fn table(name: &str, count: usize, half_extents: Vec3, spacing: f64) {
    let mut random = Random(count as u64);
    let side = spacing * libm::cbrt(count as f64);
    let bodies: Vec<OrientedBox> = (0..count)
        .map(|_| {
            let center = random.vector(side);
            random.turned(center, half_extents)
        })
        .collect();
    let moved: Vec<(usize, OrientedBox)> = (0..count.div_ceil(100))
        .map(|_| {
            let i = (random.next() * count as f64) as usize % count;
            let center = bodies[i].center + random.vector(0.2) - Vec3::repeat(0.1);
            (i, random.turned(center, half_extents))
        })
        .collect();
    let kinds = kinds();
    let mut best = kinds.each_ref().map(|_| None::<Figures>);
    for _ in 0..ROUNDS {
        for (best, (_, round)) in best.iter_mut().zip(&kinds) {
            let now = round(&bodies, &moved);
            *best = Some(best.map_or(now, |best: Figures| {
                assert_eq!(best.found, now.found, "every round finds the same");
                Figures {
                    build: best.build.min(now.build),
                    step: best.step.min(now.step),
                    pairs: best.pairs.min(now.pairs),
                    ..now
                }
            }));
        }
    }
    let figures = best.map(Option::unwrap_or_default);
    let first = figures[0];
    let ratio = |time: Duration, of: Duration| time.as_secs_f64() / of.as_secs_f64();
    for ((kind, _), figures) in kinds.iter().zip(figures) {
        let [build, step, pairs] =
            [(figures.build, first.build), (figures.step, first.step), (figures.pairs, first.pairs)]
                .map(|(time, of)| ratio(time, of));
        let Figures { found, bounds_met, .. } = figures;
        println!("| {name} | {kind} | {build:.1} | {step:.1} | {pairs:.1} | {bounds_met} | {found} |");
    }
    let [build, step, pairs] = [first.build, first.step, first.pairs].map(|time| 1e3 * time.as_secs_f64());
    println!("| {name} | upright box, ms | {build:.2} | {step:.2} | {pairs:.2} | | |");
}

fn main() {
    let count = std::env::args().filter_map(|argument| argument.parse::<usize>().ok()).next().unwrap_or(10_000);
    println!("Times as multiples of those of upright boxes, N = {count}.\n");
    println!("| bodies | volume | build | 1 % moved | all pairs | bounds that meet | pairs reported |");
    println!("| --- | --- | --- | --- | --- | --- | --- |");
    table("needles 2 x 0.04 x 0.04", count, Vec3::new(1.0, 0.02, 0.02), 0.6);
    table("plates 1 x 1 x 0.04", count, Vec3::new(0.5, 0.5, 0.02), 0.9);
    table("cubes of side 1", count, Vec3::repeat(0.5), 1.6);
}
