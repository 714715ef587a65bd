//! Spheres and ellipsoids, also grown by a radius. Oracle: central differences of a Newton's method of the test's own, which is right to
//! rounding wherever its residual says so; steps of 1e-5 have an error near 1e-10.

use super::*;
use clearance::narrow_phase::DerivativeMethod;

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

fn across(n: Vec3) -> [Vec3; 2] {
    let axis = Vec3::ith(n.abs().imin(), 1.0);
    let x = (axis - n * n.dot(&axis)).normalize();
    [x, n.cross(&x)]
}

/// From a normal nearby: where the vector between the support points is along it. Newton's method with differences for its matrix; that it has
/// got there is seen from what is left, whatever led to it.
fn quantities([a, b]: [Smooth; 2], at: [&Placement; 2], near: Vec3) -> Quantities {
    let ends = |n: Vec3| [a.support(at[0], n), b.support(at[1], -n)];
    let off = |n: Vec3, [x, y]: [Vec3; 2]| {
        let [p, q] = ends(n);
        let rest = (q - p) - n * n.dot(&(q - p));
        [x.dot(&rest), y.dot(&rest)]
    };
    let mut n = near;
    for _ in 0..30 {
        let [x, y] = across(n);
        let h = 1e-6;
        let [e, f] = off(n, [x, y]);
        let slope = |u: f64, v: f64| {
            let turned = |sign: f64| off((n + (x * u + y * v) * sign).normalize(), [x, y]);
            let (after, before) = (turned(1.0), turned(-1.0));
            [(after[0] - before[0]) / (2.0 * h), (after[1] - before[1]) / (2.0 * h)]
        };
        let (c, d) = (slope(h, 0.0), slope(0.0, h));
        let determinant = c[0] * d[1] - c[1] * d[0];
        let (u, v) = ((-e * d[1] + f * d[0]) / determinant, (-c[0] * f + c[1] * e) / determinant);
        n = (n + x * u + y * v).normalize();
        if libm::hypot(u, v) < 1e-16 {
            break;
        }
    }
    let [e, f] = off(n, across(n));
    assert!(libm::hypot(e, f) < 1e-14, "{e:e} {f:e}");
    let [p, q] = ends(n);
    [n.dot(&(q - p)), n.x, n.y, n.z, p.x, p.y, p.z, q.x, q.y, q.z]
}

/// The largest difference to central differences.
fn off(pair: [Smooth; 2], at: [&Placement; 2], near: Vec3, derivatives: &Derivatives, step: f64) -> f64 {
    let mut most: f64 = 0.0;
    for body in 0..2 {
        for k in 0..6 {
            let axis = Vec3::ith(k % 3, step);
            let (v, w) = if k < 3 { (axis, Vec3::zeros()) } else { (Vec3::zeros(), axis) };
            let moved = |sign: f64| {
                let there = twisted(at[body], v * sign, w * sign);
                quantities(pair, if body == 0 { [&there, at[1]] } else { [at[0], &there] }, near)
            };
            let (after, before) = (moved(1.0), moved(-1.0));
            let difference = std::array::from_fn(|row| (after[row] - before[row]) / (2.0 * step));
            most = most.max(apart(&difference, &column(derivatives, body, k)));
        }
    }
    most
}

const PAIRS: [(usize, usize); 6] = [(0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (2, 2)];

/// Apart, nearly touching, touching, and slightly inside; metres.
const GAPS: [f64; 6] = [0.3, 1e-2, 1e-6, 0.0, -1e-3, -1e-2];

/// A thousand pairs of each kind, at gaps by turns.
fn each_pair(seed: u64, count: usize, mut look: impl FnMut([Smooth; 2], [&Placement; 2], &Separation, &Derivatives)) {
    let mut random = Random(seed);
    for (one, two) in PAIRS {
        let mut seen = [0; GAPS.len()];
        let mut done = 0;
        while done < count {
            let pair = [one, two].map(|kind| Smooth::of(&mut random, kind));
            let [a, b] = pair.map(Smooth::shape);
            let Some([at_a, at_b]) = placed(&mut random, &a, &b, GAPS[done % GAPS.len()]) else { continue };
            let (found, derivatives) = measured(&a, &b, [&at_a, &at_b]);
            look(pair, [&at_a, &at_b], &found, &derivatives);
            seen[done % GAPS.len()] += 1;
            done += 1;
        }
        assert!(seen.iter().all(|seen| seen * GAPS.len() >= count - GAPS.len()), "{seen:?}");
    }
}

#[test]
fn smooth_pairs_agree_with_central_differences() {
    each_pair(1, 1000, |pair, at, found, derivatives| {
        assert_eq!(derivatives.method, DerivativeMethod::Exact);
        assert!(derivatives.is_valid && !derivatives.on_border, "{derivatives:?}");
        assert!(derivatives.residual < 1e-14, "{derivatives:?}");
        // What is divided by a small conditioning has a large second derivative, too.
        let scale = derivatives.conditioning.min(1.0);
        let off = off(pair, at, found.normal, derivatives, 1e-5) * scale;
        assert!(off < 1e-8, "{off:e} {derivatives:?}");
    });
}

#[test]
fn what_is_left_after_the_first_order_is_of_the_second() {
    let mut random = Random(2);
    let mut worst = [f64::INFINITY, 0.0_f64];
    each_pair(3, 60, |pair, at, found, derivatives| {
        let twists = [(); 2].map(|()| (random.vector(1.0), random.vector(1.0)));
        let here = quantities(pair, at, found.normal);
        let slope = along(derivatives, twists);
        let left = |t: f64| {
            let there = [0, 1].map(|body| twisted(at[body], twists[body].0 * t, twists[body].1 * t));
            let after = quantities(pair, [&there[0], &there[1]], found.normal);
            (0..10).map(|row| (after[row] - here[row] - slope[row] * t).abs()).fold(0.0, f64::max)
        };
        // Three decades, below where the third order counts and above what rounding leaves.
        let scale = derivatives.conditioning.min(0.3);
        let orders = [1e-2, 1e-3, 1e-4].map(|part| (left(part * scale) / left(part * scale / 10.0)).log10());
        worst = [worst[0].min(orders[1]).min(orders[2]), worst[1].max(orders[1]).max(orders[2])];
    });
    assert!(worst[0] > 1.8 && worst[1] < 2.2, "{worst:?}");
}

#[test]
fn a_common_motion_turns_everything_with_it() {
    let mut random = Random(4);
    each_pair(5, 500, |pair, at, found, derivatives| {
        let here = quantities(pair, at, found.normal);
        let vector = |first: usize| Vec3::new(here[first], here[first + 1], here[first + 2]);
        let (v, w) = (random.vector(1.0), random.vector(1.0));
        let moved = along(derivatives, at.map(|at| (v + w.cross(&at.translation), w)));
        let (n, p, q) = (w.cross(&vector(1)), v + w.cross(&vector(4)), v + w.cross(&vector(7)));
        let off = apart(&moved, &[0.0, n.x, n.y, n.z, p.x, p.y, p.z, q.x, q.y, q.z]);
        assert!(off * derivatives.conditioning.min(1.0) < 1e-10, "{off:e} {found:?} {derivatives:?}");
    });
}
