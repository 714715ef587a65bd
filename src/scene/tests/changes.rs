//! What changed since: random lists of edits against the simple model, which is compared with itself before and after every
//! edit. The oracle finds changes by looking; the log is told of them by the edits.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};

use proptest::test_runner::{Config, TestRunner};

use super::model::{Model, ModelBody, Side};
use super::random_edits::sessions;
use super::*;
use crate::limits::Limits;

const KINDS: [ChangeKinds; 7] = [
    ChangeKinds::ADDED,
    ChangeKinds::REMOVED,
    ChangeKinds::MOVED,
    ChangeKinds::RESHAPED,
    ChangeKinds::LAYERS,
    ChangeKinds::GROUPS,
    ChangeKinds::ENABLED,
];

/// What edits changed, as seen from outside.
#[derive(Clone, Debug, Default)]
struct Seen {
    bodies: BTreeMap<u64, ChangeKinds>,
    robots: BTreeMap<String, ChangeKinds>,
    entries: Vec<(Side, Side)>,
}

impl Seen {
    fn add(&mut self, other: &Self) {
        other.bodies.iter().for_each(|(id, kinds)| *self.bodies.entry(*id).or_default() |= *kinds);
        other.robots.iter().for_each(|(name, kinds)| *self.robots.entry(name.clone()).or_default() |= *kinds);
        self.entries.extend_from_slice(&other.entries);
    }

    /// Compares the model before and after one edit.
    fn look(&mut self, edit: &Edit, before: &Model, after: &Model, bases: &mut BTreeMap<String, Pose>) {
        let body_of = |model: &Model, id: u64| model.bodies.iter().find(|body| body.id == id).cloned();
        let ids: BTreeSet<u64> = before.bodies.iter().chain(&after.bodies).map(|body| body.id).collect();
        let replaced = if let Edit::ReplaceShape { body, .. } = edit {
            match body {
                BodyRef::Id(id) => Some(id.0),
                BodyRef::Name(name) => before.bodies.iter().find(|body| body.name == *name).map(|body| body.id),
            }
        } else {
            None
        };
        for id in ids {
            let mut kinds = of_body(body_of(before, id), body_of(after, id));
            if replaced == Some(id) {
                kinds |= ChangeKinds::RESHAPED;
            }
            if kinds != ChangeKinds::default() {
                *self.bodies.entry(id).or_default() |= kinds;
            }
        }
        let robot = if let Edit::AddRobot { name, base, .. } = edit {
            bases.insert(name.clone(), *base);
            Some((name, ChangeKinds::ADDED))
        } else if let Edit::RemoveRobot { robot } = edit {
            Some((robot, ChangeKinds::REMOVED))
        } else if let Edit::MoveRobot { robot, base } = edit {
            let moved = bases.insert(robot.clone(), *base) != Some(*base);
            moved.then_some((robot, ChangeKinds::MOVED))
        } else {
            None
        };
        if let Some((name, kinds)) = robot {
            *self.robots.entry(name.clone()).or_default() |= kinds;
        }
        if matches!(edit, Edit::SetAllowedCollision { .. } | Edit::SetPairMargin { .. } | Edit::DeclareEffects { .. }) {
            self.entries.extend(differing(&before.allowed, &after.allowed));
            self.entries.extend(differing(&before.margins, &after.margins));
            self.entries.extend(differing(&before.effects, &after.effects));
        }
    }

    fn speaks_of(&self, x: &ModelBody, y: &ModelBody) -> bool {
        let answers =
            |body: &ModelBody| Model::body_answers(body).into_iter().map(|(side, _)| side).collect::<Vec<_>>();
        let (x, y) = (answers(x), answers(y));
        self.entries.iter().any(|(a, b)| (x.contains(a) && y.contains(b)) || (x.contains(b) && y.contains(a)))
    }
}

fn of_body(before: Option<ModelBody>, after: Option<ModelBody>) -> ChangeKinds {
    let (before, after) = match (before, after) {
        (Some(before), Some(after)) => (before, after),
        (None, Some(_)) => return ChangeKinds::ADDED,
        (Some(_), None) => return ChangeKinds::REMOVED,
        (None, None) => return ChangeKinds::default(),
    };
    let when = |changed: bool, kinds| if changed { kinds } else { ChangeKinds::default() };
    when(before.pose != after.pose, ChangeKinds::MOVED)
        | when(before.groups != after.groups, ChangeKinds::GROUPS)
        | when((before.layers, before.mask) != (after.layers, after.mask), ChangeKinds::LAYERS)
        | when(before.enabled != after.enabled, ChangeKinds::ENABLED)
}

