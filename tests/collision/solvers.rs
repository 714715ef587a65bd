//! Every solver against every other on random pairs of all kinds that it claims.
//!
//! Oracle: each bracket is proved by its own solver, so the brackets of one pair all hold the same number and have a point in
//! common, and no verdict contradicts another. That cannot show an error that all solvers share; those have oracles of
//! their own elsewhere.

use clearance::geometry::{Core, Placement, Pose, Quaternion, Shape, Vec3};
use clearance::narrow_phase::{Depth, Goal, NoSeparation, Separation, Solver, Termination, separation};

use crate::samples::{Random, at, convex_shapes};

fn asked(solver: Solver, depth: Depth) -> Goal<'static> {
    Goal { solver, depth, ..Goal::penetration() }
}

/// What the solvers that claim the pair say of it.
fn answers(a: &Shape, b: &Shape, at_a: &Placement, at_b: &Placement, depth: Depth) -> Vec<(Solver, Separation)> {
    let answer = |solver: Solver| match separation(a, b, at_a, at_b, &asked(solver, depth)) {
        Ok(found) => Some((solver, found)),
        Err(NoSeparation::Unclaimed(_)) => None,
        Err(other) => panic!("{other}"),
    };
    Solver::ALL.into_iter().filter_map(answer).collect()
}

fn assert_agree(answers: &[(Solver, Separation)], a: &Shape, b: &Shape) {
    let lower = answers.iter().map(|(_, s)| s.bracket.lower).fold(f64::NEG_INFINITY, f64::max);
    let upper = answers.iter().map(|(_, s)| s.bracket.upper).fold(f64::INFINITY, f64::min);
    let all = || answers.iter().map(|(s, found)| format!("{s}: {found:?}\n")).collect::<String>();
    assert!(lower <= upper, "{} and {}: no number is in all brackets\n{}", a.kind(), b.kind(), all());
    for (solver, found) in answers {
        assert!(
            (found.bracket.lower..=found.bracket.upper).contains(&found.signed_distance),
            "{solver}: {found:?} estimates outside of its bracket"
        );
    }
}

#[test]
fn solvers_agree_on_random_pairs_of_every_kind() {
    let mut random = Random::new(41);
    let shapes = convex_shapes();
    let mut claimed = [0; Solver::ALL.len()];
    let (mut apart, mut deep, mut narrow) = (0, 0, [0; Solver::ALL.len()]);
    for a in &shapes {
        for b in &shapes {
            for depth in [Depth::Penetration, Depth::Distance, Depth::Verdict] {
                let (at_a, at_b) = (random.pose(0.5).placement(), random.pose(0.5).placement());
                let answers = answers(a, b, &at_a, &at_b, depth);
                assert_agree(&answers, a, b);
                match answers[0].1.signed_distance {
                    d if d > 0.01 => apart += 1,
                    d if d < -0.01 => deep += 1,
                    _ => (),
                }
                for (solver, found) in answers {
                    let place = Solver::ALL.iter().position(|s| *s == solver).unwrap();
                    claimed[place] += 1;
                    narrow[place] += usize::from(found.termination != Termination::IterationLimit);
                }
            }
        }
    }
    assert!(apart > 50 && deep > 50, "{apart} apart, {deep} deep");
    for (solver, (claimed, narrow)) in Solver::ALL.into_iter().zip(claimed.into_iter().zip(narrow)) {
        assert!(claimed >= 12, "{solver} claimed {claimed} pairs");
        // Frank-Wolfe and the quadratic program may end with a wide bracket, but not as a rule.
        let least = match solver {
            Solver::FrankWolfe | Solver::Qp => claimed / 2,
            Solver::Default
            | Solver::Gjk
            | Solver::GjkPolyak
            | Solver::GjkNesterov
            | Solver::GjkNesterovNormalised
            | Solver::Sat
            | Solver::Exact => claimed - claimed / 50,
        };
        assert!(narrow >= least, "{solver}: only {narrow} of {claimed} brackets are as narrow as asked");
    }
}

