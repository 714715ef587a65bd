//! Contact patches whose corners are known by hand.
//!
//! Oracle: closed forms, and, where two polygons face one another, a dense grid of the plane between them: a place is in the patch
//! when the polygons the test made the shapes from both hold it, by signs of sides alone. `patch_regimes` has random pairs of all kinds.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::Arc;

use clearance::geometry::tolerance::PATCH_TILT;
use clearance::geometry::{
    Compound, Grid, HeightField, Part, Placement, PointCloud, Pose, Quaternion, Shape, TriangleMesh, Vec3, Voxels,
};
use clearance::narrow_phase::{
    ContactPatch, ContactPoint, Goal, MOST_POINTS, NoPatch, PatchGoal, Separation, contact_patch, separation,
};

use crate::samples::{Random, at};

pub fn patch_of(
    a: &Shape,
    b: &Shape,
    at_a: &Placement,
    at_b: &Placement,
    goal: &PatchGoal,
) -> (Separation, ContactPatch) {
    let found = separation(a, b, at_a, at_b, &Goal::penetration()).unwrap();
    let patch = contact_patch(a, b, at_a, at_b, &found, goal).unwrap();
    (found, patch)
}

fn turned(translation: [f64; 3], axis: Vec3, angle: f64) -> Placement {
    Pose::new(Vec3::from(translation), Quaternion::about_axis(axis.normalize(), angle)).unwrap().placement()
}

fn cuboid(x: f64, y: f64, z: f64) -> Shape {
    Shape::cuboid(Vec3::new(x, y, z)).unwrap()
}

/// Whether the middles of the points are these places, in any order.
fn assert_places(points: &[ContactPoint], expected: &[[f64; 3]], tolerance: f64) {
    let is_at = |p: &ContactPoint, e: &[f64; 3]| (p.middle() - Vec3::from(*e)).norm() <= tolerance;
    let all = expected.iter().all(|e| points.iter().any(|p| is_at(p, e)));
    assert!(points.len() == expected.len() && all, "{points:#?}\nexpected {expected:?}");
}

#[test]
fn a_box_on_a_box_touches_in_four_points_of_equal_depth() {
    let (lower, upper) = (cuboid(1.0, 1.0, 0.5), cuboid(0.4, 0.3, 0.2));
    for gap in [-0.1, -1e-3, -1e-12, 0.0, 1e-9, 0.25] {
        let (found, patch) =
            patch_of(&lower, &upper, &at(0.0, 0.0, 0.0), &at(0.2, -0.1, 0.7 + gap), &PatchGoal::default());
        assert!((found.normal - Vec3::z()).norm() < 1e-12);
        let z = 0.5 + gap / 2.0;
        let corners = [[0.6, 0.2, z], [-0.2, 0.2, z], [-0.2, -0.4, z], [0.6, -0.4, z]];
        assert_places(patch.points(), &corners, 1e-12);
        assert!(patch.points().iter().all(|p| (p.signed_distance - gap).abs() < 1e-12), "{patch:?}");
        assert!((patch.area() - 0.48).abs() < 1e-12 && !patch.truncated);
        assert_eq!(patch.polygon().len(), 4);
    }
}

/// What shakes by less than the tilt keeps its corners, and they move no farther than it does.
#[test]
fn a_box_that_shakes_keeps_its_four_points() {
    let (lower, upper) = (cuboid(1.0, 1.0, 0.5), cuboid(0.4, 0.3, 0.2));
    let corners = [[0.6, 0.2], [-0.2, 0.2], [-0.2, -0.4], [0.6, -0.4]];
    let mut random = Random::new(23);
    for _ in 0..500 {
        let angle = random.magnitude(-16.0, -2.1);
        let shift = random.vector(angle);
        let place = turned([0.2 + shift.x, -0.1 + shift.y, 0.7 + shift.z], random.direction(), angle);
        let (_, patch) = patch_of(&lower, &upper, &at(0.0, 0.0, 0.0), &place, &PatchGoal::default());
        assert_eq!((patch.points().len(), patch.polygon().len()), (4, 4), "{angle} {patch:?}");
        for [x, y] in corners {
            let near = |p: &&ContactPoint| libm::hypot(p.point_on_a.x - x, p.point_on_a.y - y) < 4.0 * angle + 1e-14;
            let point = patch.points().iter().find(near).unwrap();
            assert!(
                point.signed_distance.abs() < 4.0 * angle + 1e-14
                    && (point.point_on_a.z - 0.5).abs() < 4.0 * angle + 1e-14
            );
        }
    }
}

