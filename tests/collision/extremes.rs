//! Numbers at the ends of `f64`, and hulls that are all edge: each was once a wrong verdict or a panic.

use clearance::geometry::{Pose, Quaternion, Shape, Vec3};
use clearance::narrow_phase::{Accuracy, Goal, Solver, separation};

use crate::samples::{Random, at};

/// Oracle: the point is a convex combination of the hull's points, so the truth is a contact.
#[test]
fn hulls_with_sharp_edges_keep_the_points_on_them() {
    let mut random = Random::new(31);
    for _ in 0..300 {
        let thickness = libm::pow(10.0, random.between(-4.0, -1.0));
        let (a, b) = (Vec3::zeros(), Vec3::new(1.0, random.between(-0.3, 0.3), 0.0));
        let back = Vec3::new(random.between(0.2, 0.8), -1.0, 0.0);
        let on_edge = a + (b - a) * random.between(0.2, 0.8) + Vec3::y() * random.between(0.0, 1e-12);
        let points = [a, b, back + Vec3::z() * thickness, back - Vec3::z() * thickness, on_edge];
        let hull = Shape::convex(&points).unwrap();
        let place = at(on_edge.x, on_edge.y, on_edge.z);
        let found = separation(&hull, &Shape::point(), &at(0.0, 0.0, 0.0), &place, &Goal::penetration()).unwrap();
        assert!(found.bracket.lower <= 0.0, "a point of the hull is called apart: {found:?}");
    }
}

#[test]
fn lengths_whose_squares_underflow_still_have_verdicts() {
    for size in [1e-150, 1e-165, 1e-200, 1e-300] {
        let cube = Shape::cuboid(Vec3::repeat(size)).unwrap();
        let goal = Goal::penetration();
        let apart = separation(&cube, &cube, &at(0.0, 0.0, 0.0), &at(3.0 * size, 0.0, 0.0), &goal).unwrap();
        assert!(apart.bracket.lower > 0.9 * size && apart.bracket.upper < 1.1 * size, "{size:e}: {apart:?}");
        let meeting = separation(&cube, &cube, &at(0.0, 0.0, 0.0), &at(size, 0.0, 0.0), &goal).unwrap();
        assert!(meeting.bracket.upper < 0.0, "{size:e}: {meeting:?}");
        let points = separation(&Shape::point(), &Shape::point(), &at(0.0, 0.0, 0.0), &at(size, 0.0, 0.0), &goal);
        assert!(points.unwrap().bracket.lower > 0.0, "{size:e}");
    }
    // At the very end of the range a bracket may span zero, but it holds the truth and nothing panics.
    let tiny = 5e-324;
    let sphere = Shape::sphere(tiny).unwrap();
    let found = separation(&sphere, &sphere, &at(0.0, 0.0, 0.0), &at(1e-310, 0.0, 0.0), &Goal::penetration()).unwrap();
    assert!(found.bracket.lower <= 1e-310 && 1e-310 <= found.bracket.upper + 2.0 * tiny, "{found:?}");
}

#[test]
fn normals_of_extreme_length_mean_their_direction() {
    let ball = Shape::sphere(0.9).unwrap();
    for scale in [5e-324, 1e-300, 1.0, 1e150] {
        let floor = Shape::half_space(Vec3::new(scale, 0.0, 0.0), -2.0 * scale).unwrap();
        let found = separation(&ball, &floor, &at(0.0, 0.0, 0.0), &at(0.0, 0.0, 0.0), &Goal::penetration()).unwrap();
        assert!((found.signed_distance - 1.1).abs() < 1e-12, "{scale:e}: {found:?}");
    }
    let error = Shape::half_space(Vec3::new(1e-300, 0.0, 0.0), 1e10).unwrap_err();
    assert!(error.to_string().starts_with("offset / |normal|"), "{error}");
}

#[test]
fn a_loose_tolerance_does_not_make_a_decidable_pair_indeterminate() {
    let ball = Shape::sphere(0.5).unwrap();
    let hull = Shape::ellipsoid(Vec3::new(0.4, 0.3, 0.2)).unwrap();
    for (distance, margin) in [(1.3, 0.0), (1.3, 0.35), (0.95, 0.04)] {
        let accuracy = Accuracy { absolute: 10.0, relative: 0.0 };
        let goal = Goal { accuracy, margin, ..Goal::penetration() };
        let found = separation(&ball, &hull, &at(0.0, 0.0, 0.0), &at(distance, 0.1, 0.0), &goal).unwrap();
        let bracket = found.bracket;
        assert!(bracket.lower > 0.0 && (bracket.lower > margin || bracket.upper <= margin), "{found:?}");
    }
}

