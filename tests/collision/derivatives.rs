//! Exact derivatives. Oracle: central differences of separations in moved places, whose error is of second order in the step and of
//! the separation's own by its inverse; closed forms; gauge identities; swapped sides.
#![cfg(feature = "effect-derivatives")]

use clearance::geometry::{Placement, Pose, Quaternion, Shape, Vec3};
use clearance::narrow_phase::{
    Accuracy, DerivativeMethod, Derivatives, Goal, Separation, TwistMatrix, derivatives, separation,
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

    fn vector(&mut self, size: f64) -> Vec3 {
        Vec3::new(self.within(-size, size), self.within(-size, size), self.within(-size, size))
    }

    fn rotation(&mut self) -> Quaternion {
        let v = [(); 4].map(|()| self.within(-1.0, 1.0));
        Quaternion { w: v[0] + 0.01, x: v[1], y: v[2], z: v[3] }
    }
}

fn goal() -> Goal<'static> {
    Goal { accuracy: Accuracy { absolute: 0.0, relative: 0.0 }, ..Goal::penetration() }
}

/// The pose after a twist for one unit of time, to second order and more: turned about its own origin.
fn twisted(pose: &Placement, v: Vec3, w: Vec3) -> Placement {
    let angle = w.norm();
    let turn = if angle > 0.0 { Quaternion::about_axis(w / angle, angle) } else { Quaternion::IDENTITY };
    let turned = Pose::new(Vec3::zeros(), turn).unwrap().placement();
    Placement { rotation: turned.rotation * pose.rotation, translation: pose.translation + v }
}

fn measured(a: &Shape, b: &Shape, at: [&Placement; 2]) -> (Separation, Derivatives) {
    let found = separation(a, b, at[0], at[1], &goal()).unwrap();
    let told = derivatives(a, b, at[0], at[1], &found).unwrap();
    (found, told)
}

/// Signed distance, normal and points, in that order.
fn quantities(a: &Shape, b: &Shape, at: [&Placement; 2]) -> [f64; 10] {
    let found = separation(a, b, at[0], at[1], &goal()).unwrap();
    let (n, p, q) = (found.normal, found.point_on_a, found.point_on_b);
    [found.signed_distance, n.x, n.y, n.z, p.x, p.y, p.z, q.x, q.y, q.z]
}

fn told(derivatives: &Derivatives, body: usize, column: usize) -> [f64; 10] {
    let of = |m: &[TwistMatrix; 2]| [m[body][(0, column)], m[body][(1, column)], m[body][(2, column)]];
    let (n, p, q) = (of(&derivatives.normal), of(&derivatives.point_on_a), of(&derivatives.point_on_b));
    [derivatives.signed_distance[body][column], n[0], n[1], n[2], p[0], p[1], p[2], q[0], q[1], q[2]]
}

/// The largest difference to central differences, scaled by how well the pair is conditioned.
fn off(a: &Shape, b: &Shape, at: [&Placement; 2], derivatives: &Derivatives, step: f64) -> f64 {
    let mut most: f64 = 0.0;
    for body in 0..2 {
        for column in 0..6 {
            let axis = Vec3::ith(column % 3, step);
            let (v, w) = if column < 3 { (axis, Vec3::zeros()) } else { (Vec3::zeros(), axis) };
            let moved = |sign: f64| {
                let there = twisted(at[body], v * sign, w * sign);
                quantities(a, b, if body == 0 { [&there, at[1]] } else { [at[0], &there] })
            };
            let (after, before) = (moved(1.0), moved(-1.0));
            for (k, exact) in told(derivatives, body, column).into_iter().enumerate() {
                let difference = (after[k] - before[k]) / (2.0 * step);
                most = most.max((difference - exact).abs() / (1.0 + exact.abs()));
            }
        }
    }
    most
}

/// A pair whose signed distance is about `gap`: moved along the line between the origins until it is.
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

fn smooth(random: &mut Random, kind: usize) -> Shape {
    let radii = Vec3::new(random.within(0.2, 0.6), random.within(0.2, 0.6), random.within(0.2, 0.6));
    match kind {
        0 => Shape::sphere(radii.x).unwrap(),
        1 => Shape::ellipsoid(radii).unwrap(),
        _ => Shape::ellipsoid(radii).unwrap().swept(0.05).unwrap(),
    }
}

const GAPS: [f64; 5] = [0.3, 1e-2, 1e-6, -1e-3, -1e-2];

#[test]
fn smooth_pairs_agree_with_central_differences() {
    let mut random = Random(1);
    for (one, two) in [(0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (2, 2)] {
        let (mut worst, mut count): (f64, usize) = (0.0, 0);
        while count < 1000 {
            let (a, b) = (smooth(&mut random, one), smooth(&mut random, two));
            let gap = GAPS[count % GAPS.len()];
            let Some([at_a, at_b]) = placed(&mut random, &a, &b, gap) else { continue };
            let (_, derivatives) = measured(&a, &b, [&at_a, &at_b]);
            assert_eq!(derivatives.method, DerivativeMethod::ExactSmooth);
            assert!(derivatives.is_valid && !derivatives.on_border, "{derivatives:?}");
            assert!(derivatives.residual < 1e-14, "{derivatives:?}");
            let scale = derivatives.conditioning.min(1.0);
            worst = worst.max(off(&a, &b, [&at_a, &at_b], &derivatives, 1e-5) * scale);
            count += 1;
        }
        println!("{one} {two}: {worst:e}");
        assert!(worst < 1e-6, "{one} and {two}: {worst:e}");
    }
}