/// As near the origin as far from it, up to the rounding of places so far out.
#[test]
fn a_patch_far_from_the_origin_has_the_same_corners() {
    let (lower, upper) = (cuboid(1.0, 1.0, 0.5), cuboid(0.4, 0.3, 0.2));
    let ground = Shape::half_space(Vec3::z(), 0.5).unwrap();
    let home = Vec3::new(1e7, -3e7, 2e7);
    let lean = Quaternion::about_axis(Vec3::new(0.6, 0.8, 0.0), 0.5 * PATCH_TILT);
    for floor in [&lower, &ground] {
        let placed = |home: Vec3| {
            let at_b = Pose::new(home + Vec3::new(0.25, -0.125, 0.75), lean).unwrap().placement();
            let at_a = Pose::new(home, Quaternion::IDENTITY).unwrap().placement();
            patch_of(floor, &upper, &at_a, &at_b, &PatchGoal::default()).1
        };
        let (near, far) = (placed(Vec3::zeros()), placed(home));
        assert_eq!(near.points().len(), 4);
        for (p, q) in near.points().iter().zip(far.points()) {
            assert!((p.point_on_a + home - q.point_on_a).norm() < 2e-8);
            assert!((p.signed_distance - q.signed_distance).abs() < 1e-10, "{p:?} {q:?}");
        }
    }
}

/// Faces of one size that lie flush, and faces that share an edge or a corner only.
#[test]
fn flush_faces_touch_in_their_corners_and_shared_edges_in_their_ends() {
    let cube = cuboid(1.0, 1.0, 1.0);
    let on = |x: f64, y: f64| patch_of(&cube, &cube, &at(0.0, 0.0, 0.0), &at(x, y, 2.0), &PatchGoal::default()).1;
    assert_places(
        on(0.0, 0.0).points(),
        &[[1.0, 1.0, 1.0], [-1.0, 1.0, 1.0], [-1.0, -1.0, 1.0], [1.0, -1.0, 1.0]],
        1e-14,
    );
    assert_places(
        on(0.5, 0.0).points(),
        &[[1.0, 1.0, 1.0], [-0.5, 1.0, 1.0], [-0.5, -1.0, 1.0], [1.0, -1.0, 1.0]],
        1e-14,
    );
    // A face above beside the other one: by the same normal there is nothing but an edge, or a corner.
    let beside = |x: f64, y: f64| {
        let (lower, upper) = (at(0.0, 0.0, 0.0), at(x, y, 2.5));
        let found = separation(&cube, &cube, &lower, &upper, &Goal::penetration()).unwrap();
        let found = Separation { normal: Vec3::z(), point_on_b: found.point_on_a + Vec3::z() * 0.5, ..found };
        contact_patch(&cube, &cube, &lower, &upper, &found, &PatchGoal::default()).unwrap()
    };
    assert_places(beside(2.0, 0.0).points(), &[[1.0, 1.0, 1.25], [1.0, -1.0, 1.25]], 1e-14);
    assert_places(beside(2.0, 2.0).points(), &[[1.0, 1.0, 1.25]], 1e-14);
}

#[test]
fn an_edge_on_a_face_touches_in_two_points_and_a_corner_in_one() {
    let (table, die) = (cuboid(1.0, 1.0, 0.5), cuboid(0.2, 0.3, 0.2));
    let goal = PatchGoal::default();
    let up = 0.5 + 0.2 * 2.0_f64.sqrt();
    let (_, edge) =
        patch_of(&table, &die, &at(0.0, 0.0, 0.0), &turned([0.1, 0.2, up - 1e-3], Vec3::y(), PI / 4.0), &goal);
    assert_places(edge.points(), &[[0.1, 0.5, 0.4995], [0.1, -0.1, 0.4995]], 1e-12);
    // The edge reaches over the table's.
    let (_, over) = patch_of(&table, &die, &at(0.0, 0.0, 0.0), &turned([0.1, 0.9, up], Vec3::y(), PI / 4.0), &goal);
    assert_places(over.points(), &[[0.1, 0.6, 0.5], [0.1, 1.0, 0.5]], 1e-12);
    let tip = Quaternion::about_axis(Vec3::x(), 0.6).compose(Quaternion::about_axis(Vec3::y(), 0.5));
    let tipped = Pose::new(Vec3::new(0.1, 0.2, 0.9), tip).unwrap().placement();
    let (found, corner) = patch_of(&table, &die, &at(0.0, 0.0, 0.0), &tipped, &goal);
    let [only] = corner.points() else { panic!("{corner:?}") };
    assert_eq!((only.point_on_a, only.point_on_b), (found.point_on_a, found.point_on_b));
    assert_eq!((corner.polygon().len(), only.signed_distance), (1, found.signed_distance));
}

