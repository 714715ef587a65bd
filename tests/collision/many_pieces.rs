//! Terrain, point clouds and voxels against every kind of shape, held against all pairs of their pieces one by one.
//!
//! Oracle: `separation` of single convex pieces, which knows neither trees nor pyramids: a column of terrain as the convex hull of
//! its six corners, a point of a cloud as a segment without length, swept; a cell as
//! the convex hull of its eight corners. The least of all lower bounds and the least of all
//! upper bounds bracket the truth. Brackets of convex pairs are checked in `soundness`.

use std::sync::Arc;

use clearance::geometry::{
    Aabb, Compound, Grid, HeightField, Part, Placement, PointCloud, Pose, Quaternion, Shape, TriangleMesh, Vec3, Voxels,
};
use clearance::narrow_phase::{Accuracy, Bracket, Depth, Goal, NoSeparation, Separation, separation};

use crate::samples::{Random, at, convex_shapes};

/// A shape and the convex pieces it is the union of, by number.
struct Specimen {
    whole: Shape,
    /// In the frame of the whole, but for the parts of a compound, which have poses.
    pieces: Vec<(Shape, Pose)>,
}

impl Specimen {
    fn of(whole: Shape, pieces: impl IntoIterator<Item = Shape>) -> Self {
        Self { whole, pieces: pieces.into_iter().map(|piece| (piece, Pose::identity())).collect() }
    }

    fn swept(self, radius: f64) -> Self {
        let swept = |shape: &Shape| shape.swept(radius).unwrap();
        Self { whole: swept(&self.whole), pieces: self.pieces.iter().map(|(s, at)| (swept(s), *at)).collect() }
    }
}

/// Hills of a metre over a floor at -0.5, on a grid that is no power of two.
fn terrain(rows: u32, columns: u32, random: &mut Random) -> Specimen {
    let waves: Vec<(f64, f64)> = (0..3).map(|_| (random.between(-3.0, 3.0), random.between(-3.0, 3.0))).collect();
    let spacing = [1.6 / f64::from(columns - 1), 1.3 / f64::from(rows - 1)];
    let height = |i: u32| {
        let (y, x) = (f64::from(i / columns) * spacing[1], f64::from(i % columns) * spacing[0]);
        let sum: f64 = waves.iter().map(|(u, v)| libm::sin(2.0 * u * x + 2.0 * v * y)).sum();
        // A flat that lies on the floor is a field too.
        (0.15 * sum).max(-0.5 + if i.is_multiple_of(11) { 0.0 } else { 0.2 })
    };
    let heights: Vec<f64> = (0..rows * columns).map(height).collect();
    let point =
        |row: u32, column: u32, z: f64| Vec3::new(f64::from(column) * spacing[0], f64::from(row) * spacing[1], z);
    let mut columns_below = Vec::new();
    for row in 0..rows - 1 {
        for column in 0..columns - 1 {
            let corners = [(row, column), (row, column + 1), (row + 1, column + 1), (row + 1, column)];
            for triangle in [[0, 1, 2], [0, 2, 3]] {
                let top = triangle.map(|k: usize| corners[k]);
                let high = top.map(|(r, c)| point(r, c, heights[(r * columns + c) as usize]));
                let low = top.map(|(r, c)| point(r, c, -0.5));
                columns_below.push(Shape::convex(&[high, low].concat()).unwrap());
            }
        }
    }
    let field = HeightField::new(Grid { rows, columns, spacing }, heights, -0.5).unwrap();
    Specimen::of(Shape::height_field(Arc::new(field)), columns_below)
}

/// Points in and on a ball, some of them twice, each with a ball of its own.
fn cloud(count: usize, radius: f64, random: &mut Random) -> Specimen {
    let mut points: Vec<Vec3> = Vec::new();
    for i in 0..count {
        let p = random.direction() * if i % 3 == 0 { random.between(0.0, 0.7) } else { 0.7 };
        points.push(if i % 10 == 9 { points[i - 4] } else { p });
    }
    let whole = Shape::point_cloud(Arc::new(PointCloud::new(&points).unwrap()), radius).unwrap();
    Specimen::of(whole, points.iter().map(|p| Shape::segment(*p, *p).unwrap().swept(radius).unwrap()))
}