/// Boxes where separating axes are hardest: turned by next to nothing, by right angles, of no thickness, of one size.
#[test]
fn axes_of_boxes_agree_with_gjk_and_epa_however_nearly_parallel_the_edges_are() {
    let mut random = Random::new(42);
    let (mut apart, mut overlapping, mut measured) = (0, 0, 0);
    for round in 0..600 {
        let size = |random: &mut Random| [0.0, 0.01, 0.3, 0.3, 0.5, 1.0][random.between(0.0, 6.0) as usize];
        let mut extents = || Vec3::new(size(&mut random), size(&mut random), size(&mut random));
        let (a, b) = (Shape::cuboid(extents()).unwrap(), Shape::cuboid(extents()).unwrap());
        let angle = [0.0, 1e-16, 1e-12, 1e-8, 1e-5, 1e-2, 1.0][round % 7];
        let turn = Quaternion::about_axis(random.direction(), angle * random.between(0.5, 1.0));
        let quarter = Quaternion::about_axis(Vec3::ith(round % 3, 1.0), std::f64::consts::FRAC_PI_2);
        let rotation = if round % 2 == 0 { turn } else { turn.compose(quarter) };
        let at_a = random.pose(1.0);
        let at_b = at_a.compose(&Pose::new(random.vector(0.7), rotation).unwrap()).placement();
        let at_a = at_a.placement();
        let by_axes = separation(&a, &b, &at_a, &at_b, &asked(Solver::Sat, Depth::Penetration)).unwrap();
        let by_gjk = separation(&a, &b, &at_a, &at_b, &asked(Solver::Gjk, Depth::Penetration)).unwrap();
        assert_agree(&[(Solver::Sat, by_axes), (Solver::Gjk, by_gjk)], &a, &b);
        if by_axes.bracket.lower > 0.0 {
            apart += 1;
        } else if by_axes.bracket.upper < 0.0 {
            overlapping += 1;
            measured += usize::from(by_axes.cost.epa_iterations == 0);
            let width = by_axes.bracket.upper - by_axes.bracket.lower;
            assert!(width < 1e-12, "{by_axes:?}");
            // The witness points belong to the boxes and are as far apart as the depth.
            for (shape, at, point) in [(&a, &at_a, by_axes.point_on_a), (&b, &at_b, by_axes.point_on_b)] {
                let Core::Cuboid { half_extents } = shape.core() else { unreachable!() };
                let local = at.direction_into(point - at.translation);
                assert!((local.abs() - half_extents).max() < 1e-12, "{local:?} in {half_extents:?}, {by_axes:?}");
            }
        }
    }
    assert!(apart > 100 && overlapping > 100 && measured == overlapping, "{apart}, {overlapping}, {measured}");
}