/// Pairs of parties whose entry is not the same in both tables.
fn differing<V: Copy + PartialEq>(one: &[(Side, Side, V)], two: &[(Side, Side, V)]) -> Vec<(Side, Side)> {
    let value = |table: &[(Side, Side, V)], a: &Side, b: &Side| {
        table.iter().find(|(x, y, _)| (x, y) == (a, b) || (y, x) == (a, b)).map(|entry| entry.2)
    };
    let all = one.iter().chain(two).map(|(a, b, _)| (a.clone(), b.clone()));
    all.filter(|(a, b)| value(one, a, b) != value(two, a, b)).collect()
}

/// How often each regime was met.
#[derive(Debug, Default)]
struct Reached {
    kinds: [usize; 7],
    came_and_went: usize,
    robots: [usize; 3],
    touched_by_an_entry: usize,
    untouched_beside_entries: usize,
    gone: usize,
}

fn run(session: &[(Vec<Edit>, Option<u64>)], reached: &mut Reached) {
    let limits = Limits { snapshots_kept: 5, ..Limits::default() };
    let mut scene = Scene::with_limits(Epoch(1), limits);
    let (mut model, mut bases) = (Model::default(), BTreeMap::new());
    // Element n: what led to revision n + 1.
    let mut steps: Vec<Seen> = Vec::new();
    for (edits, ahead) in session {
        let expected = ahead.map(|ahead| Revision(scene.snapshot().revision().0 + ahead));
        if scene.apply(edits, expected).is_err() {
            continue;
        }
        let mut step = Seen::default();
        for edit in edits {
            let before = model.clone();
            model.apply(edit).unwrap();
            step.look(edit, &before, &model, &mut bases);
        }
        steps.push(step);
        let snapshot = scene.snapshot();
        assert_eq!(snapshot.validate(), Ok(()));
        assert_eq!(snapshot.oldest_change(), scene.oldest_revision());
        for since in 0..=steps.len() {
            let mut seen = Seen::default();
            steps[since..].iter().for_each(|step| seen.add(step));
            match snapshot.changes_since(Revision(since as u64)) {
                Ok(changes) => compare(&changes, &seen, &snapshot, &model, reached),
                Err(refused) => {
                    let oldest = scene.oldest_revision();
                    assert_eq!(refused, NotKept::Gone { asked: Revision(since as u64), oldest });
                    assert!((since as u64) < oldest.0);
                    reached.gone += 1;
                }
            }
        }
        let (ahead, latest) = (Revision(steps.len() as u64 + 1), snapshot.revision());
        assert_eq!(snapshot.changes_since(ahead).unwrap_err(), NotKept::Ahead { asked: ahead, latest });
    }
}

