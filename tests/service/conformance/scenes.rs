//! Scenes and changes of them.

use clearance::limits::Limits;
use clearance::transports::wire::v1;
use tonic::Code;

use super::through_every_door;
use crate::support::door::Door;
use crate::support::messages::*;

through_every_door!(
    removed_body_is_not_reported,
    moved_body_is_reported_where_it_is,
    refused_edit_changes_nothing,
    compare_and_set_lost_is_aborted,
    wrong_epoch_is_refused,
    repeated_change_with_its_key_is_made_once,
    deleted_scene_is_not_found,
    second_scene_of_a_name_is_refused,
    unknown_bodies_are_named,
    allowed_pair_is_not_reported,
    health_tells_memory_and_what_each_revision_wrote,
    contents_come_in_pages,
    broad_phase_is_chosen_with_the_scene_and_changes_no_answer,
);

fn limits() -> Limits {
    Limits::default()
}

async fn two_balls(door: &impl Door) -> v1::ApplyResponse {
    door.create_scene(SCENE).await.unwrap();
    let balls = vec![add("left", sphere(0.5), at(0.0, 0.0, 0.0)), add("right", sphere(0.5), at(0.8, 0.0, 0.0))];
    door.apply(apply(balls)).await.unwrap()
}

async fn removed_body_is_not_reported(door: &impl Door) {
    let made = two_balls(door).await;
    assert_eq!((made.revision, made.added.len()), (1, 2));
    let answer = door.collide(collide(vec![all_pairs()])).await.unwrap();
    assert_eq!(verdicts(&answer), [v1::Verdict::Collision]);
    assert_eq!((answer.epoch, answer.revision), (made.epoch, 1));
    door.apply(apply(vec![remove(numbered(made.added[1]))])).await.unwrap();
    let answer = door.collide(collide(vec![all_pairs()])).await.unwrap();
    assert_eq!(verdicts(&answer), [v1::Verdict::Free]);
    assert_eq!((answer.revision, answer.items[0].pairs.len()), (2, 0));
}

async fn moved_body_is_reported_where_it_is(door: &impl Door) {
    two_balls(door).await;
    let moved = door.apply(apply(vec![move_to(named("right"), at(3.0, 0.0, 0.0))])).await.unwrap();
    let answer = door.distance(distance(vec![body(named("left"))])).await.unwrap();
    assert_eq!(answer.revision, moved.revision);
    let bracket = answer.items[0].nearest.as_ref().unwrap().bracket.unwrap();
    assert!(bracket.lower <= 2.0 && 2.0 <= bracket.upper && bracket.upper - bracket.lower < 1e-8, "{bracket:?}");
}

async fn refused_edit_changes_nothing(door: &impl Door) {
    two_balls(door).await;
    let before = door
        .get_scene(v1::GetSceneRequest { scene: SCENE.to_owned(), ..v1::GetSceneRequest::default() })
        .await
        .unwrap();
    let edits = vec![add("third", sphere(0.1), at(9.0, 0.0, 0.0)), remove(named("left")), remove(named("nobody"))];
    let refusal = door.apply(apply(edits)).await.unwrap_err();
    assert_eq!((refusal.code, refusal.reason.as_str()), (Code::FailedPrecondition, "EDIT_REFUSED"));
    assert_eq!(refusal.field, "edits[2].body", "{refusal:?}");
    let after = door
        .get_scene(v1::GetSceneRequest { scene: SCENE.to_owned(), ..v1::GetSceneRequest::default() })
        .await
        .unwrap();
    assert_eq!(before, after);
    assert_eq!(after.bodies.iter().map(|body| body.name.as_str()).collect::<Vec<_>>(), ["left", "right"]);
}

async fn compare_and_set_lost_is_aborted(door: &impl Door) {
    two_balls(door).await;
    let expecting = |revision| v1::ApplyRequest {
        expected_revision: Some(revision),
        ..apply(vec![move_to(named("left"), at(0.0, 1.0, 0.0))])
    };
    let refusal = door.apply(expecting(0)).await.unwrap_err();
    assert_eq!((refusal.code, refusal.reason.as_str()), (Code::Aborted, "REVISION_MOVED_ON"));
    assert_eq!(door.apply(expecting(1)).await.unwrap().revision, 2);
}

