//! Contacts led on from one revision to another. Oracle: the difference of the two full sets, each of `Collide` over all pairs
//! at its own revision; every event, field by field.

use std::collections::BTreeMap;
use std::sync::Arc;

use clearance::geometry::{Pose, Quaternion, Shape, Vec3};
use clearance::narrow_phase::Solver;
use clearance::query::{
    ContactChanges, ContactEvent, ContactEventKind, ContactQuestion, ContactState, ContactTracker, Context, EndReason,
    Filter, Mode, NotAdvanced, PairAnswer, PairQuery, Prepared, Side, Subject, Threshold, Verdict, Wants,
};
use clearance::scene::{BodyId, Edit, Epoch, NewBody, Party, Revision, Scene, Snapshot};

use crate::moving_scene::{Chance, MovingScene};

type Set = BTreeMap<(BodyId, BodyId), (ContactState, PairAnswer)>;

/// The pairs in contact or undecided at a revision, from scratch.
fn full_set(snapshot: &Snapshot, question: &ContactQuestion) -> Set {
    let margin = match question.threshold {
        Threshold::Touching => 0.0,
        Threshold::Margin(margin) => margin,
    };
    // A group that nobody is in any more lets nobody through; `Collide` would refuse its name.
    let groups: Vec<String> =
        question.filter.groups.iter().filter(|group| snapshot.has_group(group)).cloned().collect();
    if groups.is_empty() && !question.filter.groups.is_empty() {
        return Set::new();
    }
    let filter = Filter {
        groups,
        ignore: question.filter.ignore.iter().copied().filter(|id| snapshot.body(*id).is_some()).collect(),
        ..question.filter.clone()
    };
    let (wants, solver) = (question.wants, question.solver);
    let context = Context { wants, margin, solver, filter, max_pairs: 10_000, ..Context::default() };
    let query = PairQuery { items: vec![Subject::All], mode: Mode::All, context };
    let answer = Prepared::collide(snapshot, &query).unwrap().answer(&|| false).items.remove(0);
    assert!(!answer.truncated && answer.problem.is_none());
    let mut set = Set::new();
    for pair in answer.pairs {
        let [a, b] = [&pair.a, &pair.b].map(|side| match side {
            Side::Body { id, .. } => *id,
            Side::Link { .. } | Side::Query { .. } => panic!("only bodies were asked about"),
        });
        let bodies = [a, b].map(|id| snapshot.body(id).unwrap());
        let threshold = match question.threshold {
            Threshold::Touching => 0.0,
            Threshold::Margin(margin) => snapshot.margin(bodies[0].member(), bodies[1].member()).unwrap_or(margin),
        };
        let state = if pair.bracket.upper <= threshold {
            ContactState::Contact
        } else if pair.bracket.lower > threshold {
            continue; // Within an entry's margin, and only touching counts.
        } else {
            ContactState::Undecided
        };
        set.insert((a, b), (state, pair));
    }
    set
}

/// What the two sets say without knowing what happened in between.
fn difference(before: &Set, after: &Set, now: &Snapshot, question: &ContactQuestion) -> Vec<ContactEvent> {
    let mut keys: Vec<_> = before.keys().chain(after.keys()).copied().collect();
    keys.sort_unstable();
    keys.dedup();
    let event = |key: (BodyId, BodyId)| {
        let state = |set: &Set| set.get(&key).map_or(ContactState::Apart, |(state, _)| *state);
        let (was, is) = (state(before), state(after));
        let kind = match is {
            _ if was == is => ContactEventKind::Stay,
            ContactState::Contact => ContactEventKind::Begin,
            ContactState::Apart => ContactEventKind::End,
            ContactState::Undecided => ContactEventKind::Undecided,
        };
        let reason = (kind == ContactEventKind::End).then(|| match (now.body(key.0), now.body(key.1)) {
            (None, _) | (_, None) => EndReason::Removed,
            (Some(a), Some(b)) if !a.enabled || !b.enabled => EndReason::Disabled,
            (Some(a), Some(b)) => {
                let groups = &question.filter.groups;
                let passes =
                    [a, b].iter().all(|body| groups.is_empty() || groups.iter().any(|group| body.is_in(group)));
                let unbounded = a.bounds.is_none() && b.bounds.is_none();
                if passes && now.admits(a, b) && !unbounded { EndReason::Apart } else { EndReason::NotAPair }
            }
        });
        let pair = after.get(&key).map(|(_, answer)| answer.clone());
        ContactEvent { a: key.0, b: key.1, kind, before: was, after: is, reason, pair }
    };
    let all = keys.into_iter().map(event);
    all.filter(|event| question.stays || event.kind != ContactEventKind::Stay).collect()
}