fn compare(changes: &Changes, seen: &Seen, snapshot: &Snapshot, model: &Model, reached: &mut Reached) {
    let told: Vec<(u64, ChangeKinds)> = changes.bodies().iter().map(|body| (body.id.0, body.kinds)).collect();
    assert_eq!(told, seen.bodies.iter().map(|(id, kinds)| (*id, *kinds)).collect::<Vec<_>>());
    let robots: Vec<(&str, ChangeKinds)> = changes.robots().iter().map(|robot| (&*robot.name, robot.kinds)).collect();
    assert_eq!(robots, seen.robots.iter().map(|(name, kinds)| (name.as_str(), *kinds)).collect::<Vec<_>>());
    for (_, kinds) in told {
        KINDS.iter().zip(&mut reached.kinds).for_each(|(kind, count)| *count += usize::from(kinds.contains(*kind)));
        reached.came_and_went += usize::from(kinds.contains(ChangeKinds::ADDED | ChangeKinds::REMOVED));
    }
    for (kind, count) in [ChangeKinds::ADDED, ChangeKinds::REMOVED, ChangeKinds::MOVED].iter().zip(&mut reached.robots)
    {
        *count += robots.iter().filter(|(_, kinds)| kinds.contains(*kind)).count();
    }
    let of_entries = changes.bodies_of_entries(snapshot);
    assert!(of_entries.is_sorted_by(|a, b| a < b) && of_entries.iter().all(|id| snapshot.body(*id).is_some()));
    // A group that nobody is in and no entry names is forgotten, and comes back as another; whoever was in it left it.
    let unchanged = |body: &&ModelBody| !seen.bodies.contains_key(&body.id);
    for x in model.bodies.iter().filter(unchanged) {
        for y in model.bodies.iter().filter(unchanged).filter(|y| y.id != x.id) {
            let [a, b] = [x, y].map(|body| snapshot.body(BodyId(body.id)).unwrap());
            let touched = changes.has_entry_for(a.member(), b.member());
            assert_eq!(touched, seen.speaks_of(x, y), "{x:?}, {y:?}, {seen:?}");
            assert!(!touched || of_entries.contains(&a.id) || of_entries.contains(&b.id));
            reached.touched_by_an_entry += usize::from(touched);
            reached.untouched_beside_entries += usize::from(!touched && changes.has_entries());
        }
    }
}

#[test]
fn the_log_tells_what_the_model_shows() {
    let reached = RefCell::new(Reached::default());
    let config = Config { cases: 300, failure_persistence: None, ..Config::default() };
    TestRunner::new(config)
        .run(&sessions(arm()), |session| {
            run(&session, &mut reached.borrow_mut());
            Ok(())
        })
        .unwrap();
    let Reached { kinds, came_and_went, robots, touched_by_an_entry, untouched_beside_entries, gone } =
        reached.into_inner();
    assert!(kinds.iter().chain(&robots).all(|count| *count >= 20), "{kinds:?}, {robots:?}");
    let others = [came_and_went, touched_by_an_entry, untouched_beside_entries, gone];
    assert!(others.iter().all(|count| *count >= 20), "{others:?}");
}

#[test]
fn what_is_so_already_changes_nothing() {
    let mut scene = scene_of([ball("a", 1.0), grouped("b", &["g", "h"])]);
    apply(&mut scene, &[allow(one("a"), one("b"), Some(true)), add_arm("arm", &arm())]);
    let since = scene.snapshot().revision();
    apply(
        &mut scene,
        &[
            Edit::MoveBody { body: "a".into(), pose: at(1.0) },
            Edit::SetGroups { body: "b".into(), groups: vec!["h".to_owned(), "g".to_owned(), "h".to_owned()] },
            Edit::SetLayers { body: "a".into(), layers: u32::MAX, mask: u32::MAX },
            Edit::SetEnabled { body: "a".into(), enabled: true },
            Edit::MoveRobot { robot: "arm".to_owned(), base: Pose::identity() },
            allow(one("b"), one("a"), Some(true)),
            margin(one("b"), one("a"), None),
        ],
    );
    let changes = scene.snapshot().changes_since(since).unwrap();
    assert!(changes.bodies().is_empty() && changes.robots().is_empty() && !changes.has_entries(), "{changes:?}");
    apply(&mut scene, &[Edit::MoveBody { body: "a".into(), pose: at(-0.0) }]);
    apply(&mut scene, &[Edit::MoveBody { body: "a".into(), pose: at(0.0) }]);
    let changes = scene.snapshot().changes_since(Revision(scene.snapshot().revision().0 - 1)).unwrap();
    assert_eq!(changes.bodies(), [BodyChange { id: BodyId(1), kinds: ChangeKinds::MOVED }], "the sign of a zero shows");
}

#[test]
fn a_log_of_one_kept_revision_knows_only_its_own() {
    let mut scene = Scene::with_limits(Epoch(1), Limits { snapshots_kept: 0, ..Limits::default() });
    apply(&mut scene, &[Edit::AddBody(ball("a", 0.0))]);
    let snapshot = scene.snapshot();
    assert!(snapshot.changes_since(Revision(1)).unwrap().bodies().is_empty());
    let gone = NotKept::Gone { asked: Revision(0), oldest: Revision(1) };
    assert_eq!(snapshot.changes_since(Revision(0)).unwrap_err(), gone);
}
