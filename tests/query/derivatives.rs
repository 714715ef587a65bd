//! Derivatives of a question's pairs. Oracle: the kernel's own derivatives of every pair of bodies, made one by one (`tests/collision/derivatives`
//! holds those against differences); central differences of whole answers about a robot's states; and the same question without derivatives,
//! which has to be answered with the same bytes.
#![cfg(feature = "effect-derivatives")]

use std::sync::Arc;

use clearance::geometry::{Placement, Pose, Quaternion, Shape, Vec3};
use clearance::limits::Limits;
use clearance::narrow_phase::{
    Accuracy, Cost, DerivativeGoal, DerivativeMethod, Derivatives, Goal, TwistMatrix, derivatives, separation,
};
use clearance::query::{
    Attached, CheckStates, Clearance, ClearanceOf, ContactEventKind, ContactQuestion, ContactTracker, Context,
    ItemAnswer, ItemBatch, Mode, NearestBodies, Neighbours, NotAdvanced, Overlay, PairAnswer, PairDerivatives,
    PairQuery, Prepared, Refused, Side, Subject, Threshold, Verdict, Wants, World, Worlds,
};
use clearance::robot::{ModelOptions, RobotModel};
use clearance::scene::{Body, BodyId, BodyRef, Edit, Epoch, NewBody, Scene, Snapshot};

use crate::workload::{scenes, states, ur5};

fn place(x: f64, y: f64, z: f64) -> Pose {
    Pose::new(Vec3::new(x, y, z), Quaternion::IDENTITY).unwrap()
}

/// Rows of boxes, cylinders, balls and ellipsoids that overlap and stand apart.
fn pile() -> Scene {
    let shape = |i: usize| match i % 4 {
        0 => Shape::cuboid(Vec3::new(0.2, 0.15, 0.1)),
        1 => Shape::cylinder(0.15, 0.12),
        2 => Shape::sphere(0.16),
        _ => Shape::ellipsoid(Vec3::new(0.2, 0.1, 0.15)),
    };
    let turned = |i: usize| Quaternion { w: 1.0, x: 0.3 * (i % 5) as f64, y: 0.2 * (i % 3) as f64, z: 0.1 };
    let at = |i: usize| Vec3::new(0.35 * (i % 4) as f64, 0.33 * (i / 4 % 4) as f64, 0.3 * (i / 16) as f64);
    let mut scene = Scene::new(Epoch(1));
    let add = |i: usize| {
        let pose = Pose::new(at(i), turned(i)).unwrap();
        Edit::AddBody(NewBody::new(format!("body {i}"), Arc::new(shape(i).unwrap()), pose))
    };
    scene.apply(&(0..48).map(add).collect::<Vec<_>>(), None).unwrap();
    scene
}

fn with(wants: Wants, margin: f64) -> Context {
    Context { wants, margin, max_pairs: 10_000, ..Context::default() }
}

const EXACT: Accuracy = Accuracy { absolute: 0.0, relative: 0.0 };
const PLAIN: Wants = Wants { witness: true, depth: true, ..Wants::VERDICT };
const DERIVATIVES: Wants = Wants { derivatives: true, ..PLAIN };

fn ask(snapshot: &Snapshot, subject: Subject, context: Context, distance: bool) -> ItemAnswer {
    let query = PairQuery { items: vec![subject], mode: Mode::All, context };
    let prepared = if distance { Prepared::distance(snapshot, &query) } else { Prepared::collide(snapshot, &query) };
    prepared.unwrap().answer(&|| false).items.remove(0)
}

fn body<'s>(snapshot: &'s Snapshot, side: &Side) -> &'s Body {
    match side {
        Side::Body { id, .. } => snapshot.body(*id).unwrap(),
        Side::Link { .. } | Side::Query { .. } => panic!("only bodies were asked about"),
    }
}

/// The kernel's derivatives of the two bodies, side A first.
fn by_hand(snapshot: &Snapshot, pair: &PairAnswer) -> Derivatives {
    as_asked(snapshot, pair, &Goal::penetration())
}

