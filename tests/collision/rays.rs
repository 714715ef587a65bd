//! Rays: what is called a miss is one, and a hit is where it is said to be.
//!
//! Oracles: closed forms; for every kind of shape the distance of points of the ray, by [`crate::oracle`] in double-doubles. A ray is apart
//! from the shape at points before its bracket and after a miss, and on the shape somewhere in the bracket. Points are trusted to what
//! doubles leave of them, `tolerance`. For meshes: each triangle alone, as a shape of its own.

use std::collections::BTreeMap;
use std::sync::Arc;

use clearance::geometry::{Compound, Part, Placement, Pose, Quaternion, Ray, Shape, TriangleMesh, Vec3};
use clearance::narrow_phase::{Outcome, RayGoal, RayImpact, cast_ray};

use crate::oracle::truth;
use crate::random_pairs::{KINDS, random_pair};
use crate::samples::Random;
use crate::specimen::Form;

fn ray(origin: [f64; 3], direction: [f64; 3], length: f64) -> Ray {
    Ray::new(Vec3::from(origin), Vec3::from(direction), length).unwrap()
}

fn cast(ray: &Ray, shape: &Shape) -> RayImpact {
    cast_ray(ray, shape, &Placement::identity(), &RayGoal::whole()).unwrap()
}

/// Holds a hit against its distance and normal by a formula.
fn hits_at(ray: &Ray, shape: &Shape, expected: f64, normal: [f64; 3]) -> RayImpact {
    let found = cast(ray, shape);
    let width = 1e-11 * (1.0 + expected);
    assert_eq!(found.outcome, Outcome::Hit, "{found:?}");
    assert!(
        found.bracket.lower <= expected + 1e-15 && expected <= found.bracket.upper + 1e-15,
        "{expected}: {found:?}"
    );
    assert!(found.bracket.width() < width, "{found:?}");
    assert!((found.normal - Vec3::from(normal)).norm() < 1e-6, "{found:?}");
    assert!((found.point - ray.point(expected)).norm() < width);
    assert!(!found.starts_inside);
    found
}

/// A cube of half side 1 with its faces cut along diagonals.
fn cube_of_triangles() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let sign = |bit: usize| if bit == 0 { -1.0 } else { 1.0 };
    let corners: Vec<Vec3> = (0..8).map(|i| Vec3::new(sign(i & 1), sign(i & 2), sign(i & 4))).collect();
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let faces = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    (corners, faces)
}

