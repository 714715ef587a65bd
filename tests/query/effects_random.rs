//! Scenes with random declarations. Oracle: what is declared of each pair by itself; of lists, each body asked alone.

use std::collections::BTreeSet;
use std::sync::Arc;

use clearance::geometry::{Pose, Quaternion, Shape, Vec3};
use clearance::query::{Context, Mode, PairQuery, Prepared, Side, Subject, Wants};
use clearance::scene::{BodyId, Edit, Effect, Effects, Epoch, NewBody, Party, Scene, Snapshot};

/// SplitMix64 (Steele, Lea, Flood 2014).
struct Random(u64);

impl Random {
    fn below(&mut self, n: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) % n
    }
}

const BODIES: u64 = 14;

/// Balls that overlap their neighbours, in none to two of three groups each, and some declarations.
fn scene(random: &mut Random) -> Arc<Snapshot> {
    let group = |number: u64| ["g", "h", "k"][number as usize].to_owned();
    let mut scene = Scene::new(Epoch(1));
    let ball = Arc::new(Shape::sphere(0.7).unwrap());
    let body = |i: u64, random: &mut Random| {
        let pose = Pose::new(Vec3::new(0.5 * i as f64, 0.0, 0.0), Quaternion::IDENTITY).unwrap();
        let mut body = NewBody::new(format!("{i}"), Arc::clone(&ball), pose);
        body.groups = match random.below(8) {
            0 => vec![],
            1 => vec![group(1), group(2)],
            n => vec![group(n % 3)],
        };
        Edit::AddBody(body)
    };
    let edits: Vec<Edit> = (1..=BODIES).map(|i| body(i, random)).collect();
    scene.apply(&edits, None).unwrap();
    let party = |random: &mut Random| match random.below(8) {
        0 => Party::Everything,
        1 => Party::Body(clearance::scene::BodyRef::Id(BodyId(1 + random.below(BODIES)))),
        n => Party::Group(group(n % 3)),
    };
    let mut declarations = Vec::new();
    for _ in 0..random.below(6) {
        let a = party(random);
        let b = if random.below(3) == 0 { a.clone() } else { party(random) };
        let effects = if random.below(3) == 0 { Effects::of(Effect::Depth) } else { Effects::NONE };
        declarations.push(Edit::DeclareEffects { a, b, effects: Some(effects) });
    }
    for declaration in declarations {
        // A body and itself make no pair.
        let _ = scene.apply(&[declaration], None);
    }
    scene.snapshot()
}

fn listed(snapshot: &Snapshot, items: Vec<Subject>) -> (BTreeSet<(BodyId, BodyId)>, usize, u64) {
    let context = Context { wants: Wants { pairs: true, ..Wants::VERDICT }, max_pairs: 10_000, ..Context::default() };
    let query = PairQuery { items, mode: Mode::All, context };
    let answer = Prepared::collide(snapshot, &query).unwrap().answer(&|| false);
    let of = |side: &Side| match side {
        Side::Body { id, .. } => *id,
        Side::Link { .. } | Side::Query { .. } => panic!("{side:?}"),
    };
    let pairs: Vec<_> =
        answer.items.iter().flat_map(|item| &item.pairs).map(|pair| (of(&pair.a), of(&pair.b))).collect();
    (pairs.iter().copied().collect(), pairs.len(), answer.cost.nodes)
}

#[test]
fn whoever_need_not_look_has_nobody_to_find() {
    let mut random = Random(3);
    let (mut alone, mut quiet_pairs, mut kept_quiet, mut without_walk) = (0, 0, 0, 0);
    for _ in 0..4000 {
        let snapshot = scene(&mut random);
        let quiet = snapshot.quiet_bodies();
        let bodies: Vec<_> = snapshot.bodies().collect();
        for one in &bodies {
            let meets_no_body = snapshot.meets_no_body(one.member());
            for two in bodies.iter().filter(|two| two.id != one.id) {
                let empty = snapshot.is_declared_empty(one.member(), two.member());
                assert!(empty || !meets_no_body, "{} and {}", one.id, two.id);
                let both = quiet.has(one.member()) && quiet.has(two.member());
                assert!(empty || !both, "{} and {}", one.id, two.id);
                quiet_pairs += usize::from(both);
                kept_quiet += usize::from(quiet.has(one.member()) && !empty);
            }
            alone += usize::from(meets_no_body);
        }
        let each: Vec<Subject> = bodies.iter().map(|body| Subject::Body(body.id)).collect();
        let (all, count, nodes) = listed(&snapshot, vec![Subject::All]);
        let (one_by_one, twice, _) = listed(&snapshot, each);
        assert_eq!(all, one_by_one);
        assert_eq!((count, twice), (all.len(), 2 * all.len()), "each pair once");
        without_walk += usize::from(nodes == 0);
    }
    let regimes = [alone, quiet_pairs, kept_quiet, without_walk];
    assert!(regimes.iter().all(|count| *count > 100), "{regimes:?}");
}
