//! Contact patches of random pairs of all kinds, laid on one another by faces, edges and corners.
//!
//! Oracle: what must hold of every patch. Its points are in the shapes, as far as support values along 200 random directions and formulas of the
//! test's own tell (`sweep::least`); they are near both support planes; and the patch misses nothing: where the hulls of the support
//! points along directions around the normal, sampled by the test, both hold a place, so does the patch. Beyond that, the same
//! question asked again: with the sides swapped, or moved as a whole, the points are the same.

use std::f64::consts::TAU;

use clearance::geometry::tolerance::PATCH_TILT;
use clearance::geometry::{Core, Placement, Pose, Quaternion, Shape, Vec3};
use clearance::narrow_phase::{ContactPatch, ContactPoint, Goal, PatchGoal, Separation, contact_patch, separation};

use crate::samples::{Random, convex_shapes};
use crate::sweep::least;

/// All kinds, some of them with faces of many corners, some on a plane of their own.
fn shapes() -> Vec<Shape> {
    let v = Vec3::new;
    let ring = |count: u32, z: f64| {
        (0..count).map(move |k| {
            let (y, x) = libm::sincos(TAU * f64::from(k) / f64::from(count));
            v(0.4 * x, 0.4 * y, z)
        })
    };
    let prism = |count: u32| Shape::convex(&ring(count, -0.3).chain(ring(count, 0.3)).collect::<Vec<_>>()).unwrap();
    let mut shapes = convex_shapes();
    shapes.extend([
        prism(3),
        prism(8),
        prism(48),
        Shape::convex(&ring(7, 0.0).collect::<Vec<_>>()).unwrap(),
        Shape::triangle(v(0.5, 0.0, 0.0), v(-0.3, 0.4, 0.0), v(-0.3, -0.4, 0.0)).unwrap(),
        Shape::segment(v(-0.4, 0.0, 0.0), v(0.5, 0.0, 0.0)).unwrap(),
        Shape::ellipsoid(v(0.4, 0.3, 0.0)).unwrap(),
        // A wedge with a ridge that is all but flat.
        Shape::convex(&[
            v(0.5, 0.0, 0.3),
            v(-0.5, 0.0, 0.3),
            v(0.5, 0.5, 0.297),
            v(-0.5, 0.5, 0.297),
            v(0.5, -0.5, 0.297),
            v(-0.5, -0.5, 0.297),
            v(0.0, 0.0, -0.2),
        ])
        .unwrap(),
        Shape::half_space(v(0.0, 0.0, 1.0), 0.1).unwrap(),
        Shape::plane(v(0.0, 1.0, 0.0), -0.2).unwrap().swept(0.02).unwrap(),
    ]);
    shapes
}

fn is_wall(shape: &Shape) -> bool {
    matches!(shape.core(), Core::HalfSpace { .. } | Core::Plane { .. })
}

fn is_curved(shape: &Shape) -> bool {
    matches!(shape.core(), Core::Cylinder { .. } | Core::Cone { .. } | Core::Ellipsoid { .. })
}

/// A turn that lays axes on axes, leaning a little now and then.
fn rotation(random: &mut Random) -> Quaternion {
    let quarter = std::f64::consts::FRAC_PI_2;
    let steps = [random.index(4), random.index(4), random.index(4)].map(|k| quarter * k as f64);
    let upright = Quaternion::from_roll_pitch_yaw(steps[0], steps[1], steps[2]);
    let lean = match random.index(6) {
        0..=3 => 0.0,
        4 => random.between(0.0, 2.0) * PATCH_TILT,
        _ => random.between(0.0, 3.0),
    };
    let axis = if random.one_in(2) { Vec3::ith(random.index(3), 1.0) } else { random.direction() };
    Quaternion::about_axis(axis, lean).compose(upright)
}

struct Pair {
    a: Shape,
    b: Shape,
    at_a: Placement,
    at_b: Placement,
    pose_a: Pose,
    pose_b: Pose,
    found: Separation,
}

