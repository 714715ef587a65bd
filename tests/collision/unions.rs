//! Meshes, solids and compounds against slower ways to the same answer.

use std::sync::Arc;

use clearance::geometry::{Compound, Part, Pose, Quaternion, Shape, TriangleMesh, Vec3};
use clearance::narrow_phase::{Depth, Goal, separation};

use crate::samples::{Random, at, convex_shapes};

/// A closed surface: a cube whose faces are cut into `2 n^2` triangles, pushed out to half-way between cube and ball.
fn rounded_cube(n: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for face in 0..6 {
        let axis = face / 2;
        let sign = if face % 2 == 0 { 1.0 } else { -1.0 };
        let start = vertices.len() as u32;
        for i in 0..=n {
            for j in 0..=n {
                let mut p = Vec3::zeros();
                p[axis] = sign;
                p[(axis + 1) % 3] = sign * ((2.0 * f64::from(i) - f64::from(n)) / f64::from(n));
                p[(axis + 2) % 3] = (2.0 * f64::from(j) - f64::from(n)) / f64::from(n);
                vertices.push(p * (0.5 * (0.5 + 0.5 / p.norm())));
            }
        }
        for i in 0..n {
            for j in 0..n {
                let corner = |di: u32, dj: u32| start + (i + di) * (n + 1) + j + dj;
                triangles.push([corner(0, 0), corner(1, 0), corner(1, 1)]);
                triangles.push([corner(0, 0), corner(1, 1), corner(0, 1)]);
            }
        }
    }
    (vertices, triangles)
}

fn surface() -> Shape {
    let (vertices, triangles) = rounded_cube(4);
    Shape::mesh(Arc::new(TriangleMesh::surface(vertices, triangles).unwrap()))
}

fn solid() -> Shape {
    let (vertices, triangles) = rounded_cube(4);
    Shape::mesh(Arc::new(TriangleMesh::solid(vertices, triangles).unwrap()))
}

/// Oracle: every triangle as a shape of its own, one after the other.
#[test]
fn a_mesh_is_as_far_as_its_nearest_triangle() {
    let mesh = surface();
    let (vertices, triangles) = rounded_cube(4);
    let mut random = Random::new(21);
    let (mut apart, mut crossing) = (0, 0);
    for other in convex_shapes() {
        for _ in 0..4 {
            let (at_mesh, at_other) = (random.pose(0.8).placement(), random.pose(0.8).placement());
            let found = separation(&mesh, &other, &at_mesh, &at_other, &Goal::penetration()).unwrap();
            let one_by_one = triangles.iter().map(|t| {
                let [a, b, c] = t.map(|i| vertices[i as usize]);
                let triangle = Shape::triangle(a, b, c).unwrap();
                separation(&triangle, &other, &at_mesh, &at_other, &Goal::penetration()).unwrap()
            });
            let least = one_by_one.map(|s| s.signed_distance).fold(f64::INFINITY, f64::min);
            assert!((found.signed_distance - least).abs() < 1e-9, "{}: {found:?}, {least}", other.kind());
            assert!(found.bracket.lower <= least + 1e-12 && least - 1e-12 <= found.bracket.upper);
            if least > 0.0 {
                apart += 1
            } else {
                crossing += 1
            }
            // Stopping at the first contact leaves a bracket that still holds the deepest.
            for goal in [Goal::verdict(), Goal { depth: Depth::Distance, ..Goal::penetration() }] {
                let early = separation(&mesh, &other, &at_mesh, &at_other, &goal).unwrap();
                assert!(early.bracket.lower <= least + 1e-12, "{}: {early:?}, {least}", other.kind());
                assert_eq!(early.bracket.upper <= 0.0, found.bracket.upper <= 0.0);
            }
        }
    }
    assert!(apart > 10 && crossing > 10, "{apart} apart, {crossing} crossing");
}

