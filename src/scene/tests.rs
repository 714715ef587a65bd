//! The scene against what it should hold.

use std::sync::Arc;

use super::*;
use crate::geometry::{Pose, Quaternion, Shape, Vec3};

fn at(x: f64, y: f64, z: f64) -> Pose {
    Pose::new(Vec3::new(x, y, z), Quaternion::IDENTITY).unwrap()
}

fn ball(name: &str, x: f64) -> NewBody {
    NewBody::new(name, Arc::new(Shape::sphere(0.5).unwrap()), at(x, 0.0, 0.0))
}

fn floor(name: &str) -> NewBody {
    NewBody::new(name, Arc::new(Shape::half_space(Vec3::z(), 0.0).unwrap()), Pose::identity())
}

/// Applies edits that must be accepted, and looks at the result as a whole.
fn apply(scene: &mut Scene, edits: &[Edit]) -> Applied {
    let applied = scene.apply(edits, None).unwrap();
    assert_eq!(scene.snapshot().validate(), Ok(()));
    assert_eq!(scene.snapshot().revision(), applied.revision);
    applied
}

fn scene_of(bodies: impl IntoIterator<Item = NewBody>) -> Scene {
    let mut scene = Scene::new(Epoch(7));
    apply(&mut scene, &bodies.into_iter().map(Edit::AddBody).collect::<Vec<_>>());
    scene
}

fn one(name: &str) -> Party {
    Party::Body(name.into())
}

fn allow(a: Party, b: Party, allowed: Option<bool>) -> Edit {
    Edit::SetAllowedCollision { a, b, allowed }
}

fn admits(scene: &Scene, a: &str, b: &str) -> bool {
    let snapshot = scene.snapshot();
    let (a, b) = (snapshot.body_named(a).unwrap(), snapshot.body_named(b).unwrap());
    assert_eq!(snapshot.admits(a, b), snapshot.admits(b, a));
    snapshot.admits(a, b)
}

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
    assert_eq!(snapshot.tree().iter().map(|(payload, _)| payload).collect::<Vec<_>>(), [1]);
    assert!(snapshot.body(BodyId(3)).is_none() && snapshot.body_named("b").is_none());
}

#[test]
fn a_refused_list_changes_nothing_and_says_where_it_failed() {
    let mut scene = scene_of([ball("a", 0.0)]);
    let before = scene.snapshot();
    let edits = [Edit::AddBody(ball("b", 1.0)), Edit::AddBody(ball("a", 2.0))];
    let refusal = scene.apply(&edits, None).unwrap_err();
    assert_eq!(refusal.to_string(), "edits[1].name: the name \"a\" is taken");
    assert!(Arc::ptr_eq(&before, &scene.snapshot()));
    // The id that the refused list would have given goes to the next body.
    assert_eq!(apply(&mut scene, &[Edit::AddBody(ball("c", 0.0))]).added, [BodyId(2)]);
}

#[test]
fn the_most_specific_entry_decides_and_looking_wins_a_tie() {
    let grouped = |name: &str, groups: &[&str]| NewBody {
        groups: groups.iter().map(|group| (*group).to_owned()).collect(),
        ..ball(name, 0.0)
    };
    let mut scene = scene_of([grouped("a", &["g"]), grouped("b", &["h"]), grouped("c", &["g", "k"])]);
    let group = |name: &str| Party::Group(name.to_owned());
    assert!(admits(&scene, "a", "b"));
    // From the least specific entry to the most specific one: each turns the one before around.
    for (a, b, allowed) in [
        (Party::Everything, Party::Everything, true),
        (Party::Everything, group("g"), false),
        (group("h"), group("g"), true),
        (one("a"), Party::Everything, false),
        (group("h"), one("a"), true),
        (one("b"), one("a"), false),
    ] {
        apply(&mut scene, &[allow(a.clone(), b.clone(), Some(allowed))]);
        assert_eq!(admits(&scene, "a", "b"), !allowed, "{a:?} {b:?}");
    }
    assert!(!admits(&scene, "c", "b"));
    apply(&mut scene, &[allow(group("k"), group("h"), Some(false))]);
    assert!(admits(&scene, "c", "b"), "of two entries for groups the one to look wins");
    apply(&mut scene, &[allow(one("a"), one("b"), None)]);
    assert!(!admits(&scene, "a", "b"));
}
