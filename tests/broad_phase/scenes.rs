//! Scenes that differ in their broad phase alone: no answer differs, and none lacks a pair.
//!
//! Oracle: every pair of bodies measured one by one, admitted and given its margin by the snapshot. Pairs within 1e-7 m of
//! their margin are left to the brackets.

use std::sync::Arc;

use clearance::geometry::{Pose, Quaternion, Shape, Vec3};
use clearance::limits::Limits;
use clearance::narrow_phase::{Goal, separation};
use clearance::query::{Answer, Context, Filter, ItemAnswer, Mode, PairQuery, Prepared, Side, Subject, Verdict, Wants};
use clearance::scene::{Body, BodyId, Edit, Epoch, NewBody, Party, Scene, SceneOptions, Snapshot};

use crate::commands::KINDS;
use crate::random::Random;

/// What the sweep came by.
#[derive(Debug, Default)]
struct Reached {
    colliding: usize,
    within_margin: usize,
    free: usize,
    allowed: usize,
    other_layers: usize,
    own_margin: usize,
    unbounded: usize,
    filtered: usize,
    empty_scenes: usize,
    single_bodies: usize,
    removed: usize,
}

fn pose(random: &mut Random, side: f64) -> Pose {
    let turn = random.vector(1.0);
    let turn = Quaternion { w: 0.5 + random.next(), x: turn.x - 0.5, y: turn.y - 0.5, z: turn.z - 0.5 };
    Pose::new(random.vector(side), turn).unwrap()
}

fn shape(random: &mut Random) -> Shape {
    let half = random.vector(0.5) + Vec3::repeat(0.01);
    match random.below(12) {
        0 => Shape::half_space(Vec3::z(), -0.5).unwrap(),
        1 => Shape::cuboid(Vec3::new(3.0, 0.005, 0.005)).unwrap(),
        2 => Shape::cuboid(Vec3::repeat(0.25)).unwrap(),
        3..=5 => Shape::cuboid(half).unwrap(),
        6 | 7 => Shape::cylinder(half.x, half.z).unwrap(),
        _ => Shape::sphere(half.x).unwrap(),
    }
}

fn party(random: &mut Random, living: &[BodyId]) -> Party {
    match random.below(4) {
        0 => Party::Group(format!("group {}", random.below(3))),
        1 if random.below(4) == 0 => Party::Everything,
        _ => Party::Body(living[random.below(living.len())].into()),
    }
}

/// One list of edits, all of which fit.
fn edits(random: &mut Random, living: &mut Vec<BodyId>, next: &mut u64, side: f64, reached: &mut Reached) -> Vec<Edit> {
    let mut edits = Vec::new();
    for _ in 0..random.below(20) {
        let some = |random: &mut Random| -> BodyId { living[random.below(living.len())] };
        match random.below(10) {
            _ if living.is_empty() => (),
            0 => {
                let gone = living.swap_remove(random.below(living.len()));
                edits.push(Edit::RemoveBody { body: gone.into() });
                reached.removed += 1;
                continue;
            }
            1..=3 => {
                edits.push(Edit::MoveBody { body: some(random).into(), pose: pose(random, side) });
                continue;
            }
            4 => {
                let (body, enabled) = (some(random).into(), random.below(3) > 0);
                edits.push(Edit::SetEnabled { body, enabled });
                continue;
            }
            5 => {
                let (a, b) = (party(random, living), party(random, living));
                let of_one = matches!((&a, &b), (Party::Body(one), Party::Body(other)) if one == other);
                let allowed = [Some(true), Some(false), None][random.below(3)];
                edits.extend((!of_one).then_some(Edit::SetAllowedCollision { a, b, allowed }));
                continue;
            }
            6 => {
                let (a, b) = (party(random, living), party(random, living));
                let of_one = matches!((&a, &b), (Party::Body(one), Party::Body(other)) if one == other);
                let margin = [Some(0.0), Some(0.4 * random.next()), None][random.below(3)];
                edits.extend((!of_one).then_some(Edit::SetPairMargin { a, b, margin }));
                continue;
            }
            7 => {
                let body = some(random).into();
                let (layers, mask) = (1 << random.below(2), 1 << random.below(2));
                edits.push(Edit::SetLayers { body, layers, mask });
                continue;
            }
            _ => (),
        }
        let groups = vec![format!("group {}", random.below(3))];
        let body = NewBody::new(format!("body {next}"), Arc::new(shape(random)), pose(random, side));
        edits.push(Edit::AddBody(NewBody { groups, ..body }));
        living.push(BodyId(*next));
        *next += 1;
    }
    edits
}

fn ask(snapshot: &Snapshot, query: &PairQuery, distance: bool) -> Answer {
    let prepared = if distance { Prepared::distance(snapshot, query) } else { Prepared::collide(snapshot, query) };
    prepared.unwrap().answer(&|| false)
}

/// Pairs of bodies in the list of an item.
fn listed(item: &ItemAnswer) -> Vec<(BodyId, BodyId, Verdict)> {
    let id = |side: &Side| match side {
        Side::Body { id, .. } => *id,
        Side::Link { .. } | Side::Query { .. } => panic!("only bodies were asked about"),
    };
    item.pairs.iter().map(|pair| (id(&pair.a), id(&pair.b), pair.verdict)).collect()
}