/// Cells along a crooked line and in a block, at a resolution that is no sum of powers of two.
fn voxels(random: &mut Random) -> Specimen {
    let mut map = Voxels::new(0.15).unwrap();
    let line: Vec<Vec3> = (0..30).map(|i| Vec3::repeat(f64::from(i) * 0.04 - 0.6) + random.vector(0.1)).collect();
    let block: Vec<[i32; 3]> = (0..27).map(|i| [i % 3 - 6, i / 3 % 3 - 1, i / 9]).collect();
    map = map.with_points(&line).unwrap().with_cells(&block).unwrap();
    let cell = |cell: [i32; 3]| Shape::convex(&map.box_of(cell).corners()).unwrap();
    Specimen::of(Shape::voxels(map.clone()), map.cells().into_iter().map(cell))
}

/// A crumpled sheet.
fn mesh(random: &mut Random) -> Specimen {
    let vertex =
        |i: u32| Vec3::new(f64::from(i % 6) * 0.3 - 0.7, f64::from(i / 6) * 0.3 - 0.7, random.between(-0.2, 0.2));
    let vertices: Vec<Vec3> = (0..36).map(vertex).collect();
    let quads = (0..25).map(|i| i / 5 * 6 + i % 5);
    let triangles: Vec<[u32; 3]> = quads.flat_map(|i| [[i, i + 1, i + 7], [i, i + 7, i + 6]]).collect();
    let corner = |i: u32| vertices[i as usize];
    let singles: Vec<Shape> =
        triangles.iter().map(|&[a, b, c]| Shape::triangle(corner(a), corner(b), corner(c)).unwrap()).collect();
    Specimen::of(Shape::mesh(Arc::new(TriangleMesh::surface(vertices, triangles).unwrap())), singles)
}

fn compound(parts: Vec<(Shape, Pose)>) -> Specimen {
    let made = parts.iter().map(|(shape, pose)| Part { shape: shape.clone(), pose: *pose }).collect();
    Specimen { whole: Shape::compound(Arc::new(Compound::new(made).unwrap())), pieces: parts }
}

/// Brackets of all pairs of pieces, row by row.
fn one_by_one(a: &Specimen, b: &Specimen, at_a: &Placement, at_b: &Placement) -> Vec<Vec<Bracket>> {
    // The frame of a part: composed in doubles, which is what the slack below is for.
    let placed = |at: &Placement, pose: &Pose| {
        let inner = pose.placement();
        Placement::computed(at.rotation * inner.rotation, at.point(inner.translation))
    };
    let bracket = |(one, at_one): &(Shape, Pose), (two, at_two): &(Shape, Pose)| {
        let (at_one, at_two) = (placed(at_a, at_one), placed(at_b, at_two));
        separation(one, two, &at_one, &at_two, &Goal::penetration()).unwrap().bracket
    };
    a.pieces.iter().map(|one| b.pieces.iter().map(|two| bracket(one, two)).collect()).collect()
}

/// What composing poses of parts may be off by, at the sizes of these tests; metres.
const COMPOSED: f64 = 1e-13;

fn least(brackets: &[Vec<Bracket>]) -> Bracket {
    let (mut lower, mut upper) = (f64::INFINITY, f64::INFINITY);
    for bracket in brackets.iter().flatten() {
        (lower, upper) = (lower.min(bracket.lower), upper.min(bracket.upper));
    }
    Bracket { lower: lower - COMPOSED, upper: upper + COMPOSED }
}

#[derive(Debug, Default)]
struct Regimes {
    apart: u32,
    near: u32,
    shallow: u32,
    deep: u32,
    pruned: u32,
}

fn agree(one: &Bracket, other: &Bracket) -> bool {
    one.lower <= other.upper && other.lower <= one.upper
}