/// In the order begin, stay, end, undecided; then by what was before and is after, the reasons, and what was led over.
#[derive(Debug, Default)]
struct Reached {
    transitions: BTreeMap<String, usize>,
    skipped: usize,
    measured_all: usize,
    same_revision: usize,
    nothing_changed: usize,
}

fn check(changes: &ContactChanges, before: &Set, after: &Set, now: &Snapshot, question: &ContactQuestion) {
    let expected = difference(before, after, now, question);
    assert_eq!(changes.events, expected, "to revision {}, {question:?}, {before:?}", now.revision());
    let count = |state| after.values().filter(|(own, _)| *own == state).count();
    assert_eq!(changes.contacts, count(ContactState::Contact));
    assert_eq!(changes.undecided, count(ContactState::Undecided));
    assert_eq!((changes.epoch, changes.revision), (now.epoch(), now.revision()));
}

fn run(seed: u64, question: &ContactQuestion, reached: &mut Reached) {
    let mut moving = MovingScene::new(seed, 4);
    let mut chance = Chance::new(seed + 77);
    let mut tracker = ContactTracker::new(question.clone());
    let mut sets = Set::new();
    for round in 0..30 {
        let lists = [1, 1, 1, 0, 2, 3, 7][chance.below(7)];
        (0..lists).for_each(|_| moving.step());
        let snapshot = &moving.snapshot();
        if round == 0 && question.filter.groups.iter().any(|group| !snapshot.has_group(group)) {
            return;
        }
        let from = tracker.revision();
        let changes = tracker.advance(snapshot, &|| false).unwrap();
        let now = full_set(snapshot, question);
        assert_eq!(changes.from, from);
        check(&changes, &sets, &now, snapshot, question);
        let held: Vec<_> = tracker.pairs().collect();
        assert_eq!(held, now.iter().map(|((a, b), (state, _))| (*a, *b, *state)).collect::<Vec<_>>());
        for event in &changes.events {
            let name = format!("{:?} {:?}->{:?} {:?}", event.kind, event.before, event.after, event.reason);
            *reached.transitions.entry(name).or_default() += 1;
        }
        reached.skipped += usize::from(lists == 2 || lists == 3);
        reached.measured_all += usize::from(lists == 7);
        reached.same_revision += usize::from(lists == 0);
        reached.nothing_changed += usize::from(lists == 1 && changes.cost.pairs == 0);
        sets = now;
    }
}

fn questions() -> Vec<ContactQuestion> {
    let plain = ContactQuestion::default();
    let all = Wants { depth: true, witness: true, ..Wants::VERDICT };
    vec![
        plain.clone(),
        ContactQuestion { stays: true, wants: all, ..plain.clone() },
        ContactQuestion { threshold: Threshold::Margin(0.1), stays: true, ..plain.clone() },
        ContactQuestion { threshold: Threshold::Margin(0.0), wants: all, ..plain.clone() },
        // Gives up early, so that many pairs cannot be decided.
        ContactQuestion { solver: Solver::FrankWolfe, stays: true, ..plain.clone() },
        ContactQuestion { solver: Solver::FrankWolfe, threshold: Threshold::Margin(0.05), ..plain.clone() },
        ContactQuestion {
            filter: Filter { groups: vec!["g".to_owned(), "h".to_owned()], ..Filter::default() },
            ..plain
        },
    ]
}