/// The axes are apart by no more than rounding: what is left of the distance between them is not perpendicular to them.
#[test]
fn a_ball_almost_on_the_axis_of_a_cone_has_a_unit_normal() {
    let ball = Shape::sphere(4518.334114157639).unwrap();
    let cone = Shape::cone(19049.27638583989, 8906.391497796696).unwrap();
    let place =
        |t: [f64; 3], [w, x, y, z]: [f64; 4]| Pose::new(Vec3::from(t), Quaternion { w, x, y, z }).unwrap().placement();
    let at_ball = place([130.87355139177268, -324.14836272689115, 875.1111736546347], [1.0; 4]);
    let turn = [1.000003386386333, 0.9999983177973364, 1.000000622873853, 1.0000029533088168];
    let at_cone = place([-4011.273520804187, -324.14836272689115, 875.1111736546347], turn);
    for (one, other, at_one, at_other) in [(&ball, &cone, &at_ball, &at_cone), (&cone, &ball, &at_cone, &at_ball)] {
        let found = separation(one, other, at_one, at_other, &Goal::penetration()).unwrap();
        assert!((found.normal.norm() - 1.0).abs() < 1e-14, "{found:?}");
    }
}

/// The meridian narrows the bracket from one side only, and the estimate of doubles is on the other.
#[test]
fn a_tiny_cone_deep_in_a_capsule_on_its_axis_has_its_estimate_in_the_bracket() {
    let capsule = Shape::capsule(479866.5287507827, 226337.10736123673).unwrap();
    let cone = Shape::cone(1.0316182803952063e-6, 5.907906739818707e-7).unwrap();
    let t = Vec3::new(14868064.484302688, -38111873.266648896, -1781937.5164195693);
    let [w, x, y, z] = [1.0000000000011708, 4.822033347885226e-13, 2.8356171663444786e-13, 4.375509644353268e-13];
    let at_capsule = Pose::new(t, Quaternion { w, x, y, z }).unwrap().placement();
    let at_cone = Pose::new(t, Quaternion::IDENTITY).unwrap().placement();
    let goal = Goal { accuracy: Accuracy { absolute: 0.0, relative: 0.0 }, ..Goal::penetration() };
    let found = separation(&capsule, &cone, &at_capsule, &at_cone, &goal).unwrap();
    let bracket = found.bracket;
    assert!(bracket.lower <= found.signed_distance && found.signed_distance <= bracket.upper, "{found:?}");
}

/// A point on the face of a box, which exact arithmetic tells: its estimate is no farther out than the bracket of doubles.
#[test]
fn a_point_on_the_face_of_a_box_far_out_has_its_estimate_in_the_bracket() {
    let cuboid = Shape::cuboid(Vec3::new(3584.0, 3584.0, 4608.0)).unwrap();
    let at_point = at(3004451.4851513575, 83507998.80698475, -8866682.281142829);
    let t = Vec3::new(3004451.4851513575, 83511582.80698475, -8866682.281142829);
    let (w, x) = (2.7106885795442714, -1.0375494256096017e-16);
    let (y, z) = (1.178819236222159e-16, -4.177860848950298e-17);
    let at_box = Pose::new(t, Quaternion { w, x, y, z }).unwrap().placement();
    let goal = Goal { margin: 1177.6000000000001, cut_off: 5888.0, ..Goal::verdict() };
    let found = separation(&Shape::point(), &cuboid, &at_point, &at_box, &goal).unwrap();
    let bracket = found.bracket;
    assert!(bracket.lower <= found.signed_distance && found.signed_distance <= bracket.upper, "{found:?}");
    assert!(bracket.upper <= 0.0, "they touch: {found:?}");
}

/// Boxes that lie square in one another: the face of their difference nearest the origin is many triangles in one plane. The
/// oracle is the error that the answer states: two points apart by no more than the depth are points of both boxes.
#[test]
fn witnesses_of_boxes_that_lie_square_are_on_the_boxes() {
    let mut random = Random::new(41);
    let mut overlaps = 0;
    for _ in 0..200 {
        let half = |random: &mut Random| Vec3::from_fn(|_, _| random.between(0.2, 1.0));
        let (a, b) = (Shape::cuboid(half(&mut random)).unwrap(), Shape::cuboid(half(&mut random)).unwrap());
        let t = random.vector(0.8);
        let goal = Goal { solver: Solver::Gjk, ..Goal::penetration() };
        let found = separation(&a, &b, &at(0.0, 0.0, 0.0), &at(t.x, t.y, t.z), &goal).unwrap();
        if found.bracket.upper < 0.0 {
            overlaps += 1;
            assert!(found.point_error < 1e-12, "{t:?}: {found:?}");
        }
    }
    assert!(overlaps > 50, "{overlaps} overlaps");
}