/// Every pair that must be in the list of all against all.
fn check_list(snapshot: &Snapshot, context: &Context, item: &ItemAnswer, reached: &mut Reached) {
    let found = listed(item);
    let filter = &context.filter;
    let counts = |body: &Body| {
        let in_groups = filter.groups.is_empty() || filter.groups.iter().any(|group| body.is_in(group));
        body.enabled && in_groups && !filter.ignore.contains(&body.id)
    };
    let bodies: Vec<&Arc<Body>> = snapshot.bodies().collect();
    reached.empty_scenes += usize::from(bodies.is_empty());
    reached.single_bodies += usize::from(bodies.len() == 1);
    for (i, a) in bodies.iter().enumerate() {
        for b in &bodies[i + 1..] {
            let is_found = found.binary_search_by_key(&(a.id, b.id), |(a, b, _)| (*a, *b)).is_ok();
            let allowed = snapshot.is_allowed(a.member(), b.member()) && !filter.disregard_allowed_collisions;
            let meets = a.meets(b.layers, b.mask);
            reached.allowed += usize::from(allowed);
            reached.other_layers += usize::from(!meets);
            if !counts(a) || !counts(b) || !b.enabled || !meets || allowed {
                reached.filtered += usize::from(!counts(a) || !counts(b));
                assert!(!is_found, "the pair {}, {} is not to be looked at", a.name, b.name);
                continue;
            }
            let Ok(truth) = separation(&a.shape, &b.shape, &a.placement, &b.placement, &Goal::penetration()) else {
                assert!(!is_found, "two unbounded bodies have no distance");
                continue;
            };
            let own = snapshot.margin(a.member(), b.member());
            let margin = own.unwrap_or(context.margin);
            reached.own_margin += usize::from(own.is_some());
            reached.unbounded += usize::from(a.bounds.is_none() || b.bounds.is_none());
            match truth.signed_distance {
                d if (d - margin).abs() < 1e-7 || d.abs() < 1e-7 => continue,
                d if d <= 0.0 => reached.colliding += 1,
                d if d <= margin => reached.within_margin += 1,
                _ => reached.free += 1,
            }
            let expected = truth.signed_distance <= margin;
            assert_eq!(is_found, expected, "{} and {}: {truth:?}, margin {margin}", a.name, b.name);
        }
    }
}

#[test]
fn the_choice_changes_no_answer_and_no_answer_lacks_a_pair() {
    let mut reached = Reached::default();
    for seed in 0..60 {
        let random = &mut Random(seed);
        let side = [1.5, 4.0, 12.0][seed as usize % 3];
        let mut scenes =
            KINDS.map(|broad_phase| Scene::with_options(Epoch(1), Limits::default(), &SceneOptions { broad_phase }));
        let (mut living, mut next) = (Vec::new(), 1);
        for round in 0..8 {
            let margin = [0.0, 0.1, 0.3][random.below(3)];
            let mut filter = Filter::default();
            let snapshots = scenes.each_ref().map(Scene::snapshot);
            if round % 3 == 1 && snapshots[0].has_group("group 1") {
                filter.groups.push("group 1".to_owned());
            }
            filter.disregard_allowed_collisions = random.below(4) == 0;
            if let (0, Some(body)) = (random.below(3), living.first()) {
                filter.ignore.push(*body);
            }
            let wants = [Wants::VERDICT, Wants::ALL][random.below(2)];
            let context = Context { margin, wants, filter, max_pairs: 100_000, ..Context::default() };
            let mut items = vec![Subject::All];
            items.extend(living.iter().take(5).map(|id| Subject::Body(*id)));
            for _ in 0..3 {
                let at = pose(random, side);
                items.push(Subject::Shape { shape: Shape::sphere(0.1 + 0.5 * random.next()).unwrap(), pose: at });
            }
            let query = PairQuery { items, mode: Mode::All, context };
            for distance in [false, true] {
                let [tree, sweep, exhaustive] =
                    snapshots.each_ref().map(|snapshot| ask(snapshot, &query, distance).canonical());
                assert_eq!(tree, exhaustive, "seed {seed}, round {round}");
                assert_eq!(sweep, exhaustive, "seed {seed}, round {round}");
                if !distance {
                    check_list(&snapshots[0], &query.context, &exhaustive.items[0], &mut reached);
                }
            }
            let edits = edits(random, &mut living, &mut next, side, &mut reached);
            for scene in &mut scenes {
                scene.apply(&edits, None).unwrap();
                assert_eq!(scene.snapshot().validate(), Ok(()));
            }
        }
    }
    let Reached { colliding, within_margin, free, allowed, other_layers, own_margin, unbounded, filtered, .. } =
        reached;
    for (regime, count) in [
        ("colliding pair", colliding),
        ("pair within its margin", within_margin),
        ("free pair", free),
        ("allowed pair", allowed),
        ("pair of other layers", other_layers),
        ("pair with a margin of its own", own_margin),
        ("pair with an unbounded body", unbounded),
        ("body left out by the filter", filtered),
        ("empty scene", reached.empty_scenes),
        ("scene of one body", reached.single_bodies),
        ("body removed", reached.removed),
    ] {
        assert!(count >= 2, "{regime}: only {count} of {reached:?}");
    }
}