#[test]
fn leading_on_tells_the_difference_of_the_full_sets() {
    let mut reached = Reached::default();
    for question in questions() {
        (0..40).for_each(|seed| run(seed, &question, &mut reached));
    }
    for transition in [
        "Begin Apart->Contact None",
        "Begin Undecided->Contact None",
        "Stay Contact->Contact None",
        "Stay Undecided->Undecided None",
        "End Contact->Apart Some(Removed)",
        "End Contact->Apart Some(Disabled)",
        "End Contact->Apart Some(NotAPair)",
        "End Contact->Apart Some(Apart)",
        "End Undecided->Apart Some(Removed)",
        "End Undecided->Apart Some(Disabled)",
        "End Undecided->Apart Some(NotAPair)",
        "End Undecided->Apart Some(Apart)",
        "Undecided Apart->Undecided None",
        "Undecided Contact->Undecided None",
    ] {
        let count = reached.transitions.get(transition).copied().unwrap_or(0);
        assert!(count >= 5, "{transition}: only {count}; {reached:?}");
    }
    let Reached { skipped, measured_all, same_revision, nothing_changed, transitions: _ } = reached;
    let others = [skipped, measured_all, same_revision, nothing_changed];
    assert!(others.iter().all(|count| *count >= 100), "{others:?}");
}

#[test]
fn equal_histories_give_equal_events_whatever_was_led_over_in_between() {
    for seed in 0..20 {
        let mut moving = MovingScene::new(seed, 40);
        let question = ContactQuestion { stays: true, ..ContactQuestion::default() };
        let mut stepwise = ContactTracker::new(question.clone());
        let mut at_once = ContactTracker::new(question.clone());
        stepwise.advance(&moving.snapshot(), &|| false).unwrap();
        at_once.advance(&moving.snapshot(), &|| false).unwrap();
        let mut again = stepwise.clone();
        for _ in 0..10 {
            moving.step();
            let one = stepwise.advance(&moving.snapshot(), &|| false).unwrap();
            assert_eq!(one, again.advance(&moving.snapshot(), &|| false).unwrap());
        }
        at_once.advance(&moving.snapshot(), &|| false).unwrap();
        moving.step();
        let last = moving.snapshot();
        let (one, two) = (stepwise.advance(&last, &|| false).unwrap(), at_once.advance(&last, &|| false).unwrap());
        assert_eq!(one, two, "what comes after does not depend on the way to the revision led on from");
    }
}

fn at(x: f64) -> Pose {
    Pose::new(Vec3::new(x, 0.0, 0.0), Quaternion::IDENTITY).unwrap()
}

fn ball(name: &str, x: f64) -> Edit {
    Edit::AddBody(NewBody::new(name, Arc::new(Shape::sphere(0.5).unwrap()), at(x)))
}

fn kinds(changes: &ContactChanges) -> Vec<(ContactEventKind, u64, u64)> {
    changes.events.iter().map(|event| (event.kind, event.a.0, event.b.0)).collect()
}

#[test]
fn what_does_not_move_is_not_measured_again() {
    let mut scene = Scene::new(Epoch(1));
    let balls: Vec<Edit> = (0..1000).map(|i| ball(&format!("ball {i}"), 0.75 * f64::from(i))).collect();
    scene.apply(&balls, None).unwrap();
    let mut tracker = ContactTracker::new(ContactQuestion::default());
    let first = tracker.advance(&scene.snapshot(), &|| false).unwrap();
    assert_eq!((first.from, first.events.len(), first.contacts), (None, 999, 999));
    scene.apply(&[Edit::MoveBody { body: BodyId(500).into(), pose: at(-0.75) }], None).unwrap();
    let moved = tracker.advance(&scene.snapshot(), &|| false).unwrap();
    let (begin, end) = (ContactEventKind::Begin, ContactEventKind::End);
    assert_eq!(kinds(&moved), [(begin, 1, 500), (end, 499, 500), (end, 500, 501)]);
    assert!(moved.cost.pairs <= 4 && moved.cost.nodes < 100, "{:?}", moved.cost);
    assert_eq!(moved.contacts, 998);
}

