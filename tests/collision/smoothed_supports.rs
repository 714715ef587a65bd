//! Smoothing of order one. Oracle: the exact formulae, where smoothing is to vanish; second differences of a softmax of heights written out
//! here; gauge identities; swapped sides; laws of chance with fixed seeds.

use std::hint::black_box;

use clearance::geometry::{Core, Placement, Shape, Vec3};
use clearance::narrow_phase::{
    DerivativeGoal, DerivativeMethod, Derivatives, Goal, MOST_SAMPLES, Separation, TwistMatrix, derivatives, separation,
};

use crate::derivative_pairs::{KINDS, Placed, Random, difference, hull, is_wall, numbers, shape};

const GUMBEL: DerivativeMethod = DerivativeMethod::Smoothed1Gumbel;
const GAUSSIAN: DerivativeMethod = DerivativeMethod::Smoothed1Gaussian;

fn asked(method: DerivativeMethod, epsilon: f64) -> DerivativeGoal {
    DerivativeGoal { method, epsilon, ..DerivativeGoal::default() }
}

/// A corner of one hull faces a face of the other, or edges cross: where no other corner is nearly as high, weights die out
/// exponentially, and what is left is the cell.
///
/// A corner has nothing flat, and the softmax's tensor goes to zero; along an edge or a face the tensor grows as 1/epsilon, which the cell calls
/// infinite: there the difference goes as epsilon.
#[test]
fn gumbel_goes_to_the_cells_away_from_borders() {
    let mut random = Random(21);
    let mut seen = 0;
    while seen < 60 {
        let shapes = [hull(&mut random, 12), hull(&mut random, 12)];
        let Some(pair) = Placed::new(&mut random, shapes, 0.2) else { continue };
        let cell = pair.by(DerivativeMethod::ExactCell);
        if !cell.is_valid || cell.on_border {
            continue;
        }
        let off = |epsilon: f64| {
            let told = pair.derivatives(&asked(GUMBEL, epsilon));
            assert!(told.is_valid && told.samples == 0 && told.residual < 1e-4);
            difference(&numbers(&told), &numbers(&cell))
        };
        let (one, tenth) = (off(2e-3), off(2e-4));
        // How soon depends on how near the next corner and the end of the edge are.
        if one > 0.05 {
            continue;
        }
        assert!(tenth < 0.2 * one + 1e-6, "{one:e} {tenth:e}");
        seen += 1;
    }
}

/// The mean of the highest of noisy heights, and how far it is above the highest.
fn smoothed_height(corners: &[Vec3], d: Vec3, temperature: f64) -> (f64, f64) {
    let heights: Vec<f64> = corners.iter().map(|p| d.dot(p)).collect();
    let top = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let sum = heights.iter().map(|h| libm::exp((h - top) / temperature)).sum::<f64>();
    (top + temperature * libm::log(sum), temperature * libm::log(sum))
}

