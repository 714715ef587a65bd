//! What cannot be done: the edit, the field and the reason are named, and nothing has changed.

use super::*;
use crate::geometry::tolerance::LARGEST_LENGTH;
use crate::limits::Limits;

/// The last edit is refused with that text; the ones before it are not made either.
fn check(scene: &mut Scene, edits: Vec<Edit>, field_and_reason: &str) {
    let before = scene.snapshot();
    let refusal = scene.apply(&edits, None).unwrap_err();
    assert_eq!(refusal.to_string(), format!("edits[{}].{field_and_reason}", edits.len() - 1));
    assert!(Arc::ptr_eq(&before, &scene.snapshot()));
}

#[test]
fn every_field_that_can_be_wrong_is_named() {
    let mut scene = scene_of([ball("a", 0.0)]);
    apply(&mut scene, &[add_arm("arm", &arm())]);
    let add = |body: NewBody| vec![Edit::AddBody(ball("before", 0.0)), Edit::AddBody(body)];
    let a = || BodyRef::from("a");
    let base = |name: &str, base| Edit::AddRobot { name: name.to_owned(), model: arm(), base };
    let shape = |scale, padding| Edit::ReplaceShape { body: a(), shape: ball("", 0.0).shape, scale, padding };
    for (edits, text) in [
        (add(ball("", 0.0)), "name: a name must not be empty"),
        (add(ball("a", 0.0)), "name: the name \"a\" is taken"),
        (add(ball("before", 0.0)), "name: the name \"before\" is taken"),
        (add(ball("arm", 0.0)), "name: the name \"arm\" is taken"),
        (add(NewBody { scale: f64::NAN, ..ball("b", 0.0) }), "scale: not a finite number"),
        (add(NewBody { padding: -0.5, ..ball("b", 0.0) }), "padding: -0.5 is negative"),
        (add(NewBody { groups: vec![String::new()], ..ball("b", 0.0) }), "groups: a name must not be empty"),
        (vec![shape(0.0, 0.0)], "scale: 0 is not positive"),
        (vec![shape(1.0, f64::INFINITY)], "padding: not a finite number"),
        (vec![Edit::RemoveBody { body: "b".into() }], "body: no body is named \"b\""),
        (vec![Edit::RemoveBody { body: BodyId(9).into() }], "body: no body has the id 9"),
        (vec![Edit::RemoveBody { body: BodyId(0).into() }], "body: no body has the id 0"),
        (vec![Edit::RemoveBody { body: a() }, Edit::RemoveBody { body: a() }], "body: no body is named \"a\""),
        (
            vec![Edit::RemoveBody { body: a() }, Edit::SetLayers { body: BodyId(1).into(), layers: 0, mask: 0 }],
            "body: the body 1 was removed",
        ),
        (vec![base("arm", at(0.0))], "name: the name \"arm\" is taken"),
        (vec![base("a", at(0.0))], "name: the name \"a\" is taken"),
        (vec![base("l/r", at(0.0))], "name: the name \"l/r\" of a robot must not contain '/'"),
        (vec![Edit::MoveRobot { robot: "b".to_owned(), base: at(0.0) }], "robot: no robot is named \"b\""),
        (vec![Edit::RemoveRobot { robot: "b".to_owned() }], "robot: no robot is named \"b\""),
        (vec![allow(one("a"), one("b"), Some(true))], "b: no body is named \"b\""),
        (vec![allow(one("b"), one("a"), None)], "a: no body is named \"b\""),
        (vec![allow(one("a"), one("a"), Some(true))], "b: a body or link makes no pair with itself"),
        (vec![allow(link("arm", "hand"), one("a"), Some(true))], "a: the robot \"arm\" has no link \"hand\""),
        (vec![allow(one("a"), link("leg", "foot"), Some(true))], "b: no robot is named \"leg\""),
        (vec![allow(group(""), one("a"), Some(true))], "a: a name must not be empty"),
        (vec![margin(one("a"), Party::Everything, Some(f64::NAN))], "margin: not a finite number"),
        (vec![margin(one("a"), Party::Everything, Some(-1.0))], "margin: -1 is negative"),
    ] {
        check(&mut scene, edits, text);
    }
    let text = scene.apply(&[shape(4.0 * LARGEST_LENGTH, 0.0)], None).unwrap_err().to_string();
    assert!(text.starts_with("edits[0].scale: "), "{text}");
}

#[test]
fn a_refused_list_uses_up_no_id() {
    let mut scene = scene_of([ball("a", 0.0)]);
    check(
        &mut scene,
        vec![Edit::AddBody(ball("b", 0.0)), Edit::AddBody(ball("a", 0.0))],
        "name: the name \"a\" is taken",
    );
    assert_eq!(apply(&mut scene, &[Edit::AddBody(ball("c", 0.0))]).added, [BodyId(2)]);
}

#[test]
fn caps_are_named_with_what_was_asked_and_what_is_allowed() {
    let limits = Limits {
        max_bodies: 2,
        max_edits: 3,
        max_robots_in_scene: 1,
        max_pair_entries: 1,
        max_groups: 1,
        max_name_bytes: 4,
        ..Limits::default()
    };
    let mut scene = Scene::with_limits(Epoch(1), limits);
    apply(&mut scene, &[Edit::AddBody(ball("a", 0.0)), Edit::AddBody(ball("b", 0.0)), add_arm("arm", &arm())]);
    apply(&mut scene, &[allow(one("a"), one("b"), Some(true))]);
    let exceeded = |field: &str, limit: &str, asked: usize, allowed: usize| {
        format!("{field}: {limit} exceeded: asked for {asked}, allowed is {allowed}")
    };
    let set_groups = Edit::SetGroups { body: "a".into(), groups: vec!["g".to_owned(), "h".to_owned()] };
    for (edit, text) in [
        (Edit::AddBody(ball("c", 0.0)), exceeded("name", "max_bodies", 3, 2)),
        (Edit::AddBody(ball("seven", 0.0)), exceeded("name", "max_name_bytes", 5, 4)),
        (add_arm("leg", &arm()), exceeded("name", "max_robots_in_scene", 2, 1)),
        (margin(one("a"), one("b"), Some(0.1)), exceeded("a", "max_pair_entries", 2, 1)),
        (allow(group("seven"), one("b"), Some(true)), exceeded("a", "max_name_bytes", 5, 4)),
        (set_groups, exceeded("groups", "max_groups", 2, 1)),
    ] {
        check(&mut scene, vec![edit], &text);
    }
    // Replacing an entry, or taking back what is not there, needs no more room.
    apply(&mut scene, &[allow(one("b"), one("a"), Some(false)), margin(one("a"), one("b"), None)]);
    let moves = vec![Edit::MoveBody { body: "a".into(), pose: at(1.0) }; 4];
    let refusal = scene.apply(&moves, None).unwrap_err();
    assert_eq!(refusal.to_string(), "max_edits exceeded: asked for 4, allowed is 3");
}
