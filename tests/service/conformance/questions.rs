//! What a question can want.

use clearance::limits::Limits;
use clearance::transports::wire::v1;

use super::through_every_door;
use crate::support::door::Door;
use crate::support::messages::*;

through_every_door!(
    points_and_normal_are_in_the_world,
    a_pair_within_the_margin_is_margin,
    nothing_within_the_cut_off_has_no_bracket,
    pairs_are_listed_in_order_and_truncated,
    left_out_bodies_are_not_looked_at,
    subjects_are_answered_one_by_one,
    every_solver_brackets_the_same_distance,
    a_pair_that_the_solver_does_not_take_is_invalid_and_says_why,
);

fn limits() -> Limits {
    Limits::default()
}

/// Balls of radius 0.5 whose centres are `x` metres along x.
async fn balls(door: &impl Door, centres: &[f64]) -> v1::ApplyResponse {
    door.create_scene(SCENE).await.unwrap();
    let ball = |(i, x): (usize, &f64)| add(&format!("ball{i}"), sphere(0.5), at(*x, 0.0, 0.0));
    door.apply(apply(centres.iter().enumerate().map(ball).collect())).await.unwrap()
}

fn near(actual: Option<v1::Vec3>, expected: v1::Vec3) -> bool {
    let v = actual.unwrap();
    (v.x - expected.x).abs().max((v.y - expected.y).abs()).max((v.z - expected.z).abs()) < 1e-9
}

async fn points_and_normal_are_in_the_world(door: &impl Door) {
    balls(door, &[0.0, 3.0]).await;
    let mut question = distance(vec![body(named("ball1"))]);
    question.context.as_mut().unwrap().wants = Some(v1::Wants { witness: true, ..v1::Wants::default() });
    let answer = door.distance(question).await.unwrap();
    let pair = answer.items[0].nearest.as_ref().unwrap();
    let witness = pair.witness.unwrap();
    // Side A is the lower id, whichever was asked about.
    assert!(near(witness.point_on_a, vec3(0.5, 0.0, 0.0)), "{witness:?}");
    assert!(near(witness.point_on_b, vec3(2.5, 0.0, 0.0)), "{witness:?}");
    assert!(near(witness.normal, vec3(1.0, 0.0, 0.0)), "{witness:?}");
}

async fn a_pair_within_the_margin_is_margin(door: &impl Door) {
    balls(door, &[0.0, 1.1]).await;
    for (margin, verdict) in [(0.05, v1::Verdict::Free), (0.2, v1::Verdict::Margin)] {
        let mut question = collide(vec![all_pairs()]);
        question.context.as_mut().unwrap().margin = margin;
        assert_eq!(verdicts(&door.collide(question).await.unwrap()), [verdict]);
    }
    let party = |name| Some(v1::Party { kind: Some(v1::party::Kind::Body(named(name))) });
    let entry = v1::SetPairMargin { a: party("ball0"), b: party("ball1"), margin: Some(0.2) };
    door.apply(apply(vec![edit(v1::edit::Kind::SetPairMargin(entry))])).await.unwrap();
    assert_eq!(verdicts(&door.collide(collide(vec![all_pairs()])).await.unwrap()), [v1::Verdict::Margin]);
}

async fn nothing_within_the_cut_off_has_no_bracket(door: &impl Door) {
    balls(door, &[0.0, 5.0]).await;
    let mut question = distance(vec![all_pairs()]);
    question.context.as_mut().unwrap().cut_off = Some(1.0);
    let answer = door.distance(question).await.unwrap();
    assert_eq!(verdicts(&answer), [v1::Verdict::Free]);
    assert!(answer.items[0].nearest.is_none());
}

async fn pairs_are_listed_in_order_and_truncated(door: &impl Door) {
    let made = balls(door, &[0.0, 0.9, 1.8, 2.7]).await;
    let sides = |answer: &v1::Answer| -> Vec<(u64, u64)> {
        let id = |side: &Option<v1::Side>| match side.as_ref().unwrap().kind {
            Some(v1::side::Kind::Body(v1::BodySide { id, .. })) => id,
            other => panic!("{other:?}"),
        };
        answer.items[0].pairs.iter().map(|pair| (id(&pair.a), id(&pair.b))).collect()
    };
    let ids = &made.added;
    let answer = door.collide(collide(vec![all_pairs()])).await.unwrap();
    assert_eq!(sides(&answer), [(ids[0], ids[1]), (ids[1], ids[2]), (ids[2], ids[3])]);
    assert!(!answer.items[0].truncated);
    let mut question = collide(vec![all_pairs()]);
    question.context.as_mut().unwrap().max_pairs = Some(2);
    let answer = door.collide(question).await.unwrap();
    assert_eq!(sides(&answer), [(ids[0], ids[1]), (ids[1], ids[2])]);
    assert!(answer.items[0].truncated);
}