#[test]
fn two_nearly_convex_meshes_are_hardly_farther_than_their_hulls() {
    let (vertices, _) = rounded_cube(4);
    let hull = Shape::convex(&vertices).unwrap();
    let mesh = surface();
    let mut random = Random::new(22);
    let mut apart = 0;
    for _ in 0..20 {
        let (one, other) = (random.pose(1.2).placement(), random.pose(1.2).placement());
        let hulls = separation(&hull, &hull, &one, &other, &Goal::penetration()).unwrap();
        let meshes = separation(&mesh, &mesh, &one, &other, &Goal::penetration()).unwrap();
        if hulls.signed_distance > 0.0 {
            apart += 1;
            // The quads of the mesh are not quite flat, so the hull covers it with up to this much to spare.
            let spare = meshes.signed_distance - hulls.signed_distance;
            assert!((-1e-9..0.01).contains(&spare), "{hulls:?}\n{meshes:?}");
        } else {
            assert!(meshes.bracket.upper <= 0.0, "convex surfaces that overlap without nesting cross: {meshes:?}");
        }
    }
    assert!(apart >= 5, "{apart} apart");
}

#[test]
fn only_a_solid_mesh_collides_with_what_is_inside_it() {
    let ball = Shape::sphere(0.1).unwrap();
    let (center, here) = (at(0.05, 0.0, 0.0), at(0.0, 0.0, 0.0));
    for goal in [Goal::penetration(), Goal::verdict(), Goal { depth: Depth::Distance, ..Goal::penetration() }] {
        let hollow = separation(&surface(), &ball, &here, &center, &goal).unwrap();
        assert!(hollow.bracket.lower > 0.0, "{hollow:?}");
        for (a, b, at_a, at_b) in [(&solid(), &ball, &here, &center), (&ball, &solid(), &center, &here)] {
            let full = separation(a, b, at_a, at_b, &goal).unwrap();
            assert!(full.bracket.upper <= 0.0, "{full:?}");
            assert!(full.bracket.lower <= full.signed_distance && full.signed_distance <= full.bracket.upper);
        }
    }
    let outside = separation(&solid(), &ball, &here, &at(2.0, 0.0, 0.0), &Goal::penetration()).unwrap();
    assert!(outside.bracket.lower > 0.0);
    let nested = separation(&solid(), &solid().scaled(0.25).unwrap(), &here, &center, &Goal::verdict()).unwrap();
    assert!(nested.bracket.upper <= 0.0, "a mesh inside a solid one: {nested:?}");
}

#[test]
fn every_part_of_a_mesh_is_looked_for_inside_a_solid_one() {
    let corner = |x: f64, y: f64| Vec3::new(x, y, 0.0);
    let far = [corner(5.0, 0.0), corner(6.0, 0.0), corner(5.0, 1.0)];
    let inside = far.map(|v| v * 0.01);
    let both = TriangleMesh::surface([far, inside].concat(), vec![[0, 1, 2], [3, 4, 5]]).unwrap();
    let here = at(0.0, 0.0, 0.0);
    let found = separation(&solid(), &Shape::mesh(Arc::new(both)), &here, &here, &Goal::verdict()).unwrap();
    assert!(found.bracket.upper <= 0.0, "{found:?}");
}

#[test]
fn a_compound_is_as_far_as_its_nearest_part_and_names_it() {
    let poses: Vec<Pose> =
        (0..4).map(|i| Pose::new(Vec3::new(f64::from(i), 0.0, 0.0), Quaternion::IDENTITY).unwrap()).collect();
    let parts = poses.iter().map(|pose| Part { shape: Shape::sphere(0.2).unwrap(), pose: *pose }).collect();
    let row = Shape::compound(Arc::new(Compound::new(parts).unwrap()));
    let ball = Shape::sphere(0.1).unwrap();
    let found = separation(&row, &ball, &at(0.0, 5.0, 0.0), &at(2.1, 5.0, 1.0), &Goal::penetration()).unwrap();
    let expected = 1.01f64.sqrt() - 0.3;
    assert!((found.signed_distance - expected).abs() < 1e-12, "{found:?}");
    assert_eq!((found.subshape_a, found.subshape_b), (2, 0));
    let mixed = Part { shape: surface(), pose: poses[3] };
    let row = Compound::new(vec![Part { shape: ball.clone(), pose: poses[0] }, mixed]).unwrap();
    let found = separation(
        &ball,
        &Shape::compound(Arc::new(row)),
        &at(3.0, 0.0, 2.0),
        &at(0.0, 0.0, 0.0),
        &Goal::penetration(),
    );
    assert!((found.unwrap().signed_distance - (2.0 - 0.1 - 0.5)).abs() < 1e-9);
}