/// A box that leans by less than the tilt lies on its face, about whichever edge or diagonal it leans; one that leans by more does not.
#[test]
fn a_box_lies_on_its_face_up_to_the_tilt() {
    let (table, plate) = (cuboid(3.0, 3.0, 0.5), cuboid(1.0, 0.01, 0.2));
    let count = |axis: Vec3, angle: f64, tilt: f64| {
        let place = turned([0.0, 0.0, 0.9], axis, angle);
        let (found, patch) =
            patch_of(&table, &plate, &at(0.0, 0.0, 0.0), &place, &PatchGoal { tilt, ..PatchGoal::default() });
        let deepest = patch.points().iter().map(|p| p.signed_distance).fold(f64::INFINITY, f64::min);
        assert!((deepest - found.signed_distance).abs() < 1e-8);
        patch.points().len()
    };
    for tilt in [PATCH_TILT, 1e-4, 0.1, 0.4] {
        for yaw in 0..24 {
            let (y, x) = libm::sincos(TAU * f64::from(yaw) / 24.0);
            let axis = Vec3::new(x, y, 0.0);
            assert_eq!(count(axis, 0.98 * tilt, tilt), 4, "{axis} {tilt}");
            // Beyond, the corner it stands on, and the ends of those of its edges that lean by less.
            // Leaning by 1.2 the nearest other face leans by 0.37.
            for angle in [1.02 * tilt, 1.3 * tilt, if tilt < 0.3 { 1.2 } else { 0.6 }] {
                let leans = [x, y].map(|part: f64| libm::asin(libm::sin(angle) * part.abs()));
                let expected = 1 + leans.iter().filter(|lean| **lean <= tilt).count();
                assert_eq!(count(axis, angle, tilt), expected, "{axis} {angle} {tilt}");
            }
        }
    }
    assert_eq!(count(Vec3::x(), 1e-6, 0.0), 2);
    assert_eq!(count(Vec3::x(), 0.0, 0.0), 4);
}

/// Boxes that are turned against one another about the normal: beyond the tilt the overlap has up to eight corners, below four.
#[test]
fn nearly_parallel_sides_are_one_side() {
    let (lower, upper) = (cuboid(1.0, 1.0, 0.5), cuboid(1.0, 1.0, 0.5));
    let random = &mut Random::new(5);
    for _ in 0..200 {
        let yaw = random.between(-0.9, 0.9) * PATCH_TILT;
        let shift = random.vector(1e-3);
        let place = turned([shift.x, shift.y, 1.0 + shift.z], Vec3::z(), yaw);
        let (_, patch) = patch_of(&lower, &upper, &at(0.0, 0.0, 0.0), &place, &PatchGoal::default());
        assert_eq!(patch.points().len(), 4, "{yaw} {shift}");
        assert!((patch.area() - 4.0).abs() < 0.05);
    }
    for yaw in [0.02, 0.3, PI / 4.0] {
        let place = turned([0.0, 0.0, 1.0], Vec3::z(), yaw);
        let (_, patch) = patch_of(&lower, &upper, &at(0.0, 0.0, 0.0), &place, &PatchGoal::default());
        assert_eq!(patch.points().len(), 8);
        // Its sides are at a distance of 1 from the middle, so it has half its outline for area; they meet at turns of the angle
        // and of what is left of a right angle, in turn.
        let expected = 4.0 * (libm::tan(yaw / 2.0) + libm::tan((FRAC_PI_2 - yaw) / 2.0));
        assert!((patch.area() - expected).abs() < 1e-9, "{} {expected}", patch.area());
        let few = PatchGoal { most: 4, ..PatchGoal::default() };
        let (_, reduced) = patch_of(&lower, &upper, &at(0.0, 0.0, 0.0), &place, &few);
        assert!(reduced.truncated && reduced.points().len() == 4 && reduced.area() > 0.6 * expected);
    }
}

#[test]
fn lying_round_bodies_touch_along_lines_and_standing_ones_on_discs() {
    let table = cuboid(1.0, 1.0, 0.5);
    let ground = Shape::half_space(Vec3::z(), 0.5).unwrap();
    let goal = PatchGoal::default();
    for floor in [&table, &ground] {
        for (shape, radius) in [(Shape::capsule(0.2, 0.5).unwrap(), 0.2), (Shape::cylinder(0.2, 0.5).unwrap(), 0.2)] {
            let lying = turned([0.1, 0.0, 0.5 + radius - 0.01], Vec3::x(), FRAC_PI_2);
            let (_, patch) = patch_of(floor, &shape, &at(0.0, 0.0, 0.0), &lying, &goal);
            assert_places(patch.points(), &[[0.1, 0.5, 0.495], [0.1, -0.5, 0.495]], 1e-12);
        }
        for standing in [Shape::cylinder(0.2, 0.5).unwrap(), Shape::cone(0.2, 0.5).unwrap()] {
            let (_, patch) = patch_of(floor, &standing, &at(0.0, 0.0, 0.0), &at(0.3, 0.2, 1.0), &goal);
            assert_eq!(patch.points().len(), 16);
            let rim = |p: &ContactPoint| (p.middle() - Vec3::new(0.3, 0.2, 0.5)).norm();
            assert!(patch.points().iter().all(|p| (rim(p) - 0.2).abs() < 1e-12));
            assert!(patch.area() < PI * 0.04 && patch.area() > 0.974 * PI * 0.04);
        }
        // In an overlap the witness of a curved surface may be as far off as its curvature hides from the depth; apart it is near.
        let head = turned([0.0, 0.0, 1.01], Vec3::x(), PI);
        for round in [
            Shape::cone(0.2, 0.5).unwrap(),
            Shape::ellipsoid(Vec3::new(0.1, 0.2, 0.5)).unwrap(),
            Shape::sphere(0.5).unwrap(),
        ] {
            let (found, patch) = patch_of(floor, &round, &at(0.0, 0.0, 0.0), &head, &goal);
            assert_places(patch.points(), &[[0.0, 0.0, 0.505]], 1e-3);
            assert_eq!(patch.points()[0].point_on_b, found.point_on_b);
        }
    }
    // A cone that lies on its side touches from its apex to its rim.
    let (radius, half) = (0.3_f64, 0.5_f64);
    let slope = libm::atan2(radius, 2.0 * half);
    let lying = turned([0.0, 0.0, 0.5 + half * libm::sin(slope)], Vec3::y(), FRAC_PI_2 + slope);
    let (_, patch) = patch_of(&ground, &Shape::cone(radius, half).unwrap(), &at(0.0, 0.0, 0.0), &lying, &goal);
    let length = libm::hypot(radius, 2.0 * half);
    let [one, other] = patch.points() else { panic!("{patch:?}") };
    assert!(((one.middle() - other.middle()).norm() - length).abs() < 1e-12);
}

