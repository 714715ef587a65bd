//! Random lists of edits, many of which cannot be made, against the simple model: the scene accepts what the model
//! accepts, refuses at the edit at which the model does, and then holds the same.

use std::cell::RefCell;

use proptest::prelude::*;
use proptest::sample::select;
use proptest::test_runner::{Config, TestRunner};

use super::model::{Model, ModelBody};
use super::*;
use crate::limits::Limits;

/// How often each regime was met in the sweep.
#[derive(Debug, Default)]
struct Reached {
    accepted: usize,
    refused_later_than_first: usize,
    mismatched: usize,
    removed_and_added_again: usize,
    allowed_pairs: usize,
    looked_at_despite_an_entry: usize,
    margins: usize,
    declared: usize,
    declared_empty: usize,
    allowed_links: usize,
    self_pairs_changed: usize,
    gone: usize,
}

fn names() -> impl Strategy<Value = String> {
    prop_oneof![12 => select(vec!["a", "b", "c", "d"]), 1 => Just("arm"), 1 => Just("")].prop_map(str::to_owned)
}

fn robots() -> impl Strategy<Value = String> {
    prop_oneof![8 => select(vec!["arm", "leg"]), 1 => Just("a")].prop_map(str::to_owned)
}

fn group_names() -> impl Strategy<Value = Vec<String>> {
    prop::collection::vec(select(vec!["g", "h", "k"]).prop_map(str::to_owned), 0..3)
}

fn body_refs() -> impl Strategy<Value = BodyRef> {
    prop_oneof![3 => names().prop_map(BodyRef::Name), 1 => (1..10_u64).prop_map(|id| BodyRef::Id(BodyId(id)))]
}

fn parties() -> impl Strategy<Value = Party> {
    let links = prop_oneof![9 => select(vec!["base", "upper", "lower"]), 1 => Just("hand")];
    prop_oneof![
        4 => body_refs().prop_map(Party::Body),
        2 => (robots(), links).prop_map(|(robot, link)| Party::Link { robot, link: link.to_owned() }),
        3 => select(vec!["g", "h", "k", "z"]).prop_map(group),
        1 => robots().prop_map(Party::Robot),
        1 => Just(Party::Everything),
    ]
}

fn poses() -> impl Strategy<Value = Pose> {
    (-3.0..3.0).prop_map(at)
}

fn inflations() -> impl Strategy<Value = (f64, f64)> {
    let scales = prop_oneof![20 => select(vec![1.0, 2.0]), 1 => select(vec![0.0, -1.0, f64::NAN])];
    (scales, prop_oneof![20 => select(vec![0.0, 0.25]), 1 => select(vec![-0.1, f64::INFINITY])])
}

fn declared() -> impl Strategy<Value = Option<Effects>> {
    let some =
        prop::sample::subsequence(Effect::EACH.to_vec(), 0..=3).prop_map(|effects| effects.into_iter().collect());
    prop_oneof![2 => Just(None), 3 => Just(Some(Effects::NONE)), 3 => some.prop_map(Some)]
}

fn edits(model: Arc<RobotModel>) -> impl Strategy<Value = Edit> {
    let layers = || select(vec![u32::MAX, u32::MAX, 1, 2, 3, 0]);
    let new_body = (names(), poses(), inflations(), group_names(), layers(), layers()).prop_map(
        |(name, pose, (scale, padding), groups, layers, mask)| NewBody {
            pose,
            scale,
            padding,
            groups,
            layers,
            mask,
            ..ball(&name, 0.0)
        },
    );
    let margins = prop_oneof![20 => 0.0..1.0_f64, 1 => Just(-1.0), 1 => Just(f64::NAN)];
    prop_oneof![
        7 => new_body.prop_map(Edit::AddBody),
        5 => body_refs().prop_map(|body| Edit::RemoveBody { body }),
        3 => (body_refs(), poses()).prop_map(|(body, pose)| Edit::MoveBody { body, pose }),
        1 => (body_refs(), inflations()).prop_map(|(body, (scale, padding))| {
            Edit::ReplaceShape { body, shape: ball("", 0.0).shape, scale, padding }
        }),
        2 => (body_refs(), group_names()).prop_map(|(body, groups)| Edit::SetGroups { body, groups }),
        1 => (body_refs(), layers(), layers()).prop_map(|(body, layers, mask)| Edit::SetLayers { body, layers, mask }),
        1 => (body_refs(), any::<bool>()).prop_map(|(body, enabled)| Edit::SetEnabled { body, enabled }),
        2 => (robots(), poses()).prop_map(move |(name, base)| Edit::AddRobot { name, model: Arc::clone(&model), base }),
        1 => (robots(), poses()).prop_map(|(robot, base)| Edit::MoveRobot { robot, base }),
        1 => robots().prop_map(|robot| Edit::RemoveRobot { robot }),
        7 => (parties(), parties(), any::<Option<bool>>()).prop_map(|(a, b, allowed)| allow(a, b, allowed)),
        4 => (parties(), parties(), prop::option::weighted(0.8, margins)).prop_map(|(a, b, value)| margin(a, b, value)),
        4 => (parties(), parties(), declared()).prop_map(|(a, b, effects)| declare(a, b, effects)),
    ]
}

