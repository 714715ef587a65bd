//! Pairs whose signed distance a formula gives. Oracle: the formula, exact to a few roundings.

use clearance::geometry::{Placement, Pose, Quaternion, Shape, Vec3};
use clearance::narrow_phase::{Goal, Separation, separation};

use crate::samples::at;

const TOLERANCE: f64 = 1e-9;

/// Distance, bracket, witness and normal of one pair, and the mirrored answer of the swapped one.
fn check(a: &Shape, b: &Shape, at_a: &Placement, at_b: &Placement, expected: f64) -> Separation {
    let goal = Goal::penetration();
    let found = separation(a, b, at_a, at_b, &goal).unwrap();
    let context = || format!("{} against {}: {found:?}, expected {expected}", a.kind(), b.kind());
    assert!((found.signed_distance - expected).abs() <= TOLERANCE * (1.0 + expected.abs()), "{}", context());
    assert!(found.bracket.lower <= expected && expected <= found.bracket.upper, "{}", context());
    assert!((found.normal.norm() - 1.0).abs() < 1e-12, "{}", context());
    let gap = found.point_on_b - found.point_on_a - found.normal * found.signed_distance;
    assert!(gap.norm() < 1e-12, "{}", context());
    let swapped = separation(b, a, at_b, at_a, &goal).unwrap();
    assert!((swapped.signed_distance - expected).abs() <= TOLERANCE * (1.0 + expected.abs()), "{}", context());
    assert!(swapped.bracket.lower <= expected && expected <= swapped.bracket.upper, "{}", context());
    found
}

fn sphere(radius: f64) -> Shape {
    Shape::sphere(radius).unwrap()
}

fn cuboid(x: f64, y: f64, z: f64) -> Shape {
    Shape::cuboid(Vec3::new(x, y, z)).unwrap()
}

fn turned(x: f64, y: f64, z: f64, axis: Vec3, angle: f64) -> Placement {
    Pose::new(Vec3::new(x, y, z), Quaternion::about_axis(axis, angle)).unwrap().placement()
}

#[test]
fn spheres_apart_touching_overlapping_and_concentric() {
    for distance in [5.0, 0.75, 0.7, 0.1, 1e-9, 0.0] {
        check(&sphere(0.5), &sphere(0.25), &at(0.0, 0.0, 0.0), &at(0.0, distance, 0.0), distance - 0.75);
    }
}

#[test]
fn a_point_on_a_point_is_a_proved_contact() {
    let found = check(&Shape::point(), &Shape::point(), &at(0.0, 0.0, 0.0), &at(0.0, 0.0, 0.0), 0.0);
    assert_eq!(found.bracket.upper, 0.0);
}

#[test]
fn cuboids_face_to_face_edge_to_edge_and_vertex_to_face() {
    let unit = cuboid(0.5, 0.5, 0.5);
    for gap in [2.0, 1e-3, 1e-9, -1e-9, -0.3] {
        let found = check(&unit, &unit, &at(0.0, 0.0, 0.0), &at(1.0 + gap, 0.2, 0.1), gap);
        assert!((found.normal - Vec3::x()).norm() < 1e-6, "{found:?}");
    }
    // An edge along z towards one along y: half diagonals apart.
    let half_diagonal = 0.5f64.sqrt();
    let eighth = std::f64::consts::FRAC_PI_4;
    for gap in [0.5, 1e-6, -0.05] {
        let one = turned(0.0, 0.0, 0.0, Vec3::z(), eighth);
        let other = turned(2.0 * half_diagonal + gap, 0.0, 0.0, Vec3::y(), eighth);
        check(&unit, &unit, &one, &other, gap);
    }
    // A corner down on a large face.
    let corner = Quaternion::about_axis(Vec3::new(1.0, -1.0, 0.0).normalize(), libm::atan(2f64.sqrt()));
    for gap in [0.25, 1e-9, -0.1] {
        let above = Pose::new(Vec3::new(0.0, 0.0, 0.5 + 0.75f64.sqrt() + gap), corner).unwrap().placement();
        check(&cuboid(5.0, 5.0, 0.5), &unit, &at(0.0, 0.0, 0.0), &above, gap);
    }
}

