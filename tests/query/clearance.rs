//! All pairs within a distance. Oracle: balls, whose distances are those of their centres less their radii; for the UR5 the
//! list that a margin of that size gives.

use std::sync::Arc;

use clearance::geometry::{Pose, Quaternion, Shape, Vec3};
use clearance::query::{
    CheckStates, Clearance, ClearanceOf, Context, ItemAnswer, Mode, PairQuery, Prepared, Refused, Side, Subject,
    Verdict, Wants,
};
use clearance::scene::{BodyId, Edit, Epoch, NewBody, Scene, Snapshot};

use crate::workload::{scenes, states, ur5};

const COUNT: usize = 60;

/// Fractional parts of multiples of irrational numbers fill a cube of 3 m evenly.
fn centre(i: usize) -> Vec3 {
    let along = |step: f64| 3.0 * (i as f64 * step).fract();
    Vec3::new(along(0.754_877_666_2), along(0.569_840_290_9), along(0.430_159_709_0))
}

fn radius(i: usize) -> f64 {
    0.1 + 0.05 * (i % 4) as f64
}

fn balls() -> Arc<Snapshot> {
    let ball = |i: usize| {
        let pose = Pose::new(centre(i), Quaternion::IDENTITY).unwrap();
        Edit::AddBody(NewBody::new(format!("ball {i}"), Arc::new(Shape::sphere(radius(i)).unwrap()), pose))
    };
    let mut scene = Scene::new(Epoch(1));
    scene.apply(&(0..COUNT).map(ball).collect::<Vec<_>>(), None).unwrap();
    scene.snapshot()
}

fn ask(snapshot: &Snapshot, subjects: ClearanceOf, within: f64) -> Vec<ItemAnswer> {
    Prepared::clearance(snapshot, &Clearance { subjects, within }).unwrap().answer(&|| false).items
}

fn pairs_of(items: Vec<Subject>, context: Context) -> ClearanceOf {
    ClearanceOf::Subjects(PairQuery { items, mode: Mode::All, context })
}

fn ids(item: &ItemAnswer) -> Vec<(u64, u64)> {
    let id = |side: &Side| match side {
        Side::Body { id, .. } => id.0,
        Side::Query { .. } => 0,
        Side::Link { .. } => panic!("no robot was asked about"),
    };
    item.pairs.iter().map(|pair| (id(&pair.a), id(&pair.b))).collect()
}

#[test]
fn every_pair_within_the_distance_has_its_row_and_its_bracket() {
    let snapshot = balls();
    let distance = |a: usize, b: usize| (centre(a) - centre(b)).norm() - radius(a) - radius(b);
    let mut rows = 0;
    for within in [0.0, 0.05, 0.3, 10.0] {
        let context =
            Context { max_pairs: 10_000, wants: Wants { witness: true, ..Wants::VERDICT }, ..Context::default() };
        let items = vec![Subject::All, Subject::Body(BodyId(7))];
        let answers = ask(&snapshot, pairs_of(items, context), within);
        let expected: Vec<(u64, u64)> = (0..COUNT)
            .flat_map(|a| (a + 1..COUNT).map(move |b| (a, b)))
            .filter(|&(a, b)| distance(a, b) <= within)
            .map(|(a, b)| (a as u64 + 1, b as u64 + 1))
            .collect();
        assert_eq!(ids(&answers[0]), expected, "within {within}");
        let of_one: Vec<(u64, u64)> = expected.iter().copied().filter(|(a, b)| *a == 7 || *b == 7).collect();
        assert_eq!(ids(&answers[1]), of_one);
        for (pair, (a, b)) in answers[0].pairs.iter().zip(&expected) {
            let truth = distance(*a as usize - 1, *b as usize - 1);
            assert!(pair.bracket.lower - 1e-12 <= truth && truth <= pair.bracket.upper + 1e-12, "{pair:?} {truth}");
            // Apart, every row is as narrow as was asked, not the nearest alone.
            assert!(truth <= 0.0 || pair.bracket.upper - pair.bracket.lower < 1e-8, "{pair:?}");
            assert!(pair.witness.is_some() || truth <= 0.0);
            rows += 1;
        }
    }
    assert!(rows > COUNT * (COUNT - 1) / 2, "{rows}");
}

#[test]
fn rows_are_cut_at_the_limit_and_that_is_told() {
    let snapshot = balls();
    let shape = Subject::Shape { shape: Shape::point(), pose: Pose::identity() };
    let all = ask(&snapshot, pairs_of(vec![shape.clone()], Context { max_pairs: COUNT, ..Context::default() }), 10.0);
    let some = ask(&snapshot, pairs_of(vec![shape], Context { max_pairs: 5, ..Context::default() }), 10.0);
    assert!(all[0].pairs.len() == COUNT && !all[0].truncated);
    assert!(some[0].truncated && some[0].pairs[..] == all[0].pairs[..5]);
    assert_eq!(some[0].nearest.as_ref().unwrap().b, all[0].nearest.as_ref().unwrap().b);
}

#[test]
fn rows_of_a_state_are_its_pairs_within_a_margin_of_that_size() {
    let snapshot = &scenes(&ur5())[3];
    let positions: Vec<f64> =
        states().into_iter().filter(|(scene, _, _)| *scene == 3).flat_map(|(_, q, _)| q).collect();
    let within = 0.1;
    let request = |margin: f64| CheckStates {
        robot: "ur5".to_owned(),
        positions: positions.clone(),
        mode: Mode::All,
        context: Context {
            margin,
            wants: Wants { pairs: true, ..Wants::VERDICT },
            max_pairs: 1000,
            ..Context::default()
        },
    };
    let rows = ask(snapshot, ClearanceOf::States(request(0.0)), within);
    let margins = request(within);
    let margins = Prepared::check_states(snapshot, &margins).unwrap().answer(&|| false).items;
    let sides = |item: &ItemAnswer| item.pairs.iter().map(|pair| (pair.a.clone(), pair.b.clone())).collect::<Vec<_>>();
    let (mut links, mut bodies) = (0, 0);
    for (row, margin) in rows.iter().zip(&margins) {
        assert_eq!(sides(row), sides(margin));
        // A margin does not make a row, nor the distance a margin.
        assert_eq!(row.verdict == Verdict::Collision, margin.verdict == Verdict::Collision);
        assert_ne!(row.verdict, Verdict::Margin);
        bodies += row.pairs.iter().filter(|pair| matches!(pair.b, Side::Body { .. })).count();
        links += row.pairs.iter().filter(|pair| matches!(pair.b, Side::Link { .. })).count();
    }
    assert!(links > 10 && bodies > 10, "{links} {bodies}");
}

#[test]
fn a_distance_that_is_none_is_refused() {
    let snapshot = balls();
    for within in [-1.0, f64::NAN, f64::INFINITY] {
        let question = Clearance { subjects: pairs_of(vec![Subject::All], Context::default()), within };
        let refused = Prepared::clearance(&snapshot, &question).err().unwrap();
        assert!(matches!(refused, Refused::Invalid { field, .. } if field == "within"));
    }
}