/// Holds every way to ask about two shapes, in both orders, against the brackets of their pieces.
fn check(a: &Specimen, b: &Specimen, at_a: &Placement, at_b: &Placement, seen: &mut Regimes) {
    let brackets = one_by_one(a, b, at_a, at_b);
    let truth = least(&brackets);
    let whole = separation(&a.whole, &b.whole, at_a, at_b, &Goal::penetration()).unwrap();
    let what = || format!("{} {}: {whole:?}\n{truth:?}", a.whole.kind(), b.whole.kind());
    assert!(agree(&whole.bracket, &truth), "{}", what());
    assert!(whole.bracket.width() <= 1e-8 * whole.bracket.lower.abs().max(1e-4), "{}", what());
    let named = brackets[whole.subshape_a as usize][whole.subshape_b as usize];
    assert!(named.lower - COMPOSED <= whole.bracket.upper, "{} names {named:?}", what());
    if (whole.cost.pairs as usize) < brackets.len() * brackets[0].len() / 4 {
        seen.pruned += 1;
    }
    match truth {
        Bracket { lower, .. } if lower > 0.02 => seen.apart += 1,
        Bracket { lower, .. } if lower > 0.0 => seen.near += 1,
        Bracket { upper, .. } if upper > -0.05 => seen.shallow += 1,
        Bracket { .. } => seen.deep += 1,
    }
    let turned = separation(&b.whole, &a.whole, at_b, at_a, &Goal::penetration()).unwrap();
    assert!(agree(&turned.bracket, &truth), "turned: {turned:?}\n{}", what());
    for (margin, cut_off, relative) in [(0.0, f64::INFINITY, 1e-9), (0.03, f64::INFINITY, 1e-2), (0.05, 0.1, 1e-6)] {
        for depth in [Depth::Verdict, Depth::Distance] {
            let accuracy = Accuracy { absolute: 0.0, relative };
            let goal = Goal { depth, margin, cut_off, accuracy, ..Goal::penetration() };
            let found = separation(&a.whole, &b.whole, at_a, at_b, &goal).unwrap();
            let Separation { bracket: Bracket { lower, upper }, .. } = found;
            assert!(agree(&found.bracket, &truth), "{goal:?}: {found:?}\n{}", what());
            assert!(lower <= found.signed_distance && found.signed_distance <= upper, "{goal:?}: {found:?}");
            let gap = (found.point_on_b - found.point_on_a - found.normal * found.signed_distance).amax();
            assert!(gap < 1e-9, "{goal:?}: {found:?}");
            if truth.upper <= 0.0 {
                assert!(upper <= 0.0, "{goal:?}: {found:?}\n{}", what());
            } else if truth.lower > margin && truth.lower <= cut_off {
                assert!(lower > margin, "{goal:?}: {found:?}\n{}", what());
            } else if truth.lower > 0.0 {
                assert!(lower > 0.0, "{goal:?}: {found:?}\n{}", what());
            }
        }
    }
}

/// Asks about a pair apart, all but in contact, and overlapping.
fn at_three_gaps(a: &Specimen, b: &Specimen, random: &mut Random, seen: &mut Regimes) {
    let (at_a, mut at_b) = (random.pose(0.5).placement(), random.pose(0.5).placement());
    let bounded = a.whole.bounds().is_some() && b.whole.bounds().is_some();
    at_b.translation += random.direction() * if bounded { 3.0 } else { 0.0 };
    let start = separation(&a.whole, &b.whole, &at_a, &at_b, &Goal::penetration()).unwrap();
    for gap in [0.2, 1e-3, -0.03, -0.4] {
        let at_b = Placement { translation: at_b.translation - start.normal * (start.signed_distance - gap), ..at_b };
        check(a, b, &at_a, &at_b, seen);
    }
}