/// The same of what is found with that goal: how far a question reaches may change the last bits of a witness.
fn as_asked(snapshot: &Snapshot, pair: &PairAnswer, goal: &Goal) -> Derivatives {
    let (a, b) = (body(snapshot, &pair.a), body(snapshot, &pair.b));
    let (shapes, at) = ([&*a.shape, &*b.shape], [&a.placement, &b.placement]);
    let found = separation(shapes[0], shapes[1], at[0], at[1], goal).unwrap();
    derivatives(shapes[0], shapes[1], at[0], at[1], &found, &DerivativeGoal::default(), &Goal::penetration()).unwrap()
}

/// What a question without derivatives would have said.
fn stripped(mut item: ItemAnswer) -> ItemAnswer {
    item.cost = without(item.cost);
    let pairs = item.pairs.iter_mut().chain(&mut item.nearest);
    pairs.chain(&mut item.nearest_self).chain(&mut item.nearest_scene).for_each(|pair| pair.derivatives = None);
    item
}

fn without(cost: Cost) -> Cost {
    Cost { derivative_separations: 0, derivative_supports: 0, derivative_corners: 0, ..cost }
}

#[test]
fn derivatives_are_the_kernels_own_and_change_nothing_else() {
    let scene = pile();
    let snapshot = &scene.snapshot();
    let (mut apart, mut touching) = (0, 0);
    for margin in [0.0, 0.05] {
        for subject in [vec![Subject::All], snapshot.bodies().map(|b| Subject::Body(b.id)).collect()].concat() {
            for distance in [false, true] {
                let plain = ask(snapshot, subject.clone(), with(PLAIN, margin), distance);
                let asked = ask(snapshot, subject.clone(), with(DERIVATIVES, margin), distance);
                assert_eq!(plain.cost, without(plain.cost), "nobody asked");
                assert!(plain.pairs.iter().chain(&plain.nearest).all(|pair| pair.derivatives.is_none()));
                for pair in asked.pairs.iter().chain(&asked.nearest) {
                    let told = pair.derivatives.as_deref().unwrap();
                    assert_eq!(told.twists, by_hand(snapshot, pair));
                    assert!(told.joints.is_empty());
                    *(if pair.bracket.upper <= 0.0 { &mut touching } else { &mut apart }) += 1;
                }
                assert_eq!(stripped(asked), plain);
            }
            let Subject::Body(_) = subject else { continue };
            let near = |wants| {
                let request = NearestBodies { items: vec![subject.clone()], count: 4, context: with(wants, margin) };
                Neighbours::new(snapshot, &request).unwrap().answer_all(&|| false).items.remove(0)
            };
            let (plain, mut asked) = (near(PLAIN), near(DERIVATIVES));
            assert_eq!(asked.nearest.len(), 4);
            for pair in &mut asked.nearest {
                assert_eq!(pair.derivatives.take().unwrap().twists, by_hand(snapshot, pair));
            }
            asked.cost = without(asked.cost);
            assert_eq!(asked, plain);
        }
    }
    assert!(apart > 100 && touching > 100, "{apart} {touching}");
}

/// A bare shape is side A, in its own place.
#[test]
fn a_bare_shape_moves_about_its_own_origin() {
    let scene = pile();
    let snapshot = &scene.snapshot();
    let shape = Shape::ellipsoid(Vec3::new(0.1, 0.2, 0.3)).unwrap();
    let pose = Pose::new(Vec3::new(-0.8, 0.2, 0.1), Quaternion { w: 1.0, x: 0.2, y: 0.1, z: 0.5 }).unwrap();
    let subject = Subject::Shape { shape: shape.clone(), pose };
    let nearest = ask(snapshot, subject, with(DERIVATIVES, 0.0), true).nearest.unwrap();
    let other = body(snapshot, &nearest.b);
    let at = [&pose.placement(), &other.placement];
    let found = separation(&shape, &other.shape, at[0], at[1], &Goal::penetration()).unwrap();
    let goal = DerivativeGoal::default();
    let own = derivatives(&shape, &other.shape, at[0], at[1], &found, &goal, &Goal::penetration()).unwrap();
    assert_eq!(nearest.derivatives.unwrap().twists, own);
}