#[test]
fn parallel_capsules_touch_along_what_they_share_and_crossed_ones_in_a_point() {
    let capsule = Shape::capsule(0.1, 1.0).unwrap();
    let goal = PatchGoal::default();
    for angle in [0.0, 1e-15, 1e-9, 0.5 * PATCH_TILT, PI, PI - 1e-3] {
        let beside = turned([0.2, 0.0, 0.5], Vec3::x(), angle);
        let (_, patch) = patch_of(&capsule, &capsule, &at(0.0, 0.0, 0.0), &beside, &goal);
        assert_places(patch.points(), &[[0.1, 0.0, 1.0], [0.1, 0.0, -0.5]], PATCH_TILT);
    }
    for angle in [2.0 * PATCH_TILT, 0.5, FRAC_PI_2] {
        let (_, patch) =
            patch_of(&capsule, &capsule, &at(0.0, 0.0, 0.0), &turned([0.2, 0.0, 0.0], Vec3::x(), angle), &goal);
        assert_places(patch.points(), &[[0.1, 0.0, 0.0]], 1e-9);
    }
    // End to end there is no line to share.
    let (_, ends) = patch_of(&capsule, &capsule, &at(0.0, 0.0, 0.0), &at(0.0, 0.0, 2.2), &goal);
    assert_places(ends.points(), &[[0.0, 0.0, 1.1]], 1e-12);
}

/// A wedge whose ridge lies on a plane is deepest along its ridge, which is within the outline of its two sides.
#[test]
fn the_deepest_place_is_told_where_it_is_no_corner() {
    let lift = 0.004;
    let ridge = [[0.5, 0.0, 0.0], [-0.5, 0.0, 0.0]];
    let sides = [[0.6, 1.0, lift], [-0.6, 1.0, lift], [0.6, -1.0, lift], [-0.6, -1.0, lift], [0.0, 0.0, 1.0]];
    let points: Vec<Vec3> = ridge.iter().chain(&sides).map(|p| Vec3::from(*p)).collect();
    let wedge = Shape::convex(&points).unwrap();
    let ground = Shape::half_space(Vec3::z(), 0.0).unwrap();
    let goal = PatchGoal::default();
    let (found, patch) = patch_of(&ground, &wedge, &at(0.0, 0.0, 0.0), &at(0.0, 0.0, -0.001), &goal);
    assert_eq!((patch.polygon().len(), patch.points().len()), (4, 5));
    assert_eq!(patch.points()[4].signed_distance, found.signed_distance);
    assert!(patch.polygon().iter().all(|p| (p.signed_distance - 0.003).abs() < 1e-12));
    // Where nothing but it is within the cut-off, it is alone; the fewest points are it alone, too.
    for goal in [PatchGoal { cut_off: 0.0, ..goal }, PatchGoal { most: 1, ..goal }, PatchGoal { most: 0, ..goal }] {
        let (_, patch) = patch_of(&ground, &wedge, &at(0.0, 0.0, 0.0), &at(0.0, 0.0, -0.001), &goal);
        let [only] = patch.points() else { panic!("{patch:?}") };
        assert!((only.signed_distance + 0.001).abs() < 1e-15);
    }
    let sharp = PatchGoal { tilt: 0.001, ..goal };
    let (_, patch) = patch_of(&ground, &wedge, &at(0.0, 0.0, 0.0), &at(0.0, 0.0, -0.001), &sharp);
    assert_places(patch.points(), &[[0.5, 0.0, -0.0005], [-0.5, 0.0, -0.0005]], 1e-12);
}