#[test]
fn terrain_clouds_and_voxels_are_as_far_from_every_kind_of_shape_as_their_nearest_pieces() {
    let mut random = Random::new(41);
    let mut seen = Regimes::default();
    let pose =
        |x: f64, y: f64| Pose::new(Vec3::new(x, y, 0.1), Quaternion { w: 0.9, x: 0.1, y: -0.3, z: 0.2 }).unwrap();
    let ball = Shape::sphere(0.3).unwrap();
    let clouds = [cloud(30, 0.04, &mut random), cloud(25, 0.0, &mut random).swept(0.02)];
    let maps = [voxels(&mut random), voxels(&mut random).swept(0.05)];
    for specimen in [terrain(5, 6, &mut random)].into_iter().chain(clouds).chain(maps) {
        let mut others: Vec<Specimen> =
            convex_shapes().into_iter().map(|shape| Specimen::of(shape.clone(), [shape])).collect();
        for wall in [Shape::half_space(Vec3::new(0.3, -0.2, 2.0), 0.4), Shape::plane(Vec3::new(0.1, 1.0, 0.3), -0.2)] {
            let wall = wall.unwrap();
            others.push(Specimen::of(wall.clone(), [wall]));
        }
        others.push(mesh(&mut random));
        others.push(compound(vec![(ball.clone(), pose(0.4, 0.0)), (convex_shapes().remove(2), pose(-0.3, 0.2))]));
        others.push(terrain(4, 5, &mut random));
        others.push(cloud(20, 0.1, &mut random));
        others.push(voxels(&mut random));
        for other in &others {
            at_three_gaps(&specimen, other, &mut random, &mut seen);
        }
    }
    let Regimes { apart, near, shallow, deep, pruned } = seen;
    assert!(apart >= 30 && near >= 30 && shallow >= 30 && deep >= 30 && pruned >= 60, "{seen:?}");
}

/// Clouds and terrain as parts: the pieces are the parts, each of them a union itself.
#[test]
fn a_compound_may_hold_terrain_clouds_and_voxels() {
    let mut random = Random::new(42);
    let (field, dots) = (terrain(4, 4, &mut random), cloud(20, 0.05, &mut random));
    let pose = Pose::new(Vec3::new(0.5, 0.3, 1.2), Quaternion { w: 1.0, x: 0.2, y: -0.4, z: 0.1 }).unwrap();
    let (map, low) = (voxels(&mut random), Pose::new(Vec3::new(0.0, 0.0, -1.5), Quaternion::IDENTITY).unwrap());
    let parts = vec![(field.whole.clone(), Pose::identity()), (dots.whole.clone(), pose), (map.whole, low)];
    let both = compound(parts);
    let mut seen = Regimes::default();
    for shape in convex_shapes() {
        at_three_gaps(&both, &Specimen::of(shape.clone(), [shape]), &mut random, &mut seen);
    }
    assert!(seen.apart >= 5 && seen.near >= 5 && seen.shallow >= 5 && seen.deep >= 5, "{seen:?}");
}

#[test]
fn what_is_under_the_surface_collides_though_it_touches_no_triangle() {
    let heights = vec![2.0; 9];
    let field = HeightField::new(Grid { rows: 3, columns: 3, spacing: [4.0, 4.0] }, heights, -1.0).unwrap();
    let ground = Shape::height_field(Arc::new(field));
    let (ball, here) = (Shape::sphere(0.25).unwrap(), at(0.0, 0.0, 0.0));
    let of = |z: f64| separation(&ground, &ball, &here, &at(3.0, 1.0, z), &Goal::penetration()).unwrap();
    let near = |found: Separation, expected: f64| {
        assert!((found.signed_distance - expected).abs() < 1e-12, "{expected}: {found:?}");
        assert!(found.bracket.lower <= expected + 1e-12 && expected - 1e-12 <= found.bracket.upper);
    };
    near(of(3.0), 0.75);
    near(of(2.25), 0.0);
    // Up is the shortest way out of the column at 1.9 m, down at -0.9; and below the floor is outside.
    near(of(1.9), -0.35);
    near(of(-0.9), -0.35);
    near(of(-2.0), 0.75);
    assert!(of(0.5).bracket.upper <= -0.25, "{:?}", of(0.5));
    // Beside the field, at half its height.
    near(separation(&ground, &ball, &here, &at(9.0, 4.0, 0.5), &Goal::penetration()).unwrap(), 0.75);
}

