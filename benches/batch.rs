//! Pairs of mixed kinds asked in random order, kind by kind through `separations`, and sorted before: what order saves.
//!
//! `taskset -c 0 cargo bench --no-default-features --bench batch`, some ten seconds. All run in turn, round after round;
//! a gain is the median of the rounds' ratios, so that a machine that slows down slows both sides.

use std::array;
use std::hint::black_box;
use std::time::Instant;

use clearance::geometry::{Placement, Pose, Quaternion, Shape, Vec3};
use clearance::narrow_phase::{Depth, Goal, PairQuestion, separation, separations};

const ROUNDS: usize = 21;

/// A round asks about so many pairs in each way, the smaller batch again and again.
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

fn questions(pairs: &[Pair], depth: Depth) -> Vec<PairQuestion<'_>> {
    let goal = Goal { depth, ..Goal::penetration() };
    pairs.iter().map(|pair| PairQuestion { a: &pair.a, b: &pair.b, at_a: &pair.at_a, at_b: &pair.at_b, goal }).collect()
}

/// A sum over the answers, so that none is left away.
fn one_by_one(questions: &[PairQuestion]) -> f64 {
    let ask = |q: &PairQuestion| separation(q.a, q.b, q.at_a, q.at_b, &q.goal).expect("both have bounds");
    questions.iter().map(|question| ask(question).bracket.lower).sum()
}

fn by_kinds(questions: &[PairQuestion]) -> f64 {
    let mut sum = 0.0;
    separations(questions, |_, answer| sum += answer.expect("both have bounds").bracket.lower);
    sum
}

/// Nanoseconds a pair.
fn time(questions: &[PairQuestion], ask: impl Fn(&[PairQuestion]) -> f64) -> f64 {
    let times = PAIRS_A_ROUND.div_ceil(questions.len());
    let started = Instant::now();
    for _ in 0..times {
        black_box(ask(black_box(questions)));
    }
    started.elapsed().as_secs_f64() * 1e9 / (times * questions.len()) as f64
}

fn median<const N: usize>(mut values: [f64; N]) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    values[N / 2]
}

/// One line: the batch as it is; by how much faster `separations` is, its sorting included; and by how much faster a batch
/// that was sorted before, whole.
fn compare(mix: &str, memory: &str, asked: &str, questions: &[PairQuestion]) {
    let mut sorted = questions.to_vec();
    sorted.sort_by_key(|question| (question.a.kind(), question.b.kind()));
    let rounds: [_; ROUNDS] =
        array::from_fn(|_| [time(questions, one_by_one), time(questions, by_kinds), time(&sorted, one_by_one)]);
    let mixed = median(rounds.map(|[mixed, ..]| mixed));
    let gains = [1, 2].map(|way| median(rounds.map(|round| round[0] / round[way])));
    println!("| {mix} | {} | {memory} | {asked} | {mixed:.0} | {:.2} | {:.2} |", questions.len(), gains[0], gains[1]);
}

fn main() {
    let few = ["sphere", "capsule", "box"];
    let many = ["sphere", "capsule", "box", "cylinder", "cone", "ellipsoid", "triangle", "hull 8", "hull 40"];
    println!(
        "| kinds | pairs | in memory | asked | kinds mixed, ns a pair | gain, `separations` | gain, sorted before |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- |");
    for (mix, kinds) in [("3", few.as_slice()), ("9", many.as_slice())] {
        // Fewer, asked again and again, the predictors of branches would learn by heart.
        for count in [1_000, 10_000] {
            let pairs = pairs(count, kinds);
            for (asked, depth) in [("verdict", Depth::Verdict), ("distance", Depth::Distance)] {
                let mut questions = questions(&pairs, depth);
                compare(mix, "in order", asked, &questions);
                let mut random = Random(2);
                (1..count).rev().for_each(|i| questions.swap(i, random.index(i + 1)));
                compare(mix, "scattered", asked, &questions);
            }
        }
    }
}