#[test]
fn every_kind_is_hit_where_the_formula_says() {
    let v = Vec3::new;
    let down = |x: f64, y: f64| ray([x, y, 5.0], [0.0, 0.0, -3.0], 100.0);
    let up = [0.0, 0.0, 1.0];
    hits_at(&down(0.0, 0.0), &Shape::sphere(1.0).unwrap(), 4.0, up);
    hits_at(&down(0.6, 0.0), &Shape::sphere(1.0).unwrap(), 4.2, [0.6, 0.0, 0.8]);
    hits_at(&down(0.2, 0.3), &Shape::cuboid(v(0.5, 0.6, 0.25)).unwrap(), 4.75, up);
    hits_at(&down(0.2, 0.3), &Shape::cuboid(v(0.5, 0.6, 0.0)).unwrap(), 5.0, up);
    hits_at(&down(0.2, 0.3), &Shape::cuboid(v(0.5, 0.6, 0.25)).unwrap().swept(0.125).unwrap(), 4.625, up);
    hits_at(&down(0.0, 0.0), &Shape::capsule(0.25, 1.0).unwrap(), 3.75, up);
    hits_at(&down(0.1, 0.1), &Shape::cylinder(0.25, 1.0).unwrap(), 4.0, up);
    // From the rim of radius 0.5 at -0.5 to the apex at 0.5: half way up at 0.25, and as steep as 2.
    hits_at(&down(0.25, 0.0), &Shape::cone(0.5, 0.5).unwrap(), 5.0, [0.8_f64.sqrt(), 0.0, 0.2_f64.sqrt()]);
    hits_at(&down(0.0, 0.0), &Shape::ellipsoid(v(1.0, 2.0, 0.5)).unwrap(), 4.5, up);
    let tent = [v(-1.0, -1.0, 0.0), v(1.0, -1.0, 0.0), v(1.0, 1.0, 0.0), v(-1.0, 1.0, 0.0), v(0.0, 0.0, 0.5)];
    hits_at(&down(0.0, -0.5), &Shape::convex(&tent).unwrap(), 4.75, [0.0, -0.2_f64.sqrt(), 0.8_f64.sqrt()]);
    hits_at(&down(0.3, 0.1), &Shape::triangle(tent[0], tent[1], tent[2]).unwrap(), 5.0, up);
    hits_at(&down(0.2, 0.1), &Shape::half_space(v(0.0, 0.0, 2.0), 1.0).unwrap(), 4.5, up);
    hits_at(&down(0.2, 0.1), &Shape::plane(v(0.0, 0.0, -2.0), 1.0).unwrap(), 5.5, up);
    hits_at(&ray([0.0, 0.0, -2.0], up, 9.0), &Shape::plane(Vec3::z(), 0.0).unwrap(), 2.0, [0.0, 0.0, -1.0]);
    hits_at(
        &down(0.0, 0.0),
        &Shape::segment(v(-1.0, 0.0, 0.0), v(1.0, 0.0, 0.0)).unwrap().swept(0.5).unwrap(),
        4.5,
        up,
    );
    hits_at(&down(0.0, 0.0), &Shape::point().swept(0.5).unwrap(), 4.5, up);
}

#[test]
fn the_middle_of_a_face_that_is_cut_along_its_diagonal_is_hit_and_so_is_a_corner_of_many_triangles() {
    let (corners, faces) = cube_of_triangles();
    for mesh in [TriangleMesh::surface(corners.clone(), faces.clone()), TriangleMesh::solid(corners, faces)] {
        let shape = Shape::mesh(Arc::new(mesh.unwrap()));
        // Both faces in the way are crossed on their diagonals.
        hits_at(&ray([0.0, 0.0, 5.0], [0.0, 0.0, -1.0], 100.0), &shape, 4.0, [0.0, 0.0, 1.0]);
        hits_at(&ray([0.25, 0.25, 5.0], [0.0, 0.0, -1.0], 100.0), &shape, 4.0, [0.0, 0.0, 1.0]);
        let found = cast(&ray([1.0, 0.3, 5.0], [0.0, 0.0, -1.0], 100.0), &shape);
        assert_eq!(found.outcome, Outcome::Undecided, "along a side: {found:?}");
    }
    // A fan of six around the origin.
    let ring = |i: u32| {
        let (sin, cos) = libm::sincos(f64::from(i) * std::f64::consts::FRAC_PI_3);
        Vec3::new(cos, sin, -0.2)
    };
    let vertices = std::iter::once(Vec3::zeros()).chain((0..6).map(ring)).collect();
    let fan = TriangleMesh::surface(vertices, (0..6).map(|i| [0, 1 + i, 1 + (i + 1) % 6]).collect()).unwrap();
    let found = cast(&ray([0.0, 0.0, 2.0], [0.0, 0.0, -1.0], 9.0), &Shape::mesh(Arc::new(fan.clone())));
    assert_eq!(found.outcome, Outcome::Hit, "{found:?}");
    assert!(found.bracket.lower <= 2.0 && 2.0 <= found.bracket.upper && found.bracket.width() < 1e-9, "{found:?}");
    // Without one of them the corner is a corner of the border, and nothing is proved.
    let torn = TriangleMesh::surface(fan.vertices().to_vec(), fan.triangles()[1..].to_vec()).unwrap();
    let found = cast(&ray([0.0, 0.0, 2.0], [0.0, 0.0, -1.0], 9.0), &Shape::mesh(Arc::new(torn)));
    assert_eq!(found.outcome, Outcome::Undecided, "{found:?}");
}