#[test]
fn terrain_names_the_column_and_a_cloud_the_point() {
    let heights = (0..20).map(|i| if i == 11 { 1.0 } else { 0.0 }).collect();
    let field = HeightField::new(Grid { rows: 4, columns: 5, spacing: [1.0, 1.0] }, heights, -1.0).unwrap();
    let ground = Shape::height_field(Arc::new(field));
    let (point, here) = (Shape::point(), at(0.0, 0.0, 0.0));
    // Over the cell of row 1 and column 3, nearer to its greatest column: 2 * (1 * 4 + 3).
    let found = separation(&point, &ground, &at(3.8, 1.2, 0.5), &here, &Goal::penetration()).unwrap();
    assert_eq!((found.subshape_a, found.subshape_b), (0, 14));
    let found = separation(&ground, &point, &here, &at(3.2, 1.8, 0.5), &Goal::penetration()).unwrap();
    assert_eq!((found.subshape_a, found.subshape_b), (15, 0));

    let points: Vec<Vec3> = (0..50).map(|i| Vec3::new(f64::from(i * 17 % 50), 0.0, 0.0)).collect();
    let cloud = Shape::point_cloud(Arc::new(PointCloud::new(&points).unwrap()), 0.1).unwrap();
    let found = separation(&cloud, &point, &here, &at(17.2, 0.0, 0.0), &Goal::penetration()).unwrap();
    assert!(found.subshape_a == 1 && (found.signed_distance - 0.1).abs() < 1e-12, "{found:?}");

    let map = Voxels::new(0.5).unwrap().with_cells(&[[4, 0, 0], [-3, 0, 0], [0, 0, 0], [1, 0, 0]]).unwrap();
    let found = separation(&Shape::voxels(map.clone()), &point, &here, &at(1.25, 0.25, 0.25), &Goal::penetration());
    let found = found.unwrap();
    assert_eq!(map.cells()[found.subshape_a as usize], [1, 0, 0]);
    assert!((found.signed_distance - 0.25).abs() < 1e-12, "{found:?}");
}

#[test]
fn points_inside_a_solid_mesh_collide_wherever_the_rest_of_the_cloud_is() {
    let sign = |bit: u32| if bit == 0 { -1.0 } else { 1.0 };
    let corners: Vec<Vec3> = (0..8).map(|i| Vec3::new(sign(i & 1), sign(i & 2), sign(i & 4))).collect();
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let faces = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    let cube = Shape::mesh(Arc::new(TriangleMesh::solid(corners, faces).unwrap()));
    let mut random = Random::new(43);
    let here = at(0.0, 0.0, 0.0);
    for count in [1, 30, 400] {
        let around: Vec<Vec3> = (0..count).map(|_| random.direction() * random.between(1.9, 4.0)).collect();
        for with_one_inside in [false, true] {
            let mut points = around.clone();
            points.extend(with_one_inside.then(|| random.vector(0.8)));
            let cloud = Shape::point_cloud(Arc::new(PointCloud::new(&points).unwrap()), 0.05).unwrap();
            for goal in [Goal::verdict(), Goal::penetration()] {
                let found = separation(&cube, &cloud, &here, &here, &goal).unwrap();
                assert_eq!(found.bracket.upper <= 0.0, with_one_inside, "{count}: {found:?}");
                assert_eq!(found.bracket.lower > 0.0, !with_one_inside, "{count}: {found:?}");
            }
        }
    }
    // Cells that touch nothing else, and one that holds the whole of a small solid.
    let lone = |cell: [i32; 3]| Shape::voxels(Voxels::new(0.5).unwrap().with_cells(&[[9, 9, 9], cell]).unwrap());
    assert!(separation(&cube, &lone([0, 0, 0]), &here, &here, &Goal::verdict()).unwrap().bracket.upper <= 0.0);
    assert!(separation(&cube, &lone([-9, 0, 0]), &here, &here, &Goal::verdict()).unwrap().bracket.lower > 0.0);
    let grain = cube.scaled(0.1).unwrap();
    let found = separation(&grain, &lone([0, 0, 0]), &at(0.25, 0.25, 0.25), &here, &Goal::verdict()).unwrap();
    assert!(found.bracket.upper <= 0.0, "{found:?}");
    // Terrain is connected: any point of it tells.
    let grid = Grid { rows: 3, columns: 3, spacing: [0.1, 0.1] };
    let small = Shape::height_field(Arc::new(HeightField::new(grid, vec![0.3; 9], 0.0).unwrap()));
    assert!(separation(&small, &cube, &here, &here, &Goal::verdict()).unwrap().bracket.upper <= 0.0);
    assert!(separation(&small, &cube, &at(3.0, 0.0, 0.0), &here, &Goal::verdict()).unwrap().bracket.lower > 0.0);
}