/// A hull above a ball of radius zero: the point's own tensor is zero, so `dn` under a sideways move is `(d I + H)^-1`, from which H is
/// read back, and compared with second differences of the smoothed support function. That is above the true one by no more than the
/// temperature times log n.
#[test]
fn gumbel_is_the_hessian_of_the_smoothed_support_function_whose_bias_is_bounded() {
    let mut random = Random(22);
    let (mut widest, mut least): (f64, f64) = (0.0, 1.0);
    for count in 0..60 {
        let shapes = [hull(&mut random, 30), Shape::point()];
        let Some(pair) = Placed::new(&mut random, shapes, 0.3) else { continue };
        let epsilon = [0.02, 0.1, 0.3][count % 3];
        let told = pair.derivatives(&asked(GUMBEL, epsilon));
        let Core::Convex(core) = pair.shapes[0].core() else { unreachable!() };
        let found = pair.separation().unwrap();
        let corners: Vec<Vec3> = core.points().iter().map(|p| pair.at[0].rotation * p).collect();
        let temperature = epsilon * pair.shapes[0].bounds().unwrap().half_extents().amax();
        let n = found.normal;
        let bias = smoothed_height(&corners, n, temperature).1;
        assert!((0.0..=temperature * libm::log(corners.len() as f64)).contains(&bias));
        (widest, least) = (widest.max(bias / temperature), least.min(bias / temperature));
        let h = 1e-4 * epsilon;
        let height = |u: Vec3| smoothed_height(&corners, n + u, temperature).0;
        let x = n.cross(&Vec3::ith(n.abs().imin(), 1.0)).normalize();
        let y = n.cross(&x);
        let second = |p: Vec3, q: Vec3| {
            let four = height((p + q) * h) - height((p - q) * h) - height((q - p) * h) + height((p + q) * -h);
            four / (4.0 * h * h)
        };
        let expected = nalgebra::Matrix2::new(second(x, x), second(x, y), second(y, x), second(y, y));
        let turned = |along: Vec3| {
            let dn = told.normal[1].fixed_columns::<3>(0) * along;
            nalgebra::Vector2::new(x.dot(&dn), y.dot(&dn))
        };
        let inverse = nalgebra::Matrix2::from_columns(&[turned(x), turned(y)]);
        let hessian = inverse.try_inverse().unwrap() - nalgebra::Matrix2::identity() * found.signed_distance;
        let off = (hessian - expected).amax() / (1.0 + expected.amax());
        assert!(off < 1e-5, "{off:e}\n{hessian}{expected}");
    }
    assert!(widest > 1.0 && least < 0.9, "{widest} {least}: from one corner that counts to several");
}

/// Common motion of both bodies: the distance stays, the normal turns along, points go along.
#[test]
fn gumbel_keeps_to_common_motion_and_to_swapped_sides() {
    let mut random = Random(23);
    let mut count = 0;
    while count < 400 {
        let kinds = [0, 1].map(|_| (random.next() * KINDS.len() as f64) as usize);
        if kinds.iter().any(|kind| matches!(KINDS[*kind], "cylinder" | "cone")) || kinds.iter().all(|k| is_wall(*k)) {
            continue; // These are sampled: closed forms are asked.
        }
        let shapes = kinds.map(|kind| shape(kind, &mut random));
        let gap = [0.2, 0.01, -0.02][count % 3];
        let Some(pair) = Placed::new(&mut random, shapes, gap) else { continue };
        let told = pair.derivatives(&asked(GUMBEL, 0.1));
        count += 1;
        if !told.is_valid {
            continue;
        }
        let found = pair.separation().unwrap();
        let (v, w) = (random.vector(1.0), random.vector(1.0));
        // About the origin of the frame: each body's own origin moves along.
        let twists = pair.at.map(|at| (v + w.cross(&at.translation), w));
        let change = |m: &[TwistMatrix; 2]| {
            (0..2)
                .map(|b| {
                    m[b] * nalgebra::Vector6::from_fn(|i, _| if i < 3 { twists[b].0[i] } else { twists[b].1[i - 3] })
                })
                .sum::<Vec3>()
        };
        let distance: f64 = (0..2)
            .map(|b| {
                (0..3)
                    .map(|i| told.signed_distance[b][i] * twists[b].0[i] + told.signed_distance[b][i + 3] * w[i])
                    .sum::<f64>()
            })
            .sum();
        let scale = 1.0 + numbers(&told).iter().fold(0.0f64, |most, x| most.max(x.abs()));
        let names = [KINDS[kinds[0]], KINDS[kinds[1]]];
        assert!(distance.abs() < 1e-10 * scale, "{names:?} {distance:e}");
        let off = [
            change(&told.normal) - w.cross(&found.normal),
            change(&told.point_on_a) - v - w.cross(&found.point_on_a),
            change(&told.point_on_b) - v - w.cross(&found.point_on_b),
        ];
        for off in off {
            assert!(off.norm() < 1e-10 * scale, "{names:?} {gap} {off}");
        }
        // Of the other side: the same with blocks and points exchanged and normals turned round. The very same witness is asked, as
        // the separation of swapped shapes may end at another one.
        let swapped = swapped(&pair, &found, 0.1);
        let back = Derivatives {
            signed_distance: [swapped.signed_distance[1], swapped.signed_distance[0]],
            normal: [-swapped.normal[1], -swapped.normal[0]],
            point_on_a: [swapped.point_on_b[1], swapped.point_on_b[0]],
            point_on_b: [swapped.point_on_a[1], swapped.point_on_a[0]],
            ..swapped
        };
        let off = difference(&numbers(&told), &numbers(&back));
        assert!(off < 1e-12 * scale * scale, "{names:?} {off:e} {scale}");
    }
}

