//! Pairs changed since a revision. Oracle: all pairs, of which those are left that have a changed side or entry by the lists
//! kept beside the scene; for distances every such pair measured one by one.

use clearance::geometry::{Pose, Shape};
use clearance::narrow_phase::{Bracket, Goal, separation};
use clearance::query::{
    Context, ItemAnswer, Mode, PairAnswer, PairQuery, Prepared, Refused, Side, Subject, Verdict, Wants,
};
use clearance::scene::{Body, BodyId, Edit, Epoch, NewBody, Revision, Scene, Snapshot};

use crate::moving_scene::MovingScene;

fn query(subject: Subject, context: Context) -> PairQuery {
    PairQuery { items: vec![subject], mode: Mode::All, context }
}

fn collide(snapshot: &Snapshot, subject: Subject, context: Context) -> ItemAnswer {
    Prepared::collide(snapshot, &query(subject, context)).unwrap().answer(&|| false).items.remove(0)
}

fn distance(snapshot: &Snapshot, subject: Subject, context: Context) -> ItemAnswer {
    Prepared::distance(snapshot, &query(subject, context)).unwrap().answer(&|| false).items.remove(0)
}

fn bodies<'s>(snapshot: &'s Snapshot, pair: &PairAnswer) -> [&'s Body; 2] {
    [&pair.a, &pair.b].map(|side| match side {
        Side::Body { id, .. } => &**snapshot.body(*id).unwrap(),
        Side::Link { .. } | Side::Query { .. } => panic!("only bodies were asked about"),
    })
}

/// The bracket of the least distance of the pairs that count, each measured by itself.
fn least(snapshot: &Snapshot, moving: &MovingScene, since: Revision) -> Option<Bracket> {
    let mut least: Option<Bracket> = None;
    for a in snapshot.bodies() {
        for b in snapshot.bodies().filter(|b| b.id > a.id) {
            if snapshot.admits(a, b) && moving.changed_since(since, a, b) {
                let found = separation(&a.shape, &b.shape, &a.placement, &b.placement, &Goal::penetration());
                let Ok(found) = found else { continue };
                let Bracket { lower, upper } = found.bracket;
                least =
                    Some(least.map_or(found.bracket, |old| Bracket {
                        lower: old.lower.min(lower),
                        upper: old.upper.min(upper),
                    }));
            }
        }
    }
    least
}

#[test]
fn changed_pairs_are_those_of_all_pairs_that_have_changed() {
    let [mut listed, mut left_out, mut by_entry_alone, mut both_changed, mut none, mut gone] = [0_usize; 6];
    for seed in 0..60 {
        let mut moving = MovingScene::new(seed, 6);
        for _ in 0..25 {
            moving.step();
            let snapshot = &moving.snapshot();
            let wants =
                if seed % 2 == 0 { Wants::VERDICT } else { Wants { depth: true, witness: true, ..Wants::VERDICT } };
            let context = Context { wants, margin: 0.1, max_pairs: 10_000, ..Context::default() };
            let all = collide(snapshot, Subject::All, context.clone());
            for back in 0..=7.min(snapshot.revision().0) {
                let since = Revision(snapshot.revision().0 - back);
                let question = query(Subject::ChangedSince(since), context.clone());
                let prepared = Prepared::collide(snapshot, &question);
                if since < moving.scene.oldest_revision() {
                    let oldest = moving.scene.oldest_revision();
                    assert_eq!(prepared.err(), Some(Refused::Gone { asked: since, oldest }));
                    gone += 1;
                    continue;
                }
                let found = prepared.unwrap().answer(&|| false).items.remove(0);
                let counts = |pair: &&PairAnswer| {
                    let [a, b] = bodies(snapshot, pair);
                    moving.changed_since(since, a, b)
                };
                let expected: Vec<PairAnswer> = all.pairs.iter().filter(counts).cloned().collect();
                assert_eq!(found.pairs, expected, "seed {seed}, since {since}");
                let verdict = expected.iter().fold(Verdict::Free, |verdict, pair| verdict.and(pair.verdict));
                assert_eq!(found.verdict, verdict);

                let changes = snapshot.changes_since(since).unwrap();
                listed += found.pairs.len();
                left_out += all.pairs.len() - found.pairs.len();
                none += usize::from(back == 0 && found.pairs.is_empty());
                for pair in &found.pairs {
                    let changed = bodies(snapshot, pair).map(|body| changes.has_body(body.id));
                    by_entry_alone += usize::from(changed == [false; 2]);
                    both_changed += usize::from(changed == [true; 2]);
                }

                let wants = Wants { depth: true, ..Wants::VERDICT };
                let nearest = distance(snapshot, Subject::ChangedSince(since), Context { wants, ..Context::default() });
                match (least(snapshot, &moving, since), nearest.nearest.map(|pair| pair.bracket)) {
                    (Some(truth), Some(told)) => {
                        let meets = told.lower <= truth.upper && truth.lower <= told.upper;
                        assert!(meets, "seed {seed}, since {since}: {told:?}, {truth:?}");
                    }
                    (truth, told) => assert!(truth.is_none() && told.is_none(), "{truth:?}, {told:?}"),
                }
            }
        }
    }
    let regimes = [listed, left_out, by_entry_alone, both_changed, none, gone];
    assert!(regimes.iter().all(|count| *count >= 100), "{regimes:?}");
}

#[test]
fn only_what_changed_is_walked() {
    let ball = std::sync::Arc::new(Shape::sphere(0.3).unwrap());
    let at = |x: f64| {
        Pose::new(clearance::geometry::Vec3::new(x, 0.0, 0.0), clearance::geometry::Quaternion::IDENTITY).unwrap()
    };
    let body =
        |i: usize| Edit::AddBody(NewBody::new(format!("ball {i}"), std::sync::Arc::clone(&ball), at(0.5 * i as f64)));
    let mut scene = Scene::new(Epoch(1));
    scene.apply(&(0..5000).map(body).collect::<Vec<_>>(), None).unwrap();
    let before = scene.snapshot().revision();
    scene.apply(&[Edit::MoveBody { body: BodyId(2500).into(), pose: at(0.2) }], None).unwrap();
    let answer = collide(&scene.snapshot(), Subject::ChangedSince(before), Context::default());
    let ids: Vec<BodyId> =
        answer.pairs.iter().flat_map(|pair| bodies(&scene.snapshot(), pair).map(|body| body.id)).collect();
    assert_eq!(ids, [1, 2500, 2, 2500].map(BodyId));
    assert!(answer.cost.pairs <= 4 && answer.cost.nodes < 100, "{:?}", answer.cost);
}

#[test]
fn a_revision_to_come_is_invalid_by_name() {
    let mut scene = Scene::new(Epoch(1));
    scene.apply(&[], None).unwrap();
    let items = vec![Subject::All, Subject::ChangedSince(Revision(2))];
    let question = PairQuery { items, mode: Mode::All, context: Context::default() };
    let refused = Prepared::distance(&scene.snapshot(), &question).err().unwrap();
    assert_eq!(refused.to_string(), "items[1].changed_since: revision 2 comes after revision 1, which is asked");
}
