//! Pairs with corners, edges, faces, rims and rulings. Oracle: central differences of separations as exact as rounding lets them be, where
//! the steps stay in the cell: seen from forward and backward differences that agree.

use super::*;
use clearance::narrow_phase::DerivativeMethod;

/// Kinds as `shape` numbers them, and how exact the separations of such pairs are.
const PAIRS: [(usize, usize); 20] = [
    (2, 2), // Box and box: faces, edges, corners.
    (2, 6), // Box and hull.
    (6, 6),
    (6, 10), // Hull and wall.
    (2, 0),  // Box and sphere.
    (6, 0),
    (7, 7), // Triangles.
    (7, 8), // Triangle and segment.
    (8, 8),
    (3, 3), // Capsules.
    (3, 2),
    (9, 9), // Boxes with round edges.
    (4, 0), // Cylinder: rim, side, disc.
    (5, 0), // Cone: rim, side, disc, apex.
    (4, 8),
    (5, 8),
    (4, 10),
    (5, 10),
    (1, 2), // Ellipsoid and box.
    (1, 8),
];

/// Central differences of one column with a step and with half of it.
fn differences(shapes: [&Shape; 2], at: [&Placement; 2], body: usize, k: usize, step: f64) -> [Quantities; 2] {
    [step, step / 2.0].map(|step| {
        let axis = Vec3::ith(k % 3, step);
        let (v, w) = if k < 3 { (axis, Vec3::zeros()) } else { (Vec3::zeros(), axis) };
        let [after, before] = [1.0, -1.0].map(|sign| {
            let there = twisted(at[body], v * sign, w * sign);
            let at = if body == 0 { [&there, at[1]] } else { [at[0], &there] };
            of_separation(&separation(shapes[0], shapes[1], at[0], at[1], &goal()).unwrap())
        });
        std::array::from_fn(|row| (after[row] - before[row]) / (2.0 * step))
    })
}

#[test]
fn cells_agree_with_central_differences_where_these_stay_in_the_cell() {
    let mut random = Random(31);
    for (one, two) in PAIRS {
        // Witnesses of curved pairs are right to the root of rounding only, which a longer step makes up for.
        let is_curved = |kind| matches!(kind, 1 | 4 | 5);
        let (step, tolerance) = if is_curved(one) || is_curved(two) { (4e-3, 2e-3) } else { (1e-6, 1e-7) };
        let (mut agreed, mut left_out, mut tried, mut worst) = (0, 0, 0, 0.0_f64);
        while agreed < 60 {
            tried += 1;
            assert!(tried < 400, "{one} {two}: {agreed} agreed, {left_out} left out");
            let (a, b) = (shape(&mut random, one), shape(&mut random, two));
            let Some([at_a, at_b]) = placed(&mut random, &a, &b, [0.3, 1e-2, -1e-2][tried % 3]) else { continue };
            let (_, told) = measured(&a, &b, [&at_a, &at_b]);
            if told.on_border || !told.is_valid || told.conditioning < 0.05 {
                left_out += 1;
                continue;
            }
            assert_eq!(told.method, DerivativeMethod::ExactCell);
            let (mut off, mut curved) = (0.0_f64, 0.0_f64);
            for body in 0..2 {
                for k in 0..6 {
                    let [long, short] = differences([&a, &b], [&at_a, &at_b], body, k, step);
                    // Richardson: what is of second order in the step goes.
                    let difference = std::array::from_fn(|row| (4.0 * short[row] - long[row]) / 3.0);
                    off = off.max(apart(&difference, &column(&told, body, k)));
                    curved = curved.max(apart(&long, &short));
                }
            }
            // Where a step led to another cell the two differences are far from each other.
            if curved > 10.0 * tolerance {
                left_out += 1;
                continue;
            }
            worst = worst.max(off);
            assert!(off < tolerance / told.conditioning.min(1.0), "{off:e} {curved:e} {one} {two} {told:?}");
            agreed += 1;
        }
        println!("{one} {two}: {agreed} agreed, {left_out} left out, {tried} tried, worst {worst:e}");
    }
}

/// What is told of a ball whose center is at `center`, over a box of half a metre each way.
fn over_a_box(center: Vec3) -> Derivatives {
    let (ball, cuboid) = (Shape::sphere(0.1).unwrap(), Shape::cuboid(Vec3::repeat(0.5)).unwrap());
    let at = [Vec3::zeros(), center].map(|place| Pose::new(place, Quaternion::IDENTITY).unwrap().placement());
    measured(&cuboid, &ball, [&at[0], &at[1]]).1
}

#[test]
fn where_features_meet_is_a_border() {
    // Over a face, over its edge and its corner; beside an edge, and beside its end; beside a corner.
    for (center, on_border, conditioning) in [
        (Vec3::new(0.1, 0.2, 1.0), false, f64::INFINITY),
        (Vec3::new(0.5, 0.2, 1.0), true, f64::INFINITY),
        (Vec3::new(0.5, 0.5, 1.0), true, f64::INFINITY),
        (Vec3::new(0.8, 0.2, 0.9), false, 0.5),
        (Vec3::new(0.8, 0.5, 0.9), true, 0.5),
        (Vec3::new(0.7, 0.8, 1.1), false, 0.7),
    ] {
        let told = over_a_box(center);
        assert_eq!((told.on_border, told.is_valid), (on_border, true), "{center:?} {told:?}");
        // Of a corner and of an edge: how far the center is from it.
        assert!(told.conditioning == conditioning || (told.conditioning - conditioning).abs() < 1e-9, "{told:?}");
    }
}

#[test]
fn witnesses_that_are_no_single_point_have_no_derivative() {
    let boxes = [(); 2].map(|()| Shape::cuboid(Vec3::repeat(0.5)).unwrap());
    let capsule = Shape::capsule(0.1, 0.3).unwrap();
    let over = Pose::new(Vec3::new(0.2, 0.1, 1.5), Quaternion::IDENTITY).unwrap().placement();
    let lying = Pose::new(over.translation, Quaternion::about_axis(Vec3::x(), std::f64::consts::FRAC_PI_2)).unwrap();
    let here = Pose::new(Vec3::zeros(), Quaternion::IDENTITY).unwrap().placement();
    for (other, at) in [(&boxes[1], over), (&capsule, lying.placement())] {
        let (_, told) = measured(&boxes[0], other, [&here, &at]);
        assert!(!told.is_valid && told.on_border, "{told:?}");
        // The distance has one all the same: the envelope theorem asks for one normal, not for one witness.
        let [.., up, _, _, _] = told.signed_distance[1];
        assert!((up - 1.0).abs() < 1e-12, "{told:?}");
    }
}
