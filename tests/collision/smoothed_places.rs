//! Smoothing of order zero. Oracle: the closed form of the mean of a direction over normal moves, to second order; laws of chance, with
//! fixed seeds. Each statistical test says how unlikely it is to fail of a right estimator, and what wrong one it would tell.

use clearance::geometry::{Placement, Pose, Quaternion, Shape, Vec3};
use clearance::narrow_phase::{
    DerivativeGoal, DerivativeMethod, Derivatives, Goal, MOST_SAMPLES, NoDerivatives, derivatives, separation,
};

use crate::derivative_pairs::{Placed, Random, difference, goal, numbers};

fn placed_at(shapes: [Shape; 2], position: Vec3) -> Placed {
    let at = |t| Pose::new(t, Quaternion::IDENTITY).unwrap().placement();
    Placed { shapes, at: [at(Vec3::zeros()), at(position)] }
}

const RADIUS: f64 = 0.5;
const DISTANCE: f64 = 2.0;

fn two_spheres() -> Placed {
    placed_at([Shape::sphere(RADIUS).unwrap(), Shape::sphere(RADIUS).unwrap()], Vec3::new(0.0, 0.0, DISTANCE))
}

fn asked(epsilon: f64, samples: u32, seed: u64) -> DerivativeGoal {
    DerivativeGoal { method: DerivativeMethod::Smoothed0, epsilon, samples, seed, stream: 0 }
}

/// With centres c apart, moved independently by s = epsilon radius along each axis, the mean normal is c/|c| + s^2 laplace(c/|c|) + O(s^4), and
/// laplace(c/|c|) = -2 c/|c|^3: across c its derivative is (1 - 2 s^2/|c|^2) / |c|.
///
/// The same seed makes the same moves for every epsilon, so what chance does to the linear part is the same and drops out of differences:
/// est(2e) - est(e) is the bias's alone, and twice the epsilon makes four times of it. Its relative standard error is some 4 / 256 with 65536
/// samples, so five of them, 0.08 times 1.44, leave the slope within 0.15: a slope of 1 or 3 would be told with certainty.
#[test]
fn the_bias_grows_with_the_square_of_epsilon() {
    let pair = two_spheres();
    let turned = |epsilon: f64| {
        let told = pair.derivatives(&asked(epsilon, MOST_SAMPLES, 5));
        // Both bodies, both directions across: of one value each, but for the sign.
        let n = &told.normal;
        (n[1][(0, 0)] + n[1][(1, 1)] - n[0][(0, 0)] - n[0][(1, 1)]) / 4.0
    };
    let [small, middle, large] = [0.1, 0.2, 0.4].map(turned);
    let (first, second) = (middle - small, large - middle);
    let slope = libm::log2(second / first);
    println!("slope {slope}");
    assert!((slope - 2.0).abs() < 0.15, "{slope}");
    let square = |epsilon: f64| (epsilon * RADIUS / DISTANCE).powi(2);
    let expected = -2.0 * (square(0.2) - square(0.1)) / DISTANCE;
    assert!((first / expected - 1.0).abs() < 0.1, "{first} {expected}");
    assert!((small - 1.0 / DISTANCE).abs() < 0.02, "{small}");
}

