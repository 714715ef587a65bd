//! Many pairs in one call, worked off kind by kind.
//!
//! Oracle: the same pairs asked one by one.

use std::sync::Arc;

use clearance::geometry::{Compound, Part, Placement, Shape, TriangleMesh, Vec3};
use clearance::narrow_phase::{
    Accuracy, Depth, Goal, NoSeparation, PairQuestion, Separation, Solver, separation, separations,
};

use crate::samples::{Random, at, convex_shapes};

/// One shape of every kind.
fn shapes() -> Vec<Shape> {
    let v = Vec3::new;
    let mut shapes = convex_shapes();
    let corners = vec![v(0.0, 0.0, 0.0), v(0.6, 0.0, 0.0), v(0.0, 0.5, 0.0), v(0.0, 0.0, 0.4)];
    let mesh = TriangleMesh::surface(corners, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]).unwrap();
    let mut random = Random::new(3);
    let part = |shape: &Shape, random: &mut Random| Part { shape: shape.clone(), pose: random.pose(0.3) };
    let parts = vec![part(&shapes[2], &mut random), part(&shapes[7], &mut random)];
    shapes.push(Shape::half_space(v(0.1, 0.2, 1.0), -0.3).unwrap());
    shapes.push(Shape::plane(v(1.0, 0.2, 0.3), 0.1).unwrap());
    shapes.push(Shape::mesh(Arc::new(mesh)));
    shapes.push(Shape::compound(Arc::new(Compound::new(parts).unwrap())));
    shapes
}

/// Different for neighbours, so that an answer to another pair's goal is noticed.
fn goal(number: usize) -> Goal<'static> {
    let depth = [Depth::Verdict, Depth::Distance, Depth::Penetration][number % 3];
    let accuracy = Accuracy { relative: [1e-3, 1e-9][number % 2], absolute: 0.0 };
    let solver = if number.is_multiple_of(5) { Solver::Qp } else { Solver::Default };
    Goal { depth, accuracy, solver, margin: 0.01 * (number % 4) as f64, ..Goal::penetration() }
}

/// The answers in the order of the pairs, and the order in which they came.
fn asked_together(pairs: &[PairQuestion]) -> (Vec<Result<Separation, NoSeparation>>, Vec<usize>) {
    let mut answers = vec![None; pairs.len()];
    let mut order = Vec::new();
    separations(pairs, |index, answer| {
        assert!(answers[index].replace(answer).is_none(), "pair {index} came twice");
        order.push(index);
    });
    (answers.into_iter().map(|answer| answer.expect("every pair comes")).collect(), order)
}

#[test]
fn a_batch_has_the_bytes_of_its_pairs_asked_one_by_one() {
    let shapes = shapes();
    let mut random = Random::new(41);
    let mut kinds: Vec<(usize, usize)> =
        (0..shapes.len()).flat_map(|a| (0..shapes.len()).map(move |b| (a, b))).flat_map(|pair| [pair; 3]).collect();
    (1..kinds.len()).rev().for_each(|i| kinds.swap(i, random.index(i + 1)));
    let places: Vec<[Placement; 2]> =
        kinds.iter().map(|_| [random.pose(0.6).placement(), random.pose(0.6).placement()]).collect();
    let pairs: Vec<PairQuestion> = kinds
        .iter()
        .zip(&places)
        .enumerate()
        .map(|(i, (&(a, b), [at_a, at_b]))| PairQuestion { a: &shapes[a], b: &shapes[b], at_a, at_b, goal: goal(i) })
        .collect();
    assert!(pairs.len() > 3 * 256, "several windows, the last of them not full");
    let (mut unbounded, mut unclaimed, mut answered) = (0, 0, 0);
    for (together, pair) in asked_together(&pairs).0.iter().zip(&pairs) {
        let alone = separation(pair.a, pair.b, pair.at_a, pair.at_b, &pair.goal);
        // Debug tells 0 from -0, and one NaN is like another.
        assert_eq!(format!("{together:?}"), format!("{alone:?}"), "{} and {}", pair.a.kind(), pair.b.kind());
        match alone {
            Ok(_) => answered += 1,
            Err(NoSeparation::Unbounded { .. } | NoSeparation::Empty { .. }) => unbounded += 1,
            Err(NoSeparation::Unclaimed(_)) => unclaimed += 1,
        }
    }
    assert!(answered > 500 && unbounded > 5 && unclaimed > 50, "{answered}, {unbounded}, {unclaimed}");
}

#[test]
fn an_empty_batch_has_no_answers() {
    separations(&[], |index, _| panic!("there is no pair {index}"));
}

#[test]
fn the_work_goes_kind_by_kind_and_equal_kinds_keep_their_order() {
    let (ball, cuboid) = (Shape::sphere(0.1).unwrap(), Shape::cuboid(Vec3::repeat(0.2)).unwrap());
    let (here, there) = (at(0.0, 0.0, 0.0), at(1.0, 0.0, 0.0));
    let goal = Goal::verdict();
    let pairs: Vec<PairQuestion> = (0..300)
        .map(|i| {
            let (a, b) = [(&ball, &ball), (&cuboid, &ball), (&ball, &cuboid)][i % 3];
            PairQuestion { a, b, at_a: &here, at_b: &there, goal }
        })
        .collect();
    let order = asked_together(&pairs).1;
    // 256 pairs are put in order at a time.
    for window in [&order[..256], &order[256..]] {
        let runs: Vec<&[usize]> = window.chunk_by(|one, next| one % 3 == next % 3).collect();
        assert_eq!(runs.len(), 3, "three pairs of kinds, each in one run");
        assert!(runs.iter().all(|run| run.is_sorted()));
    }
}
