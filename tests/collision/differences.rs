//! Central differences of separations. Oracle: the exact formulae of smooth pairs, which have a proof and differences of their own
//! (`derivatives`); pairs whose borders are known by construction.

use clearance::geometry::{Pose, Quaternion, Shape, Vec3};
use clearance::narrow_phase::{DerivativeGoal, DerivativeMethod, Goal, NoDerivatives, derivatives};

use crate::derivative_pairs::{KINDS, Placed, Random, goal, numbers, shape};

const METHOD: DerivativeMethod = DerivativeMethod::FiniteDifference;

fn placed_at(shapes: [Shape; 2], position: Vec3) -> Placed {
    let at = |t| Pose::new(t, Quaternion::IDENTITY).unwrap().placement();
    Placed { shapes, at: [at(Vec3::zeros()), at(position)] }
}

/// What is told as the residual, times the third power of size by conditioning (by which third derivatives of normals grow), bounds the
/// error.
#[test]
fn they_agree_with_the_formulae_of_smooth_pairs_within_what_they_tell() {
    let mut random = Random(11);
    for (one, two) in [(0, 0), (0, 1), (1, 1), (1, 2), (2, 2)] {
        let (mut worst, mut largest, mut count): (f64, f64, usize) = (0.0, 0.0, 0);
        let gaps = [0.3, 1e-2, 1e-6, -1e-3, -1e-2];
        while count < 100 {
            let shapes = [shape(one, &mut random), shape(two, &mut random)];
            let Some(pair) = Placed::new(&mut random, shapes, gaps[count % gaps.len()]) else { continue };
            let (told, exact) = (pair.by(METHOD), pair.by(DerivativeMethod::Exact));
            assert!(told.is_valid && !told.on_border, "{} {}: {told:?}\n{exact:?}", KINDS[one], KINDS[two]);
            assert!(told.conditioning.is_nan() && told.samples == 0 && told.cost.separations == 25);
            let bends = (0.3 / exact.conditioning).max(1.0).powi(3);
            for (difference, exact) in numbers(&told).into_iter().zip(numbers(&exact)) {
                let error = (difference - exact).abs() / (1.0 + exact.abs()) / bends;
                worst = worst.max(error / told.residual);
                largest = largest.max(error);
            }
            count += 1;
        }
        println!("{} {}: {worst:.3} of the residual, {largest:e}", KINDS[one], KINDS[two]);
        assert!(worst < 4.0 && largest < 0.01);
        assert!(worst > 1e-3, "a residual that is never reached tells nothing");
    }
}

/// Oracle: every length multiplied by a power of two multiplies nothing but lengths, so the step as a part of the size stays.
#[test]
fn the_step_is_a_part_of_the_smaller_size_and_grows_with_the_error() {
    let shapes = |scale: f64| [Shape::sphere(0.25 * scale).unwrap(), Shape::sphere(8.0 * scale).unwrap()];
    let told = |scale: f64, away: f64| {
        let mut pair = placed_at(shapes(scale), Vec3::new(3.0, 4.0, 7.5) * scale);
        for at in &mut pair.at {
            at.translation.x += away * scale;
            at.quaternion = None;
        }
        pair.by(METHOD)
    };
    let (near, far) = (told(1.0, 0.0), told(1.0, (1u64 << 36) as f64));
    for scale in [1.0 / 1024.0, 1024.0] {
        assert_eq!(told(scale, 0.0).epsilon, near.epsilon);
    }
    assert!((1e-6..0.05).contains(&near.epsilon), "{near:?}");
    assert!(far.epsilon > 1.5 * near.epsilon && far.residual > near.residual, "{} {}", far.epsilon, near.epsilon);
    // A body of radius 0.25 about 9 away from one of radius 8: the normal turns by 1 / (distance of the centres).
    let across = Vec3::new(4.0, -3.0, 0.0) / 5.0;
    let distance = Vec3::new(3.0, 4.0, 7.5).norm();
    let turned = near.normal[1] * nalgebra::Vector6::new(across.x, across.y, 0.0, 0.0, 0.0, 0.0);
    assert!((turned - across / distance).norm() < 10.0 * near.residual);
}

#[test]
fn borders_and_leaps_are_seen() {
    let cube = || Shape::cuboid(Vec3::repeat(1.0)).unwrap();
    let ball = || Shape::sphere(0.5).unwrap();
    // Above a face, above its edge, above its corner.
    for (position, on_border) in [(0.3, false), (1.0, true)] {
        let told = placed_at([cube(), ball()], Vec3::new(position, 0.2, 2.0)).by(METHOD);
        assert!(told.is_valid && told.on_border == on_border, "{position}: {told:?}");
    }
    let told = placed_at([cube(), ball()], Vec3::new(1.0, 1.0, 2.0)).by(METHOD);
    assert!(told.is_valid && told.on_border);
    // Beside the edge, where it is round.
    let told = placed_at([cube(), ball()], Vec3::new(1.5, 0.2, 2.0)).by(METHOD);
    assert!(told.is_valid && !told.on_border);
    // Two faces: no one witness.
    let told = placed_at([cube(), cube()], Vec3::new(0.3, 0.2, 2.5)).by(METHOD);
    assert!(!told.is_valid && told.on_border, "{told:?}");
    // As deep to one side as to another: the normal leaps, or the bracket of the depth is so wide that nothing is known.
    let told = placed_at([cube(), ball()], Vec3::new(0.75, 0.0, 0.75)).by(METHOD);
    assert!(!told.is_valid && (told.on_border || told.residual > 1.0), "{told:?}");
}

#[test]
fn a_stop_ends_them() {
    let pair = placed_at([Shape::sphere(0.5).unwrap(), Shape::sphere(0.5).unwrap()], Vec3::new(2.0, 0.0, 0.0));
    let found = pair.separation().unwrap();
    let asked = DerivativeGoal { method: METHOD, ..DerivativeGoal::default() };
    let [a, b] = &pair.shapes;
    let stopped = Goal { stop: &|| true, ..goal() };
    let told = derivatives(a, b, &pair.at[0], &pair.at[1], &found, &asked, &stopped);
    assert_eq!(told, Err(NoDerivatives::Stopped));
}