/// The variance over 300 seeds is known to sqrt(2/300) = 8 %, its logarithm to 0.08, so the slope over a factor of 16 to 0.04: 0.2 are five of
/// them. A variance that goes with 1/sqrt(samples), or not at all, would be told with certainty.
#[test]
fn the_variance_goes_with_one_over_samples_and_the_residual_tells_it() {
    let pair = two_spheres();
    let variance = |samples: u32| {
        let told: Vec<Derivatives> = (0..300).map(|seed| pair.derivatives(&asked(0.1, samples, seed))).collect();
        let of = |entry: &dyn Fn(&Derivatives) -> f64| {
            let values: Vec<f64> = told.iter().map(entry).collect();
            let mean = values.iter().sum::<f64>() / 300.0;
            values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / 299.0
        };
        let residual = told.iter().map(|told| told.residual).sum::<f64>() / 300.0;
        // The distance along the line of the centres; a point's way along it has the same variance, and no entry has a larger one.
        (of(&|told| told.signed_distance[1][2]), of(&|told| told.point_on_b[1][(2, 2)]), residual)
    };
    let (few, many) = (variance(16), variance(256));
    let slope = libm::log2(many.0 / few.0) / 4.0;
    println!("slope {slope}; {few:?} {many:?}");
    assert!((slope + 1.0).abs() < 0.2, "{slope}");
    let told = many.2 / many.0.max(many.1).sqrt();
    assert!((0.8..1.5).contains(&told), "the residual is {told} times the standard deviation of the largest entry");
}

/// Within five standard errors of the largest entry: of 120 entries one is beyond by chance once in 14 000 sets.
#[test]
fn the_mean_agrees_with_the_formula_of_spheres() {
    let pair = two_spheres();
    let (told, exact) = (pair.derivatives(&asked(0.02, 16384, 3)), pair.by(DerivativeMethod::Exact));
    assert!(told.is_valid && told.residual < 0.03, "{}", told.residual);
    assert!(told.samples == 16384 && told.seed == 3 && told.epsilon == 0.02 && told.cost.separations == 32768);
    let off = difference(&numbers(&told), &numbers(&exact));
    assert!(off < 5.0 * told.residual && off > 0.1 * told.residual, "{off} {}", told.residual);
}

#[test]
fn equal_seeds_give_equal_bytes_and_other_streams_others() {
    let pair = two_spheres();
    let bits = |goal: &DerivativeGoal| numbers(&pair.derivatives(goal)).iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    let goal = asked(0.1, 8, 1);
    assert_eq!(bits(&goal), bits(&goal));
    assert_ne!(bits(&goal), bits(&DerivativeGoal { stream: 1, ..goal }));
    assert_ne!(bits(&goal), bits(&DerivativeGoal { seed: 2, ..goal }));
}

/// A box's corner and a ball, moved as the code does, with numbers of its own.
struct Draws {
    pair: Placed,
    epsilon: f64,
}

impl Draws {
    /// How the point on B is, moved by `way` times z.
    fn point(&self, z: &[f64; 12], way: f64) -> Vec3 {
        let moved = |body: usize| {
            let part = |from: usize| Vec3::from_fn(|axis, _| z[6 * body + from + axis]) * (way * self.epsilon);
            let at = &self.pair.at[body];
            let turn = Quaternion::about_axis(part(3).normalize(), part(3).norm());
            Placement::computed(turn.matrix() * at.rotation, at.translation + part(0) * 0.5)
        };
        let [a, b] = &self.pair.shapes;
        separation(a, b, &moved(0), &moved(1), &goal()).unwrap().point_on_b
    }

    /// What one draw tells of the point's way along x with B's along x: plainly, less the value at the place itself, and as half
    /// the difference there and back.
    fn told(&self, random: &mut Random, here: Vec3) -> [f64; 3] {
        let z = [(); 12].map(|()| random.nearly_normal());
        let (there, back) = (self.point(&z, 1.0), self.point(&z, -1.0));
        let by_move = z[6] / (self.epsilon * 0.5);
        let antithetic = (there - back).x * by_move / 2.0;
        let controlled = [(there - here).x * by_move, (back - here).x * -by_move];
        // The half difference has the control variate in it, whatever was subtracted.
        let mean = (controlled[0] + controlled[1]) / 2.0;
        assert!((mean - antithetic).abs() < 1e-9 * by_move.abs().max(1.0), "{mean} {antithetic}");
        [there.x * by_move, controlled[0], antithetic]
    }
}

