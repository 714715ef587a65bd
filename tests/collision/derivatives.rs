//! Exact derivatives. Oracle: central differences of separations in moved places, whose error is of second order in the step and of
//! the separation's own by its inverse; closed forms; gauge identities; swapped sides.
#![cfg(feature = "effect-derivatives")]

use clearance::geometry::{Placement, Pose, Quaternion, Shape, Vec3};
use clearance::narrow_phase::{
    Accuracy, DerivativeGoal, DerivativeMethod, Derivatives, Goal, Separation, TwistMatrix, derivatives, separation,
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
    Placement::computed(turned.rotation * pose.rotation, pose.translation + v)
}

fn measured(a: &Shape, b: &Shape, at: [&Placement; 2]) -> (Separation, Derivatives) {
    let found = separation(a, b, at[0], at[1], &goal()).unwrap();
    let told = derivatives(a, b, at[0], at[1], &found, &DerivativeGoal::default(), &goal()).unwrap();
    (found, told)
}

/// A ball or an ellipsoid, grown by a ball.
#[derive(Clone, Copy)]
struct Smooth {
    radii: Vec3,
    swept: f64,
}

impl Smooth {
    fn of(random: &mut Random, kind: usize) -> Self {
        let radii = Vec3::new(random.within(0.2, 0.6), random.within(0.2, 0.6), random.within(0.2, 0.6));
        match kind {
            0 => Self { radii: Vec3::zeros(), swept: radii.x },
            1 => Self { radii, swept: 0.0 },
            _ => Self { radii, swept: 0.05 },
        }
    }

    fn shape(self) -> Shape {
        let core = if self.radii.x == 0.0 { Shape::point() } else { Shape::ellipsoid(self.radii).unwrap() };
        if self.swept > 0.0 { core.swept(self.swept).unwrap() } else { core }
    }

    /// Its point farthest in a unit direction of the world.
    fn support(self, at: &Placement, direction: Vec3) -> Vec3 {
        let d = at.rotation.tr_mul(&direction);
        let scaled = self.radii.component_mul(&d);
        let far = scaled.norm();
        let on_core = if far > 0.0 { self.radii.component_mul(&scaled) / far } else { Vec3::zeros() };
        at.translation + at.rotation * on_core + direction * self.swept
    }
}

/// Signed distance, normal and points, in that order, from a normal nearby: where the vector between the support points is along it. Newton's
/// method with differences for its matrix; that it has got there is seen from what is left, whatever led to it.
fn quantities([a, b]: [Smooth; 2], at: [&Placement; 2], near: Vec3) -> [f64; 10] {
    let across = |n: Vec3| {
        let axis = Vec3::ith(n.abs().imin(), 1.0);
        let x = (axis - n * n.dot(&axis)).normalize();
        [x, n.cross(&x)]
    };
    let ends = |n: Vec3| [a.support(at[0], n), b.support(at[1], -n)];
    let off = |n: Vec3, [x, y]: [Vec3; 2]| {
        let [p, q] = ends(n);
        [x.dot(&(q - p)), y.dot(&(q - p))]
    };
    let mut n = near;
    for _ in 0..30 {
        let [x, y] = across(n);
        // Of the turned normal's own plane, so that what is along it stays out.
        let turned = |u: f64, v: f64| {
            let m = (n + x * u + y * v).normalize();
            let [p, q] = ends(m);
            let rest = (q - p) - m * m.dot(&(q - p));
            [x.dot(&rest), y.dot(&rest)]
        };
        let h = 1e-6;
        let [e, f] = off(n, [x, y]);
        let column = |u: f64, v: f64| {
            let (after, before) = (turned(u, v), turned(-u, -v));
            [(after[0] - before[0]) / (2.0 * h), (after[1] - before[1]) / (2.0 * h)]
        };
        let (c, d) = (column(h, 0.0), column(0.0, h));
        let determinant = c[0] * d[1] - c[1] * d[0];
        let (u, v) = ((-e * d[1] + f * d[0]) / determinant, (-c[0] * f + c[1] * e) / determinant);
        n = (n + x * u + y * v).normalize();
        if u.hypot(v) < 1e-16 {
            break;
        }
    }
    let [e, f] = off(n, across(n));
    assert!(e.hypot(f) < 1e-14, "{e:e} {f:e}");
    let [p, q] = ends(n);
    [n.dot(&(q - p)), n.x, n.y, n.z, p.x, p.y, p.z, q.x, q.y, q.z]
}

fn told(derivatives: &Derivatives, body: usize, column: usize) -> [f64; 10] {
    let of = |m: &[TwistMatrix; 2]| [m[body][(0, column)], m[body][(1, column)], m[body][(2, column)]];
    let (n, p, q) = (of(&derivatives.normal), of(&derivatives.point_on_a), of(&derivatives.point_on_b));
    [derivatives.signed_distance[body][column], n[0], n[1], n[2], p[0], p[1], p[2], q[0], q[1], q[2]]
}

/// The largest difference to central differences, scaled by how well the pair is conditioned.
fn off(pair: [Smooth; 2], at: [&Placement; 2], near: Vec3, derivatives: &Derivatives, step: f64) -> f64 {
    let mut most: f64 = 0.0;
    for body in 0..2 {
        for column in 0..6 {
            let axis = Vec3::ith(column % 3, step);
            let (v, w) = if column < 3 { (axis, Vec3::zeros()) } else { (Vec3::zeros(), axis) };
            let moved = |sign: f64| {
                let there = twisted(at[body], v * sign, w * sign);
                quantities(pair, if body == 0 { [&there, at[1]] } else { [at[0], &there] }, near)
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

const GAPS: [f64; 5] = [0.3, 1e-2, 1e-6, -1e-3, -1e-2];

#[test]
fn smooth_pairs_agree_with_central_differences() {
    let mut random = Random(1);
    for (one, two) in [(0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (2, 2)] {
        let (mut worst, mut count): (f64, usize) = (0.0, 0);
        while count < 1000 {
            let pair = [one, two].map(|kind| Smooth::of(&mut random, kind));
            let [a, b] = pair.map(Smooth::shape);
            let gap = GAPS[count % GAPS.len()];
            let Some([at_a, at_b]) = placed(&mut random, &a, &b, gap) else { continue };
            let (found, derivatives) = measured(&a, &b, [&at_a, &at_b]);
            assert_eq!(derivatives.method, DerivativeMethod::Exact);
            assert!(derivatives.is_valid && !derivatives.on_border, "{derivatives:?}");
            assert!(derivatives.residual < 1e-14, "{derivatives:?}");
            let scale = derivatives.conditioning.min(1.0);
            worst = worst.max(off(pair, [&at_a, &at_b], found.normal, &derivatives, 1e-5) * scale);
            count += 1;
        }
        println!("{one} {two}: {worst:e}");
        assert!(worst < 1e-6, "{one} and {two}: {worst:e}");
    }
}