/// The nearest pair is one of the list, and the list is cut before derivatives are made.
#[test]
fn a_pair_has_its_derivatives_made_once_and_one_that_is_not_told_never() {
    let scene = pile();
    let snapshot = &scene.snapshot();
    let ask = |max_pairs: usize, within: f64| {
        let context = Context { max_pairs, ..with(DERIVATIVES, 0.0) };
        let subjects = PairQuery { items: vec![Subject::All], mode: Mode::All, context };
        let question = Clearance { subjects: ClearanceOf::Subjects(subjects), within };
        Prepared::clearance(&**snapshot, &question).unwrap().answer(&|| false).items.remove(0)
    };
    let all = ask(10_000, 0.05);
    let corners = |pair: &PairAnswer| pair.derivatives.as_deref().unwrap().twists.cost.corners;
    let of = |item: &ItemAnswer| {
        let nearest = item.nearest.as_ref().unwrap();
        let listed = item.pairs.iter().any(|pair| (&pair.a, &pair.b) == (&nearest.a, &nearest.b));
        item.pairs.iter().map(corners).sum::<u64>() + if listed { 0 } else { corners(nearest) }
    };
    assert!(all.pairs.len() > 60, "{}", all.pairs.len());
    assert!(all.pairs.contains(all.nearest.as_ref().unwrap()), "the nearest with the same derivatives");
    assert!(of(&all) > 100);
    assert_eq!(all.cost.derivative_corners, of(&all));
    let cut = ask(3, 0.05);
    assert_eq!((cut.pairs.len(), cut.truncated, &cut.nearest), (3, true, &all.nearest));
    assert_eq!(cut.cost.derivative_corners, of(&cut));
}

#[test]
fn an_overlap_whose_depth_nobody_wants_has_no_witness_and_no_derivatives() {
    let scene = pile();
    let snapshot = &scene.snapshot();
    let wants = Wants { derivatives: true, ..Wants::VERDICT };
    let answer = ask(snapshot, Subject::All, with(wants, 0.05), false);
    let (mut hits, mut near) = (0, 0);
    for pair in &answer.pairs {
        assert_eq!(pair.derivatives.is_some(), pair.witness.is_some(), "{pair:?}");
        assert_eq!(pair.witness.is_some(), pair.bracket.upper > 0.0);
        *(if pair.verdict == Verdict::Collision { &mut hits } else { &mut near }) += 1;
    }
    assert!(hits > 10 && near > 10, "{hits} {near}");
}

#[test]
fn tracked_contacts_have_derivatives_where_an_event_is_told() {
    let mut scene = pile();
    let question = |stays, wants| ContactQuestion {
        threshold: Threshold::Margin(0.01),
        wants,
        stays,
        ..ContactQuestion::default()
    };
    let mut trackers = [(true, DERIVATIVES), (false, DERIVATIVES), (true, PLAIN)]
        .map(|(stays, wants)| ContactTracker::new(question(stays, wants)));
    let mut stayed = 0;
    for step in 0..3 {
        let nudge = Edit::MoveBody {
            body: BodyRef::Name("body 5".to_owned()),
            pose: place(0.35, 0.33, 0.01 * f64::from(step)),
        };
        scene.apply(&[nudge], None).unwrap();
        let snapshot = scene.snapshot();
        let [with_stays, without_stays, plain] = trackers.each_mut().map(|t| t.advance(&snapshot, &|| false).unwrap());
        for event in &with_stays.events {
            let Some(pair) = &event.pair else { continue };
            let goal = Goal { margin: 0.01, cut_off: 0.01, ..Goal::penetration() };
            assert_eq!(pair.derivatives.as_ref().unwrap().twists, as_asked(&snapshot, pair, &goal));
        }
        let told: Vec<_> = with_stays.events.iter().filter(|e| e.kind != ContactEventKind::Stay).collect();
        stayed += with_stays.events.len() - told.len();
        assert_eq!(without_stays.events.iter().collect::<Vec<_>>(), told);
        let made = |events: &[clearance::query::ContactEvent]| -> u64 {
            events.iter().filter_map(|e| Some(e.pair.as_ref()?.derivatives.as_ref()?.twists.cost.corners)).sum()
        };
        assert_eq!(without_stays.cost.derivative_corners, made(&without_stays.events));
        assert_eq!(plain.cost, without(with_stays.cost));
        let mut bare = with_stays.events;
        bare.iter_mut().filter_map(|e| e.pair.as_mut()).for_each(|pair| pair.derivatives = None);
        assert_eq!(bare, plain.events);
    }
    assert!(stayed > 50, "{stayed}");
    // A tracker that is stopped is as it was.
    let (snapshot, before) = (scene.snapshot(), trackers[0].revision());
    assert_eq!(trackers[0].advance(&snapshot, &|| true), Err(NotAdvanced::Stopped));
    assert_eq!(trackers[0].revision(), before);
}

