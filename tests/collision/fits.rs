//! How well decompositions fit their meshes: the figures of the cost card.
//!
//! Oracles: closed forms of an L and its hull; and dense random points of the surface and of the pieces, whose greatest distances come
//! from below and are no more than the proved upper ends.

use std::sync::Arc;

use clearance::geometry::{Compound, Core, Part, Placement, Pose, Quaternion, Shape, TriangleMesh, Vec3, decomposed};
use clearance::narrow_phase::{Bracket, Depth, Fit, FitGoal, Goal, fit, separation};

use crate::samples::Random;

const UNLIMITED: FitGoal = FitGoal { accuracy: 1e-3, most_points: 200_000, stop: &|| false };

/// An L of two bars, 1 m long and 0.2 m thick.
fn corner_piece() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let outline = [(0.0, 0.0), (1.0, 0.0), (1.0, 0.2), (0.2, 0.2), (0.2, 1.0), (0.0, 1.0)];
    let level = |z: f64| outline.map(|(x, y)| Vec3::new(x, y, z));
    let caps = [[0, 1, 2], [0, 2, 3], [0, 3, 5], [3, 4, 5]];
    let mut triangles: Vec<[u32; 3]> = caps.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
    triangles.extend(caps.map(|cap| cap.map(|i| i + 6)));
    for i in 0..6 {
        let j = (i + 1) % 6;
        triangles.extend([[i, j, j + 6], [i, j + 6, i + 6]]);
    }
    ([level(0.0), level(0.2)].concat(), triangles)
}

/// A ring of square section: a hole that no convex shape has.
fn ring(n: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let section = [(1.0, -0.1), (1.0, 0.1), (0.7, 0.1), (0.7, -0.1)];
    let point = |i: u32, (r, z): (f64, f64)| {
        let angle = std::f64::consts::TAU * f64::from(i) / f64::from(n);
        Vec3::new(r * libm::cos(angle), r * libm::sin(angle), z)
    };
    let vertices = (0..n).flat_map(|i| section.map(|corner| point(i, corner))).collect();
    let at = |i: u32, k: u32| 4 * (i % n) + k % 4;
    let quads = (0..n).flat_map(|i| (0..4).map(move |k| (i, k)));
    let faces = quads
        .flat_map(|(i, k)| [[at(i, k), at(i + 1, k), at(i + 1, k + 1)], [at(i, k), at(i + 1, k + 1), at(i, k + 1)]]);
    (vertices, faces.collect())
}

fn of_hulls(hulls: &[Vec<Vec3>]) -> Arc<Compound> {
    let part = |points: &Vec<Vec3>| Part { shape: Shape::convex(points).unwrap(), pose: Pose::identity() };
    Arc::new(Compound::new(hulls.iter().map(part).collect()).unwrap())
}

fn holds(bracket: &Bracket, truth: f64) {
    assert!(bracket.lower <= truth + 1e-9 && truth <= bracket.upper + 1e-9, "{bracket:?}, {truth}");
    assert!(bracket.upper - bracket.lower <= 1.001e-3, "{bracket:?}, {truth}");
}

#[test]
fn the_hull_of_an_l_is_inflated_where_the_l_is_not_and_loses_nothing() {
    let (vertices, triangles) = corner_piece();
    let mesh = Arc::new(TriangleMesh::surface(vertices.clone(), triangles).unwrap());
    let found = fit(&mesh, &of_hulls(&[vertices]), &UNLIMITED);
    // The middle of the hypotenuse, (0.6, 0.6), is 0.4 from both bars.
    holds(&found.inflation, 0.4);
    holds(&found.loss, 0.0);
    assert!(found.closed && found.points > 0, "{found:?}");
}

#[test]
fn a_bar_without_the_other_is_not_inflated_and_loses_that() {
    let (vertices, triangles) = corner_piece();
    let mesh = Arc::new(TriangleMesh::solid(vertices.clone(), triangles).unwrap());
    let bar: Vec<Vec3> = vertices.iter().filter(|v| v.y < 0.5).copied().collect();
    let found = fit(&mesh, &of_hulls(&[bar]), &UNLIMITED);
    // From the far corner (0, 1) to that between the bars, (0.2, 0.2).
    holds(&found.loss, 0.68_f64.sqrt());
    // All of the bar's surface is at distance zero, so the work ends before the bracket is as narrow as asked.
    assert!(found.inflation.lower < 1e-9 && found.inflation.upper < 2e-3, "{found:?}");
}