/// Lists of edits, each with how far the expected revision is from the real one, if one is given.
pub(super) fn sessions(model: Arc<RobotModel>) -> impl Strategy<Value = Vec<(Vec<Edit>, Option<u64>)>> {
    let expected = prop_oneof![6 => Just(None), 3 => Just(Some(0)), 1 => Just(Some(1))];
    let list = prop_oneof![1 => Just(0_usize), 8 => Just(1), 3 => 2..5_usize]
        .prop_flat_map(move |length| prop::collection::vec(edits(Arc::clone(&model)), length));
    prop::collection::vec((list, expected), 1..60)
}

fn run(session: &[(Vec<Edit>, Option<u64>)], reached: &mut Reached) {
    let kept = 5;
    let mut scene = Scene::with_limits(Epoch(1), Limits { snapshots_kept: kept, ..Limits::default() });
    let mut model = Model::default();
    let mut history = vec![scene.snapshot()];
    let mut names_seen = Vec::new();
    for (edits, ahead) in session {
        let before = scene.snapshot();
        let expected = ahead.map(|ahead| Revision(before.revision().0 + ahead));
        let outcome = scene.apply(edits, expected);
        let mut next = model.clone();
        let stopped_at = edits.iter().position(|edit| next.apply(edit).is_none());
        match outcome {
            Ok(applied) => {
                assert_eq!((stopped_at, applied.revision.0), (None, before.revision().0 + 1));
                let new_bodies: Vec<&ModelBody> =
                    next.bodies.iter().filter(|body| model.bodies.iter().all(|old| old.id != body.id)).collect();
                assert!(new_bodies.iter().all(|body| applied.added.contains(&BodyId(body.id))));
                assert!(applied.added.is_sorted());
                let again = new_bodies.iter().filter(|body| names_seen.contains(&body.name)).count();
                reached.removed_and_added_again += again;
                names_seen.extend(new_bodies.iter().map(|body| body.name.clone()));
                model = next;
                history.push(scene.snapshot());
                reached.accepted += 1;
            }
            Err(refusal) => {
                assert!(Arc::ptr_eq(&before, &scene.snapshot()));
                match refusal {
                    Refusal::RevisionMismatch { .. } => {
                        assert_eq!(*ahead, Some(1));
                        reached.mismatched += 1;
                    }
                    Refusal::Edit { index, .. } => {
                        assert_eq!(Some(index), stopped_at, "{edits:?}");
                        reached.refused_later_than_first += usize::from(index > 0);
                    }
                    Refusal::TooManyEdits(_) => panic!("short lists are not too long"),
                }
            }
        }
        compare(&scene.snapshot(), &model, reached);
    }
    for snapshot in &history {
        let kept = snapshot.revision().0 + kept as u64 > history.len() as u64 - 1;
        match scene.at(snapshot.revision()) {
            Ok(found) => assert!(kept && Arc::ptr_eq(&found, snapshot)),
            Err(_) => assert!(!kept),
        }
        assert_eq!(snapshot.validate(), Ok(()));
        reached.gone += usize::from(!kept);
    }
}

