//! Many states in one request: parts, order, the first hit, the clock, and bad items.

use std::cell::Cell;
use std::sync::Arc;

use clearance::geometry::{Pose, Shape};
use clearance::query::{CheckStates, Context, Mode, Prepared, Refused, Verdict, Wants};
use clearance::robot::{LinkOptions, MeshRequest, ModelOptions, RobotModel};
use clearance::scene::{Edit, Epoch, NewBody, Scene};

use crate::workload::{scenes, states, ur5};

fn request(mode: Mode, wants: Wants) -> CheckStates {
    let positions = states().into_iter().filter(|(scene, _, _)| *scene == 3).flat_map(|(_, q, _)| q).collect();
    CheckStates { robot: "ur5".to_owned(), positions, mode, context: Context { wants, ..Context::default() } }
}

#[test]
fn the_answer_is_the_same_in_one_part_and_in_many() {
    let snapshot = &scenes(&ur5())[3];
    for mode in [Mode::All, Mode::StopAtFirst] {
        let request = request(mode, Wants::ALL);
        let prepared = Prepared::check_states(snapshot, &request).unwrap();
        let whole = prepared.answer(&|| false);
        for size in [1, 3, 7] {
            let starts = (0..prepared.len()).step_by(size);
            let parts: Vec<_> = starts.map(|s| prepared.run(s..(s + size).min(prepared.len()), &|| false)).collect();
            assert_eq!(prepared.join(parts), whole, "parts of {size}");
        }
    }
}

#[test]
fn stop_at_first_says_which_state_it_was() {
    let snapshot = &scenes(&ur5())[3];
    let all_request = request(Mode::All, Wants::VERDICT);
    let all = Prepared::check_states(snapshot, &all_request).unwrap().answer(&|| false);
    let first_request = request(Mode::StopAtFirst, Wants::VERDICT);
    let first = Prepared::check_states(snapshot, &first_request).unwrap().answer(&|| false);
    let hit = all.items.iter().position(|item| item.verdict == Verdict::Collision).unwrap();
    assert!(hit > 0 && hit + 1 < all.items.len(), "the workload has a hit in the middle");
    assert_eq!((all.stopped_at, first.stopped_at), (None, Some(hit)));
    assert_eq!(first.items[..=hit], all.items[..=hit]);
    assert!(first.items[hit + 1..].iter().all(|item| item.verdict == Verdict::NotRun));
}

#[test]
fn when_time_runs_out_the_rest_is_not_run() {
    let snapshot = &scenes(&ur5())[3];
    let request = request(Mode::All, Wants::VERDICT);
    let prepared = Prepared::check_states(snapshot, &request).unwrap();
    let asked = Cell::new(0);
    let stop = || {
        asked.set(asked.get() + 1);
        asked.get() > 40
    };
    let cut = prepared.answer(&stop);
    let whole = prepared.answer(&|| false);
    assert!(cut.out_of_time && !whole.out_of_time);
    let done = cut.items.iter().position(|item| item.verdict == Verdict::NotRun).unwrap();
    assert!(done > 0, "some were answered before");
    assert_eq!(cut.items[..done], whole.items[..done]);
    assert!(cut.items[done..].iter().all(|item| item.verdict == Verdict::NotRun));
}

#[test]
fn bad_numbers_are_refused_by_item_and_field() {
    let snapshot = &scenes(&ur5())[3];
    let mut bad = request(Mode::All, Wants::VERDICT);
    bad.positions[7] = f64::NAN;
    let answer = Prepared::check_states(snapshot, &bad).unwrap().answer(&|| false);
    assert_eq!(answer.items[1].verdict, Verdict::InvalidInput);
    let problem = answer.items[1].problem.as_deref().unwrap();
    assert!(problem.contains("states[1]") && problem.contains("shoulder_lift_joint"), "{problem}");
    assert_ne!(answer.items[2].verdict, Verdict::InvalidInput);

    bad.positions.pop();
    let refused = |request: &CheckStates| Prepared::check_states(snapshot, request).err().unwrap();
    assert!(matches!(refused(&bad), Refused::Invalid { field, .. } if field == "positions"));
    let unknown = CheckStates { robot: "ur6".to_owned(), ..request(Mode::All, Wants::VERDICT) };
    assert!(matches!(refused(&unknown), Refused::NotFound { what: "robot", .. }));
    for (margin, cut_off) in [(f64::NAN, None), (-1.0, None), (0.0, Some(f64::INFINITY)), (0.0, Some(-0.5))] {
        let context = Context { margin, cut_off, ..Context::default() };
        let request = CheckStates { context, ..request(Mode::All, Wants::VERDICT) };
        assert!(matches!(refused(&request), Refused::Invalid { field, .. } if field.starts_with("context.")));
    }
}

#[test]
fn the_first_hit_is_not_told_across_a_gap_that_time_left() {
    let snapshot = &scenes(&ur5())[3];
    let request = request(Mode::StopAtFirst, Wants::VERDICT);
    let prepared = Prepared::check_states(snapshot, &request).unwrap();
    let whole = prepared.answer(&|| false);
    let hit = whole.stopped_at.unwrap();
    assert!(hit >= 2);
    // The first part runs out of time at once, the second finds the hit.
    let parts = [prepared.run(0..2, &|| true), prepared.run(2..prepared.len(), &|| false)];
    let answer = prepared.join(parts);
    assert!(answer.out_of_time && answer.stopped_at.is_none());
    assert!(answer.items.iter().all(|item| item.verdict == Verdict::NotRun));
}

#[test]
fn a_robot_that_cannot_move_has_one_state() {
    let post = r#"<robot name="post"><link name="post"><collision><geometry><sphere radius="0.2"/></geometry></collision></link></robot>"#;
    let mut no_meshes = |_: &MeshRequest| Err("none".to_owned());
    let model =
        RobotModel::from_urdf(post, None, &mut no_meshes, &ModelOptions::uniform(LinkOptions::default())).unwrap();
    let mut scene = Scene::new(Epoch(1));
    let base = Pose::identity();
    let ball = NewBody::new("ball", Arc::new(Shape::sphere(0.2).unwrap()), base);
    let robot = Edit::AddRobot { name: "post".to_owned(), model: Arc::new(model), base };
    scene.apply(&[robot, Edit::AddBody(ball)], None).unwrap();
    let request =
        CheckStates { robot: "post".to_owned(), positions: Vec::new(), mode: Mode::All, context: Context::default() };
    let snapshot = scene.snapshot();
    let answer = Prepared::check_states(&snapshot, &request).unwrap().answer(&|| false);
    assert_eq!(answer.items.iter().map(|item| item.verdict).collect::<Vec<_>>(), [Verdict::Collision]);
}