#[test]
fn capsules_parallel_crossed_and_coaxial() {
    let capsule = Shape::capsule(0.1, 1.0).unwrap();
    let quarter = std::f64::consts::FRAC_PI_2;
    check(&capsule, &capsule, &at(0.0, 0.0, 0.0), &at(0.5, 0.0, 0.3), 0.3);
    check(&capsule, &capsule, &at(0.0, 0.0, 0.0), &at(0.0, 0.0, 2.5), 0.3);
    for height in [1.0, 0.2, 0.1, 0.0] {
        let crossed = turned(0.0, height, 0.0, Vec3::y(), quarter);
        check(&capsule, &capsule, &at(0.0, 0.0, 0.0), &crossed, height - 0.2);
    }
}

#[test]
fn cylinders_and_cones_on_their_axis() {
    let (cylinder, cone) = (Shape::cylinder(0.5, 1.0).unwrap(), Shape::cone(0.5, 1.0).unwrap());
    for gap in [1.0, 1e-6, -0.1] {
        check(&cylinder, &cone, &at(0.0, 0.0, 0.0), &at(0.0, 0.0, 2.0 + gap), gap);
        check(&cylinder, &cylinder, &at(0.0, 0.0, 0.0), &at(1.0 + gap, 0.0, 0.5), gap);
    }
    // A ball outside the slant of a cone: distance of a point from a line in the plane, slope 2 : 0.5.
    let slant = Vec3::new(2.0, 0.0, 0.5).normalize();
    let out = Vec3::new(0.25, 0.0, 0.0) + slant * 0.7;
    check(&cone, &sphere(0.2), &at(0.0, 0.0, 0.0), &at(out.x, out.y, out.z), 0.5);
}

#[test]
fn half_spaces_are_solid_and_planes_are_thin() {
    let floor = Shape::half_space(Vec3::new(0.0, 0.0, 2.0), 1.0).unwrap(); // z <= 1/2
    let plane = Shape::plane(Vec3::new(0.0, 0.0, 2.0), 1.0).unwrap();
    let unit = cuboid(0.5, 0.5, 0.5);
    for (height, above) in [(3.0, 2.0), (1.0, 0.0), (0.75, -0.25), (-4.0, -5.0)] {
        let found = check(&unit, &floor, &at(0.0, 0.0, height), &at(0.0, 0.0, 0.0), above);
        assert!((found.normal + Vec3::z()).norm() < 1e-12);
    }
    for (height, distance) in [(3.0, 2.0), (0.75, -0.25), (0.25, -0.25), (-4.0, 4.0)] {
        check(&unit, &plane, &at(0.0, 0.0, height), &at(0.0, 0.0, 0.0), distance);
    }
    let unbounded = separation(&floor, &plane, &at(0.0, 0.0, 0.0), &at(0.0, 0.0, 9.0), &Goal::penetration());
    assert_eq!(
        unbounded.unwrap_err().to_string(),
        "a half_space and a plane are both unbounded, so they have no signed distance"
    );
}

#[test]
fn the_distance_does_not_depend_on_where_the_pair_is() {
    let (a, b) = (cuboid(0.3, 0.4, 0.5), Shape::ellipsoid(Vec3::new(0.2, 0.3, 0.6)).unwrap());
    let near = separation(&a, &b, &at(0.0, 0.0, 0.0), &at(1.0, 0.25, -0.5), &Goal::penetration()).unwrap();
    let offset = 1048576.0; // a power of two, so that the positions are exact
    let (far_a, far_b) = (at(offset, -offset, offset), at(offset + 1.0, 0.25 - offset, offset - 0.5));
    let far = separation(&a, &b, &far_a, &far_b, &Goal::penetration()).unwrap();
    assert_eq!((near.bracket, near.signed_distance, near.normal), (far.bracket, far.signed_distance, far.normal));
}
