//! What do derivatives cost? Each method as a multiple of the distance alone, of the same pairs in the same rounds.
//!
//! `cargo bench --no-default-features --features effect-derivatives --bench derivatives`, below a minute. Pairs are 1 cm apart, or
//! as deep in one another, turned at random.

use std::hint::black_box;
use std::time::Instant;

use clearance::geometry::{Placement, Pose, Quaternion, Shape, Vec3};
use clearance::narrow_phase::{Depth, DerivativeGoal, DerivativeMethod, Goal, derivatives, separation};

const PAIRS: usize = 200;
const ROUNDS: usize = 31;

/// Metres.
const GAPS: [f64; 2] = [0.01, -0.01];

struct Pair {
    a: Shape,
    b: Shape,
    at_a: Placement,
    at_b: Placement,
}

/// A linear congruential generator (Knuth's MMIX constants).
struct Random(u64);

impl Random {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * ((self.0 >> 11) as f64 / (1_u64 << 53) as f64)
    }

    fn vector(&mut self) -> Vec3 {
        Vec3::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0), self.between(-1.0, 1.0))
    }

    fn direction(&mut self) -> Vec3 {
        loop {
            let v = self.vector();
            if v.norm() > 0.1 && v.norm() < 1.0 {
                return v.normalize();
            }
        }
    }

    fn turn(&mut self) -> Quaternion {
        let v = self.vector();
        Quaternion { w: self.between(0.1, 1.0), x: v.x, y: v.y, z: v.z }
    }
}

fn ellipsoid(random: &mut Random) -> Shape {
    let radii = Vec3::new(random.between(0.3, 1.0), random.between(0.3, 1.0), random.between(0.3, 1.0));
    Shape::ellipsoid(radii).expect("positive radii")
}

fn hull(corners: usize, random: &mut Random) -> Shape {
    let radii = Vec3::new(random.between(0.3, 1.0), random.between(0.3, 1.0), random.between(0.3, 1.0));
    let points: Vec<Vec3> = (0..corners).map(|_| random.direction().component_mul(&radii)).collect();
    Shape::convex(&points).expect("finite points")
}

fn place(at: Vec3, turn: Quaternion) -> Placement {
    Pose::new(at, turn).expect("finite numbers").placement()
}

fn pair(a: Shape, b: Shape, gap: f64, random: &mut Random) -> Pair {
    let at_a = place(Vec3::zeros(), random.turn());
    let turn = random.turn();
    let mut at_b = place(random.direction() * 4.0, turn);
    for _ in 0..20 {
        let found = separation(&a, &b, &at_a, &at_b, &Goal::penetration()).expect("bounded shapes");
        at_b.translation += found.normal * (gap - found.signed_distance);
    }
    Pair { at_b: place(at_b.translation, turn), a, b, at_a }
}

fn timed(mut work: impl FnMut()) -> f64 {
    let begun = Instant::now();
    work();
    begun.elapsed().as_secs_f64()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// The methods, and how many pairs of samples.
const METHODS: [(DerivativeMethod, &str, u32); 6] = [
    (DerivativeMethod::Exact, "exact", 1),
    (DerivativeMethod::ExactCell, "exact_cell", 1),
    (DerivativeMethod::Smoothed1Gumbel, "smoothed_1, Gumbel", 1),
    (DerivativeMethod::Smoothed1Gaussian, "smoothed_1, Gaussian, 64 samples", 64),
    (DerivativeMethod::Smoothed0, "smoothed_0, 64 samples", 64),
    (DerivativeMethod::FiniteDifference, "finite_difference", 1),
];

fn main() {
    println!("| pairs of | derivatives | distance and derivatives | to the distance alone | separations | valid |");
    println!("| --- | --- | --- | --- | --- | --- |");
    for (name, make, gap) in [
        ("ellipsoids", ellipsoid as fn(&mut Random) -> Shape, GAPS[0]),
        ("ellipsoids, in one another", ellipsoid, GAPS[1]),
        ("hulls of 250", |random: &mut Random| hull(250, random), GAPS[0]),
        ("hulls of 250, in one another", |random: &mut Random| hull(250, random), GAPS[1]),
        ("hulls of 20", |random: &mut Random| hull(20, random), GAPS[0]),
    ] {
        let depth = if gap > 0.0 { Depth::Distance } else { Depth::Penetration };
        let goal = Goal { depth, ..Goal::penetration() };
        let mut random = Random(7);
        let pairs: Vec<Pair> = (0..PAIRS)
            .map(|_| {
                let [a, b] = [make(&mut random), make(&mut random)];
                pair(a, b, gap, &mut random)
            })
            .collect();
        let asked = |pair: &Pair| separation(&pair.a, &pair.b, &pair.at_a, &pair.at_b, &goal).expect("bounded shapes");
        let told = |pair: &Pair, method, samples| {
            let found = asked(pair);
            let goal_of = DerivativeGoal { method, samples, ..DerivativeGoal::default() };
            derivatives(&pair.a, &pair.b, &pair.at_a, &pair.at_b, &found, &goal_of, &goal).expect("single pieces")
        };
        let mut alone = Vec::new();
        let mut with = vec![Vec::new(); METHODS.len()];
        for _ in 0..ROUNDS {
            alone.push(timed(|| pairs.iter().for_each(|pair| _ = black_box(asked(pair)))));
            for (times, (method, _, samples)) in with.iter_mut().zip(METHODS) {
                times.push(timed(|| pairs.iter().for_each(|pair| _ = black_box(told(pair, method, samples)))));
            }
        }
        for (times, (method, method_name, samples)) in with.iter().zip(METHODS) {
            let ratio = median(times.iter().zip(&alone).map(|(with, alone)| with / alone).collect());
            let all: Vec<_> = pairs.iter().map(|pair| told(pair, method, samples)).collect();
            let separations = all.iter().map(|told| told.cost.separations).sum::<u64>() / PAIRS as u64;
            let valid = all.iter().filter(|told| told.is_valid).count();
            let microseconds = median(times.clone()) * 1e6 / PAIRS as f64;
            println!(
                "| {name} | {method_name} | {microseconds:.2} us | {ratio:.2} | {separations} | {valid} of {PAIRS} |"
            );
        }
    }
}