async fn left_out_bodies_are_not_looked_at(door: &impl Door) {
    balls(door, &[0.0, 0.9]).await;
    let groups = v1::SetGroups { body: Some(named("ball0")), groups: vec!["fixtures".to_owned()] };
    door.apply(apply(vec![edit(v1::edit::Kind::SetGroups(groups))])).await.unwrap();
    let probe = placed(sphere(0.1), at(0.9, 0.0, 0.0));
    for (filter, verdict) in [
        (v1::Filter::default(), v1::Verdict::Collision),
        (v1::Filter { ignore: vec![named("ball1")], ..v1::Filter::default() }, v1::Verdict::Free),
        (v1::Filter { groups: vec!["fixtures".to_owned()], ..v1::Filter::default() }, v1::Verdict::Free),
        (v1::Filter { layers: Some(0), ..v1::Filter::default() }, v1::Verdict::Free),
    ] {
        let mut question = collide(vec![probe.clone()]);
        question.context.as_mut().unwrap().filter = Some(filter.clone());
        assert_eq!(verdicts(&door.collide(question).await.unwrap()), [verdict], "{filter:?}");
    }
}

async fn subjects_are_answered_one_by_one(door: &impl Door) {
    balls(door, &[0.0, 3.0]).await;
    let items = (0..40).map(|i| placed(sphere(0.1), at(0.05 + 0.1 * f64::from(i), 0.0, 0.0))).collect();
    let answer = door.collide(collide(items)).await.unwrap();
    for (i, verdict) in verdicts(&answer).into_iter().enumerate() {
        // Apart from both balls by more than 0.6 m.
        let free = (6..=23).contains(&i) || i >= 36;
        assert_eq!(verdict == v1::Verdict::Free, free, "item {i}");
    }
}

const SOLVERS: [v1::Solver; 10] = [
    v1::Solver::Unspecified,
    v1::Solver::Default,
    v1::Solver::FrankWolfe,
    v1::Solver::Gjk,
    v1::Solver::GjkPolyak,
    v1::Solver::GjkNesterov,
    v1::Solver::GjkNesterovNormalised,
    v1::Solver::Sat,
    v1::Solver::Qp,
    v1::Solver::Exact,
];

async fn every_solver_brackets_the_same_distance(door: &impl Door) {
    door.create_scene(SCENE).await.unwrap();
    let edits =
        vec![add("a", cuboid(0.5, 0.5, 0.5), at(0.0, 0.0, 0.0)), add("b", cuboid(0.5, 0.5, 0.5), at(3.0, 0.25, 0.0))];
    door.apply(apply(edits)).await.unwrap();
    for solver in SOLVERS {
        let mut question = distance(vec![all_pairs()]);
        question.context.as_mut().unwrap().solver = solver.into();
        let answer = door.distance(question).await.unwrap();
        let bracket = answer.items[0].nearest.as_ref().unwrap().bracket.unwrap();
        assert!(bracket.lower <= 2.0 && 2.0 <= bracket.upper, "{solver:?}: {bracket:?}");
    }
}

async fn a_pair_that_the_solver_does_not_take_is_invalid_and_says_why(door: &impl Door) {
    balls(door, &[0.0, 3.0]).await;
    let cylinder = shape(v1::shape::Core::Cylinder(v1::Cylinder { radius: 0.1, half_length: 0.1 }));
    // Items that meet no such pair are answered.
    let items = vec![placed(cuboid(0.1, 0.1, 0.1), at(3.0, 0.0, 0.0)), placed(cylinder, at(3.0, 0.0, 0.0))];
    let mut question = collide(items);
    question.context.as_mut().unwrap().solver = v1::Solver::Qp.into();
    let answer = door.collide(question).await.unwrap();
    assert_eq!(verdicts(&answer), [v1::Verdict::Collision, v1::Verdict::InvalidInput]);
    let problem = &answer.items[1].problem;
    assert_eq!(
        problem,
        "context.solver: the solver qp does not take a cylinder and a sphere: a cylinder is no polytope"
    );
}