fn swapped(pair: &Placed, found: &Separation, epsilon: f64) -> Derivatives {
    let found = Separation {
        normal: -found.normal,
        point_on_a: found.point_on_b,
        point_on_b: found.point_on_a,
        subshape_a: found.subshape_b,
        subshape_b: found.subshape_a,
        ..*found
    };
    let [a, b] = &pair.shapes;
    let goal = asked(GUMBEL, epsilon);
    let again = crate::derivative_pairs::goal();
    derivatives(b, a, &pair.at[1], &pair.at[0], &found, &goal, &again).unwrap()
}

fn ellipsoids() -> Placed {
    let mut random = Random(24);
    let shapes = [shape(1, &mut random), shape(2, &mut random)];
    Placed::new(&mut random, shapes, 0.1).unwrap()
}

/// For a smooth side `S(d + e z) - S(d - e z) = 2 e H z + O(e^3)`: the same seed makes the same of the first part, so differences of two epsilons
/// have the bias alone, and twice the epsilon makes four times of it. With 65536 samples their relative standard error is 2 %; five of them
/// leave the slope within 0.15, and one of 1 or 3 would be told with certainty.
#[test]
fn the_bias_of_gaussian_noise_on_smooth_sides_grows_with_the_square_of_epsilon() {
    let pair = ellipsoids();
    let told = |epsilon: f64| {
        numbers(&pair.derivatives(&DerivativeGoal { samples: MOST_SAMPLES, seed: 6, ..asked(GAUSSIAN, epsilon) }))
    };
    let [small, middle, large] = [0.025, 0.05, 0.1].map(told);
    let norm = |one: &[f64], other: &[f64]| one.iter().zip(other).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
    let slope = libm::log2(norm(&large, &middle) / norm(&middle, &small));
    println!("slope {slope}");
    assert!((slope - 2.0).abs() < 0.15, "{slope}");
    let exact = numbers(&pair.by(DerivativeMethod::Exact));
    let off = difference(&small, &exact);
    assert!(off < 0.03, "{off}");
}

#[test]
fn spheres_and_closed_forms_need_no_samples_and_are_exact() {
    let mut random = Random(25);
    for (one, two, method) in [(0, 0, GAUSSIAN), (0, 0, GUMBEL), (1, 2, GUMBEL), (0, 13, GAUSSIAN), (1, 14, GUMBEL)] {
        let shapes = [shape(one, &mut random), shape(two, &mut random)];
        let pair = Placed::new(&mut random, shapes, 0.1).unwrap();
        let (told, exact) = (pair.derivatives(&asked(method, 0.2)), pair.by(DerivativeMethod::ExactCell));
        assert!(difference(&numbers(&told), &numbers(&exact)) < 1e-12, "{one} {two}");
        assert_eq!((told.samples, told.seed, told.residual), (0, 0, 0.0));
    }
}

/// Of the conditioning, which is M's least eigenvalue, over 200 seeds: its variance is known to 10 %, the slope over a factor of 16 to 0.05;
/// 0.25 are five of them. The mean over all seeds is 200 x 64 samples, another seed's 65536 are as good as the truth next to it, and
/// five of its standard errors are asked for. (The least eigenvalue is no linear function, whose mean is off by 1/samples; with
/// 256 samples that is less than a tenth of the standard deviation.)
#[test]
fn gaussian_variance_goes_with_one_over_samples_around_the_right_mean() {
    let mut random = Random(26);
    let shapes = [hull(&mut random, 40), hull(&mut random, 40)];
    let pair = Placed::new(&mut random, shapes, 0.1).unwrap();
    let turned = |samples: u32, seed: u64| {
        let told = pair.derivatives(&DerivativeGoal { samples, seed, ..asked(GAUSSIAN, 0.2) });
        (told.conditioning, told.residual, told.cost.supports)
    };
    let over_seeds = |samples: u32| {
        let values: Vec<f64> = (0..200).map(|seed| turned(samples, seed).0).collect();
        let mean = values.iter().sum::<f64>() / 200.0;
        (mean, values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / 199.0)
    };
    let ((_, few), (mean, many)) = (over_seeds(64), over_seeds(1024));
    let slope = libm::log2(many / few) / 4.0;
    let (truth, residual, supports) = turned(MOST_SAMPLES, 9999);
    println!("slope {slope}, mean {mean} of {truth}, residual {residual}");
    assert!((slope + 1.0).abs() < 0.25, "{slope}");
    assert!((mean - truth).abs() < 5.0 * (many / 200.0 + many / 64.0).sqrt() + 0.1 * many.sqrt(), "{mean} {truth}");
    assert_eq!(supports, 4 * u64::from(MOST_SAMPLES));
    let (_, residual, _) = turned(1024, 1);
    let told = residual / many.sqrt();
    assert!((0.5..4.0).contains(&told), "the residual is {told} of the standard deviation of the conditioning");
    assert_eq!(turned(1, 0).1, f64::INFINITY);
}

