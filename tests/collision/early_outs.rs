//! Questions that are answered before the distance is known.

use std::sync::Arc;

use clearance::geometry::{Pose, Shape, TriangleMesh, Vec3};
use clearance::narrow_phase::{Depth, Goal, separation};

use crate::samples::{Random, at};

/// Oracle: the depth that is built in: both hold the ball of that radius around the middle of the line of centres.
#[test]
fn a_deep_overlap_is_told_from_one_look_along_the_line_of_centers() {
    let mut random = Random::new(99);
    let round_hull = |random: &mut Random| {
        let points: Vec<Vec3> = (0..60).map(|_| random.direction()).collect();
        Shape::convex(&points).unwrap()
    };
    let shapes = [
        Shape::ellipsoid(Vec3::new(0.8, 1.0, 1.2)).unwrap(),
        Shape::cylinder(1.0, 1.0).unwrap(),
        Shape::cone(1.5, 1.5).unwrap(),
        round_hull(&mut random),
    ];
    for a in &shapes {
        for b in &shapes {
            for _ in 0..20 {
                let (at_a, t) = (random.pose(1.0).placement(), random.direction() * 0.5);
                let at_b = Pose::new(at_a.translation + t, random.pose(1.0).rotation()).unwrap().placement();
                for depth in [Depth::Verdict, Depth::Distance] {
                    let found = separation(a, b, &at_a, &at_b, &Goal { depth, ..Goal::penetration() }).unwrap();
                    assert!(
                        found.bracket.upper < 0.0 && found.cost.supports == 1,
                        "{}, {}: {found:?}",
                        a.kind(),
                        b.kind()
                    );
                    let deeper = separation(a, b, &at_a, &at_b, &Goal::penetration()).unwrap();
                    assert!(deeper.bracket.lower <= found.bracket.upper, "{found:?} {deeper:?}");
                }
            }
        }
    }
}

/// Oracle: the distance by hand. A vertex that no triangle uses, here next to the other body, is not a point of the mesh.
#[test]
fn a_vertex_without_a_triangle_is_no_witness() {
    let vertices = vec![Vec3::new(2.9, 0.0, 0.0), Vec3::zeros(), Vec3::y(), Vec3::z()];
    let mesh = Shape::mesh(Arc::new(TriangleMesh::surface(vertices, vec![[1, 2, 3]]).unwrap()));
    let sphere = Shape::sphere(1.0).unwrap();
    for (a, b, at_a, at_b) in [(&mesh, &sphere, 0.0, 4.0), (&sphere, &mesh, 4.0, 0.0)] {
        let found = separation(a, b, &at(at_a, 0.0, 0.0), &at(at_b, 0.0, 0.0), &Goal::verdict()).unwrap();
        assert!(found.bracket.lower > 0.0 && found.bracket.lower <= 3.0 && found.bracket.upper >= 3.0, "{found:?}");
    }
}