/// Of a box that leans, sunk in by more at one side, the patch ends where the faces are as far apart as the cut-off.
#[test]
fn the_cut_off_ends_the_patch() {
    let ground = Shape::half_space(Vec3::z(), 0.0).unwrap();
    let plate = cuboid(1.0, 0.5, 0.1);
    let lean = 0.008;
    let (sin, cos) = libm::sincos(lean);
    // The lower face is at z = 0 in the middle.
    let place = turned([0.1 * sin, 0.0, 0.1 * cos], Vec3::y(), lean);
    let reach = |goal: &PatchGoal| {
        let (_, patch) = patch_of(&ground, &plate, &at(0.0, 0.0, 0.0), &place, goal);
        assert_eq!(patch.points().len(), 4);
        let x = patch.points().iter().map(|p| p.point_on_a.x);
        (x.clone().fold(f64::INFINITY, f64::min), x.fold(f64::NEG_INFINITY, f64::max))
    };
    let goal = PatchGoal::default();
    let near = |(a, b): (f64, f64), (c, d): (f64, f64)| (a - c).abs() < 1e-12 && (b - d).abs() < 1e-12;
    assert!(near(reach(&goal), (-cos, cos)));
    assert!(near(reach(&PatchGoal { cut_off: 0.0, ..goal }), (0.0, cos)));
    assert!(near(reach(&PatchGoal { cut_off: 0.004, ..goal }), (-0.004 / libm::tan(lean), cos)));
    assert!(near(reach(&PatchGoal { cut_off: -0.004, ..goal }), (0.004 / libm::tan(lean), cos)));
    // A pair that is proved farther apart has no patch at all.
    let (found, patch) =
        patch_of(&ground, &plate, &at(0.0, 0.0, 0.0), &at(0.0, 0.0, 0.2), &PatchGoal { cut_off: 0.05, ..goal });
    assert!(
        found.bracket.lower > 0.05 && patch.points().is_empty() && patch.polygon().is_empty() && patch.area() == 0.0
    );
    let (_, patch) =
        patch_of(&ground, &plate, &at(0.0, 0.0, 0.0), &at(0.0, 0.0, 0.1), &PatchGoal { cut_off: 0.0, ..goal });
    assert_eq!(patch.points().len(), 4, "what touches exactly is within zero");
}

#[test]
fn degenerate_shapes_have_patches() {
    let goal = PatchGoal::default();
    let table = cuboid(1.0, 1.0, 0.5);
    let sheet = cuboid(0.3, 0.2, 0.0);
    let corners = [[0.3, 0.2], [-0.3, 0.2], [-0.3, -0.2], [0.3, -0.2]];
    let flat = Shape::convex(&corners.map(|[x, y]| Vec3::new(x, y, 0.0))).unwrap();
    let grid: Vec<Vec3> =
        (0..169).map(|i| Vec3::new(f64::from(i % 13 - 6) * 0.05, f64::from(i / 13 - 6) / 30.0, 0.0)).collect();
    let grid = Shape::convex(&grid).unwrap();
    for thin in [&sheet, &flat, &grid] {
        for (lower, upper) in [(&table, thin), (thin, &table)] {
            let gap = if std::ptr::eq(lower, &table) { 0.5 } else { 0.5 + 1e-3 };
            let (found, patch) = patch_of(lower, upper, &at(0.0, 0.0, 0.0), &at(0.0, 0.0, gap), &goal);
            let z = (found.point_on_a.z + found.point_on_b.z) / 2.0;
            assert_places(patch.points(), &corners.map(|[x, y]| [x, y, z]), 1e-12);
            assert!(!patch.truncated, "what a grid has within its outline is not missed");
        }
        let (_, patch) = patch_of(thin, thin, &at(0.0, 0.0, 0.0), &at(0.1, 0.0, 0.01), &goal);
        assert!((patch.area() - 0.2).abs() < 1e-12);
    }
    let needle = Shape::convex(&[Vec3::zeros(), Vec3::x() * 0.4, Vec3::x() * 0.9]).unwrap();
    let (_, patch) = patch_of(&table, &needle, &at(0.0, 0.0, 0.0), &at(0.0, 0.0, 0.6), &goal);
    assert_places(patch.points(), &[[0.0, 0.0, 0.55], [0.9, 0.0, 0.55]], 1e-12);
    let degenerate = [
        Shape::point(),
        cuboid(0.0, 0.0, 0.0),
        Shape::cylinder(0.0, 0.0).unwrap(),
        Shape::cone(0.0, 0.0).unwrap(),
        Shape::ellipsoid(Vec3::zeros()).unwrap(),
        Shape::segment(Vec3::zeros(), Vec3::zeros()).unwrap(),
        Shape::triangle(Vec3::zeros(), Vec3::zeros(), Vec3::zeros()).unwrap(),
    ];
    for point in &degenerate {
        let (_, patch) = patch_of(&table, point, &at(0.0, 0.0, 0.0), &at(0.2, 0.3, 0.6), &goal);
        assert_places(patch.points(), &[[0.2, 0.3, 0.55]], 1e-12);
    }
    let stick = Shape::cylinder(0.0, 0.4).unwrap();
    for line in [stick, Shape::cone(0.0, 0.4).unwrap(), Shape::ellipsoid(Vec3::new(0.0, 0.0, 0.4)).unwrap()] {
        let (_, patch) =
            patch_of(&table, &line, &at(0.0, 0.0, 0.0), &turned([0.0, 0.0, 0.6], Vec3::x(), FRAC_PI_2), &goal);
        assert_places(patch.points(), &[[0.0, 0.4, 0.55], [0.0, -0.4, 0.55]], 1e-12);
    }
    let discs = [
        Shape::cylinder(0.4, 0.0).unwrap(),
        Shape::cone(0.4, 0.0).unwrap(),
        Shape::ellipsoid(Vec3::new(0.4, 0.4, 0.0)).unwrap(),
    ];
    for disc in &discs {
        for half_turns in [0.0, 1.0] {
            let (_, patch) =
                patch_of(&table, disc, &at(0.0, 0.0, 0.0), &turned([0.0, 0.0, 0.6], Vec3::x(), half_turns * PI), &goal);
            assert!(
                patch.points().len() == 16 && (patch.area() / (PI * 0.16) - 0.9745).abs() < 1e-4,
                "{}",
                disc.kind()
            );
        }
    }
}