#[test]
fn a_ray_that_starts_inside_is_hit_at_once_and_one_in_a_surface_goes_on() {
    let inside = |shape: &Shape| cast(&ray([0.1, 0.2, 0.05], [1.0, 0.0, 0.0], 100.0), shape);
    let (corners, faces) = cube_of_triangles();
    let solid = Shape::mesh(Arc::new(TriangleMesh::solid(corners.clone(), faces.clone()).unwrap()));
    let surface = Shape::mesh(Arc::new(TriangleMesh::surface(corners, faces).unwrap()));
    let ball =
        Arc::new(Compound::new(vec![Part { shape: Shape::sphere(1.0).unwrap(), pose: Pose::identity() }]).unwrap());
    for shape in [
        Shape::sphere(1.0).unwrap(),
        Shape::cuboid(Vec3::repeat(1.0)).unwrap(),
        Shape::cylinder(1.0, 1.0).unwrap(),
        Shape::half_space(Vec3::z(), 1.0).unwrap(),
        Shape::compound(ball),
        solid,
    ] {
        let found = inside(&shape);
        assert!(found.starts_inside && found.outcome == Outcome::Hit, "{}: {found:?}", shape.kind());
        assert_eq!((found.bracket.lower, found.bracket.upper), (0.0, 0.0));
        assert_eq!(found.normal, -Vec3::x());
    }
    let through = inside(&surface);
    assert!(!through.starts_inside && (through.bracket.lower - 0.9).abs() < 1e-11, "{through:?}");
    // On the surface, exactly: what is closed holds it.
    let on = cast(&ray([1.0, 0.0, 0.0], [1.0, 0.0, 0.0], 9.0), &Shape::cuboid(Vec3::repeat(1.0)).unwrap());
    assert!(on.starts_inside, "{on:?}");
}

#[test]
fn a_margin_makes_the_ray_thick_and_a_limit_makes_it_short() {
    let ball = Shape::sphere(1.0).unwrap();
    let beside = ray([0.0, 1.25, 5.0], [0.0, 0.0, -1.0], 100.0);
    assert_eq!(cast(&beside, &ball).outcome, Outcome::Clear);
    let thick = cast_ray(&beside, &ball, &Placement::identity(), &RayGoal { margin: 0.5, ..RayGoal::whole() }).unwrap();
    let expected = 5.0 - (1.5_f64 * 1.5 - 1.25 * 1.25).sqrt();
    assert!(thick.bracket.lower <= expected && expected <= thick.bracket.upper, "{thick:?}");
    let short = cast(&ray([0.0, 0.0, 5.0], [0.0, 0.0, -1.0], 3.9), &ball);
    assert_eq!((short.outcome, short.bracket.lower), (Outcome::Clear, 3.9));
    let until = RayGoal { until: 3.0, ..RayGoal::whole() };
    let near = cast_ray(&ray([0.0, 0.0, 5.0], [0.0, 0.0, -1.0], 9.0), &ball, &Placement::identity(), &until).unwrap();
    assert_eq!((near.outcome, near.bracket.lower), (Outcome::Clear, 3.0));
    let grazing = cast(&ray([0.0, 1.0, 5.0], [0.0, 0.0, -1.0], 100.0), &ball);
    assert_eq!(grazing.outcome, Outcome::Undecided, "{grazing:?}");
    assert!(
        grazing.bracket.lower < 5.0 && grazing.bracket.upper > 5.0 && grazing.bracket.width() < 1e-5,
        "{grazing:?}"
    );
}