fn compare(snapshot: &Snapshot, model: &Model, reached: &mut Reached) {
    assert_eq!(snapshot.validate(), Ok(()));
    assert_eq!(snapshot.body_count(), model.bodies.len());
    for (body, expected) in snapshot.bodies().zip(&model.bodies) {
        assert_eq!((body.id.0, &*body.name, body.pose), (expected.id, expected.name.as_str(), expected.pose));
        assert_eq!((body.layers, body.mask, body.enabled), (expected.layers, expected.mask, expected.enabled));
        assert_eq!(body.shape.swept_radius(), expected.radius);
        assert!(body.groups.iter().map(|name| &**name).eq(expected.groups.iter().map(String::as_str)));
        assert!(["g", "h", "k"].iter().all(|group| body.is_in(group) == expected.groups.contains(*group)));
    }
    for (i, x) in snapshot.bodies().zip(&model.bodies) {
        for (j, y) in snapshot.bodies().zip(&model.bodies).filter(|(_, y)| y.id != x.id) {
            let (a, b) = (Model::body_answers(x), Model::body_answers(y));
            let entry = model.is_allowed(&a, &b);
            let met = x.enabled && y.enabled && x.layers & y.mask != 0 && y.layers & x.mask != 0;
            let empty = model.is_empty(&a, &b);
            assert_eq!(snapshot.admits(i, j), met && entry != Some(true) && !empty);
            assert_eq!(snapshot.declared(i.member(), j.member()), model.declared(&a, &b));
            reached.declared += usize::from(model.declared(&a, &b).is_some() && !empty);
            reached.declared_empty += usize::from(empty);
            assert_eq!(snapshot.is_allowed(i.member(), j.member()), entry == Some(true));
            assert_eq!(snapshot.margin(i.member(), j.member()), model.margin(&a, &b));
            reached.allowed_pairs += usize::from(entry == Some(true));
            reached.looked_at_despite_an_entry += usize::from(entry == Some(false));
            reached.margins += usize::from(model.margin(&a, &b).is_some());
        }
    }
    compare_robots(snapshot, model, reached);
    let largest = model.margins.iter().map(|entry| entry.2).fold(0.0, f64::max);
    assert_eq!(snapshot.largest_margin(), largest);
}

fn compare_robots(snapshot: &Snapshot, model: &Model, reached: &mut Reached) {
    let mut expected = model.robots.clone();
    expected.sort_unstable();
    assert!(snapshot.robots().map(|robot| &*robot.name).eq(expected.iter().map(String::as_str)));
    for robot in snapshot.robots() {
        let answers = [0, 1, 2].map(|link| Model::link_answers(&robot.name, link));
        for (body, expected) in snapshot.bodies().zip(&model.bodies) {
            for (link, a) in (0..).zip(&answers) {
                let b = Model::body_answers(expected);
                let allowed = model.is_allowed(a, &b) == Some(true);
                let met = expected.enabled && expected.layers != 0 && expected.mask != 0;
                assert_eq!(snapshot.admits_link(robot, link, body), met && !allowed && !model.is_empty(a, &b));
                assert_eq!(snapshot.margin(robot.link(link), body.member()), model.margin(a, &b));
                reached.allowed_links += usize::from(allowed);
            }
        }
        // Of the chain, the model looks at the outer two only.
        let pairs: Vec<(u32, u32)> = [(0, 1), (0, 2), (1, 2)]
            .into_iter()
            .filter(|(i, j)| {
                let (a, b) = (&answers[*i as usize], &answers[*j as usize]);
                let exact = model.is_allowed(&a[..1].to_vec(), &b[..1].to_vec());
                let looked_at =
                    if (*i, *j) == (0, 2) { model.is_allowed(a, b) != Some(true) } else { exact == Some(false) };
                looked_at && !model.is_empty(a, b)
            })
            .collect();
        assert_eq!(*robot.self_pairs, pairs);
        reached.self_pairs_changed += usize::from(pairs != [(0, 2)]);
    }
}

#[test]
fn random_lists_of_edits_agree_with_the_model() {
    let reached = RefCell::new(Reached::default());
    let config = Config { cases: 500, failure_persistence: None, ..Config::default() };
    TestRunner::new(config)
        .run(&sessions(arm()), |session| {
            run(&session, &mut reached.borrow_mut());
            Ok(())
        })
        .unwrap();
    let Reached {
        accepted,
        refused_later_than_first,
        mismatched,
        removed_and_added_again,
        allowed_pairs,
        looked_at_despite_an_entry,
        margins,
        declared,
        declared_empty,
        allowed_links,
        self_pairs_changed,
        gone,
    } = reached.into_inner();
    for (regime, count) in [
        ("accepted list", accepted),
        ("refusal at a later edit", refused_later_than_first),
        ("wrong expected revision", mismatched),
        ("name given again", removed_and_added_again),
        ("pair allowed by an entry", allowed_pairs),
        ("pair looked at by an entry", looked_at_despite_an_entry),
        ("pair with a margin", margins),
        ("pair with declared effects", declared),
        ("pair declared empty", declared_empty),
        ("link allowed by an entry", allowed_links),
        ("other self-collision pairs than the model's", self_pairs_changed),
        ("revision that is gone", gone),
    ] {
        assert!(count >= 20, "{regime}: only {count}");
    }
}