async fn wrong_epoch_is_refused(door: &impl Door) {
    let made = two_balls(door).await;
    let asked = |epoch| v1::RevisionRule { epoch: Some(epoch), rule: None };
    let of_epoch = |epoch| v1::Context { revision: Some(asked(epoch)), ..context() };
    let question = |epoch| v1::CollideRequest { context: Some(of_epoch(epoch)), ..collide(vec![all_pairs()]) };
    let refusal = door.collide(question(made.epoch + 1)).await.unwrap_err();
    assert_eq!((refusal.code, refusal.reason.as_str()), (Code::FailedPrecondition, "WRONG_EPOCH"));
    assert!(door.collide(question(made.epoch)).await.is_ok());
    let change = v1::ApplyRequest { expected_epoch: Some(made.epoch + 1), ..apply(vec![remove(named("left"))]) };
    assert_eq!(door.apply(change).await.unwrap_err().reason, "WRONG_EPOCH");
}

async fn repeated_change_with_its_key_is_made_once(door: &impl Door) {
    two_balls(door).await;
    let change = v1::ApplyRequest {
        idempotency_key: "k1".to_owned(),
        expected_revision: Some(1),
        ..apply(vec![add("third", sphere(0.1), at(9.0, 0.0, 0.0))])
    };
    let first = door.apply(change.clone()).await.unwrap();
    assert_eq!(door.apply(change.clone()).await.unwrap(), first);
    let other = v1::ApplyRequest { edits: vec![remove(named("left"))], ..change };
    let refusal = door.apply(other).await.unwrap_err();
    assert_eq!((refusal.code, refusal.reason.as_str()), (Code::InvalidArgument, "KEY_REUSED"));
}

async fn deleted_scene_is_not_found(door: &impl Door) {
    let made = two_balls(door).await;
    assert_eq!(door.delete_scene(SCENE).await.unwrap().bodies, 2);
    for refusal in [
        door.delete_scene(SCENE).await.unwrap_err(),
        door.collide(collide(vec![all_pairs()])).await.unwrap_err(),
        door.apply(apply(vec![remove(named("left"))])).await.unwrap_err(),
    ] {
        assert_eq!((refusal.code, refusal.reason.as_str()), (Code::NotFound, "NOT_FOUND"), "{refusal:?}");
    }
    let again = door.create_scene(SCENE).await.unwrap();
    assert!(again.epoch > made.epoch && again.revision == 0);
}

async fn second_scene_of_a_name_is_refused(door: &impl Door) {
    door.create_scene(SCENE).await.unwrap();
    let refusal = door.create_scene(SCENE).await.unwrap_err();
    assert_eq!((refusal.code, refusal.reason.as_str()), (Code::AlreadyExists, "ALREADY_EXISTS"));
    assert_eq!(door.create_scene("").await.unwrap_err().code, Code::InvalidArgument);
}

async fn unknown_bodies_are_named(door: &impl Door) {
    two_balls(door).await;
    let refusal = door.distance(distance(vec![all_pairs(), body(named("nobody"))])).await.unwrap_err();
    assert_eq!(refusal.code, Code::NotFound);
    assert!(refusal.message.contains("nobody"), "{refusal:?}");
}

async fn allowed_pair_is_not_reported(door: &impl Door) {
    two_balls(door).await;
    let party = |name| Some(v1::Party { kind: Some(v1::party::Kind::Body(named(name))) });
    let entry = |allowed| {
        edit(v1::edit::Kind::SetAllowedCollision(v1::SetAllowedCollision {
            a: party("left"),
            b: party("right"),
            allowed,
        }))
    };
    door.apply(apply(vec![entry(Some(true))])).await.unwrap();
    let question = collide(vec![all_pairs()]);
    assert_eq!(verdicts(&door.collide(question.clone()).await.unwrap()), [v1::Verdict::Free]);
    door.apply(apply(vec![entry(None)])).await.unwrap();
    assert_eq!(verdicts(&door.collide(question).await.unwrap()), [v1::Verdict::Collision]);
}

async fn broad_phase_is_chosen_with_the_scene_and_changes_no_answer(door: &impl Door) {
    let chosen = |name: &str, kind: i32| v1::CreateSceneRequest { name: name.to_owned(), broad_phase: kind };
    let kinds = [v1::BroadPhase::Tree, v1::BroadPhase::SweepAndPrune, v1::BroadPhase::Exhaustive];
    let mut answers = Vec::new();
    for kind in kinds {
        let scene = kind.as_str_name();
        let made = door.create(chosen(scene, kind.into())).await.unwrap();
        assert_eq!((made.broad_phase(), made.robots), (kind, 0));
        let balls =
            (0..40).map(|i| add(&format!("ball {i}"), sphere(0.6), at(f64::from(i % 7), f64::from(i % 5), 0.0)));
        let change = v1::ApplyRequest { scene: scene.to_owned(), ..apply(balls.collect()) };
        door.apply(change).await.unwrap();
        let contents = v1::GetSceneRequest { scene: scene.to_owned(), ..v1::GetSceneRequest::default() };
        assert_eq!(door.get_scene(contents).await.unwrap().broad_phase(), kind);
        let context = v1::Context { scene: scene.to_owned(), ..context() };
        let question =
            v1::CollideRequest { context: Some(context), ..collide(vec![all_pairs(), body(named("ball 3"))]) };
        let mut answer = door.collide(question).await.unwrap();
        answer.epoch = 0;
        answer.cost = None;
        answer.items.iter_mut().for_each(|item| item.cost = None);
        assert!(answer.items[0].pairs.len() > 40, "{answer:?}");
        answers.push(answer);
    }
    assert!(answers.iter().all(|answer| *answer == answers[0]));
    assert_eq!(door.create(chosen("unsaid", 0)).await.unwrap().broad_phase(), v1::BroadPhase::Tree);
    let refusal = door.create(chosen("unknown", 77)).await.unwrap_err();
    assert_eq!((refusal.code, refusal.field.as_str()), (Code::InvalidArgument, "broad_phase"), "{refusal:?}");
}