#[test]
fn random_rays_agree_with_the_distances_of_their_points() {
    let mut random = Random::new(5);
    let (mut kinds, mut regimes) = (BTreeMap::<&str, usize>::new(), BTreeMap::<&str, usize>::new());
    for round in 0..6000 {
        let target = random_pair(&mut random).b;
        let kind = target.shape.kind();
        let size = target.body.core.reach() + target.body.swept_radius.hi;
        let size = if size > 0.0 && size < 1e8 { size } else { 1.0 };
        let center = target.pose.translation();
        let spread = if random.one_in(3) { 1.1 } else { 0.5 };
        let aim = center + random.vector(spread) * size;
        let distance = size * random.magnitude(-1.0, 3.0);
        let origin = aim - random.direction() * distance;
        let Ok(ray) = Ray::new(origin, (aim - origin) * random.magnitude(-3.0, 3.0), distance + 3.0 * size) else {
            continue;
        };
        let margin = if random.one_in(4) { size * random.magnitude(-3.0, 0.0) } else { 0.0 };
        let found =
            cast_ray(&ray, &target.shape, &target.placement(), &RayGoal { margin, ..RayGoal::whole() }).unwrap();
        let what = format!("round {round}, {kind}: {found:?}\n{ray:?}, margin {margin}\n{target:?}");
        let from = Form::point().unwrap();
        let tolerance = 1e-13 * (size + distance + center.norm() + origin.norm()) + 1e-13 * margin;
        let at = |t: f64| {
            let p = ray.point(t);
            let there = from.clone().placed([p.x, p.y, p.z], [1.0, 0.0, 0.0, 0.0]).unwrap();
            truth(&there.body, &target.body, 1e-6 * tolerance, 60)
        };
        let free = found.bracket.lower;
        for share in [0.0, 0.3, 0.9, 1.0 - 1e-6, 1.0 - 1e-12, random.between(0.0, 1.0)] {
            assert!(free <= 0.0 || at(free * share).upper.hi >= margin - tolerance, "not free at {share}: {what}");
        }
        *kinds.entry(kind).or_default() += 1;
        let regime = match found.outcome {
            Outcome::Clear => "clear",
            Outcome::Undecided => "undecided",
            Outcome::Hit if found.starts_inside => "inside",
            Outcome::Hit => "hit",
        };
        *regimes.entry(regime).or_default() += 1;
        if found.outcome == Outcome::Hit {
            // Somewhere in the bracket it is within the margin; brackets are narrow, or end inside.
            let middle = free + 0.5 * found.bracket.width();
            let least = [found.bracket.upper, middle].map(|t| at(t).lower.hi).into_iter().fold(f64::INFINITY, f64::min);
            assert!(least <= margin + tolerance + found.bracket.width(), "not hit: {what}");
            assert!((found.normal.norm() - 1.0).abs() < 1e-9, "{what}");
            assert!(found.normal.dot(&ray.direction()) <= 1e-6, "{what}");
            if found.bracket.width() < 1e-9 * (size + distance) {
                *regimes.entry("narrow").or_default() += 1;
            }
        }
    }
    println!("{kinds:?}\n{regimes:?}");
    for kind in KINDS {
        assert!(kinds.get(kind).is_some_and(|n| *n > 100), "{kind}: {kinds:?}");
    }
    for (regime, least) in [("clear", 1000), ("hit", 1000), ("inside", 50), ("narrow", 1000)] {
        assert!(regimes.get(regime).is_some_and(|n| *n > least), "{regime}: {regimes:?}");
    }
}

