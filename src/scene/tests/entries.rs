//! Entries for pairs: which one decides, whom it speaks of, and when it goes.

use super::*;

#[test]
fn the_most_specific_entry_decides_and_looking_wins_a_tie() {
    let mut scene = scene_of([grouped("a", &["g"]), grouped("b", &["h"]), grouped("c", &["g", "k"])]);
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

#[test]
fn margins_follow_the_same_ranks_and_the_larger_wins_a_tie() {
    let mut scene = scene_of([grouped("a", &["g", "k"]), grouped("b", &["h"])]);
    let between = |scene: &Scene| {
        let snapshot = scene.snapshot();
        let [a, b] = ["a", "b"].map(|name| snapshot.body_named(name).unwrap().member());
        assert_eq!(snapshot.margin(a, b), snapshot.margin(b, a));
        (snapshot.margin(a, b), snapshot.largest_margin())
    };
    assert_eq!(between(&scene), (None, 0.0));
    apply(&mut scene, &[margin(group("g"), group("h"), Some(0.1)), margin(group("k"), group("h"), Some(0.3))]);
    assert_eq!(between(&scene), (Some(0.3), 0.3));
    apply(&mut scene, &[margin(one("b"), one("a"), Some(0.0))]);
    assert_eq!(between(&scene), (Some(0.0), 0.3));
    apply(&mut scene, &[margin(group("h"), group("k"), None), margin(one("a"), one("b"), None)]);
    assert_eq!(between(&scene), (Some(0.1), 0.1));
}

#[test]
fn entries_go_with_the_body_or_robot_they_name() {
    let model = arm();
    let mut scene = scene_of([ball("a", 0.0), ball("b", 0.0)]);
    apply(
        &mut scene,
        &[
            add_arm("arm", &model),
            allow(one("a"), one("b"), Some(true)),
            allow(one("a"), group("later"), Some(true)),
            allow(link("arm", "lower"), one("b"), Some(true)),
            margin(Party::Robot("arm".to_owned()), one("b"), Some(0.2)),
        ],
    );
    assert!(scene.snapshot().has_group("later"));
    apply(&mut scene, &[Edit::RemoveBody { body: "a".into() }, Edit::RemoveRobot { robot: "arm".to_owned() }]);
    assert!(!scene.snapshot().has_group("later"));
    assert_eq!(scene.snapshot().largest_margin(), 0.0);
    // The same names mean others now.
    apply(&mut scene, &[Edit::AddBody(ball("a", 0.0)), add_arm("arm", &model)]);
    assert!(admits(&scene, "a", "b"));
    let snapshot = scene.snapshot();
    assert!(snapshot.admits_link(snapshot.robot("arm").unwrap(), 2, snapshot.body_named("b").unwrap()));
}

#[test]
fn a_group_entry_holds_for_members_that_come_later() {
    let mut scene = scene_of([ball("a", 0.0), ball("b", 0.0)]);
    apply(&mut scene, &[allow(group("g"), group("g"), Some(true))]);
    assert!(admits(&scene, "a", "b"));
    let join = |body: &str| Edit::SetGroups { body: body.into(), groups: vec!["g".to_owned()] };
    apply(&mut scene, &[join("a"), join("b"), Edit::AddBody(grouped("c", &["g"]))]);
    assert!(!admits(&scene, "a", "b") && !admits(&scene, "a", "c"));
}

#[test]
fn links_are_spoken_of_one_by_one_and_as_a_robot() {
    let mut scene = scene_of([ball("a", 0.0), ball("b", 0.0)]);
    apply(
        &mut scene,
        &[
            add_arm("left", &arm()),
            add_arm("right", &arm()),
            allow(Party::Robot("left".to_owned()), one("a"), Some(true)),
            allow(link("left", "lower"), one("a"), Some(false)),
            allow(link("right", "base"), Party::Everything, Some(true)),
        ],
    );
    let snapshot = scene.snapshot();
    let admitted = |robot: &str, body: &str| {
        let (robot, body) = (snapshot.robot(robot).unwrap(), snapshot.body_named(body).unwrap());
        [0, 1, 2].map(|link| snapshot.admits_link(robot, link, body))
    };
    assert_eq!(admitted("left", "a"), [false, false, true]);
    assert_eq!(admitted("left", "b"), [true, true, true]);
    assert_eq!(admitted("right", "a"), [false, true, true]);
    assert!(snapshot.robots().map(|robot| &*robot.name).eq(["left", "right"]));
}

#[test]
fn the_scene_changes_which_links_are_held_against_each_other() {
    let mut scene = scene_of([]);
    apply(&mut scene, &[add_arm("arm", &arm())]);
    let pairs = |scene: &Scene| scene.snapshot().robot("arm").unwrap().self_pairs.to_vec();
    assert_eq!(pairs(&scene), [(0, 2)]);
    apply(&mut scene, &[allow(Party::Robot("arm".to_owned()), Party::Robot("arm".to_owned()), Some(true))]);
    assert_eq!(pairs(&scene), []);
    // Only an entry for the two links brings back a pair that the model leaves out.
    apply(&mut scene, &[allow(link("arm", "base"), Party::Everything, Some(false))]);
    assert_eq!(pairs(&scene), [(0, 2)]);
    apply(&mut scene, &[allow(link("arm", "upper"), link("arm", "base"), Some(false))]);
    assert_eq!(pairs(&scene), [(0, 1), (0, 2)]);
}

/// What a copy of the scene is told: all entries by name, and of changed ones what holds now, under the names of groups that
/// the scene has forgotten, too.
#[test]
fn entries_are_told_as_they_were_made() {
    let mut scene = scene_of([ball("a", 0.0), ball("b", 2.0), grouped("c", &["g"])]);
    apply(&mut scene, &[add_arm("arm", &arm())]);
    let id = |name: &str| Party::Body(scene.snapshot().body_named(name).unwrap().id.into());
    let (a, b) = (id("a"), id("b"));
    let first = scene.snapshot().revision();
    let edits = [
        allow(one("a"), one("b"), Some(true)),
        margin(one("b"), one("a"), Some(0.5)),
        allow(group("g"), link("arm", "upper"), Some(false)),
        margin(Party::Robot("arm".to_owned()), Party::Everything, Some(0.25)),
        margin(group("later"), group("later"), Some(0.125)),
    ];
    apply(&mut scene, &edits);
    let entry = |a: Party, b: Party, allowed, margin| PairEntry { a, b, allowed, margin, effects: None };
    let robot = || Party::Robot("arm".to_owned());
    let has = |entries: &[PairEntry], wanted: &PairEntry| {
        let turned = PairEntry { a: wanted.b.clone(), b: wanted.a.clone(), ..wanted.clone() };
        entries.contains(wanted) || entries.contains(&turned)
    };
    let expected = [
        entry(a.clone(), b.clone(), Some(true), Some(0.5)),
        entry(group("g"), link("arm", "upper"), Some(false), None),
        entry(robot(), Party::Everything, None, Some(0.25)),
        entry(group("later"), group("later"), None, Some(0.125)),
    ];
    let snapshot = scene.snapshot();
    let changed = snapshot.changed_entries(&snapshot.changes_since(first).unwrap());
    for told in [snapshot.pair_entries(), changed] {
        assert_eq!(told.len(), expected.len(), "{told:?}");
        assert!(expected.iter().all(|entry| has(&told, entry)), "{told:?}");
    }
    // A group that is forgotten with its entry, one that is forgotten and comes again, and a robot that takes its entries along.
    let second = snapshot.revision();
    let edits = [margin(group("later"), group("later"), None), allow(group("g"), link("arm", "upper"), None)];
    apply(&mut scene, &edits);
    apply(&mut scene, &[Edit::RemoveBody { body: "c".into() }, Edit::RemoveRobot { robot: "arm".to_owned() }]);
    apply(&mut scene, &[allow(group("g"), group("g"), Some(true)), allow(one("a"), one("b"), None)]);
    let snapshot = scene.snapshot();
    let told = snapshot.changed_entries(&snapshot.changes_since(second).unwrap());
    let expected = [
        entry(group("later"), group("later"), None, None),
        entry(group("g"), group("g"), Some(true), None),
        entry(a, b, None, Some(0.5)),
    ];
    assert!(expected.iter().all(|entry| has(&told, entry)) && told.len() == expected.len(), "{told:?}");
    assert_eq!(snapshot.pair_entries().len(), 2);
}
