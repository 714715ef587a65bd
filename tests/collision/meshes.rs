//! Meshes against all pairs of their triangles, one by one.
//!
//! Oracle: `separation` of single triangles, which goes through GJK and EPA and knows neither trees nor boxes; its brackets
//! are checked elsewhere. The least of all lower bounds and the least of all upper bounds bracket the truth.

use std::sync::Arc;

use clearance::geometry::{Placement, Shape, TriangleMesh, Vec3};
use clearance::narrow_phase::{Accuracy, Bracket, Depth, Goal, TouchingPair, Within, separation, touching_pairs};

use crate::samples::{Random, at, convex_shapes};

type Triangles = (Vec<Vec3>, Vec<[u32; 3]>);

/// A ball of radius about 1 with bumps and dents: a closed surface of `2 n (n - 1)` triangles.
fn bumpy_ball(n: u32, random: &mut Random) -> Triangles {
    let waves: Vec<(Vec3, f64)> = (0..4).map(|_| (random.vector(4.0), random.between(0.0, 6.0))).collect();
    let point = |i: u32, j: u32| {
        let (polar, around) =
            (std::f64::consts::PI * f64::from(i) / f64::from(n), std::f64::consts::TAU * f64::from(j) / f64::from(n));
        let ring = libm::sin(polar);
        let d = Vec3::new(ring * libm::cos(around), ring * libm::sin(around), libm::cos(polar));
        d * (1.0 + waves.iter().map(|(wave, phase)| 0.1 * libm::sin(wave.dot(&d) + phase)).sum::<f64>())
    };
    let mut vertices: Vec<Vec3> = (1..n).flat_map(|i| (0..n).map(move |j| (i, j))).map(|(i, j)| point(i, j)).collect();
    let (top, bottom) = (vertices.len() as u32, vertices.len() as u32 + 1);
    vertices.extend([point(0, 0), point(n, 0)]);
    let at = |i: u32, j: u32| {
        if i == 0 {
            top
        } else if i == n {
            bottom
        } else {
            (i - 1) * n + j % n
        }
    };
    let quads = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
    let faces = quads
        .flat_map(|(i, j)| [[at(i, j), at(i + 1, j), at(i, j + 1)], [at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)]]);
    let triangles = faces.filter(|[a, b, c]| a != b && b != c && c != a).collect();
    (vertices, triangles)
}