/// Oracle: each triangle as a shape of its own, one after the other.
#[test]
fn a_mesh_is_hit_where_the_first_of_its_triangles_is() {
    let mut random = Random::new(8);
    let (n, size) = (24, 2.0);
    let step = size / f64::from(n);
    let height = |i: u32, j: u32| 0.2 * libm::sin(0.7 * f64::from(i)) * libm::cos(0.9 * f64::from(j));
    let vertex = |k: u32| {
        let (i, j) = (k / (n + 1), k % (n + 1));
        Vec3::new(f64::from(i) * step - 1.0, f64::from(j) * step - 1.0, height(i, j))
    };
    let vertices: Vec<Vec3> = (0..(n + 1) * (n + 1)).map(vertex).collect();
    let cell = |k: u32| {
        let corner = k / n * (n + 1) + k % n;
        let across = corner + n + 1;
        [[corner, across, corner + 1], [across, across + 1, corner + 1]]
    };
    let triangles: Vec<[u32; 3]> = (0..n * n).flat_map(cell).collect();
    let mesh = Arc::new(TriangleMesh::surface(vertices, triangles).unwrap());
    let shape = Shape::mesh(Arc::clone(&mesh));
    let alone: Vec<Shape> = (0..mesh.triangles().len())
        .map(|i| {
            let [a, b, c] = mesh.triangle(i);
            Shape::triangle(a, b, c).unwrap()
        })
        .collect();
    let (mut hits, mut misses, mut through_corners) = (0, 0, 0);
    for round in 0..400 {
        let at = random.pose(3.0).placement();
        let aim = if round % 4 == 0 {
            mesh.vertices()[random.index(mesh.vertices().len())]
        } else {
            random.vector(1.2).component_mul(&Vec3::new(1.0, 1.0, 0.3))
        };
        let origin = random.direction() * 4.0;
        let ray = Ray::new(at.point(origin), at.point(aim) - at.point(origin), 10.0).unwrap();
        let found = cast_ray(&ray, &shape, &at, &RayGoal::whole()).unwrap();
        let each: Vec<RayImpact> = alone.iter().map(|t| cast_ray(&ray, t, &at, &RayGoal::whole()).unwrap()).collect();
        let of = |outcome: Outcome| each.iter().filter(move |one| one.outcome == outcome);
        let sure = of(Outcome::Hit).map(|one| one.bracket.upper).fold(f64::INFINITY, f64::min);
        let may = each
            .iter()
            .filter(|one| one.outcome != Outcome::Clear)
            .map(|one| one.bracket.lower)
            .fold(f64::INFINITY, f64::min);
        match found.outcome {
            Outcome::Hit => {
                assert!((found.bracket.lower - may).abs() < 1e-6, "{found:?}, {may}");
                assert!(found.bracket.upper <= sure + 1e-6, "{found:?}, {sure}");
                if found.bracket.upper < sure - 1e-3 {
                    through_corners += 1;
                }
                let narrow = found.bracket.width() < 1e-6;
                assert!(!narrow || (found.point - ray.point(found.bracket.lower)).norm() < 1e-6);
                hits += 1;
            }
            Outcome::Clear => {
                assert!(may.is_infinite(), "{found:?}, {may}");
                misses += 1;
            }
            Outcome::Undecided => assert!(sure.is_infinite() && may.is_finite(), "{found:?}"),
        }
        // With a margin: as thick.
        let goal = RayGoal { margin: 0.01, ..RayGoal::whole() };
        let thick = cast_ray(&ray, &shape, &at, &goal).unwrap();
        assert!(
            thick.bracket.lower <= found.bracket.upper
                && (found.outcome != Outcome::Hit || thick.outcome == Outcome::Hit)
        );
    }
    assert!(
        hits > 200 && misses > 20 && through_corners > 20,
        "{hits} hits, {misses} misses, {through_corners} corners"
    );
}

#[test]
fn far_away_and_turned_rays_are_as_near_as_their_numbers_allow() {
    let ball = Shape::sphere(0.5).unwrap();
    let home = Vec3::new(1e8, -3e7, 2e7);
    let at = Pose::new(home, Quaternion { w: 0.3, x: 1.0, y: -2.0, z: 0.7 }).unwrap().placement();
    let near = Ray::new(home + Vec3::x() * 4.0, -Vec3::x(), 9.0).unwrap();
    let found = cast_ray(&near, &ball, &at, &RayGoal::whole()).unwrap();
    assert!(found.bracket.lower <= 3.5 && 3.5 <= found.bracket.upper && found.bracket.width() < 1e-12, "{found:?}");
    let whole = Ray::new(Vec3::zeros(), home, 1e152).unwrap();
    let found = cast_ray(&whole, &ball, &at, &RayGoal::whole()).unwrap();
    assert_eq!(found.outcome, Outcome::Hit, "{found:?}");
    assert!((found.bracket.lower - (home.norm() - 0.5)).abs() < 1e-4);
}