#[test]
fn numbers_that_cannot_be_are_refused_by_name() {
    let scene = pile();
    let refused = |derivatives: DerivativeGoal| {
        let context = Context { derivatives, ..Context::default() };
        let query = PairQuery { items: vec![Subject::All], mode: Mode::All, context };
        match Prepared::collide(&*scene.snapshot(), &query).err() {
            Some(Refused::Invalid { field, problem }) => format!("{field} {problem}"),
            other => panic!("{other:?}"),
        }
    };
    let good = DerivativeGoal::default();
    let samples = |samples| DerivativeGoal { samples, ..good };
    let epsilon = |epsilon| DerivativeGoal { epsilon, ..good };
    assert_eq!(refused(samples(0)), "context.derivatives.samples is 0, not from 1 to 65536");
    assert_eq!(refused(samples(65_537)), "context.derivatives.samples is 65537, not from 1 to 65536");
    assert_eq!(refused(epsilon(-0.5)), "context.derivatives.epsilon is negative: -0.5");
    assert_eq!(refused(epsilon(f64::NAN)), "context.derivatives.epsilon is not finite");
}

/// A base that moves freely, an arm on it with a turning and a sliding joint, and two fingers of which one mimics the other, turned the other way and
/// twice as far; a wrist that mimics the arm. Shapes stand off their links' origins.
const CRANE: &str = r#"<robot name="crane"><link name="world"/>
  <link name="base"><collision><origin xyz="0.1 0 -0.2" rpy="0.2 0.1 0"/><geometry><box size="0.6 0.5 0.2"/></geometry></collision></link>
  <link name="arm"><collision><origin xyz="0.4 0 0"/><geometry><box size="0.7 0.08 0.1"/></geometry></collision></link>
  <link name="slide"><collision><origin xyz="0 0.05 0.1" rpy="0.4 0 0.3"/><geometry><box size="0.1 0.1 0.2"/></geometry></collision></link>
  <link name="wrist"/>
  <link name="left"><collision><origin xyz="0.1 0.05 0"/><geometry><sphere radius="0.04"/></geometry></collision></link>
  <link name="right"><collision><origin xyz="0.1 -0.05 0"/><geometry><sphere radius="0.05"/></geometry></collision></link>
  <joint name="float" type="floating"><parent link="world"/><child link="base"/><origin xyz="0.1 0.2 0.3" rpy="0.3 -0.2 0.5"/></joint>
  <joint name="turn" type="revolute"><parent link="base"/><child link="arm"/><origin xyz="0.2 0 0.1" rpy="0 0.1 0"/><axis xyz="0.2 0.3 1"/><limit lower="-3" upper="3"/></joint>
  <joint name="push" type="prismatic"><parent link="arm"/><child link="slide"/><origin xyz="0.9 0 0" rpy="0 0.5 0.2"/><axis xyz="1 0.2 0"/><limit lower="-1" upper="1"/></joint>
  <joint name="twist" type="continuous"><parent link="slide"/><child link="wrist"/><origin xyz="0.1 0 0"/><axis xyz="1 0 0"/><mimic joint="turn" multiplier="-0.5" offset="0.3"/></joint>
  <joint name="grip" type="revolute"><parent link="wrist"/><child link="left"/><origin xyz="0 0.05 0"/><axis xyz="0 0 1"/><limit lower="-3" upper="3"/></joint>
  <joint name="grip 2" type="revolute"><parent link="wrist"/><child link="right"/><origin xyz="0 -0.05 0"/><axis xyz="0 0 1"/><limit lower="-3" upper="3"/><mimic joint="grip" multiplier="-2" offset="0.1"/></joint>
</robot>"#;

fn robot(urdf: &str) -> Arc<RobotModel> {
    let options = ModelOptions::default();
    Arc::new(RobotModel::from_urdf(urdf, None, &mut |_| Err("no meshes".to_owned()), &options).unwrap())
}