#[test]
fn equal_seeds_give_equal_bytes_and_sides_have_numbers_of_their_own() {
    let mut random = Random(27);
    let shapes = [shape(8, &mut random), shape(9, &mut random)];
    let pair = Placed::new(&mut random, shapes, 0.1).unwrap();
    for method in [GAUSSIAN, GUMBEL] {
        let bits = |seed: u64, stream: u64| {
            let goal = DerivativeGoal { samples: 16, seed, stream, ..asked(method, 0.2) };
            numbers(&pair.derivatives(&goal)).iter().map(|x| x.to_bits()).collect::<Vec<_>>()
        };
        assert_eq!(bits(1, 0), bits(1, 0));
        assert_ne!(bits(1, 0), bits(2, 0));
        assert_ne!(bits(1, 0), bits(1, 1));
    }
}

/// Oracle: of a hull so large that it is climbed, what all corners together say, in the softmax written out here.
#[test]
fn corners_that_are_left_out_of_large_hulls_do_not_matter() {
    let mut random = Random(28);
    let shapes = [hull(&mut random, 3000), Shape::point()];
    let pair = Placed::new(&mut random, shapes, 0.3).unwrap();
    let Core::Convex(core) = pair.shapes[0].core() else { unreachable!() };
    let found = pair.separation().unwrap();
    for epsilon in [0.001, 0.01, 0.3] {
        let told = pair.derivatives(&asked(GUMBEL, epsilon));
        let temperature = epsilon * pair.shapes[0].bounds().unwrap().half_extents().amax();
        let across: Vec<(f64, Vec3)> = core
            .points()
            .iter()
            .map(|p| pair.at[0].rotation * p)
            .map(|p| (found.normal.dot(&p), p - found.normal * found.normal.dot(&p)))
            .collect();
        let top = across.iter().map(|(h, _)| *h).fold(f64::NEG_INFINITY, f64::max);
        let weight = |h: f64| libm::exp((h - top) / temperature);
        let total: f64 = across.iter().map(|(h, _)| weight(*h)).sum();
        let mean = across.iter().map(|(h, p)| p * weight(*h)).sum::<Vec3>() / total;
        let hessian = across
            .iter()
            .map(|(h, p)| (p - mean) * (p - mean).transpose() * weight(*h))
            .sum::<nalgebra::Matrix3<f64>>()
            / (total * temperature);
        // M dn = P v, and M is read back from three moves.
        let bend = hessian + nalgebra::Matrix3::identity() * found.signed_distance;
        let sideways = nalgebra::Matrix3::identity() - found.normal * found.normal.transpose();
        let off = (bend * told.normal[1].fixed_columns::<3>(0) - sideways).amax();
        assert!(off < 1e-9, "{epsilon}: {off:e}");
        let looked_at = told.cost.corners as usize;
        assert!(if epsilon < 0.02 { looked_at < 2000 && told.residual > 0.0 } else { looked_at == 3000 }, "{told:?}");
        assert!(told.residual < 1e-8);
    }
}