impl Pair {
    /// B comes along an axis until the gap is as drawn.
    fn random(random: &mut Random, a: &Shape, b: &Shape) -> Option<Self> {
        let place = |t: Vec3, q: Quaternion| Pose::new(t, q).unwrap();
        let pose_a = place(Vec3::zeros(), rotation(random));
        let turn_b = rotation(random);
        let way = Vec3::ith(random.index(3), if random.one_in(2) { 1.0 } else { -1.0 });
        let beside = if random.one_in(3) { Vec3::zeros() } else { random.vector(0.2) };
        let far = place(beside + way * 4.0, turn_b);
        let measure = |pose_b: &Pose| separation(a, b, &pose_a.placement(), &pose_b.placement(), &Goal::penetration());
        let gap = match random.index(4) {
            0 => 0.0,
            1 => random.between(-0.02, 0.0),
            2 => random.between(0.0, 0.05),
            _ => random.between(-0.4, 0.4),
        };
        // From afar the nearest feature may be another, so a few steps along the way; past one another there is no contact to be had.
        let mut pose_b = far;
        for _ in 0..40 {
            let found = measure(&pose_b).ok()?;
            let speed = found.normal.dot(&way);
            if speed < 0.1 {
                return None;
            }
            pose_b = place(pose_b.translation() - way * ((found.signed_distance - gap) / speed), turn_b);
        }
        let found = measure(&pose_b).ok()?;
        (pose_b.translation().norm() < 10.0).then(|| Self {
            a: a.clone(),
            b: b.clone(),
            at_a: pose_a.placement(),
            at_b: pose_b.placement(),
            pose_a,
            pose_b,
            found,
        })
    }

    fn patch(&self, goal: &PatchGoal) -> ContactPatch {
        contact_patch(&self.a, &self.b, &self.at_a, &self.at_b, &self.found, goal).unwrap()
    }

    fn sides(&self) -> [(&Shape, &Placement, f64); 2] {
        [(&self.a, &self.at_a, 1.0), (&self.b, &self.at_b, -1.0)]
    }

    fn what(&self, patch: &ContactPatch) -> String {
        let Self { a, b, pose_a, pose_b, found, .. } = self;
        format!("{} at {pose_a:?}\n{} at {pose_b:?}\n{found:?}\n{patch:#?}", a.kind(), b.kind())
    }
}

fn greatest(shape: &Shape, at: &Placement, direction: Vec3) -> f64 {
    -least(shape, at, -direction)
}

/// What holds of every patch.
fn check(pair: &Pair, patch: &ContactPatch, goal: &PatchGoal, directions: &[Vec3]) {
    let (what, found) = (|| pair.what(patch), &pair.found);
    let points = patch.points();
    assert!(!points.is_empty() && points.len() <= goal.most.max(1), "{}", what());
    assert_eq!(patch.normal, found.normal);
    let size = points.iter().map(|p| (p.point_on_a - points[0].point_on_a).norm()).fold(0.0, f64::max);
    // Two edges that are parallel within the tilt have their points half way between them.
    // The normal of an overlap of curved shapes is less certain than the depth, and so is where they touch.
    let is_curved = pair.sides().iter().any(|(shape, ..)| is_curved(shape)) && found.signed_distance < 0.0;
    let beside =
        if patch.polygon().len() == 2 { 0.5 * goal.tilt * size } else { 0.0 } + if is_curved { 1e-4 } else { 0.0 };
    let certain = 1e-12 + found.bracket.width();
    for p in points {
        let is_witness = p.point_on_a == found.point_on_a;
        // Of an overlap that does not tell where it is nothing but the corners is told.
        let is_near = found.point_error < 1e-3;
        let tolerance = certain + if is_witness && is_near { found.point_error } else { 0.0 };
        for ((shape, at, side), point) in pair.sides().into_iter().zip([p.point_on_a, p.point_on_b]) {
            if is_wall(shape) {
                continue;
            }
            let out =
                directions.iter().map(|d| point.dot(d) - greatest(shape, at, *d)).fold(f64::NEG_INFINITY, f64::max);
            assert!(out < tolerance + beside, "out by {out}\n{}", what());
            let up = patch.normal * side;
            let below = greatest(shape, at, up) - point.dot(&up);
            assert!(below < tolerance + libm::tan(goal.tilt) * 1.5, "below the support plane by {below}\n{}", what());
        }
    }
    let deepest = points.iter().map(|p| p.signed_distance).fold(f64::INFINITY, f64::min);
    assert!(
        deepest
            <= found.signed_distance + certain + 1e-8 + if found.point_error < 1e-6 { 0.0 } else { 1.5 * goal.tilt },
        "{}",
        what()
    );
    if pair.sides().iter().all(|(shape, ..)| !is_wall(shape)) {
        let [a, b] = pair.sides().map(|(shape, at, side)| greatest(shape, at, patch.normal * side));
        assert!(deepest >= -a - b - certain, "{}", what());
    }
    let polygon = patch.polygon();
    assert!(
        polygon[0].signed_distance <= polygon.iter().map(|p| p.signed_distance).fold(f64::INFINITY, f64::min) + 1e-8
    );
    for i in 0..polygon.len() {
        let [p, q, r] = [0, 1, 2].map(|k| polygon[(i + k) % polygon.len()].point_on_a);
        assert!((q - p).cross(&(r - q)).dot(&patch.normal) > -1e-14 || polygon.len() < 3, "not convex: {}", what());
    }
}