fn yard(model: &Arc<RobotModel>) -> Scene {
    let add = |name: &str, shape: Shape, pose: Pose| Edit::AddBody(NewBody::new(name, Arc::new(shape), pose));
    let base = Pose::new(Vec3::new(0.3, -0.1, 0.2), Quaternion { w: 1.0, x: 0.1, y: -0.2, z: 0.3 }).unwrap();
    let turned = Pose::new(Vec3::new(1.4, 1.2, 0.3), Quaternion { w: 1.0, x: 0.3, y: 0.2, z: -0.4 }).unwrap();
    let mut scene = Scene::new(Epoch(1));
    let edits = [
        add("egg", Shape::ellipsoid(Vec3::new(0.3, 0.2, 0.25)).unwrap(), turned),
        add("crate", Shape::cuboid(Vec3::new(0.2, 0.3, 0.2)).unwrap(), place(-0.9, 0.8, 0.7)),
        add("load", Shape::ellipsoid(Vec3::new(0.1, 0.05, 0.07)).unwrap(), place(5.0, 0.0, 0.0)),
        Edit::AddRobot { name: "crane".to_owned(), model: Arc::clone(model), base },
    ];
    scene.apply(&edits, None).unwrap();
    scene
}

/// SplitMix64 (Steele, Lea, Flood 2014): from -1 to 1.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// The whole answer about one state, as exact as rounding lets it be.
fn state(worlds: &Worlds, robot: &str, positions: &[f64], wants: Wants) -> ItemAnswer {
    let context = Context { wants, accuracy: EXACT, ..Context::default() };
    let request = CheckStates { robot: robot.to_owned(), positions: positions.to_vec(), mode: Mode::All, context };
    Prepared::check_states(worlds, &request).unwrap().answer(&|| false).items.remove(0)
}

/// What became of comparing gradients.
#[derive(Default, Debug)]
struct Compared {
    own: usize,
    scene: usize,
    passed_over: usize,
}

/// Holds the gradients of the nearest pairs, within and without, against central differences of their distances. Apart these have a gradient
/// wherever one pair of points is nearest; its error is of second order in the step, and of the distance's own by its inverse.
fn compare(worlds: &Worlds, robot: &str, positions: &[f64], tolerance: f64, compared: &mut Compared) {
    let step = 1e-6;
    let sides = |pair: &PairAnswer| [&pair.a, &pair.b].map(|side| side.with_subshape(0));
    let answer = state(worlds, robot, positions, DERIVATIVES);
    let moved: Vec<[ItemAnswer; 2]> = (0..positions.len())
        .map(|i| {
            [-step, step].map(|by| {
                let mut there = positions.to_vec();
                there[i] += by;
                state(worlds, robot, &there, PLAIN)
            })
        })
        .collect();
    type Minimum = fn(&ItemAnswer) -> Option<&PairAnswer>;
    let minima: [Minimum; 2] = [|item| item.nearest_self.as_ref(), |item| item.nearest_scene.as_ref()];
    for (which, minimum) in minima.into_iter().enumerate() {
        let pair = minimum(&answer).unwrap();
        let told: &PairDerivatives = pair.derivatives.as_deref().unwrap();
        assert_eq!(told.joints.len(), positions.len());
        let stays = moved.iter().flatten().all(|item| sides(minimum(item).unwrap()) == sides(pair));
        if pair.bracket.lower < 1e-4 || told.twists.is_contested || !stays {
            compared.passed_over += 1;
            continue;
        }
        for (i, [before, after]) in moved.iter().enumerate() {
            let [before, after] = [before, after].map(|item| minimum(item).unwrap().signed_distance);
            let difference = (after - before) / (2.0 * step);
            let error = (difference - told.joints[i]).abs();
            assert!(error < tolerance, "position {i}: {} and not {difference}: {pair:?}", told.joints[i]);
        }
        *(if which == 0 { &mut compared.own } else { &mut compared.scene }) += 1;
    }
}

#[test]
fn gradients_of_a_real_arm_are_differences_of_its_clearance() {
    let model = ur5();
    let worlds: Vec<_> = scenes(&model);
    let mut compared = Compared::default();
    for (scene, positions, _) in states().into_iter().step_by(4) {
        let worlds = Worlds::as_is(&worlds[scene]);
        compare(&worlds, "ur5", &positions, 2e-6, &mut compared);
    }
    assert!(compared.own > 40 && compared.scene > 40, "{compared:?}");
}