#[test]
fn a_margin_that_changes_begins_and_ends_contacts_of_bodies_that_rest() {
    let mut scene = Scene::new(Epoch(1));
    scene.apply(&[ball("a", 0.0), ball("b", 1.1), ball("c", 2.2)], None).unwrap();
    let margin = |a: Party, b: Party, margin| Edit::SetPairMargin { a, b, margin };
    let mut near =
        ContactTracker::new(ContactQuestion { threshold: Threshold::Margin(0.01), ..ContactQuestion::default() });
    let mut touching = ContactTracker::new(ContactQuestion::default());
    let mut advance = |scene: &Scene| {
        let snapshot = scene.snapshot();
        assert_eq!(kinds(&touching.advance(&snapshot, &|| false).unwrap()), []);
        kinds(&near.advance(&snapshot, &|| false).unwrap())
    };
    assert_eq!(advance(&scene), []);
    scene.apply(&[margin(Party::Body("a".into()), Party::Everything, Some(0.2))], None).unwrap();
    assert_eq!(advance(&scene), [(ContactEventKind::Begin, 1, 2)]);
    scene.apply(&[margin(Party::Everything, Party::Everything, Some(0.2))], None).unwrap();
    assert_eq!(advance(&scene), [(ContactEventKind::Begin, 2, 3)]);
    scene.apply(&[margin(Party::Everything, Party::Everything, None)], None).unwrap();
    assert_eq!(advance(&scene), [(ContactEventKind::End, 2, 3)]);
}

#[test]
fn what_touches_or_not_within_the_margin_is_in_contact_all_the_same() {
    // Centres exactly the sum of the radii apart, but off the axes: a square root that no bracket proves to be exact.
    let mut scene = Scene::new(Epoch(1));
    let place = |x: f64, y: f64| Pose::new(Vec3::new(x, y, 0.0), Quaternion::IDENTITY).unwrap();
    let shape = Arc::new(Shape::cylinder(0.625, 1.0).unwrap());
    let body = |name: &str, pose| Edit::AddBody(NewBody::new(name, Arc::clone(&shape), pose));
    scene.apply(&[body("a", place(0.0, 0.0)), body("b", place(0.75, 1.0))], None).unwrap();
    let mut touching = ContactTracker::new(ContactQuestion::default());
    let open = touching.advance(&scene.snapshot(), &|| false).unwrap();
    assert_eq!(kinds(&open), [(ContactEventKind::Undecided, 1, 2)]);
    assert_eq!((open.contacts, open.undecided), (0, 1));
    let mut near =
        ContactTracker::new(ContactQuestion { threshold: Threshold::Margin(0.01), ..ContactQuestion::default() });
    let within = near.advance(&scene.snapshot(), &|| false).unwrap();
    assert_eq!(kinds(&within), [(ContactEventKind::Begin, 1, 2)]);
    assert!(matches!(within.events[0].pair.as_ref().unwrap().verdict, Verdict::Indeterminate(_)));
}

/// A limit near the largest number overflowed in the length at which the list of pairs is cut, so that it was sorted for
/// every pair.
#[test]
fn the_largest_limit_is_no_limit() {
    let mut scene = Scene::new(Epoch(1));
    let balls: Vec<Edit> = (0..80).map(|i| ball(&format!("{i}"), 0.45 * f64::from(i))).collect();
    scene.apply(&balls, None).unwrap();
    for max_contacts in [usize::MAX, usize::MAX / 2, usize::MAX / 2 - 31] {
        let mut tracker = ContactTracker::new(ContactQuestion { max_contacts, ..ContactQuestion::default() });
        assert_eq!(tracker.advance(&scene.snapshot(), &|| false).unwrap().events.len(), 79 + 78);
    }
}