#[test]
fn deep_overlaps_have_the_patch_of_the_faces_that_part_soonest() {
    let (a, b) = (cuboid(1.0, 1.0, 1.0), cuboid(0.3, 0.4, 0.1));
    let (found, patch) = patch_of(&a, &b, &at(0.0, 0.0, 0.0), &at(0.0, 0.0, 0.05), &PatchGoal::default());
    assert!((found.signed_distance + 1.05).abs() < 1e-12);
    assert_places(
        patch.points(),
        &[[0.3, 0.4, 0.475], [-0.3, 0.4, 0.475], [-0.3, -0.4, 0.475], [0.3, -0.4, 0.475]],
        1e-12,
    );
    assert!(patch.points().iter().all(|p| (p.signed_distance + 1.05).abs() < 1e-12));
}

/// A regular or random convex polygon, by corners in order.
fn polygon(random: &mut Random, corners: usize, radius: f64) -> Vec<[f64; 2]> {
    let mut angles: Vec<f64> = (0..corners).map(|_| random.between(0.0, TAU)).collect();
    angles.sort_by(f64::total_cmp);
    let (stretch, turn) = (random.between(0.3, 1.0), random.between(0.0, TAU));
    let (s, c) = libm::sincos(turn);
    let place = |t: &f64| {
        let (y, x) = libm::sincos(*t);
        let (x, y) = (radius * x, radius * stretch * y);
        [c * x - s * y, s * x + c * y]
    };
    angles.iter().map(place).collect()
}

/// How far within all sides a place is; negative: outside. Corners counter-clockwise.
fn inside(corners: &[[f64; 2]], p: [f64; 2]) -> f64 {
    let side = |i: usize| {
        let ([ax, ay], [bx, by]) = (corners[i], corners[(i + 1) % corners.len()]);
        let (dx, dy) = (bx - ax, by - ay);
        (dx * (p[1] - ay) - dy * (p[0] - ax)) / libm::hypot(dx, dy)
    };
    (0..corners.len()).map(side).fold(f64::INFINITY, f64::min)
}

/// A frustum: the polygon at z = 0, and a smaller copy at a height.
fn frustum(base: &[[f64; 2]], height: f64) -> Shape {
    let ring = |scale: f64, z: f64| base.iter().map(move |[x, y]| Vec3::new(x * scale, y * scale, z));
    Shape::convex(&ring(1.0, 0.0).chain(ring(0.5, height)).collect::<Vec<_>>()).unwrap()
}

#[test]
fn faces_of_hulls_overlap_where_a_dense_grid_says_so() {
    let mut random = Random::new(31);
    let (mut held, mut free, mut corners_met) = (0, 0, [0; 33]);
    for round in 0..300 {
        let (na, nb) = (3 + random.index(14), 3 + random.index(14));
        let (face_a, face_b) = (polygon(&mut random, na, 1.0), polygon(&mut random, nb, 0.8));
        let shift = [random.between(-0.7, 0.7), random.between(-0.7, 0.7)];
        let gap = random.between(-0.01, 0.02);
        // A hangs down from z = 0, B stands on z = gap; then both are moved together.
        let (a, b) = (frustum(&face_a, -0.9), frustum(&face_b, 0.7));
        let common = if round % 2 == 0 { Pose::identity() } else { random.pose(10.0) };
        let shifted = Pose::new(Vec3::new(shift[0], shift[1], gap), Quaternion::IDENTITY).unwrap();
        let (at_a, at_b) = (common.placement(), common.compose(&shifted).placement());
        let found = separation(&a, &b, &at_a, &at_b, &Goal::penetration()).unwrap();
        let normal = at_a.direction(Vec3::z());
        if (found.normal - normal).norm() > 1e-7 {
            continue; // Faces that do not lie over one another, or sides that part sooner.
        }
        let goal = PatchGoal { tilt: 1e-6, ..PatchGoal::default() };
        let patch = contact_patch(&a, &b, &at_a, &at_b, &found, &goal).unwrap();
        let flat = |p: &ContactPoint| {
            let local = at_a.direction_into(p.point_on_a - at_a.translation);
            [local.x, local.y]
        };
        if patch.polygon().len() < 3 {
            continue;
        }
        corners_met[patch.polygon().len()] += 1;
        let found_polygon: Vec<[f64; 2]> = patch.polygon().iter().map(flat).collect();
        for i in 0..60 {
            for j in 0..60 {
                let p = [f64::from(i) / 30.0 - 1.0, f64::from(j) / 30.0 - 1.0];
                let truth = inside(&face_a, p).min(inside(&face_b, [p[0] - shift[0], p[1] - shift[1]]));
                let ours = inside(&found_polygon, p);
                // Straightening moves a side by what the tilt and the rounding of the far pose make.
                if truth.abs() > 1e-5 {
                    assert_eq!(truth > 0.0, ours > 0.0, "{p:?} {truth} {ours}");
                    if truth > 0.0 { held += 1 } else { free += 1 }
                }
            }
        }
        for p in patch.points() {
            assert!((p.signed_distance - gap).abs() < 1e-7, "{p:?} {gap}");
        }
    }
    assert!(held > 20_000 && free > 20_000, "{held} {free}");
    assert!(corners_met[3..9].iter().all(|n| *n > 3), "{corners_met:?}");
}