/// Floating, sliding, turning joints, mimics of either, and both sides of pairs within the robot.
#[test]
fn gradients_of_every_kind_of_joint_are_differences_of_the_clearance() {
    let model = robot(CRANE);
    let scene = yard(&model);
    let worlds = Worlds::as_is(&scene.snapshot());
    let mut random = Random(7);
    let mut compared = Compared::default();
    for _ in 0..60 {
        let q: Vec<f64> = (0..10).map(|i| if i < 3 { 0.5 * random.next() } else { 1.2 * random.next() }).collect();
        if q[3..7].iter().map(|c| c * c).sum::<f64>() > 0.3 {
            compare(&worlds, "crane", &q, 1e-5, &mut compared);
        }
    }
    assert!(compared.own > 15 && compared.scene > 30, "{compared:?}");
}

/// Only what moves the sides against each other counts, to the last bit.
#[test]
fn joints_that_both_sides_hang_from_add_nothing() {
    let model = robot(CRANE);
    let scene = yard(&model);
    let worlds = &Worlds::as_is(&scene.snapshot());
    let q = [0.1, 0.2, 0.3, 0.4, -0.2, 0.9, 0.5, 0.3, 0.1, -0.4];
    let mut met = 0;
    let request = CheckStates {
        robot: "crane".to_owned(),
        positions: q.to_vec(),
        mode: Mode::All,
        context: with(DERIVATIVES, 0.0),
    };
    let question = Clearance { subjects: ClearanceOf::States(request), within: 5.0 };
    let answer = Prepared::clearance(worlds, &question).unwrap().answer(&|| false).items.remove(0);
    for pair in &answer.pairs {
        let joints = &pair.derivatives.as_ref().unwrap().joints;
        match (&pair.a, &pair.b) {
            (Side::Link { .. }, Side::Link { .. }) => {
                assert!(joints[..7].iter().all(|g| *g == 0.0), "the base: {pair:?}");
                met += 1;
            }
            (Side::Link { link, .. }, Side::Body { .. }) => {
                assert!(joints[..3].iter().any(|g| g.abs() > 1e-3), "{pair:?}");
                // What is before a joint does not move with it.
                assert!(*link != model.link("base").unwrap() || joints[7..].iter().all(|g| *g == 0.0), "{pair:?}");
            }
            _ => panic!("{pair:?}"),
        }
    }
    assert!(met >= 3 && answer.pairs.len() > 12, "{met} of {}", answer.pairs.len());
}