async fn health_tells_memory_and_what_each_revision_wrote(door: &impl Door) {
    for (name, kind) in [("a tree", 1), ("sorted", 2), ("in no order", 3)] {
        door.create(v1::CreateSceneRequest { name: name.to_owned(), broad_phase: kind }).await.unwrap();
        let to = |edits| v1::ApplyRequest { scene: name.to_owned(), ..apply(edits) };
        let balls =
            (0..2_000).map(|i| add(&format!("ball {i}"), sphere(0.1), at(f64::from(i % 50), f64::from(i / 50), 0.0)));
        door.apply(to(balls.collect())).await.unwrap();
        door.apply(to(vec![move_to(named("ball 7"), at(3.0, 3.5, 0.0))])).await.unwrap();
        let health = door.scene_health(name).await.unwrap();
        assert_eq!((health.name.as_str(), health.revision, health.bodies), (name, 2, 2_000));
        let memory = health.memory.unwrap();
        assert!(
            memory.bodies > 2_000 * 200 && memory.names > 2_000 * 20 && memory.broad_phase > 2_000 * 48,
            "{memory:?}"
        );
        let kept: Vec<u64> = health.kept.iter().map(|kept| kept.revision).collect();
        assert_eq!(kept, [0, 1, 2]);
        let (built, moved) = (health.kept[1].written_bytes, health.kept[2].written_bytes);
        // One body out of two thousand: what its edit wrote is a small part of what building the scene wrote.
        assert!(moved > 200 && 20 * moved < built, "{moved} of {built}");
        assert!(health.kept_bytes >= built + moved, "{health:?}");
        let entries = match health.broad_phase.unwrap() {
            v1::scene_health::BroadPhase::Tree(tree) => (1, tree.entries),
            v1::scene_health::BroadPhase::SweepAndPrune(sweep) => (2, sweep.entries),
            v1::scene_health::BroadPhase::Exhaustive(exhaustive) => (3, exhaustive.entries),
        };
        assert_eq!(entries, (kind, 2_000));
    }
    assert_eq!(door.scene_health("nowhere").await.unwrap_err().code, Code::NotFound);
}

async fn contents_come_in_pages(door: &impl Door) {
    door.create_scene(SCENE).await.unwrap();
    let balls = (0..10).map(|i| add(&format!("ball {i}"), sphere(0.1), at(f64::from(i), 0.0, 0.0)));
    door.apply(apply(balls.collect())).await.unwrap();
    door.apply(apply(vec![remove(named("ball 4"))])).await.unwrap();
    let page = |after_body, max_bodies| v1::GetSceneRequest {
        scene: SCENE.to_owned(),
        max_bodies: Some(max_bodies),
        after_body,
        ..v1::GetSceneRequest::default()
    };
    let (mut listed, mut after) = (Vec::new(), 0);
    loop {
        let contents = door.get_scene(page(after, 4)).await.unwrap();
        assert_eq!((contents.body_count, contents.revision), (9, 2));
        listed.extend(contents.bodies.iter().map(|body| body.id));
        let Some(last) = listed.last().copied().filter(|_| contents.bodies_left) else { break };
        after = last;
    }
    assert_eq!(listed, [1, 2, 3, 4, 6, 7, 8, 9, 10]);
    let none = door.get_scene(page(0, 0)).await.unwrap();
    assert!(none.bodies.is_empty() && none.bodies_left && none.body_count == 9);
    assert!(!door.get_scene(page(u64::MAX, 4)).await.unwrap().bodies_left);
    let refusal = door.get_scene(page(0, 100_001)).await.unwrap_err();
    assert_eq!(refusal.code, Code::ResourceExhausted, "{refusal:?}");
}