#[test]
fn faces_of_too_many_corners_are_cut_short_and_say_so() {
    let ring: Vec<[f64; 2]> = (0..100)
        .map(|k| {
            let (y, x) = libm::sincos(TAU * f64::from(k) / 100.0);
            [x, y]
        })
        .collect();
    let (drum, table) = (frustum(&ring, 0.7), cuboid(2.0, 2.0, 0.5));
    let (_, patch) = patch_of(&table, &drum, &at(0.0, 0.0, 0.0), &at(0.0, 0.0, 0.5), &PatchGoal::default());
    assert!(patch.truncated && patch.points().len() == MOST_POINTS);
    assert!(patch.area() > 0.99 * PI * 0.995, "{}", patch.area());
    for most in 1..10 {
        let (_, few) = patch_of(
            &table,
            &drum,
            &at(0.0, 0.0, 0.0),
            &at(0.0, 0.0, 0.5),
            &PatchGoal { most, ..PatchGoal::default() },
        );
        assert!(few.points().len() == most && few.truncated);
        assert!(most != 4 || few.area() > 1.9);
    }
}

/// The piece that the separation names is what the patch is of.
#[test]
fn pieces_of_meshes_compounds_terrain_maps_and_clouds_have_patches() {
    let goal = PatchGoal::default();
    let brick = cuboid(0.2, 0.2, 0.1);
    let floor = |z: f64| {
        vec![Vec3::new(-1.0, -1.0, z), Vec3::new(1.0, -1.0, z), Vec3::new(1.0, 1.0, z), Vec3::new(-1.0, 1.0, z)]
    };
    let mesh = Arc::new(TriangleMesh::surface(floor(0.0), vec![[0, 1, 2], [0, 2, 3]]).unwrap());
    let over = |x: f64, y: f64| at(x, y, 0.1 + 0.01);
    let (found, patch) = patch_of(&Shape::mesh(Arc::clone(&mesh)), &brick, &at(0.0, 0.0, 0.0), &over(0.5, -0.5), &goal);
    assert_eq!(found.subshape_a, 0);
    assert_places(
        patch.points(),
        &[[0.7, -0.3, 0.005], [0.3, -0.3, 0.005], [0.3, -0.7, 0.005], [0.7, -0.7, 0.005]],
        1e-12,
    );
    // Across the diagonal one of the two triangles is named, and the patch ends with it.
    let (_, half) = patch_of(&Shape::mesh(Arc::clone(&mesh)), &brick, &at(0.0, 0.0, 0.0), &over(0.0, 0.0), &goal);
    assert!((half.area() - 0.08).abs() < 1e-12);

    let part = |shape: &Shape, x: f64| Part {
        shape: shape.clone(),
        pose: Pose::new(Vec3::new(x, 0.0, 0.0), Quaternion::IDENTITY).unwrap(),
    };
    let pair = Shape::compound(Arc::new(Compound::new(vec![part(&brick, -1.0), part(&brick, 1.0)]).unwrap()));
    let ground = Shape::half_space(Vec3::z(), 0.0).unwrap();
    let leaning = turned([0.0, 0.0, 0.11], Vec3::y(), 1e-3);
    let (found, patch) = patch_of(&ground, &pair, &at(0.0, 0.0, 0.0), &leaning, &goal);
    assert!(found.subshape_b == 1 && patch.points().len() == 4, "{patch:?}");
    assert!(patch.points().iter().all(|p| p.point_on_b.x > 0.7 && p.point_on_a.z.abs() < 1e-15));

    let grid = Grid { rows: 3, columns: 3, spacing: [1.0, 1.0] };
    let terrain = Shape::height_field(Arc::new(HeightField::new(grid, vec![0.0; 9], -1.0).unwrap()));
    let (_, patch) = patch_of(&terrain, &brick, &at(0.0, 0.0, 0.0), &at(0.7, 0.25, 0.1), &goal);
    assert!((patch.area() - 0.16).abs() < 1e-12, "{patch:?}");
    let cells = Voxels::new(1.0).unwrap().with_cells(&[[0, 0, 0], [3, 4, 1], [-70, 2, 2]]).unwrap();
    let (_, patch) = patch_of(&Shape::voxels(cells), &brick, &at(0.0, 0.0, 0.0), &at(3.1, 4.5, 2.1), &goal);
    assert!((patch.area() - 0.4 * 0.3).abs() < 1e-12, "{patch:?}");
    let cloud = Shape::point_cloud(Arc::new(PointCloud::new(&[Vec3::zeros(), Vec3::x()]).unwrap()), 0.05).unwrap();
    let (found, patch) = patch_of(&cloud, &brick, &at(0.0, 0.0, 0.0), &at(1.0, 0.0, 0.2), &goal);
    assert!(
        found.subshape_a == 1 && patch.points().len() == 1 && (patch.points()[0].signed_distance - 0.05).abs() < 1e-12
    );

    let hidden = Shape::compound(Arc::new(Compound::new(vec![part(&Shape::mesh(mesh), 0.0)]).unwrap()));
    let found = separation(&hidden, &brick, &at(0.0, 0.0, 0.0), &over(0.5, -0.5), &Goal::penetration()).unwrap();
    let refused = contact_patch(&hidden, &brick, &at(0.0, 0.0, 0.0), &over(0.5, -0.5), &found, &goal);
    assert_eq!(refused, Err(NoPatch::NotOnePiece { kind: "compound", subshape: 0 }));
    let walls = contact_patch(&ground, &ground, &at(0.0, 0.0, 0.0), &at(0.0, 0.0, 0.0), &found, &goal);
    assert_eq!(walls, Err(NoPatch::Unbounded { a: "half_space", b: "half_space" }));
}