/// A twist of a link, its origin where forward kinematics have it. Oracle: differences of answers to states whose base is moved by hand, on a base
/// that is all there is between world and link.
#[test]
fn twists_of_links_and_of_bodies_they_hold_are_about_the_links_origin() {
    let urdf = r#"<robot name="drone"><link name="world"/>
      <link name="body"><collision><origin xyz="0.3 -0.2 0.1" rpy="0.3 0.2 0.1"/><geometry><sphere radius="0.05"/></geometry></collision></link>
      <joint name="fly" type="floating"><parent link="world"/><child link="body"/></joint></robot>"#;
    let model = robot(urdf);
    let egg = Shape::ellipsoid(Vec3::new(0.3, 0.2, 0.25)).unwrap();
    let load = Shape::ellipsoid(Vec3::new(0.1, 0.05, 0.07)).unwrap();
    let add = |name: &str, shape: Shape, pose: Pose| Edit::AddBody(NewBody::new(name, Arc::new(shape), pose));
    let turned = Pose::new(Vec3::new(0.2, 0.1, 0.05), Quaternion { w: 1.0, x: 0.3, y: 0.2, z: -0.4 }).unwrap();
    let mut scene = Scene::new(Epoch(1));
    let drone = Edit::AddRobot { name: "drone".to_owned(), model, base: Pose::identity() };
    scene.apply(&[add("egg", egg, turned), add("load", load, place(9.0, 0.0, 0.0)), drone], None).unwrap();
    let snapshot = scene.snapshot();
    let held = Attached {
        body: BodyRef::Name("load".to_owned()),
        robot: "drone".to_owned(),
        link: "body".to_owned(),
        body_in_link: Pose::new(Vec3::new(0.9, 0.3, -0.2), Quaternion { w: 1.0, x: -0.5, y: 0.1, z: 0.2 }).unwrap(),
        may_touch: Vec::new(),
    };
    let overlay = Overlay { edits: Vec::new(), attached: vec![held] };
    let limits = Limits::default();
    let alone = Worlds::as_is(&snapshot);
    let world = World::as_is(&snapshot).under(&overlay, &limits).unwrap();
    let holding = Worlds::new(world, Vec::new(), Vec::new()).unwrap();
    for (worlds, position, is_held) in [(&alone, [0.8, 0.4, 0.3], false), (&holding, [-0.58, -0.29, -1.29], true)] {
        let at = Pose::new(Vec3::from(position), Quaternion { w: 0.8, x: 0.3, y: -0.4, z: 0.3 }).unwrap();
        let positions = |pose: &Pose| {
            let (p, q) = (pose.translation(), pose.rotation());
            vec![p.x, p.y, p.z, q.x, q.y, q.z, q.w]
        };
        let ask = |pose: &Pose, wants| state(worlds, "drone", &positions(pose), wants).nearest_scene.unwrap();
        let nearest = ask(&at, DERIVATIVES);
        let of_load = |side: &Side| matches!(side, Side::Body { id: BodyId(2), .. });
        assert_eq!(of_load(&nearest.a) || of_load(&nearest.b), is_held, "{nearest:?}");
        // A pair of two bodies has the lower id as side A.
        let (body, other) = if is_held { (1, 0) } else { (0, 1) };
        let told = nearest.derivatives.as_deref().unwrap();
        assert_eq!(told.joints.len(), 7);
        for column in 0..6 {
            let axis = Vec3::ith(column % 3, 1.0);
            let twisted = |by: f64| {
                let (translation, rotation) = (at.translation(), at.rotation());
                let pose = if column < 3 {
                    Pose::new(translation + axis * by, rotation)
                } else {
                    Pose::new(translation, Quaternion::about_axis(axis, by).compose(rotation))
                };
                ask(&pose.unwrap(), PLAIN)
            };
            // Normals are known to some 1e-8.
            let step = 1e-3;
            let [before, after] =
                [twisted(-step), twisted(step)].map(|pair| (pair.witness.unwrap(), pair.signed_distance));
            let slope = |before: Vec3, after: Vec3| (after - before) / (2.0 * step);
            let column_of = |block: &[TwistMatrix; 2]| -> Vec3 { block[body].column(column).into() };
            let near = |what: &str, told: Vec3, difference: Vec3| {
                assert!((told - difference).norm() < 1e-4, "{what}, column {column}: {told} and not {difference}");
            };
            let twists = &told.twists;
            near("normal", column_of(&twists.normal), slope(before.0.normal, after.0.normal));
            near("a", column_of(&twists.point_on_a), slope(before.0.point_on_a, after.0.point_on_a));
            near("b", column_of(&twists.point_on_b), slope(before.0.point_on_b, after.0.point_on_b));
            let difference = (after.1 - before.1) / (2.0 * step);
            assert!((twists.signed_distance[body][column] - difference).abs() < 1e-6);
        }
        // The other side is a body of the scene, about its own origin.
        let sides = [&nearest.a, &nearest.b];
        let Side::Body { id, .. } = sides[other] else { panic!("{nearest:?}") };
        let origin: Placement = snapshot.body(*id).unwrap().placement;
        let witness = nearest.witness.unwrap();
        let point = if other == 0 { witness.point_on_a } else { witness.point_on_b };
        let normal = if other == 0 { -witness.normal } else { witness.normal };
        let turn = (point - origin.translation).cross(&normal);
        let row = told.twists.signed_distance[other];
        assert!((Vec3::new(row[3], row[4], row[5]) - turn).norm() < 1e-7);
    }
}