#[test]
fn what_cannot_be_led_on_is_refused_and_changes_nothing() {
    let mut scene = Scene::new(Epoch(1));
    scene.apply(&[ball("a", 0.0), ball("b", 0.45), ball("c", 0.9)], None).unwrap();
    let early = scene.snapshot();
    let question = ContactQuestion { max_contacts: 3, ..ContactQuestion::default() };
    let mut tracker = ContactTracker::new(question.clone());
    assert_eq!(tracker.advance(&early, &|| true), Err(NotAdvanced::Stopped));
    assert_eq!(tracker.revision(), None);
    tracker.advance(&early, &|| false).unwrap();

    scene.apply(&[ball("d", 1.35)], None).unwrap();
    let refused = tracker.advance(&scene.snapshot(), &|| false).unwrap_err();
    assert_eq!(refused.to_string(), "max_contacts exceeded: asked for 5, allowed is 3");
    assert_eq!((tracker.revision(), tracker.pairs().count()), (Some(Revision(1)), 3));
    scene.apply(&[Edit::RemoveBody { body: "c".into() }], None).unwrap();
    let (begin, end) = (ContactEventKind::Begin, ContactEventKind::End);
    let changes = tracker.advance(&scene.snapshot(), &|| false).unwrap();
    assert_eq!(kinds(&changes), [(end, 1, 3), (end, 2, 3), (begin, 2, 4)]);
    assert_eq!(
        tracker.advance(&early, &|| false),
        Err(NotAdvanced::Backwards { asked: Revision(1), tracked: Revision(3) })
    );
    let other = Scene::new(Epoch(2)).snapshot();
    assert_eq!(tracker.advance(&other, &|| false), Err(NotAdvanced::OtherEpoch { asked: Epoch(2), tracked: Epoch(1) }));
    let mut many = ContactTracker::new(ContactQuestion { max_contacts: 2, ..question.clone() });
    assert!(matches!(many.advance(&early, &|| false), Err(NotAdvanced::TooMany(_))));

    let refused = |question: ContactQuestion| match ContactTracker::new(question).advance(&early, &|| false) {
        Err(NotAdvanced::Refused(refused)) => refused.to_string(),
        other => panic!("{other:?}"),
    };
    let plain = ContactQuestion::default();
    for (margin, problem) in [(f64::NAN, "is not finite"), (-1.0, "is negative: -1"), (f64::INFINITY, "is not finite")]
    {
        let question = ContactQuestion { threshold: Threshold::Margin(margin), ..plain.clone() };
        assert_eq!(refused(question), format!("context.margin: {problem}"));
    }
    let group = Filter { groups: vec!["nobody".to_owned()], ..Filter::default() };
    assert_eq!(
        refused(ContactQuestion { filter: group, ..plain.clone() }),
        "no group \"nobody\" in the scene (revision 1)"
    );
    let unknown = Filter { ignore: vec![BodyId(9)], ..Filter::default() };
    assert_eq!(
        refused(ContactQuestion { filter: unknown, ..plain.clone() }),
        "no body \"9\" in the scene (revision 1)"
    );
    let cylinder =
        |name: &str| Edit::AddBody(NewBody::new(name, Arc::new(Shape::cylinder(0.5, 0.5).unwrap()), at(0.0)));
    scene.apply(&[cylinder("e"), cylinder("f")], None).unwrap();
    let mut by_qp = ContactTracker::new(ContactQuestion { solver: Solver::Qp, ..plain });
    let unclaimed = by_qp.advance(&scene.snapshot(), &|| false).unwrap_err().to_string();
    assert!(unclaimed.starts_with("context.solver: the solver qp does not take a"), "{unclaimed}");
    assert_eq!(by_qp.revision(), None);
}
