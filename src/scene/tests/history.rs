//! Revisions, ids and snapshots: which are given, and which can still be had.

use super::*;
use crate::limits::Limits;

#[test]
fn bodies_are_found_by_id_name_and_place() {
    let mut scene = Scene::new(Epoch(7));
    let Applied { revision, added } = apply(&mut scene, &[Edit::AddBody(ball("a", 0.0)), Edit::AddBody(floor("f"))]);
    assert_eq!((revision, added), (Revision(1), vec![BodyId(1), BodyId(2)]));
    let snapshot = scene.snapshot();
    assert_eq!(snapshot.epoch(), Epoch(7));
    assert_eq!(snapshot.bodies().map(|body| &*body.name).collect::<Vec<_>>(), ["a", "f"]);
    assert_eq!(snapshot.body_named("a").unwrap().id, BodyId(1));
    assert_eq!(snapshot.unbounded(), [BodyId(2)]);
    assert_eq!(snapshot.broad_phase().iter().map(|(payload, _)| payload).collect::<Vec<_>>(), [1]);
    assert!(snapshot.body(BodyId(3)).is_none() && snapshot.body_named("b").is_none());
}

#[test]
fn the_last_64_revisions_can_be_had_and_no_others() {
    let mut scene = Scene::new(Epoch(1));
    for i in 0..100 {
        apply(&mut scene, &[Edit::AddBody(ball(&format!("ball {i}"), f64::from(i)))]);
    }
    assert_eq!(scene.oldest_revision(), Revision(37));
    for revision in 37..=100 {
        let snapshot = scene.at(Revision(revision)).unwrap();
        assert_eq!((snapshot.revision(), snapshot.body_count()), (Revision(revision), revision as usize));
        assert_eq!(snapshot.validate(), Ok(()));
    }
    let gone = scene.at(Revision(36)).unwrap_err();
    assert_eq!(gone, NotKept::Gone { asked: Revision(36), oldest: Revision(37) });
    let ahead = scene.at(Revision(101)).unwrap_err();
    assert_eq!(ahead, NotKept::Ahead { asked: Revision(101), latest: Revision(100) });
}

#[test]
fn a_scene_that_keeps_none_still_has_its_latest() {
    let mut scene = Scene::with_limits(Epoch(1), Limits { snapshots_kept: 0, ..Limits::default() });
    apply(&mut scene, &[]);
    assert_eq!(scene.oldest_revision(), Revision(1));
    assert_eq!(scene.snapshot().revision(), Revision(1));
}

#[test]
fn an_empty_list_makes_a_revision_and_tells_whether_the_expected_one_holds() {
    let mut scene = scene_of([]);
    assert_eq!(scene.apply(&[], Some(Revision(1))).unwrap().revision, Revision(2));
    let mismatch = Refusal::RevisionMismatch { expected: Revision(1), actual: Revision(2) };
    assert_eq!(scene.apply(&[], Some(Revision(1))), Err(mismatch));
}

#[test]
fn ids_are_not_given_again_but_names_are() {
    let mut scene = scene_of([ball("a", 0.0), ball("b", 0.0)]);
    let edits = [Edit::RemoveBody { body: "b".into() }, Edit::AddBody(ball("b", 1.0))];
    assert_eq!(apply(&mut scene, &edits).added, [BodyId(3)]);
    let gone = Edit::MoveBody { body: BodyId(2).into(), pose: at(0.0) };
    let refusal = scene.apply(&[gone], None).unwrap_err();
    assert_eq!(refusal.to_string(), "edits[0].body: the body 2 was removed");
}

#[test]
fn an_earlier_snapshot_does_not_see_later_edits() {
    let mut scene = scene_of([ball("a", 0.0), ball("b", 5.0)]);
    let before = scene.snapshot();
    apply(
        &mut scene,
        &[
            Edit::MoveBody { body: "a".into(), pose: at(3.0) },
            Edit::RemoveBody { body: "b".into() },
            allow(one("a"), Party::Everything, Some(true)),
        ],
    );
    assert_eq!(before.validate(), Ok(()));
    assert_eq!(before.body_named("a").unwrap().pose, at(0.0));
    assert!(before.admits(before.body_named("a").unwrap(), before.body_named("b").unwrap()));
}

#[test]
fn disabled_and_unbounded_bodies_are_not_in_the_tree() {
    let mut scene = scene_of([ball("a", 0.0), floor("f")]);
    let enable = |body: &str, enabled| Edit::SetEnabled { body: body.into(), enabled };
    apply(&mut scene, &[enable("a", false), enable("f", false)]);
    assert!(scene.snapshot().broad_phase().is_empty() && scene.snapshot().unbounded().is_empty());
    assert!(!admits(&scene, "a", "f"));
    apply(&mut scene, &[enable("a", true), enable("f", true)]);
    assert_eq!((scene.snapshot().broad_phase().len(), scene.snapshot().unbounded().len()), (1, 1));
    assert!(admits(&scene, "a", "f"));
    // A ball becomes a floor and the floor a ball.
    let replace = |body: &str, like: NewBody| Edit::ReplaceShape {
        body: body.into(),
        shape: like.shape,
        scale: 1.0,
        padding: 0.0,
    };
    apply(&mut scene, &[replace("a", floor("")), replace("f", ball("", 0.0))]);
    assert_eq!(scene.snapshot().unbounded(), [BodyId(1)]);
}

#[test]
fn shapes_are_scaled_first_and_padded_then() {
    let padded = NewBody { scale: 2.0, padding: 0.25, ..ball("a", 0.0) };
    let scene = scene_of([padded, ball("b", 0.0)]);
    let snapshot = scene.snapshot();
    assert_eq!(snapshot.body_named("a").unwrap().shape.swept_radius(), 1.25);
    assert_eq!(snapshot.body_named("b").unwrap().shape.swept_radius(), 0.5);
}

#[test]
fn layers_admit_a_pair_only_when_both_sides_do() {
    let layered = |name: &str, layers, mask| NewBody { layers, mask, ..ball(name, 0.0) };
    let scene = scene_of([layered("a", 1, 2), layered("b", 2, 1), layered("c", 2, 4), layered("d", 4, u32::MAX)]);
    assert!(admits(&scene, "a", "b") && admits(&scene, "c", "d"));
    assert!(!admits(&scene, "a", "c") && !admits(&scene, "b", "c") && !admits(&scene, "a", "d"));
}

#[test]
fn an_edit_shares_what_it_does_not_touch() {
    let mut scene = scene_of((0..5000).map(|i| ball(&format!("ball {i}"), f64::from(i))));
    let before = scene.snapshot();
    apply(&mut scene, &[Edit::MoveBody { body: "ball 2500".into(), pose: at(-7.0) }]);
    let after = scene.snapshot();
    let shared = before.bodies().zip(after.bodies()).filter(|(a, b)| Arc::ptr_eq(a, b)).count();
    assert_eq!(shared, 4999);
}
