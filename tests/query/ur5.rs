//! 400 states of a real arm in real scenes. Oracle: `truth.jsonl`, deciding pairs solved in 400-bit arithmetic; trusted to
//! 1e-12 m here, which leaves room for the rounding of forward kinematics.

use std::sync::Arc;

use clearance::query::{CheckStates, Context, ItemAnswer, Mode, PairAnswer, Prepared, Side, Verdict, Wants};
use clearance::robot::RobotModel;
use clearance::scene::Snapshot;

use crate::workload::{scenes, states, ur5};

fn ask(snapshot: &Snapshot, positions: &[f64], wants: Wants) -> ItemAnswer {
    let context = Context { wants, ..Context::default() };
    let request = CheckStates { robot: "ur5".to_owned(), positions: positions.to_vec(), mode: Mode::All, context };
    Prepared::check_states(snapshot, &request).unwrap().answer(&|| false).items.remove(0)
}

fn names(model: &RobotModel, snapshot: &Snapshot, pair: &PairAnswer) -> [String; 2] {
    [&pair.a, &pair.b].map(|side| match side {
        Side::Link { link, .. } => model.links()[*link as usize].name.clone(),
        Side::Body { id, .. } => snapshot.body(*id).unwrap().name.to_string(),
        Side::Query { .. } => unreachable!("no bare shape was asked about"),
    })
}

fn check_minimum(found: Option<&PairAnswer>, truth: &serde_json::Value, what: &str) {
    let expected = truth[what].as_f64().unwrap();
    let found = found.unwrap();
    assert!((found.signed_distance - expected).abs() < 1e-9, "{what}: {found:?}\n{truth}");
    let bracket = found.bracket;
    assert!(bracket.lower - 1e-12 <= expected && expected <= bracket.upper + 1e-12, "{what}: {found:?}\n{truth}");
}

#[test]
fn verdicts_minima_and_pairs_are_those_of_the_truth() {
    let model = ur5();
    let scenes: Vec<Arc<Snapshot>> = scenes(&model);
    let (mut hits, mut free, mut pairs_compared) = (0, 0, 0);
    for (scene, positions, truth) in states() {
        let snapshot = &scenes[scene];
        let expected = if truth["in_collision"].as_bool().unwrap() { Verdict::Collision } else { Verdict::Free };
        for wants in [Wants::VERDICT, Wants { distance: true, ..Wants::VERDICT }, Wants::ALL] {
            assert_eq!(ask(snapshot, &positions, wants).verdict, expected, "{wants:?} {truth}");
        }
        if expected == Verdict::Collision {
            hits += 1
        } else {
            free += 1
        }
        let answer = ask(snapshot, &positions, Wants { depth: true, ..Wants::VERDICT });
        check_minimum(answer.nearest.as_ref(), &truth, "min_distance");
        check_minimum(answer.nearest_self.as_ref(), &truth, "self_min");
        check_minimum(answer.nearest_scene.as_ref(), &truth, "env_min");
        // Where the two minima are well apart there is one deciding pair, and it has to be the truth's.
        let gap = truth["self_min"].as_f64().unwrap() - truth["env_min"].as_f64().unwrap();
        if gap.abs() > 1e-6 {
            let mut found = names(&model, snapshot, answer.nearest.as_ref().unwrap());
            found.sort();
            let mut expected = [0, 1].map(|i| truth["pair"][i].as_str().unwrap().to_owned());
            expected.sort();
            pairs_compared += usize::from(found == expected);
        }
    }
    assert!(hits > 100 && free > 200, "{hits} in collision, {free} free");
    assert!(pairs_compared > 380, "only {pairs_compared} deciding pairs agree");
}

#[test]
fn all_colliding_pairs_are_listed_in_order() {
    let model = ur5();
    let scenes = scenes(&model);
    let mut total = 0;
    for (scene, positions, truth) in states() {
        let answer = ask(&scenes[scene], &positions, Wants { pairs: true, ..Wants::VERDICT });
        let sides: Vec<_> = answer.pairs.iter().map(|p| (&p.a, &p.b)).collect();
        assert!(sides.windows(2).all(|w| w[0] < w[1]), "{sides:?}");
        let colliding = answer.pairs.iter().filter(|p| p.verdict == Verdict::Collision).count() as u64;
        assert_eq!(colliding, truth["colliding_pairs"].as_u64().unwrap(), "{truth}");
        total += colliding;
    }
    assert!(total > 200, "{total} colliding pairs");
}
