//! Exact derivatives, against closed forms, central differences, Taylor's remainder, and what holds whatever the shapes are: common
//! motions and swapped sides.
#![cfg(feature = "effect-derivatives")]

mod cells;
mod closed_forms;
mod identities;
mod smooth;

use clearance::geometry::{Placement, Pose, Quaternion, Shape, Vec3};
use clearance::narrow_phase::{
    Accuracy, DerivativeGoal, Derivatives, Goal, Separation, TwistMatrix, derivatives, separation,
};

/// SplitMix64 (Steele, Lea, Flood 2014).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() * count as f64) as usize
    }

    fn vector(&mut self, size: f64) -> Vec3 {
        Vec3::new(self.within(-size, size), self.within(-size, size), self.within(-size, size))
    }

    fn rotation(&mut self) -> Quaternion {
        let v = [(); 4].map(|()| self.within(-1.0, 1.0));
        Quaternion { w: v[0] + 0.01, x: v[1], y: v[2], z: v[3] }
    }
}

/// Every kind of a piece that a pair may have.
fn shape(random: &mut Random, kind: usize) -> Shape {
    let mut size = || random.within(0.2, 0.6);
    let (x, y, z) = (size(), size(), size());
    match kind {
        0 => Shape::sphere(x),
        1 => Shape::ellipsoid(Vec3::new(x, y, z)),
        2 => Shape::cuboid(Vec3::new(x, y, z)),
        3 => Shape::capsule(x, y),
        4 => Shape::cylinder(x, y),
        5 => Shape::cone(x, y),
        6 => Shape::convex(&[(); 12].map(|()| random.vector(0.5))),
        7 => Shape::triangle(random.vector(0.5), random.vector(0.5), random.vector(0.5)),
        8 => Shape::segment(random.vector(0.5), random.vector(0.5)),
        9 => Shape::cuboid(Vec3::new(x, y, z)).and_then(|shape| shape.swept(0.1)),
        _ => Shape::half_space(random.vector(1.0).normalize(), 0.1),
    }
    .unwrap()
}

/// How many kinds there are.
const KINDS: usize = 11;

/// As narrow as rounding lets a bracket be.
fn goal() -> Goal<'static> {
    Goal { accuracy: Accuracy { absolute: 0.0, relative: 0.0 }, ..Goal::penetration() }
}

/// The place after a twist of the body about its own origin.
fn twisted(place: &Placement, v: Vec3, w: Vec3) -> Placement {
    let angle = w.norm();
    let turn = if angle > 0.0 { Quaternion::about_axis(w / angle, angle) } else { Quaternion::IDENTITY };
    let turned = Pose::new(Vec3::zeros(), turn).unwrap().placement();
    Placement::computed(turned.rotation * place.rotation, place.translation + v)
}

fn measured(a: &Shape, b: &Shape, at: [&Placement; 2]) -> (Separation, Derivatives) {
    let found = separation(a, b, at[0], at[1], &goal()).unwrap();
    let told = derivatives(a, b, at[0], at[1], &found, &DerivativeGoal::default(), &goal()).unwrap();
    (found, told)
}

/// Signed distance, normal, points on A and B.
type Quantities = [f64; 10];

fn of_separation(found: &Separation) -> Quantities {
    let (n, p, q) = (found.normal, found.point_on_a, found.point_on_b);
    [found.signed_distance, n.x, n.y, n.z, p.x, p.y, p.z, q.x, q.y, q.z]
}

/// One column of the derivatives: body 0 or 1, and one of its six twists.
fn column(derivatives: &Derivatives, body: usize, column: usize) -> Quantities {
    let of = |m: &[TwistMatrix; 2]| [m[body][(0, column)], m[body][(1, column)], m[body][(2, column)]];
    let (n, p, q) = (of(&derivatives.normal), of(&derivatives.point_on_a), of(&derivatives.point_on_b));
    [derivatives.signed_distance[body][column], n[0], n[1], n[2], p[0], p[1], p[2], q[0], q[1], q[2]]
}

/// What derivatives say of twists of both bodies at once.
fn along(derivatives: &Derivatives, twists: [(Vec3, Vec3); 2]) -> Quantities {
    let mut sum = [0.0; 10];
    for (body, (v, w)) in twists.into_iter().enumerate() {
        for (k, speed) in [v.x, v.y, v.z, w.x, w.y, w.z].into_iter().enumerate() {
            let column = column(derivatives, body, k);
            (0..10).for_each(|row| sum[row] += column[row] * speed);
        }
    }
    sum
}

/// The largest difference of two lists, as a part of one plus the second.
fn apart(one: &Quantities, other: &Quantities) -> f64 {
    one.iter().zip(other).map(|(x, y)| (x - y).abs() / (1.0 + y.abs())).fold(0.0, f64::max)
}

/// A pair whose signed distance is about `gap`: moved along the line between the shapes until it is.
fn placed(random: &mut Random, a: &Shape, b: &Shape, gap: f64) -> Option<[Placement; 2]> {
    let at_a = Pose::new(random.vector(0.3), random.rotation()).unwrap().placement();
    let mut at_b = Pose::new(at_a.translation + random.vector(1.0), random.rotation()).unwrap().placement();
    for _ in 0..40 {
        let found = separation(a, b, &at_a, &at_b, &goal()).ok()?;
        let left = gap - found.signed_distance;
        if left.abs() < 1e-9 + 1e-3 * gap.abs() {
            return Some([at_a, at_b]);
        }
        at_b.translation += found.normal * left;
    }
    None
}