#[test]
fn an_open_surface_counts_the_inside_of_its_hull_as_inflation() {
    let (vertices, mut triangles) = corner_piece();
    triangles.pop();
    let mesh = Arc::new(TriangleMesh::surface(vertices.clone(), triangles).unwrap());
    let bar: Vec<Vec3> = vertices.iter().filter(|v| v.y < 0.5).copied().collect();
    let found = fit(&mesh, &of_hulls(&[bar]), &UNLIMITED);
    assert!(!found.closed && found.inflation.lower >= 0.099, "{found:?}");
}

/// The greatest distances of random points: of the surface from the pieces, and of the pieces from the body.
fn sampled(mesh: &Arc<TriangleMesh>, pieces: &Arc<Compound>, random: &mut Random) -> (f64, f64) {
    let (body, whole, here) =
        (Shape::mesh(Arc::clone(mesh)), Shape::compound(Arc::clone(pieces)), Placement::identity());
    let distance = |shape: &Shape, p: Vec3| {
        let there = Pose::new(p, Quaternion::IDENTITY).unwrap().placement();
        let goal = Goal { depth: Depth::Distance, ..Goal::penetration() };
        separation(shape, &Shape::point(), &here, &there, &goal).unwrap().signed_distance.max(0.0)
    };
    let mut mix = |points: &[Vec3]| {
        let weights: Vec<f64> = points.iter().map(|_| -libm::log(random.between(1e-9, 1.0))).collect();
        let total: f64 = weights.iter().sum();
        points.iter().zip(&weights).map(|(p, w)| p * (w / total)).sum::<Vec3>()
    };
    let (mut loss, mut inflation) = (0.0_f64, 0.0_f64);
    for _ in 0..40 {
        for i in 0..mesh.triangles().len() {
            loss = loss.max(distance(&whole, mix(&mesh.triangle(i))));
        }
    }
    for part in pieces.parts() {
        let Core::Convex(hull) = part.shape.core() else { panic!("{part:?}") };
        for corner in hull.points() {
            inflation = inflation.max(distance(&body, *corner));
        }
        for _ in 0..400 {
            let few: Vec<Vec3> =
                (0..3).map(|i| hull.points()[(i * 7 + hull.points().len() / 2) % hull.points().len()]).collect();
            inflation = inflation.max(distance(&body, mix(hull.points()))).max(distance(&body, mix(&few)));
        }
    }
    (loss, inflation)
}

#[test]
fn decompositions_reach_no_farther_and_lose_no_more_than_their_figures_say() {
    let mut random = Random::new(51);
    for (vertices, triangles) in [corner_piece(), ring(24)] {
        let mesh = Arc::new(TriangleMesh::solid(vertices.clone(), triangles.clone()).unwrap());
        let pieces = Arc::new(decomposed(&vertices, &triangles).unwrap());
        let found @ Fit { inflation, loss, .. } = fit(&mesh, &pieces, &UNLIMITED);
        let (lost, inflated) = sampled(&mesh, &pieces, &mut random);
        let what = || format!("{} pieces, {found:?}, {lost}, {inflated}", pieces.parts().len());
        assert!(lost <= loss.upper + 1e-9 && inflated <= inflation.upper + 1e-9, "{}", what());
        // Samples come near the greatest, as do the lower ends.
        assert!(loss.lower <= lost + 0.01 && inflation.lower <= inflated + 0.05, "{}", what());
        assert!(loss.upper < 0.02 && inflation.upper < 0.1 && pieces.parts().len() > 1, "{}", what());
    }
}

#[test]
fn work_that_is_cut_short_leaves_upper_ends_that_hold() {
    let (vertices, triangles) = ring(24);
    let mesh = Arc::new(TriangleMesh::solid(vertices.clone(), triangles).unwrap());
    let hull = of_hulls(&[vertices]);
    let whole = fit(&mesh, &hull, &UNLIMITED);
    // The middle of the hole is inflated by its radius, but for the corners of the polygon.
    assert!(whole.inflation.lower > 0.69 && whole.inflation.upper < 0.701, "{whole:?}");
    for most_points in [0, 10, 100] {
        let cut = fit(&mesh, &hull, &FitGoal { most_points, ..UNLIMITED });
        assert!(
            cut.inflation.lower <= whole.inflation.upper && whole.inflation.lower <= cut.inflation.upper,
            "{cut:?}"
        );
        assert!(cut.points <= whole.points);
    }
    let stopped = fit(&mesh, &hull, &FitGoal { stop: &|| true, ..UNLIMITED });
    assert!(stopped.inflation.upper >= whole.inflation.lower && stopped.loss.lower == 0.0, "{stopped:?}");
}