/// A random sweep over all pairs of kinds, apart, touching and inside; valid where the smoothed tensors outgrow the depth, and not where they
/// do not. The signed distance's derivatives are those of the envelope theorem, whatever is smoothed.
#[test]
fn every_pair_of_kinds_in_every_regime() {
    let mut random = Random(29);
    let (mut valid, mut invalid, mut sampled, mut closed) = ([0; 4], [0; 4], 0, 0);
    let gaps = [0.3, 1e-6, -0.02, -0.25];
    for one in 0..KINDS.len() {
        for two in 0..KINDS.len() {
            if is_wall(one) && is_wall(two) {
                continue;
            }
            for (regime, gap) in gaps.into_iter().enumerate() {
                let shapes = [shape(one, &mut random), shape(two, &mut random)];
                let Some(pair) = Placed::new(&mut random, shapes, gap) else { continue };
                let found = pair.separation().unwrap();
                for (method, epsilon) in [(GUMBEL, 0.0), (GUMBEL, 0.03), (GUMBEL, 1.0), (GAUSSIAN, 0.1)] {
                    let told = pair.derivatives(&asked(method, epsilon));
                    let names = [KINDS[one], KINDS[two]];
                    assert_eq!(told.is_valid, told.conditioning > 0.0, "{names:?} {told:?}");
                    let count = if told.is_valid { &mut valid } else { &mut invalid };
                    count[regime] += 1;
                    *(if told.samples > 0 { &mut sampled } else { &mut closed }) += 1;
                    assert!(told.epsilon > 0.0 && !told.on_border && !told.is_contested);
                    assert!(told.residual.is_finite() && numbers(&told).iter().all(|x| x.is_finite()));
                    for (body, (at, witness)) in
                        [(&pair.at[0], found.point_on_a), (&pair.at[1], found.point_on_b)].into_iter().enumerate()
                    {
                        check_envelope(&told.signed_distance[body], body, at, witness, found.normal);
                    }
                }
            }
        }
    }
    println!("valid {valid:?}, invalid {invalid:?}, sampled {sampled}, closed {closed}");
    assert!(valid.iter().all(|count| *count > 100), "{valid:?}");
    assert!(invalid[3] >= 10 && invalid[0] == 0, "{invalid:?}");
    assert!(sampled > 100 && closed > 100);
}

fn check_envelope(told: &[f64; 6], body: usize, at: &Placement, witness: Vec3, normal: Vec3) {
    let sign = if body == 0 { -1.0 } else { 1.0 };
    let moment = (witness - at.translation).cross(&normal);
    for axis in 0..3 {
        assert!((told[axis] - sign * normal[axis]).abs() < 1e-12);
        assert!((told[axis + 3] - sign * moment[axis]).abs() < 1e-12);
    }
}

/// Run it with `--release -- --ignored --nocapture`: what a distance costs, and what smoothing by softmax adds.
#[test]
#[ignore = "a measurement, of optimised builds"]
fn softmax_of_hulls_of_250_corners_costs_at_most_four_distances() {
    let mut random = Random(30);
    let pairs: Vec<Placed> = (0..300)
        .filter_map(|_| {
            let shapes = [hull(&mut random, 250), hull(&mut random, 250)];
            Placed::new(&mut random, shapes, 0.1)
        })
        .collect();
    let least = |work: &dyn Fn(&Placed)| {
        let once = || {
            let start = std::time::Instant::now();
            pairs.iter().for_each(work);
            start.elapsed().as_secs_f64() * 1e9 / pairs.len() as f64
        };
        (0..20).map(|_| once()).fold(f64::INFINITY, f64::min)
    };
    let told = asked(GUMBEL, 0.1);
    let ask = |pair: &Placed| {
        let ([a, b], [at_a, at_b]) = (&pair.shapes, &pair.at);
        separation(a, b, at_a, at_b, &Goal::penetration()).unwrap()
    };
    let distance = least(&|pair| _ = black_box(ask(pair)));
    let both = least(&|pair| {
        let ([a, b], [at_a, at_b]) = (&pair.shapes, &pair.at);
        _ = black_box(derivatives(a, b, at_a, at_b, &ask(pair), &told, &Goal::penetration()).unwrap());
    });
    println!("{} pairs: a distance {distance:.0} ns, with derivatives {both:.0} ns", pairs.len());
    assert!(both - distance <= 4.0 * distance);
}