/// Hulls, triangles and segments with edges and faces in common directions, turned by next to nothing.
#[test]
fn axes_of_small_polytopes_agree_with_gjk_and_epa() {
    let mut random = Random::new(43);
    let corners = |random: &mut Random, count: usize, size: f64| -> Vec<Vec3> {
        (0..count).map(|_| random.direction() * size).collect()
    };
    let wedge: Vec<Vec3> = [(0.0, 0.0), (1.0, 0.0), (0.3, 0.6)]
        .iter()
        .flat_map(|&(x, y)| [-0.4, 0.4].map(|z| Vec3::new(x - 0.4, y - 0.2, z)))
        .collect();
    let (x, y, z) = (Vec3::x(), Vec3::y(), Vec3::z());
    let mut shapes = vec![
        Shape::cuboid(Vec3::new(0.4, 0.3, 0.5)).unwrap(),
        Shape::convex(&wedge).unwrap(),
        Shape::convex(&[x, -x, y, -y, z, -z].map(|v| v * 0.6)).unwrap(),
        Shape::triangle(x * 0.8, y * 0.5 - x * 0.3, -y * 0.7).unwrap(),
        Shape::segment(z * 0.7, -z * 0.7).unwrap(),
        Shape::segment(x * 0.7, -y * 0.2).unwrap().swept(0.1).unwrap(),
        Shape::capsule(0.2, 0.4).unwrap(),
        Shape::sphere(0.3).unwrap(),
    ];
    for count in [4, 12, 30, 60] {
        shapes.push(Shape::convex(&corners(&mut random, count, 0.6)).unwrap());
    }
    let (mut apart, mut overlapping, mut by_axes_alone) = (0, 0, 0);
    for a in &shapes {
        for b in &shapes {
            for angle in [0.0, 1e-15, 1e-13, 1e-9, 1e-4, 1.0] {
                let turn = Quaternion::about_axis(random.direction(), angle);
                let at_a = random.pose(1.0);
                let at_b = at_a.compose(&Pose::new(random.vector(0.5), turn).unwrap()).placement();
                let at_a = at_a.placement();
                let by_axes = separation(a, b, &at_a, &at_b, &asked(Solver::Sat, Depth::Penetration)).unwrap();
                let by_gjk = separation(a, b, &at_a, &at_b, &asked(Solver::Gjk, Depth::Penetration)).unwrap();
                assert_agree(&[(Solver::Sat, by_axes), (Solver::Gjk, by_gjk)], a, b);
                if by_axes.bracket.lower > 0.0 {
                    apart += 1;
                } else if by_axes.bracket.upper < -a.swept_radius() - b.swept_radius() {
                    overlapping += 1;
                    let alone = by_axes.cost.gjk_iterations + by_axes.cost.epa_iterations == 0;
                    by_axes_alone += usize::from(alone);
                    let width = by_axes.bracket.upper - by_axes.bracket.lower;
                    assert!(width < 1e-8, "{a:?} {b:?} {by_axes:?}");
                    if !alone {
                        continue;
                    }
                    // The witness points belong to the shapes.
                    for (shape, at, point) in [(a, &at_a, by_axes.point_on_a), (b, &at_b, by_axes.point_on_b)] {
                        let probe = Placement { translation: point, ..*at };
                        let inside = separation(shape, &Shape::point(), at, &probe, &Goal::penetration()).unwrap();
                        assert!(inside.bracket.lower < 1e-9, "{inside:?} of {shape:?}: {by_axes:?}");
                    }
                }
            }
        }
    }
    assert!(apart > 100 && overlapping > 300, "{apart} apart, {overlapping} overlapping");
    assert!(by_axes_alone * 10 > overlapping * 9, "{by_axes_alone} of {overlapping} by axes alone");
}

#[test]
fn a_solver_that_does_not_take_a_shape_says_which_and_why() {
    let (cone, hull) = (Shape::cone(0.2, 0.3).unwrap(), Shape::point());
    for solver in [Solver::Sat, Solver::Qp, Solver::Exact] {
        let refused = separation(&cone, &hull, &at(0.0, 0.0, 0.0), &at(1.0, 0.0, 0.0), &asked(solver, Depth::Distance));
        let Err(NoSeparation::Unclaimed(unclaimed)) = refused else { panic!("{refused:?}") };
        let text = unclaimed.to_string();
        assert!(text.contains(solver.name()) && text.contains("cone"), "{text}");
    }
}

/// No closed form stands in for a solver that was asked for by name.
#[test]
fn a_solver_that_is_named_does_the_work() {
    let capsule = Shape::capsule(0.2, 0.5).unwrap();
    let mut random = Random::new(44);
    for solver in Solver::ALL.into_iter().filter(|solver| *solver != Solver::Default) {
        let (at_a, at_b) = (random.pose(1.0).placement(), random.pose(1.0).placement());
        let found = separation(&capsule, &capsule, &at_a, &at_b, &asked(solver, Depth::Distance)).unwrap();
        assert!(found.cost.supports > 0 && found.termination != Termination::ClosedForm, "{solver}: {found:?}");
    }
}

#[test]
fn names_of_solvers_lead_back_to_them() {
    for solver in Solver::ALL {
        assert_eq!(Solver::named(solver.name()), Some(solver));
    }
    assert_eq!(Solver::named("simplex"), None);
}