/// Loose triangles, some of them segments, points and slivers.
fn soup(count: u32, random: &mut Random) -> Triangles {
    let mut vertices = Vec::new();
    for i in 0..count {
        let (center, u, v) = (random.vector(1.0), random.vector(0.3), random.vector(0.3));
        let third = match i % 6 {
            0 => center + u * 0.5,
            1 => center,
            2 => center + u * 0.7 + v * 1e-9,
            _ => center + v,
        };
        vertices.extend([center, if i % 12 == 1 { center } else { center + u }, third]);
    }
    (vertices, (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect())
}

fn surface((vertices, triangles): &Triangles) -> Shape {
    Shape::mesh(Arc::new(TriangleMesh::surface(vertices.clone(), triangles.clone()).unwrap()))
}

fn each_triangle((vertices, triangles): &Triangles) -> Vec<Shape> {
    let corner = |i: u32| vertices[i as usize];
    triangles.iter().map(|&[a, b, c]| Shape::triangle(corner(a), corner(b), corner(c)).unwrap()).collect()
}

/// Brackets of all pairs.
fn one_by_one(a: &[Shape], b: &[Shape], at_a: &Placement, at_b: &Placement) -> Vec<Vec<Bracket>> {
    let bracket = |a: &Shape, b: &Shape| separation(a, b, at_a, at_b, &Goal::penetration()).unwrap().bracket;
    a.iter().map(|a| b.iter().map(|b| bracket(a, b)).collect()).collect()
}

fn least(brackets: &[Vec<Bracket>]) -> Bracket {
    let all = || brackets.iter().flatten();
    let least = |values: &mut dyn Iterator<Item = f64>| values.fold(f64::INFINITY, f64::min);
    Bracket { lower: least(&mut all().map(|b| b.lower)), upper: least(&mut all().map(|b| b.upper)) }
}

/// How often each regime was met.
#[derive(Debug, Default)]
struct Regimes {
    apart: u32,
    near: u32,
    overlapping: u32,
    within_margin: u32,
    beyond_cut_off: u32,
    listed: usize,
}

/// Holds every way to ask about two shapes against the brackets of their triangles.
fn check(a: &Shape, b: &Shape, at_a: &Placement, at_b: &Placement, brackets: &[Vec<Bracket>], seen: &mut Regimes) {
    let truth = least(brackets);
    let holds = |found: &Bracket| found.lower <= truth.upper && truth.lower <= found.upper;
    let whole = separation(a, b, at_a, at_b, &Goal::penetration()).unwrap();
    assert!(holds(&whole.bracket), "{whole:?}\n{truth:?}");
    assert!(whole.bracket.width() <= 1e-9 * whole.bracket.lower.abs().max(1e-4), "{whole:?}\n{truth:?}");
    let (numbers, rows) = ((whole.subshape_a as usize, whole.subshape_b as usize), brackets);
    let named = rows[numbers.0][numbers.1];
    assert!(named.lower <= whole.bracket.upper && whole.bracket.lower <= named.upper, "{whole:?} names {named:?}");
    match truth {
        Bracket { upper, .. } if upper <= 0.0 => seen.overlapping += 1,
        Bracket { lower, .. } if lower < 0.02 => seen.near += 1,
        Bracket { .. } => seen.apart += 1,
    }

    for (margin, cut_off, relative) in
        [(0.0, f64::INFINITY, 1e-9), (0.03, f64::INFINITY, 1e-2), (0.03, 0.1, 1e-6), (0.5, 0.2, 0.0)]
    {
        for depth in [Depth::Verdict, Depth::Distance] {
            let goal =
                Goal { depth, margin, cut_off, accuracy: Accuracy { absolute: 0.0, relative }, ..Goal::penetration() };
            let found = separation(a, b, at_a, at_b, &goal).unwrap();
            let Bracket { lower, upper } = found.bracket;
            assert!(lower <= truth.upper && truth.lower <= upper, "{goal:?}: {found:?}\n{truth:?}");
            assert!(lower <= found.signed_distance && found.signed_distance <= upper, "{goal:?}: {found:?}");
            let gap = (found.point_on_b - found.point_on_a - found.normal * found.signed_distance).amax();
            assert!(gap < 1e-9, "{goal:?}: {found:?}");
            if truth.upper <= 0.0 {
                assert!(upper <= 0.0, "{goal:?}: {found:?}\n{truth:?}");
            } else if truth.lower > cut_off {
                // For a verdict less may be enough: that the margin is passed, or not reached by far.
                let decided = depth == Depth::Verdict && (lower > margin || lower > 0.0 && upper <= margin);
                assert!(lower > cut_off || decided, "{goal:?}: {found:?}\n{truth:?}");
                seen.beyond_cut_off += 1;
            } else if truth.lower > margin {
                assert!(lower > margin, "{goal:?}: {found:?}\n{truth:?}");
            } else if truth.lower > 0.0 {
                assert!(lower > 0.0 && upper <= margin, "{goal:?}: {found:?}\n{truth:?}");
                seen.within_margin += 1;
            }
            if depth == Depth::Distance && truth.lower > 0.0 && truth.upper < cut_off {
                assert!(upper - lower <= (relative * lower).max(1e-12), "{goal:?}: {found:?}");
            }
        }
    }

    let mut list = Vec::new();
    for margin in [0.0, 0.05] {
        let within = Within { margin, ..Within::contact() };
        let end = touching_pairs(a, b, at_a, at_b, &within, &mut list).unwrap();
        assert!(!end.truncated && list.is_sorted_by_key(|pair| (pair.a, pair.b)));
        for TouchingPair { a, b, bracket } in &list {
            let pair = brackets[*a as usize][*b as usize];
            assert!(bracket.lower <= pair.upper && pair.lower <= bracket.upper, "{bracket:?}\n{pair:?}");
            assert!(bracket.lower <= margin);
        }
        for (i, row) in brackets.iter().enumerate() {
            for (j, pair) in row.iter().enumerate() {
                let place = list.binary_search_by_key(&(i as u32, j as u32), |pair| (pair.a, pair.b));
                if pair.upper <= margin {
                    let found = &list[place.unwrap_or_else(|_| panic!("{i}, {j} are not listed: {pair:?}"))];
                    assert!(found.bracket.upper <= margin, "{found:?}\n{pair:?}");
                }
                assert!(pair.lower <= margin || place.is_err(), "{i}, {j} are listed: {pair:?}");
            }
        }
        seen.listed += list.len();
        let most = list.len() / 2;
        let cut = touching_pairs(a, b, at_a, at_b, &Within { limit: most, ..within }, &mut list).unwrap();
        assert!(list.len() == most && (cut.truncated || most == 0));
    }
}

#[test]
fn meshes_are_as_far_as_their_nearest_triangles_and_touch_where_those_touch() {
    let mut random = Random::new(31);
    let mut seen = Regimes::default();
    for round in 0..18 {
        let pair = if round % 3 == 0 {
            [soup(40, &mut random), bumpy_ball(6, &mut random)]
        } else {
            [bumpy_ball(8, &mut random), bumpy_ball(7, &mut random)]
        };
        let [a, b] = pair.each_ref().map(surface);
        let [singles_a, singles_b] = pair.each_ref().map(each_triangle);
        let (at_a, mut at_b) = (random.pose(0.5).placement(), random.pose(0.5).placement());
        let away = random.direction();
        // Apart, then all but in contact, then crossing.
        at_b.translation += away * 3.5;
        let start = separation(&a, &b, &at_a, &at_b, &Goal::penetration()).unwrap();
        let gap = match round % 6 {
            0 | 1 => 0.3,
            2 | 3 => 1e-3,
            _ => -0.1,
        };
        at_b.translation -= start.normal * (start.signed_distance - gap);
        let brackets = one_by_one(&singles_a, &singles_b, &at_a, &at_b);
        check(&a, &b, &at_a, &at_b, &brackets, &mut seen);
    }
    let Regimes { apart, near, overlapping, within_margin, beyond_cut_off, listed } = seen;
    assert!(apart >= 4 && near >= 4 && overlapping >= 4 && within_margin >= 10, "{seen:?}");
    assert!(beyond_cut_off >= 4 && listed >= 50, "{seen:?}");
}

#[test]
fn a_mesh_touches_a_convex_shape_where_its_triangles_do() {
    let mut random = Random::new(32);
    let mut seen = Regimes::default();
    let ball = bumpy_ball(8, &mut random);
    let (mesh, singles) = (surface(&ball), each_triangle(&ball));
    for other in convex_shapes() {
        for reach in [1.5, 2.2] {
            let (at_mesh, mut at_other) = (random.pose(0.1).placement(), random.pose(0.1).placement());
            at_other.translation += random.direction() * reach;
            let brackets = one_by_one(&singles, std::slice::from_ref(&other), &at_mesh, &at_other);
            check(&mesh, &other, &at_mesh, &at_other, &brackets, &mut seen);
        }
    }
    assert!(seen.apart >= 6 && seen.overlapping >= 3 && seen.listed >= 20, "{seen:?}");
}

/// A grid of triangles in the plane z = 0 of side 1.
fn sheet(n: u32) -> Triangles {
    let vertex = |i: u32, j: u32| Vec3::new(f64::from(i), f64::from(j), 0.0) / f64::from(n);
    let vertices = (0..=n).flat_map(|i| (0..=n).map(move |j| vertex(i, j))).collect();
    let at = |i: u32, j: u32| i * (n + 1) + j;
    let quads = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
    let faces = quads
        .flat_map(|(i, j)| [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]);
    (vertices, faces.collect())
}

#[test]
fn sheets_that_lie_on_one_another_are_never_free_and_list_every_pair_that_meets() {
    let sheet = sheet(4);
    let (mesh, singles) = (surface(&sheet), each_triangle(&sheet));
    let mut random = Random::new(33);
    for _ in 0..3 {
        let place = random.pose(2.0).placement();
        for goal in [Goal::verdict(), Goal::penetration()] {
            let found = separation(&mesh, &mesh, &place, &place, &goal).unwrap();
            assert!(
                found.bracket.lower <= 0.0 && found.bracket.upper >= 0.0 && found.bracket.upper < 1e-13,
                "{found:?}"
            );
        }
        let mut list = Vec::new();
        touching_pairs(&mesh, &mesh, &place, &place, &Within::contact(), &mut list).unwrap();
        for i in 0..singles.len() {
            assert!(list.iter().any(|pair| (pair.a, pair.b) == (i as u32, i as u32)), "{i} lies on itself");
        }
        assert!(list.iter().all(|pair| pair.bracket.lower <= 0.0 && 0.0 <= pair.bracket.upper + 1e-13));
    }
}

#[test]
fn what_has_no_triangles_is_refused_by_name() {
    let (ball, floor) = (Shape::sphere(1.0).unwrap(), Shape::half_space(Vec3::z(), 0.0).unwrap());
    let here = at(0.0, 0.0, 0.0);
    let mut list = Vec::new();
    let refused = touching_pairs(&ball, &ball, &here, &here, &Within::contact(), &mut list).unwrap_err();
    assert_eq!((refused.a, refused.b), ("sphere", "sphere"));
    assert!(touching_pairs(&surface(&sheet(1)), &floor, &here, &here, &Within::contact(), &mut list).is_err());
}

/// Oracle: the sum of the solid angles of all triangles (van Oosterom and Strackee 1983), for points not near the surface.
#[test]
fn a_point_is_inside_a_solid_where_its_triangles_go_all_the_way_round_and_few_of_them_are_asked() {
    let mut random = Random::new(34);
    let (mut inside, mut outside) = (0, 0);
    let (vertices, triangles) = bumpy_ball(40, &mut random);
    let solid = Shape::mesh(Arc::new(TriangleMesh::solid(vertices.clone(), triangles.clone()).unwrap()));
    let (point, here) = (Shape::point(), at(0.0, 0.0, 0.0));
    for _ in 0..60 {
        let p = random.vector(1.0);
        let angle = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| (vertices[i as usize] - p).normalize());
            2.0 * libm::atan2(a.dot(&b.cross(&c)), 1.0 + a.dot(&b) + b.dot(&c) + c.dot(&a))
        };
        let is_inside = triangles.iter().map(angle).sum::<f64>() > std::f64::consts::TAU;
        for goal in [Goal::verdict(), Goal::penetration()] {
            let found = separation(&solid, &point, &here, &at(p.x, p.y, p.z), &goal).unwrap();
            assert_eq!(found.bracket.upper <= 0.0, is_inside, "{p}: {found:?}");
            assert_eq!(found.bracket.lower > 0.0, !is_inside, "{p}: {found:?}");
        }
        if is_inside { inside += 1 } else { outside += 1 }
    }
    assert!(inside >= 15 && outside >= 15, "{inside} inside, {outside} outside");
}

#[test]
fn time_that_is_over_at_once_leaves_a_bracket_around_the_truth() {
    let mut random = Random::new(35);
    let ball = surface(&bumpy_ball(12, &mut random));
    for (distance, depth) in [(2.6, Depth::Distance), (1.5, Depth::Penetration), (2.1, Depth::Verdict)] {
        let (here, there) = (at(0.0, 0.0, 0.0), at(0.0, 0.0, distance));
        let whole = separation(&ball, &ball, &here, &there, &Goal::penetration()).unwrap();
        let asked = std::cell::Cell::new(0);
        for patience in [0, 1, 3, 10] {
            asked.set(0);
            let stop = || {
                asked.set(asked.get() + 1);
                asked.get() > patience
            };
            let cut =
                separation(&ball, &ball, &here, &there, &Goal { depth, stop: &stop, ..Goal::penetration() }).unwrap();
            assert!(
                cut.bracket.lower <= whole.bracket.upper && whole.bracket.lower <= cut.bracket.upper,
                "{cut:?}\n{whole:?}"
            );
        }
    }
}