#[test]
fn a_compound_with_a_half_space_nearby_is_measured_part_by_part() {
    let floor = Shape::half_space(Vec3::z(), 0.0).unwrap();
    let high = Pose::new(Vec3::new(0.0, 0.0, 1.0), Quaternion::IDENTITY).unwrap();
    let low = Pose::new(Vec3::new(0.0, 0.0, 0.25), Quaternion::IDENTITY).unwrap();
    let part = |pose| Part { shape: Shape::sphere(0.5).unwrap(), pose };
    let pair = Shape::compound(Arc::new(Compound::new(vec![part(high), part(low)]).unwrap()));
    let found = separation(&floor, &pair, &at(0.0, 0.0, 0.0), &at(0.0, 0.0, 0.0), &Goal::penetration()).unwrap();
    assert!((found.signed_distance + 0.25).abs() < 1e-12 && found.subshape_b == 1, "{found:?}");
}

#[test]
fn a_part_inside_a_solid_counts_though_another_part_touches_its_surface() {
    let part = |shape: Shape, x: f64| Part { shape, pose: Pose::new(Vec3::x() * x, Quaternion::IDENTITY).unwrap() };
    let cube = TriangleMesh::solid(rounded_cube(1).0, rounded_cube(1).1).unwrap();
    let reach = cube.bounds().max.x;
    let touching = Shape::cuboid(Vec3::new(0.5, 0.01, 0.01)).unwrap();
    let row = Compound::new(vec![part(Shape::sphere(0.05).unwrap(), 0.0), part(touching, reach + 0.5)]).unwrap();
    let (row, cube) = (Shape::compound(Arc::new(row)), Shape::mesh(Arc::new(cube)));
    let here = at(0.0, 0.0, 0.0);
    let found = separation(&row, &cube, &here, &here, &Goal::penetration()).unwrap();
    assert!(found.bracket.upper < -0.1 && found.subshape_a == 0, "{found:?}");
}

#[test]
fn huge_solids_hold_what_is_inside_them() {
    let (vertices, triangles) = rounded_cube(4);
    let vertices = vertices.into_iter().map(|v| v * 1e104).collect();
    let cube = Shape::mesh(Arc::new(TriangleMesh::solid(vertices, triangles).unwrap()));
    let here = at(0.0, 0.0, 0.0);
    let found = separation(&cube, &Shape::sphere(1.0).unwrap(), &here, &here, &Goal::verdict()).unwrap();
    assert!(found.bracket.upper <= 0.0, "{found:?}");
}

/// Oracle: the lowest vertex.
#[test]
fn a_mesh_over_a_half_space_is_as_high_as_its_lowest_vertex_and_boxes_prune_the_rest() {
    let (vertices, triangles) = rounded_cube(4);
    let floor = Shape::half_space(Vec3::new(0.3, -0.2, 2.0), 0.4).unwrap();
    let wall = Shape::plane(Vec3::new(0.3, -0.2, 2.0), 0.4).unwrap();
    let normal = Vec3::new(0.3, -0.2, 2.0);
    let mut random = Random::new(23);
    for _ in 0..20 {
        let place = random.pose(2.0).placement();
        let height = |v: &Vec3| (normal.dot(&place.point(*v)) - 0.4) / normal.norm();
        let lowest = vertices.iter().map(height).fold(f64::INFINITY, f64::min);
        let found = separation(&surface(), &floor, &place, &at(0.0, 0.0, 0.0), &Goal::penetration()).unwrap();
        assert!((found.signed_distance - lowest).abs() < 1e-12, "{found:?}, {lowest}");
        assert!((found.cost.pairs as usize) < triangles.len() / 2, "{found:?}");
        let verdict = separation(&floor, &surface(), &at(0.0, 0.0, 0.0), &place, &Goal::verdict()).unwrap();
        assert_eq!(verdict.bracket.upper <= 0.0, lowest <= 0.0);
        assert!(verdict.bracket.lower <= lowest && lowest <= verdict.bracket.upper + 1e-12, "{verdict:?}, {lowest}");
        let thin = separation(&surface(), &wall, &place, &at(0.0, 0.0, 0.0), &Goal::penetration()).unwrap();
        assert!(thin.bracket.width() < 1e-9 && thin.bracket.lower.is_finite(), "{thin:?}");
    }
}