/// What a patch costs beside the separation it is made of: `cargo test --release --no-default-features --test collision -- --ignored prices --nocapture`.
#[test]
#[ignore = "measures time"]
fn prices_of_patches() {
    let mut random = Random::new(3);
    let ring = |count: u32| {
        (0..count)
            .map(|k| {
                let (y, x) = libm::sincos(TAU * f64::from(k) / f64::from(count));
                [x, y]
            })
            .collect::<Vec<_>>()
    };
    let ball: Vec<Vec3> = (0..500).map(|_| random.direction()).collect();
    let (table, goal) = (cuboid(2.0, 2.0, 0.5), PatchGoal::default());
    let rows = [
        ("box on box", table.clone(), cuboid(0.4, 0.3, 0.2), at(0.2, 0.1, 0.699)),
        ("box on box, turned", table.clone(), cuboid(0.4, 0.3, 0.2), turned([1.9, 0.1, 0.699], Vec3::z(), 0.5)),
        ("corner on box", table.clone(), cuboid(0.4, 0.3, 0.2), turned([0.2, 0.1, 0.9], Vec3::new(1.0, 2.0, 0.3), 0.7)),
        (
            "capsule on box",
            table.clone(),
            Shape::capsule(0.2, 0.5).unwrap(),
            turned([0.0, 0.0, 0.699], Vec3::x(), FRAC_PI_2),
        ),
        ("cylinder on box", table.clone(), Shape::cylinder(0.2, 0.5).unwrap(), at(1.9, 0.0, 0.999)),
        (
            "cylinder on cylinder",
            Shape::cylinder(0.5, 0.5).unwrap(),
            Shape::cylinder(0.2, 0.5).unwrap(),
            at(0.4, 0.0, 0.999),
        ),
        ("hull 32 on box", table.clone(), frustum(&ring(16), 0.5), at(1.5, 0.0, 0.499)),
        ("hull 500 on box", table.clone(), Shape::convex(&ball).unwrap(), at(0.0, 0.0, 1.49)),
        ("box on half-space", Shape::half_space(Vec3::z(), 0.5).unwrap(), cuboid(0.4, 0.3, 0.2), at(0.2, 0.1, 0.699)),
    ];
    for (name, a, b, at_b) in rows {
        let at_a = at(0.0, 0.0, 0.0);
        let (found, patch) = patch_of(&a, &b, &at_a, &at_b, &goal);
        let price = |work: &mut dyn FnMut()| {
            let round = |work: &mut dyn FnMut()| {
                let start = std::time::Instant::now();
                (0..2000).for_each(|_| work());
                start.elapsed().as_nanos() as f64 / 2000.0
            };
            (0..7).map(|_| round(work)).fold(f64::INFINITY, f64::min)
        };
        let of_pair = price(&mut || {
            _ = std::hint::black_box(separation(&a, &b, &at_a, std::hint::black_box(&at_b), &Goal::penetration()))
        });
        let of_patch = price(&mut || {
            _ = std::hint::black_box(contact_patch(&a, &b, &at_a, &at_b, std::hint::black_box(&found), &goal))
        });
        println!(
            "{name:22} {} points  separation {of_pair:7.0} ns  patch {of_patch:6.0} ns  {:?}",
            patch.points().len(),
            patch.cost
        );
    }
}
