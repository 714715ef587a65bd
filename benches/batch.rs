//! Pairs of mixed kinds asked in random order, and sorted by their kinds: what the order alone saves.
//!
//! `taskset -c 0 cargo bench --no-default-features --bench batch`, some ten seconds. Both orders run in turn, round after round;
//! a gain is the median of the rounds' ratios, so that a machine that slows down slows both sides.

use std::array;
use std::hint::black_box;
use std::time::Instant;

use clearance::geometry::{Placement, Pose, Quaternion, Shape, Vec3};
use clearance::narrow_phase::{Depth, Goal, separation};

const ROUNDS: usize = 21;

/// A round asks about so many pairs in each order, the smaller batch again and again.
const PAIRS_A_ROUND: usize = 20_000;

/// Numbers in 0..1 from a linear congruential generator (Knuth's MMIX constants), the same in every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn index(&mut self, count: usize) -> usize {
        (self.next() * count as f64) as usize
    }

    /// In the cube from -1 to 1.
    fn vector(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next()) * 2.0 - Vec3::repeat(1.0)
    }

    fn placement(&mut self) -> Placement {
        let v = self.vector();
        let rotation = Quaternion { w: 2.0 * self.next() - 1.0, x: v.x, y: v.y, z: v.z };
        Pose::new(self.vector() * 1.5, rotation).expect("numbers are finite").placement()
    }
}

/// A shape of 0.3 to 0.9 m.
fn shape(random: &mut Random, kind: &str) -> Shape {
    let size = (random.vector() + Vec3::repeat(2.0)) * 0.3;
    let mut points =
        |count| -> Vec<Vec3> { (0..count).map(|_| random.vector().normalize().component_mul(&size)).collect() };
    let shape = match kind {
        "sphere" => Shape::sphere(size.x),
        "capsule" => Shape::capsule(size.x, size.y),
        "box" => Shape::cuboid(size),
        "cylinder" => Shape::cylinder(size.x, size.y),
        "cone" => Shape::cone(size.x, size.y),
        "ellipsoid" => Shape::ellipsoid(size),
        "triangle" => Shape::triangle(random.vector(), random.vector(), random.vector()),
        "hull 8" => Shape::convex(&points(8)),
        "hull 40" => Shape::convex(&points(40)),
        other => unreachable!("no kind is called {other}"),
    };
    shape.expect("sizes are positive")
}

struct Pair {
    a: Shape,
    b: Shape,
    at_a: Placement,
    at_b: Placement,
}

/// Pairs of random kinds, one after the other in memory.
fn pairs(count: usize, kinds: &[&str]) -> Vec<Pair> {
    let mut random = Random(1);
    let any = |random: &mut Random| {
        let kind = kinds[random.index(kinds.len())];
        shape(random, kind)
    };
    (0..count)
        .map(|_| {
            let (a, b) = (any(&mut random), any(&mut random));
            Pair { a, b, at_a: random.placement(), at_b: random.placement() }
        })
        .collect()
}

/// A sum over the answers, so that none is left away.
fn one_by_one(pairs: &[&Pair], goal: &Goal) -> f64 {
    let ask = |p: &Pair| separation(&p.a, &p.b, &p.at_a, &p.at_b, goal).expect("both have bounds");
    pairs.iter().map(|pair| ask(pair).bracket.lower).sum()
}

/// Nanoseconds a pair.
fn time(pairs: &[&Pair], goal: &Goal) -> f64 {
    let times = PAIRS_A_ROUND.div_ceil(pairs.len());
    let started = Instant::now();
    for _ in 0..times {
        black_box(one_by_one(black_box(pairs), goal));
    }
    started.elapsed().as_secs_f64() * 1e9 / (times * pairs.len()) as f64
}

fn median<const N: usize>(mut values: [f64; N]) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    values[N / 2]
}

/// One line: the batch as it is, and by how much faster it is in the order of its kinds. Sorting is not timed.
fn compare(mix: &str, memory: &str, asked: &str, pairs: &[&Pair], depth: Depth) {
    let goal = Goal { depth, ..Goal::penetration() };
    let mut sorted = pairs.to_vec();
    sorted.sort_by_key(|pair| (pair.a.kind(), pair.b.kind()));
    let rounds: [_; ROUNDS] = array::from_fn(|_| [time(pairs, &goal), time(&sorted, &goal)]);
    let mixed = median(rounds.map(|[mixed, _]| mixed));
    let gain = median(rounds.map(|[mixed, sorted]| mixed / sorted));
    println!("| {mix} | {} | {memory} | {asked} | {mixed:.0} | {gain:.2} |", pairs.len());
}

fn main() {
    let few = ["sphere", "capsule", "box"];
    let many = ["sphere", "capsule", "box", "cylinder", "cone", "ellipsoid", "triangle", "hull 8", "hull 40"];
    println!("| kinds | pairs | in memory | asked | kinds mixed, ns a pair | gain, sorted by kinds |");
    println!("| --- | --- | --- | --- | --- | --- |");
    for (mix, kinds) in [("3", few.as_slice()), ("9", many.as_slice())] {
        // Fewer, asked again and again, the predictors of branches would learn by heart.
        for count in [1_000, 10_000] {
            let stored = pairs(count, kinds);
            let mut pairs: Vec<&Pair> = stored.iter().collect();
            for memory in ["in order", "scattered"] {
                if memory == "scattered" {
                    let mut random = Random(2);
                    (1..count).rev().for_each(|i| pairs.swap(i, random.index(i + 1)));
                }
                compare(mix, memory, "verdict", &pairs, Depth::Verdict);
                compare(mix, memory, "distance", &pairs, Depth::Distance);
            }
        }
    }
}
