//! What accelerates GJK and what does not: support calls of each rung of the ladder, on pairs at a given distance.
//!
//!     cargo run --release --no-default-features --example acceleration
//!
//! Prints the tables of `docs/acceleration.md`. They count work, not time, so they are the same on every machine.

use clearance::geometry::{InvalidShape, Placement, Pose, Quaternion, Shape, Vec3};
use clearance::narrow_phase::{Accuracy, Depth, Goal, Solver, Termination, separation};

/// Solvers that take every shape.
const LADDER: [Solver; 6] = [
    Solver::FrankWolfe,
    Solver::Gjk,
    Solver::GjkPolyak,
    Solver::GjkNesterov,
    Solver::GjkNesterovNormalised,
    Solver::Default,
];

const PAIRS: usize = 200;

struct Pair {
    a: Shape,
    b: Shape,
    at_a: Placement,
    at_b: Placement,
}

/// A linear congruential generator (Knuth's MMIX constants): the same numbers on every machine.
struct Random(u64);

impl Random {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * ((self.0 >> 11) as f64 / (1u64 << 53) as f64)
    }

    fn vector(&mut self) -> Vec3 {
        Vec3::from_fn(|_, _| self.between(-1.0, 1.0))
    }

    fn direction(&mut self) -> Vec3 {
        loop {
            let v = self.vector();
            if v.norm() > 0.1 && v.norm() < 1.0 {
                return v.normalize();
            }
        }
    }

    fn rotation(&mut self) -> Quaternion {
        let mut component = || self.between(-1.0, 1.0);
        Quaternion { w: component(), x: component(), y: component(), z: component() }
    }

    fn radii(&mut self) -> Vec3 {
        Vec3::from_fn(|_, _| self.between(0.3, 1.0))
    }
}

/// A kind of shape, about a metre in size.
#[derive(Clone, Copy)]
enum Family {
    Box,
    Hull(usize),
    BallAndHull,
    CylinderAndCone,
    Ellipsoid,
}

impl Family {
    const ALL: [Self; 8] = [
        Self::Box,
        Self::Hull(8),
        Self::Hull(64),
        Self::Hull(250),
        Self::Hull(940),
        Self::BallAndHull,
        Self::CylinderAndCone,
        Self::Ellipsoid,
    ];

    fn name(self) -> String {
        match self {
            Self::Box => "boxes".to_owned(),
            Self::Hull(points) => format!("hulls of {points}"),
            Self::BallAndHull => "ball and hull of 250".to_owned(),
            Self::CylinderAndCone => "cylinder and cone".to_owned(),
            Self::Ellipsoid => "ellipsoids".to_owned(),
        }
    }

    fn shapes(self, random: &mut Random) -> [Shape; 2] {
        let shapes = match self {
            Self::Box => [(); 2].map(|()| Shape::cuboid(random.radii())),
            Self::Ellipsoid => [(); 2].map(|()| Shape::ellipsoid(random.radii())),
            Self::Hull(points) => [(); 2].map(|()| hull(points, random)),
            Self::BallAndHull => [Shape::sphere(random.between(0.3, 1.0)), hull(250, random)],
            Self::CylinderAndCone => {
                let [a, b] = [(); 2].map(|()| random.radii());
                [Shape::cylinder(a.x, a.y), Shape::cone(b.x, b.y)]
            }
        };
        shapes.map(|shape| shape.expect("sizes are positive"))
    }

    /// Two shapes, turned at random, whose signed distance is `gap` metres somewhere on a random line of approach.
    fn pair(self, gap: f64, random: &mut Random) -> Pair {
        loop {
            if let Some(pair) = self.try_pair(gap, random) {
                return pair;
            }
        }
    }

    /// None when the line of approach passes by.
    fn try_pair(self, gap: f64, random: &mut Random) -> Option<Pair> {
        let [a, b] = self.shapes(random);
        let pose = |t, q| Pose::new(t, q).expect("components are finite").placement();
        let (at_a, turn, approach) = (pose(Vec3::zeros(), random.rotation()), random.rotation(), random.direction());
        let mut far = 4.0;
        // Newton's method: along a line the signed distance is convex, and its slope is the normal's share of the line.
        for _ in 0..40 {
            let at_b = pose(approach * far, turn);
            let found = separation(&a, &b, &at_a, &at_b, &Goal::penetration()).expect("both are bounded");
            let step = (found.signed_distance - gap) / found.normal.dot(&approach);
            if step.abs() < 1e-9 {
                return Some(Pair { a, b, at_a, at_b });
            }
            far -= step;
            if !(0.0..4.0).contains(&far) {
                return None;
            }
        }
        None
    }
}

/// The hull of so many points on an ellipsoid.
fn hull(points: usize, random: &mut Random) -> Result<Shape, InvalidShape> {
    let radii = random.radii();
    let points: Vec<Vec3> = (0..points).map(|_| random.direction().component_mul(&radii)).collect();
    Shape::convex(&points)
}

/// Mean support calls until the goal, and how many of the pairs did not reach it.
fn supports(pairs: &[Pair], goal: &Goal) -> (f64, usize) {
    let (mut sum, mut short) = (0, 0);
    for Pair { a, b, at_a, at_b } in pairs {
        let found = separation(a, b, at_a, at_b, goal).expect("every solver here takes every shape");
        sum += found.cost.supports;
        short += usize::from(found.termination == Termination::IterationLimit);
    }
    (sum as f64 / pairs.len() as f64, short)
}

fn row(first: &str, second: &str, pairs: &[Pair], goal: &Goal) {
    let cell = |solver| match supports(pairs, &Goal { solver, ..*goal }) {
        (mean, 0) => format!("{mean:.1}"),
        (mean, short) => format!("{mean:.0} ({short} short)"),
    };
    println!("| {first} | {second} | {} |", LADDER.map(cell).join(" | "));
}

fn head(first: &str, second: &str) {
    println!("\n| {first} | {second} | {} |", LADDER.map(Solver::name).join(" | "));
    println!("|{}", " --- |".repeat(2 + LADDER.len()));
}

fn main() {
    let relative = |relative| Accuracy { absolute: 0.0, relative };
    let gaps = [1.0, 0.1, 0.01, 0.001];
    let mut random = Random(20);
    let distance = Goal { depth: Depth::Distance, accuracy: relative(1e-6), ..Goal::penetration() };
    println!("Support calls for the distance to a relative 1e-6, mean of {PAIRS} pairs");
    head("pairs of", "apart, m");
    let mut near = Vec::new();
    for family in Family::ALL {
        for gap in gaps {
            let pairs: Vec<Pair> = (0..PAIRS).map(|_| family.pair(gap, &mut random)).collect();
            row(&family.name(), &gap.to_string(), &pairs, &distance);
            if gap == 0.01 {
                near.push((family, pairs));
            }
        }
    }
    println!("\nSupport calls for the verdict alone");
    head("pairs of", "signed distance, m");
    for family in Family::ALL {
        for gap in [0.1, 0.001, -0.001, -0.1] {
            let pairs: Vec<Pair> = (0..PAIRS).map(|_| family.pair(gap, &mut random)).collect();
            row(&family.name(), &gap.to_string(), &pairs, &Goal::verdict());
        }
    }
    println!("\nSupport calls for the distance of pairs 1 cm apart, by tolerance");
    head("pairs of", "relative tolerance");
    for (family, pairs) in &near {
        for tolerance in [1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10] {
            let goal = Goal { accuracy: relative(tolerance), ..distance };
            row(&family.name(), &format!("{tolerance:e}"), pairs, &goal);
        }
    }
}