/// Whether for each point of the one there is one of the other, and as many.
fn are_same(one: &[ContactPoint], other: &[ContactPoint], tolerance: f64) -> bool {
    let near = |p: &ContactPoint, q: &ContactPoint| {
        (p.point_on_a - q.point_on_a).norm() + (p.point_on_b - q.point_on_b).norm() < tolerance
            && (p.signed_distance - q.signed_distance).abs() < tolerance
    };
    one.len() == other.len() && one.iter().all(|p| other.iter().any(|q| near(p, q)))
}

fn for_random_pairs(seed: u64, rounds: usize, mut visit: impl FnMut(&mut Random, &Pair)) {
    let mut random = Random::new(seed);
    let shapes = shapes();
    for a in &shapes {
        for b in &shapes {
            if is_wall(a) && is_wall(b) {
                continue;
            }
            for _ in 0..rounds {
                if let Some(pair) = Pair::random(&mut random, a, b) {
                    visit(&mut random, &pair);
                }
            }
        }
    }
}

#[test]
fn points_are_on_both_shapes_and_all_regimes_are_met() {
    let mut random = Random::new(1);
    let directions: Vec<Vec3> = (0..200).map(|_| random.direction()).collect();
    let (mut points, mut lines, mut polygons, mut with_witness, mut truncated, mut apart, mut deep) =
        (0, 0, 0, 0, 0, 0, 0);
    let mut kinds = std::collections::BTreeMap::<(&str, &str), usize>::new();
    for_random_pairs(41, 12, |random, pair| {
        let most = if random.one_in(4) { 1 + random.index(6) } else { usize::MAX };
        let goal = PatchGoal { tilt: [PATCH_TILT, 0.1, 1e-6][random.index(3)], most, ..PatchGoal::default() };
        let patch = pair.patch(&goal);
        check(pair, &patch, &goal, &directions);
        match patch.polygon().len() {
            1 => points += 1,
            2 => lines += 1,
            _ => {
                polygons += 1;
                *kinds.entry((pair.a.kind(), pair.b.kind())).or_default() += 1;
            }
        }
        with_witness += usize::from(patch.points().len() > patch.polygon().len());
        truncated += usize::from(patch.truncated);
        apart += usize::from(pair.found.bracket.lower > 0.0);
        deep += usize::from(pair.found.signed_distance < -0.05);
    });
    println!(
        "{points} points, {lines} lines, {polygons} polygons, {with_witness} with a witness, {truncated} truncated, {apart} apart, {deep} deep"
    );
    assert!(points > 500 && lines > 300 && polygons > 200, "{points} points, {lines} lines, {polygons} polygons");
    assert!(with_witness > 10 && truncated > 50, "{with_witness} with a witness, {truncated} truncated");
    assert!(apart > 500 && deep > 300, "{apart} apart, {deep} deep");
    assert!(kinds.len() > 40, "polygons of only {kinds:?}");
}