#[cfg(feature = "effect-motion")]
#[test]
fn a_motion_has_the_derivatives_of_the_state_that_it_meets_in() {
    use clearance::query::{CheckMotions, Find, Motions};
    let model = robot(CRANE);
    let scene = yard(&model);
    let snapshot = scene.snapshot();
    let mut start = vec![0.1, 0.2, 0.3, 0.4, -0.2, 0.9, 0.5, 0.3, 0.1, -0.4];
    let mut goal = start.clone();
    (start[0], goal[0]) = (-0.4, 3.0);
    (start[8], goal[8]) = (-0.3, 0.3);
    let question = CheckMotions {
        robot: "crane".to_owned(),
        positions: [start.clone(), goal.clone()].concat(),
        motions: Motions::Edges,
        mode: Mode::All,
        find: Find::FirstContact,
        resolution: 1e-3,
        max_states: CheckMotions::DEFAULT_MAX_STATES,
        context: Context { accuracy: EXACT, ..with(DERIVATIVES, 0.0) },
    };
    let ask = |question: &CheckMotions| {
        Prepared::check_motions(&*snapshot, question).unwrap().answer(&|| false).items.remove(0)
    };
    let item = ask(&question);
    let [_, t] = item.motion.unwrap().reached.unwrap_or_else(|| panic!("{item:?}"));
    let told = item.nearest.clone().unwrap();
    let positions = start.iter().zip(&goal).map(|(from, to)| if t == 1.0 { *to } else { from + t * (to - from) });
    let at = state(&Worlds::as_is(&snapshot), "crane", &positions.collect::<Vec<_>>(), DERIVATIVES);
    let same = |pair: &&PairAnswer| (&pair.a, &pair.b) == (&told.a, &told.b);
    let pair = [&at.nearest_self, &at.nearest_scene].into_iter().flatten().find(same).unwrap();
    assert_eq!(pair.derivatives, told.derivatives);
    assert!(told.derivatives.unwrap().joints.iter().any(|g| g.abs() > 1e-3));
    let plain = ask(&CheckMotions { context: Context { accuracy: EXACT, ..with(PLAIN, 0.0) }, ..question });
    assert_eq!(stripped(item), plain);
}

fn by(method: DerivativeMethod, wants: Wants) -> Context {
    let derivatives = DerivativeGoal { method, samples: 4, seed: 11, ..DerivativeGoal::default() };
    Context { derivatives, ..with(wants, 0.02) }
}

const METHODS: [DerivativeMethod; 6] = [
    DerivativeMethod::Exact,
    DerivativeMethod::ExactCell,
    DerivativeMethod::FiniteDifference,
    DerivativeMethod::Smoothed0,
    DerivativeMethod::Smoothed1Gaussian,
    DerivativeMethod::Smoothed1Gumbel,
];

/// Whatever the threads, and whichever items are asked in one batch before.
#[test]
fn parts_of_a_batch_have_the_derivatives_of_the_whole() {
    let scene = pile();
    let snapshot = &*scene.snapshot();
    let items: Vec<Subject> = snapshot.bodies().map(|b| Subject::Body(b.id)).collect();
    for method in METHODS {
        let query = PairQuery { items: items.clone(), mode: Mode::All, context: by(method, DERIVATIVES) };
        let prepared = Prepared::distance(snapshot, &query).unwrap();
        let whole = prepared.answer(&|| false);
        for width in [7, 20] {
            let parts = (0..prepared.len()).step_by(width);
            let parts = parts.map(|first| prepared.run(first..(first + width).min(prepared.len()), &|| false));
            assert_eq!(prepared.join(parts.collect::<Vec<_>>()), whole);
        }
        // A pair has the same derivatives as the nearest and in the list, whether that is wanted or not.
        let listing = Wants { pairs: true, ..DERIVATIVES };
        let query = PairQuery { items: items.clone(), mode: Mode::All, context: by(method, listing) };
        let listed = Prepared::distance(snapshot, &query).unwrap().answer(&|| false);
        for (with_list, without) in listed.items.iter().zip(&whole.items) {
            assert_eq!(with_list.nearest, without.nearest);
        }
    }
}

/// Which numbers random methods have is told by the item and the pair.
#[test]
fn samples_are_a_pairs_own_in_each_item_and_come_again() {
    let scene = pile();
    let snapshot = &*scene.snapshot();
    let id = snapshot.bodies().nth(5).unwrap().id;
    let twists = |pair: &Option<PairAnswer>| pair.as_ref().unwrap().derivatives.as_ref().unwrap().twists.clone();
    let ask = |method| {
        let items = vec![Subject::Body(id), Subject::Body(id)];
        let query = PairQuery { items, mode: Mode::All, context: by(method, DERIVATIVES) };
        Prepared::distance(snapshot, &query).unwrap().answer(&|| false).items
    };
    for method in METHODS {
        let is_random = matches!(method, DerivativeMethod::Smoothed0 | DerivativeMethod::Smoothed1Gaussian);
        let items = ask(method);
        let [first, second] = [&items[0], &items[1]].map(|one| twists(&one.nearest));
        assert_eq!(first.seed != 0, first != second, "{method:?}");
        assert!(first != second || !is_random, "{method:?}");
        assert_eq!(ask(method), items);
    }
}