/// Variances over 2000 draws are known to a few per cent; asserted is a factor of ten for the same number of separations.
#[test]
fn antithetic_samples_beat_plain_ones_and_include_the_control_variate() {
    let shapes = [Shape::cuboid(Vec3::repeat(0.5)).unwrap(), Shape::sphere(0.5).unwrap()];
    let draws = Draws { pair: placed_at(shapes, Vec3::new(1.0, 0.9, 0.8)), epsilon: 0.1 };
    let here = draws.pair.separation().unwrap().point_on_b;
    let mut random = Random(4);
    let told: Vec<[f64; 3]> = (0..2000).map(|_| draws.told(&mut random, here)).collect();
    let variance = |k: usize| {
        let mean = told.iter().map(|t| t[k]).sum::<f64>() / 2000.0;
        told.iter().map(|t| (t[k] - mean).powi(2)).sum::<f64>() / 1999.0
    };
    let [plain, controlled, antithetic] = [variance(0), variance(1), variance(2)];
    println!("plain {plain}, controlled {controlled}, antithetic {antithetic}");
    // Two plain samples cost what one antithetic pair does.
    assert!(plain / 2.0 > 10.0 * antithetic, "{plain} {antithetic}");
    assert!(antithetic < controlled, "{controlled} {antithetic}");
}

#[test]
fn goals_are_checked_and_a_stop_ends_the_work() {
    let pair = two_spheres();
    let found = pair.separation().unwrap();
    let [a, b] = &pair.shapes;
    let told = |goal: &DerivativeGoal, again: &Goal| derivatives(a, b, &pair.at[0], &pair.at[1], &found, goal, again);
    let field = |goal: DerivativeGoal| match told(&goal, &Goal::penetration()) {
        Err(NoDerivatives::Goal { field, .. }) => field,
        other => panic!("{other:?}"),
    };
    use DerivativeMethod::{Smoothed0, Smoothed1Gaussian, Smoothed1Gumbel};
    for method in [Smoothed0, Smoothed1Gaussian, Smoothed1Gumbel] {
        let good = DerivativeGoal { method, epsilon: 0.1, samples: 4, seed: 0, stream: 0 };
        for epsilon in [-0.1, f64::NAN, f64::INFINITY] {
            assert_eq!(field(DerivativeGoal { epsilon, ..good }), "epsilon");
        }
        for samples in [0, MOST_SAMPLES + 1] {
            assert_eq!(field(DerivativeGoal { samples, ..good }), "samples");
        }
        assert!(told(&good, &Goal::penetration()).is_ok());
        // What a formula has no use for is no fault.
        let exact = DerivativeGoal { method: DerivativeMethod::Exact, samples: 0, ..good };
        assert!(told(&exact, &Goal::penetration()).is_ok());
    }
    let stopped = Goal { stop: &|| true, ..Goal::penetration() };
    assert_eq!(told(&asked(0.1, 4, 0), &stopped), Err(NoDerivatives::Stopped));
    let long = DerivativeGoal { method: Smoothed1Gaussian, ..asked(0.1, MOST_SAMPLES, 0) };
    let blocks = placed_at([(); 2].map(|()| Shape::cuboid(Vec3::repeat(0.5)).unwrap()), Vec3::new(1.1, 1.2, 1.3));
    let found = blocks.separation().unwrap();
    let [a, b] = &blocks.shapes;
    let told = derivatives(a, b, &blocks.at[0], &blocks.at[1], &found, &long, &stopped);
    assert_eq!(told, Err(NoDerivatives::Stopped));
}

#[test]
fn zero_epsilon_is_chosen_from_the_gap() {
    let told = |distance: f64| {
        let mut pair = two_spheres();
        pair.at[1].translation.z = distance;
        pair.derivatives(&DerivativeGoal { samples: 2, ..asked(0.0, 1, 0) }).epsilon
    };
    let [touching, near, far] = [1.0, 1.5, 100.0].map(told);
    assert!(0.0 < touching && touching < near && near < far && far < 0.3, "{touching} {near} {far}");
}