/// The support point along a direction, by the formula of each kind that has corners.
fn support_corner(shape: &Shape, at: &Placement, direction: Vec3) -> Option<Vec3> {
    let d = at.direction_into(direction);
    let farthest = |points: &[Vec3]| points.iter().copied().max_by(|p, q| p.dot(&d).total_cmp(&q.dot(&d)));
    let core = shape.core();
    let point = if let Core::Cuboid { half_extents: h } = core {
        Vec3::new(h.x.copysign(d.x), h.y.copysign(d.y), h.z.copysign(d.z))
    } else if let Core::Convex(hull) = core {
        farthest(hull.points())?
    } else if let Core::Triangle(corners) = core {
        farthest(corners)?
    } else if let Core::Segment(ends) = core {
        farthest(ends)?
    } else if let Core::AxialSegment { half_length } = core {
        Vec3::new(0.0, 0.0, half_length.copysign(d.z))
    } else {
        return None;
    };
    Some(at.point(point))
}

/// How far within the hull of some places of a plane another is; negative: outside. By trying every line through two of them.
fn depth_in(places: &[[f64; 2]], p: [f64; 2]) -> f64 {
    let mut depth = f64::INFINITY;
    for a in places {
        for b in places {
            let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
            let length = libm::hypot(dx, dy);
            let beside = |q: &[f64; 2]| (dx * (q[1] - a[1]) - dy * (q[0] - a[0])) / length;
            if length > 1e-9 && places.iter().all(|q| beside(q) > -1e-9) {
                depth = depth.min(beside(&p));
            }
        }
    }
    depth
}

fn distinct(places: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    let mut kept: Vec<[f64; 2]> = Vec::new();
    for p in places {
        if kept.iter().all(|q| libm::hypot(p[0] - q[0], p[1] - q[1]) > 1e-7) {
            kept.push(p);
        }
    }
    kept
}

/// What both shapes reach in directions well within the tilt is in the patch, to a hundredth of it.
#[test]
fn patches_miss_nothing_that_faces_the_other_shape() {
    let mut held = 0;
    let goal = PatchGoal::default();
    for_random_pairs(43, 10, |random, pair| {
        let patch = pair.patch(&goal);
        if patch.truncated {
            return;
        }
        let n = patch.normal;
        let x = n.cross(&Vec3::ith(n.iamin(), 1.0)).normalize();
        let y = n.cross(&x);
        let flat = |p: Vec3| [p.dot(&x), p.dot(&y)];
        let faces = pair.sides().map(|(shape, at, side)| -> Option<Vec<[f64; 2]>> {
            let directions = (0..65).map(|k| {
                let (sin, cos) = libm::sincos(TAU * f64::from(k) / 64.0);
                let tilt = if k == 64 { 0.0 } else { 0.98 * libm::tan(PATCH_TILT) };
                n * side + (x * cos + y * sin) * tilt
            });
            directions.map(|d| support_corner(shape, at, d).map(flat)).collect()
        });
        let [Some(face_a), Some(face_b)] = faces.map(|face| face.map(distinct)) else { return };
        let polygon: Vec<[f64; 2]> = patch.points().iter().map(|p| flat(p.point_on_a)).collect();
        let size = polygon.iter().map(|p| libm::hypot(p[0] - polygon[0][0], p[1] - polygon[0][1])).fold(0.0, f64::max);
        for _ in 0..60 {
            // A random mixture of the corners of A's face.
            let mut weights: Vec<f64> = face_a.iter().map(|_| random.between(0.0, 1.0)).collect();
            weights.iter_mut().for_each(|w| *w = w.powi(8));
            let total: f64 = weights.iter().sum();
            let mix = |axis: usize| face_a.iter().zip(&weights).map(|(p, w)| p[axis] * w).sum::<f64>() / total;
            let place = [mix(0), mix(1)];
            if face_a.len() < 3
                || face_b.len() < 3
                || depth_in(&face_b, place) < 1e-3
                || depth_in(&face_a, place) < 1e-3
            {
                continue;
            }
            held += 1;
            let out = -depth_in(&polygon, place);
            assert!(out < 0.01 * size + 1e-9, "{place:?} is out by {out}\n{}", pair.what(&patch));
        }
    });
    assert!(held > 2000, "only {held} places in both");
}

