//! Which pairs of several pieces have a second pair of pieces that is as near? Oracle: scenes laid out by hand, where it is plain which
//! pieces are nearest and whether the places are one; and of random pairs, every pair of pieces measured as shapes of their own.
#![cfg(feature = "effect-derivatives")]

use std::sync::Arc;

use clearance::geometry::{
    Compound, Grid, HeightField, Part, Placement, PointCloud, Pose, Quaternion, Shape, TriangleMesh, Vec3, Voxels,
};
use clearance::narrow_phase::{DerivativeGoal, Goal, NoDerivatives, derivatives, separation};

use crate::samples::Random;

fn place(x: f64, y: f64, z: f64) -> Pose {
    Pose::new(Vec3::new(x, y, z), Quaternion::IDENTITY).unwrap()
}

fn ball(radius: f64) -> Shape {
    Shape::sphere(radius).unwrap()
}

fn compound(parts: Vec<(Shape, Pose)>) -> Shape {
    let parts = parts.into_iter().map(|(shape, pose)| Part { shape, pose }).collect();
    Shape::compound(Arc::new(Compound::new(parts).unwrap()))
}

fn surface(vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> Shape {
    let vertices = vertices.iter().map(|v| Vec3::from(*v)).collect();
    Shape::mesh(Arc::new(TriangleMesh::surface(vertices, triangles.to_vec()).unwrap()))
}

/// Whether it is contested, asked from both sides.
fn contested(a: &Shape, b: &Shape, at_a: &Pose, at_b: &Pose) -> bool {
    let (at_a, at_b) = (at_a.placement(), at_b.placement());
    let asked = |a: &Shape, b: &Shape, at_a: &Placement, at_b: &Placement| {
        let found = separation(a, b, at_a, at_b, &Goal::penetration()).unwrap();
        derivatives(a, b, at_a, at_b, &found, &DerivativeGoal::default(), &Goal::penetration()).unwrap().is_contested
    };
    let (one, two) = (asked(a, b, &at_a, &at_b), asked(b, a, &at_b, &at_a));
    assert_eq!(one, two, "sides exchanged");
    one
}

fn two_boxes(second: f64) -> Shape {
    let cuboid = || Shape::cuboid(Vec3::new(0.1, 0.2, 0.3)).unwrap();
    compound(vec![(cuboid(), place(-1.0, 0.0, 0.0)), (cuboid(), place(1.0, 0.0, second))])
}

#[test]
fn two_boxes_at_one_distance_contest_and_one_nearer_by_a_millimetre_does_not() {
    let ball = ball(0.5);
    // 0.4 from both, touching both, and 10 mm in both.
    for x in [0.4, 0.0, -0.01] {
        let boxes = |second: f64| {
            let cuboid = || Shape::cuboid(Vec3::new(0.1, 0.2, 0.3)).unwrap();
            compound(vec![(cuboid(), place(-0.6 - x, 0.0, 0.0)), (cuboid(), place(0.6 + x + second, 0.0, 0.0))])
        };
        assert!(contested(&ball, &boxes(0.0), &Pose::identity(), &Pose::identity()), "{x}");
        assert!(!contested(&ball, &boxes(0.001), &Pose::identity(), &Pose::identity()), "{x}");
    }
    let floor = Shape::half_space(Vec3::z(), 0.0).unwrap();
    assert!(contested(&two_boxes(0.0), &floor, &place(0.0, 0.0, 0.5), &Pose::identity()));
    assert!(!contested(&two_boxes(0.001), &floor, &place(0.0, 0.0, 0.5), &Pose::identity()));
}

#[test]
fn convex_pairs_are_never_contested() {
    let cuboid = Shape::cuboid(Vec3::repeat(0.2)).unwrap();
    assert!(!contested(&cuboid, &cuboid, &Pose::identity(), &place(0.0, 0.0, 0.5)));
    assert!(!contested(&cuboid, &Shape::half_space(Vec3::z(), 0.0).unwrap(), &place(0.0, 0.0, 0.3), &Pose::identity()));
}

/// A ridge and a valley of two triangles along y: the ridge's edge is one place, the valley has one on each slope.
#[test]
fn a_common_edge_does_not_contest_and_a_valley_does() {
    let roof = |z: f64| {
        let corners =
            [[-1.0, -1.0, z], [0.0, -1.0, 0.0], [0.0, 1.0, 0.0], [1.0, -1.0, z], [-1.0, 1.0, z], [1.0, 1.0, z]];
        surface(&corners, &[[0, 1, 2], [0, 2, 4], [1, 3, 2], [3, 5, 2]])
    };
    for (above, ridge) in [(ball(0.2), true), (Shape::ellipsoid(Vec3::new(0.2, 0.1, 0.2)).unwrap(), false)] {
        let there = place(0.0, -0.1, 0.5);
        assert!(!contested(&roof(-0.5), &above, &Pose::identity(), &there), "ridge, {above:?}");
        assert!(contested(&roof(0.5), &above, &Pose::identity(), &there), "valley, {above:?}");
        // 1 mm to a side the nearer slope is alone.
        assert!(!contested(&roof(0.5), &above, &Pose::identity(), &place(0.001, -0.1, 0.5)), "{ridge}");
    }
    // Against another surface, leaf by leaf: an edge across the ridge.
    let blade = surface(&[[-1.0, 0.1, 0.5], [1.0, 0.1, 0.5], [0.0, 0.1, 1.5]], &[[0, 1, 2]]);
    assert!(!contested(&roof(-0.5), &blade, &Pose::identity(), &Pose::identity()));
}

/// z = x^2 - y^2 on a grid: a ball over its middle is as near to both arms that rise.
#[test]
fn a_saddle_contests() {
    let n = 20_u32;
    let at = |i: u32| f64::from(i) / f64::from(n) * 2.0 - 1.0;
    let vertices: Vec<[f64; 3]> =
        (0..=n).flat_map(|i| (0..=n).map(move |j| [at(i), at(j), at(i) * at(i) - at(j) * at(j)])).collect();
    let corner = |i: u32, j: u32| i * (n + 1) + j;
    let triangles: Vec<[u32; 3]> = (0..n)
        .flat_map(|i| (0..n).map(move |j| [corner(i, j), corner(i + 1, j), corner(i, j + 1), corner(i + 1, j + 1)]))
        .flat_map(|[a, b, c, d]| [[a, b, d], [a, d, c]])
        .collect();
    let saddle = surface(&vertices, &triangles);
    assert!(contested(&saddle, &ball(0.3), &Pose::identity(), &place(0.0, 0.0, 0.9)));
    assert!(!contested(&saddle, &ball(0.3), &Pose::identity(), &place(0.05, 0.013, 0.9)));
}

#[test]
fn terrain_clouds_and_voxels_contest_where_two_of_their_pieces_are_as_near() {
    let grid = Grid { rows: 2, columns: 5, spacing: [1.0, 1.0] };
    let twin = |second: f64| {
        let row = [0.0, 1.0, 0.0, second, 0.0];
        Shape::height_field(Arc::new(HeightField::new(grid, [row, row].concat(), -1.0).unwrap()))
    };
    let bar = Shape::cuboid(Vec3::new(2.0, 0.1, 0.1)).unwrap();
    let over = |shape: &Shape| {
        let bounds = shape.bounds().unwrap();
        place(bounds.center().x, bounds.center().y, bounds.max.z + 0.5)
    };
    assert!(contested(&twin(1.0), &bar, &Pose::identity(), &over(&twin(1.0))));
    // One place on the ridge between two columns, wherever the other ridge is.
    let lone = place(over(&twin(1.0)).translation().x - 1.0, 0.03, over(&twin(1.0)).translation().z);
    assert!(!contested(&twin(1.0), &ball(0.2), &Pose::identity(), &lone));
    let cloud = |z: f64| {
        let points = [Vec3::new(-0.5, 0.0, 0.0), Vec3::new(0.5, 0.0, z), Vec3::new(0.0, 0.0, -0.4)];
        Shape::point_cloud(Arc::new(PointCloud::new(&points).unwrap()), 0.05).unwrap()
    };
    for (z, expected) in [(0.0, true), (-0.001, false)] {
        assert_eq!(contested(&cloud(z), &ball(0.3), &Pose::identity(), &place(0.0, 0.0, 1.0)), expected, "{z}");
        let floor = Shape::half_space(-Vec3::z(), -1.0).unwrap();
        assert_eq!(contested(&cloud(z), &floor, &Pose::identity(), &Pose::identity()), expected, "{z}");
    }
    let map = |cells: &[[i32; 3]]| Shape::voxels(Voxels::new(0.1).unwrap().with_cells(cells).unwrap());
    // The ball is over the common face of two cells: one place.
    let pair = map(&[[0, 0, 0], [1, 0, 0]]);
    assert!(!contested(&pair, &ball(0.1), &Pose::identity(), &place(0.1, 0.05, 0.5)));
    let apart = map(&[[-1, 0, 0], [2, 0, 0]]);
    assert!(contested(&apart, &ball(0.1), &Pose::identity(), &place(0.1, 0.05, 0.5)));
    assert!(!contested(&apart, &ball(0.1), &Pose::identity(), &place(0.101, 0.05, 0.5)));
}

/// A ball in the middle of a solid cube is as near to all six faces; nearer to one, it is as near to that alone, whose two triangles share the
/// witness on their diagonal or not.
#[test]
fn within_a_solid_its_surface_is_what_is_near() {
    let corner = |i: u32| [0, 1, 2].map(|axis| if i >> axis & 1 == 0 { -1.0 } else { 1.0 });
    let vertices: Vec<Vec3> = (0..8).map(|i| Vec3::from(corner(i))).collect();
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    let cube = Shape::mesh(Arc::new(TriangleMesh::solid(vertices, triangles).unwrap()));
    assert!(contested(&cube, &ball(0.1), &Pose::identity(), &Pose::identity()));
    assert!(!contested(&cube, &ball(0.1), &Pose::identity(), &place(0.0, 0.0, 0.3)));
    assert!(!contested(&cube, &ball(0.1), &Pose::identity(), &place(0.1, 0.2, 0.3)));
}

#[test]
fn random_compounds_agree_with_their_parts_one_by_one() {
    let mut random = Random::new(71);
    let (mut yes, mut no) = (0, 0);
    for round in 0..300 {
        // Half of them have a part twice as far to one side as to the other.
        let way = if round % 2 == 0 { 0.0 } else { 1e-3 };
        let parts: Vec<(Shape, Pose)> = (0..4)
            .flat_map(|i| {
                let offset = 0.8 + 0.3 * f64::from(i);
                [(ball(0.1), place(offset, 0.0, 0.0)), (ball(0.1 + way), place(-offset, 0.0, 0.0))]
            })
            .collect();
        let at = random.pose(3.0);
        let (whole, other) = (compound(parts.clone()), ball(0.3));
        let found = |shape: &Shape, pose: &Pose| {
            let at_part = at.compose(pose).placement();
            separation(shape, &other, &at_part, &at.placement(), &Goal::penetration()).unwrap().signed_distance
        };
        let mut distances: Vec<f64> = parts.iter().map(|(shape, pose)| found(shape, pose)).collect();
        distances.sort_by(f64::total_cmp);
        let expected = distances[1] - distances[0] < 1e-9;
        assert_eq!(contested(&whole, &other, &at, &at), expected, "{distances:?}");
        *(if expected { &mut yes } else { &mut no }) += 1;
    }
    assert!(yes > 100 && no > 100, "{yes} {no}");
}

#[test]
fn time_that_runs_out_is_told() {
    let (one, other) = (two_boxes(0.0), ball(0.5));
    let (at_one, at_other) = (Pose::identity().placement(), place(0.0, 0.0, 1.0).placement());
    let found = separation(&one, &other, &at_one, &at_other, &Goal::penetration()).unwrap();
    let again = Goal { stop: &|| true, ..Goal::penetration() };
    let told = derivatives(&one, &other, &at_one, &at_other, &found, &DerivativeGoal::default(), &again);
    assert_eq!(told, Err(NoDerivatives::Stopped));
}