#[test]
fn scaled_and_swept_terrain_and_clouds_have_the_distances_that_follow() {
    let mut random = Random::new(44);
    let (here, there) = (at(0.0, 0.0, 0.0), at(0.4, 0.5, 2.0));
    let ball = Shape::sphere(0.1).unwrap();
    for specimen in [terrain(6, 7, &mut random), cloud(40, 0.03, &mut random), voxels(&mut random)] {
        let of = |shape: &Shape, ball: &Shape, there: &Placement| {
            separation(shape, ball, &here, there, &Goal::penetration()).unwrap().signed_distance
        };
        let whole = of(&specimen.whole, &ball, &there);
        assert!((of(&specimen.whole.swept(0.2).unwrap(), &ball, &there) - (whole - 0.2)).abs() < 1e-12);
        let twice = specimen.whole.scaled(2.0).unwrap();
        let far = at(0.8, 1.0, 4.0);
        assert!((of(&twice, &ball.scaled(2.0).unwrap(), &far) - 2.0 * whole).abs() < 1e-12);
        let bounds = specimen.whole.bounds().unwrap();
        assert!((twice.bounds().unwrap().max - bounds.max * 2.0).amax() < 1e-12);
    }
}

#[test]
fn a_map_without_cells_has_no_distance_and_says_so() {
    let empty = Shape::voxels(Voxels::new(0.5).unwrap());
    let (ball, here) = (Shape::sphere(1.0).unwrap(), at(0.0, 0.0, 0.0));
    assert!(empty.is_empty() && empty.bounds().is_none() && !ball.is_empty());
    for (a, b) in [(&empty, &ball), (&ball, &empty), (&empty, &empty)] {
        let refused = separation(a, b, &here, &here, &Goal::verdict()).unwrap_err();
        assert_eq!(refused, NoSeparation::Empty { a: a.kind(), b: b.kind() });
    }
    let refused = Compound::new(vec![Part { shape: empty, pose: Pose::identity() }]).unwrap_err();
    assert_eq!(refused.to_string(), "parts[0]: voxels is empty");
}

/// Oracle: the history. A map that was edited is another; the old one answers as before, byte for byte.
#[test]
fn an_edited_map_leaves_the_one_it_came_from_as_it_was() {
    let mut random = Random::new(45);
    let points: Vec<Vec3> = (0..5000).map(|_| random.direction() * 2.0).collect();
    let old = Voxels::new(0.1).unwrap().with_points(&points).unwrap();
    let (ball, here, there) = (Shape::sphere(0.2).unwrap(), at(0.0, 0.0, 0.0), at(0.3, 0.2, 0.1));
    let ask = |map: &Voxels| separation(&Shape::voxels(map.clone()), &ball, &here, &there, &Goal::penetration());
    let (before, cells) = (format!("{:?}", ask(&old)), old.cells());
    let nearer = old.with_points(&[Vec3::new(0.3, 0.2, 0.9)]).unwrap();
    let hole = Aabb { min: Vec3::new(-2.5, -2.5, 0.0), max: Vec3::repeat(2.5) };
    let opened = old.without_box(&hole).unwrap();
    assert!(ask(&nearer).unwrap().signed_distance < 0.7 && opened.len() < old.len());
    assert!(ask(&opened).unwrap().signed_distance > ask(&nearer).unwrap().signed_distance);
    assert_eq!((format!("{:?}", ask(&old)), old.cells()), (before, cells));
}