#[test]
fn swapped_sides_have_the_same_points_and_the_opposite_normal() {
    let mut polygons = 0;
    for_random_pairs(45, 8, |random, pair| {
        let most = if random.one_in(3) { 4 } else { usize::MAX };
        let cut_off =
            if random.one_in(3) { pair.found.signed_distance + random.between(0.0, 0.02) } else { f64::INFINITY };
        let goal = PatchGoal { most, cut_off, ..PatchGoal::default() };
        let patch = pair.patch(&goal);
        let found = Separation {
            normal: -pair.found.normal,
            point_on_a: pair.found.point_on_b,
            point_on_b: pair.found.point_on_a,
            ..pair.found
        };
        let swapped = contact_patch(&pair.b, &pair.a, &pair.at_b, &pair.at_a, &found, &goal).unwrap();
        let mirrored: Vec<ContactPoint> = swapped
            .points()
            .iter()
            .map(|p| ContactPoint {
                point_on_a: p.point_on_b,
                point_on_b: p.point_on_a,
                signed_distance: p.signed_distance,
            })
            .collect();
        assert!(are_same(patch.points(), &mirrored, 1e-7), "{}\n{swapped:#?}", pair.what(&patch));
        assert_eq!((swapped.normal, swapped.truncated), (-patch.normal, patch.truncated));
        assert!((patch.area() - swapped.area()).abs() < 1e-7);
        polygons += usize::from(patch.polygon().len() > 2);
    });
    assert!(polygons > 100, "{polygons} polygons");
}

#[test]
fn a_common_motion_moves_the_patch() {
    let mut polygons = 0;
    for_random_pairs(47, 8, |random, pair| {
        let goal = PatchGoal::default();
        let patch = pair.patch(&goal);
        let motion = random.pose(0.5);
        let moved = motion.placement();
        let [at_a, at_b] = [&pair.pose_a, &pair.pose_b].map(|pose| motion.compose(pose).placement());
        let found = Separation {
            normal: moved.direction(pair.found.normal),
            point_on_a: moved.point(pair.found.point_on_a),
            point_on_b: moved.point(pair.found.point_on_b),
            ..pair.found
        };
        let elsewhere = contact_patch(&pair.a, &pair.b, &at_a, &at_b, &found, &goal).unwrap();
        let expected: Vec<ContactPoint> = patch
            .points()
            .iter()
            .map(|p| ContactPoint {
                point_on_a: moved.point(p.point_on_a),
                point_on_b: moved.point(p.point_on_b),
                signed_distance: p.signed_distance,
            })
            .collect();
        // Which of many corners are left out is a matter of rounding where they are alike.
        let as_large = (elsewhere.area() - patch.area()).abs() < 1e-3;
        let same = (patch.truncated && as_large) || are_same(elsewhere.points(), &expected, 1e-7);
        assert!(same, "{}\n{elsewhere:#?}", pair.what(&patch));
        assert_eq!(elsewhere.truncated, patch.truncated);
        polygons += usize::from(patch.polygon().len() > 2);
    });
    assert!(polygons > 100, "{polygons} polygons");
}

/// Of sizes from 1e-90 to 1e90 m: the same numbers times a power of two.
#[test]
fn a_power_of_two_scales_a_patch() {
    for_random_pairs(49, 1, |random, pair| {
        let factor = libm::exp2(random.between(-300.0, 300.0).floor());
        let (Ok(a), Ok(b)) = (pair.a.scaled(factor), pair.b.scaled(factor)) else { return };
        let [at_a, at_b] = [&pair.pose_a, &pair.pose_b]
            .map(|pose| Pose::new(pose.translation() * factor, pose.rotation()).unwrap().placement());
        let patch = pair.patch(&PatchGoal::default());
        let found = separation(&a, &b, &at_a, &at_b, &Goal::penetration()).unwrap();
        if (found.normal - pair.found.normal).norm() > 1e-13 {
            return;
        }
        let scaled = contact_patch(&a, &b, &at_a, &at_b, &found, &PatchGoal::default()).unwrap();
        let back: Vec<ContactPoint> = scaled
            .points()
            .iter()
            .map(|p| ContactPoint {
                point_on_a: p.point_on_a / factor,
                point_on_b: p.point_on_b / factor,
                signed_distance: p.signed_distance / factor,
            })
            .collect();
        assert!(are_same(patch.points(), &back, 1e-9), "{factor}\n{}\n{back:#?}", pair.what(&patch));
    });
}
