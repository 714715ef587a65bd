//! Contact patches of a question's pairs. Oracle: closed forms of boxes and cylinders; the kernel's own patch of every pair of
//! bodies, measured one by one (`tests/collision/patches.rs` holds that against truths); and the same question without patches,
//! which has to be answered with the same bytes.
#![cfg(feature = "effect-patch")]

use std::sync::Arc;

use clearance::geometry::{Pose, Quaternion, Shape, Vec3};
use clearance::narrow_phase::{ContactPatch, Cost, Goal, PatchGoal, contact_patch, separation};
use clearance::query::{
    Answers, CheckMotions, CheckStates, Clearance, ClearanceOf, ContactQuestion, ContactTracker, Context, Find,
    ItemAnswer, ItemBatch, Mode, Motions, NearestBodies, NearestItem, Neighbours, PairAnswer, PairQuery, Prepared,
    Refused, Side, Subject, Threshold, Verdict, Wants,
};
use clearance::robot::{ModelOptions, RobotModel};
use clearance::scene::{Body, Edit, Epoch, NewBody, Scene, Snapshot};

fn place(x: f64, y: f64, z: f64) -> Pose {
    Pose::new(Vec3::new(x, y, z), Quaternion::IDENTITY).unwrap()
}

fn scene_of(bodies: Vec<(Shape, Pose)>) -> Scene {
    let add = |(i, (shape, pose))| Edit::AddBody(NewBody::new(format!("body {i}"), Arc::new(shape), pose));
    let mut scene = Scene::new(Epoch(1));
    scene.apply(&bodies.into_iter().enumerate().map(add).collect::<Vec<_>>(), None).unwrap();
    scene
}

fn cuboid(x: f64, y: f64, z: f64) -> Shape {
    Shape::cuboid(Vec3::new(x, y, z)).unwrap()
}

/// A table, a box that sinks 1 mm into it, one that hovers 5 mm over it, a ball far away, and the floor under it all.
fn table() -> Scene {
    scene_of(vec![
        (cuboid(1.0, 1.0, 0.5), place(0.0, 0.0, 0.0)),
        (cuboid(0.1, 0.2, 0.1), place(0.5, 0.5, 0.599)),
        (cuboid(0.1, 0.1, 0.1), place(-0.5, 0.0, 0.605)),
        (Shape::sphere(0.3).unwrap(), place(0.0, 0.0, 5.0)),
        (Shape::half_space(Vec3::z(), -0.6).unwrap(), Pose::identity()),
    ])
}

/// Rows of boxes, cylinders and balls that rest on one another, overlap and stand apart.
fn pile() -> Scene {
    let shape = |i: usize| match i % 3 {
        0 => cuboid(0.2, 0.15, 0.1),
        1 => Shape::cylinder(0.15, 0.12).unwrap(),
        _ => Shape::sphere(0.16).unwrap(),
    };
    let turned = |i: usize| Quaternion::about_axis(Vec3::z(), 0.3 * (i % 5) as f64);
    let at = |i: usize| Vec3::new(0.31 * (i % 4) as f64, 0.27 * (i / 4 % 4) as f64, 0.2 * (i / 16) as f64);
    let piled = (0..48).map(|i| (shape(i), Pose::new(at(i), turned(i)).unwrap()));
    let apart = (0..6).map(|i| (shape(i), place(5.0 + i as f64, 0.0, 0.0)));
    scene_of(piled.chain(apart).collect())
}

fn ask(snapshot: &Snapshot, subject: Subject, context: Context, distance: bool) -> ItemAnswer {
    let query = PairQuery { items: vec![subject], mode: Mode::All, context };
    let prepared = if distance { Prepared::distance(snapshot, &query) } else { Prepared::collide(snapshot, &query) };
    prepared.unwrap().answer(&|| false).items.remove(0)
}

fn neighbours(snapshot: &Snapshot, subject: Subject, context: Context) -> NearestItem {
    let request = NearestBodies { items: vec![subject], count: 4, context };
    let answer: Answers<NearestItem> = Neighbours::new(snapshot, &request).unwrap().answer_all(&|| false);
    answer.items.into_iter().next().unwrap()
}

fn with(wants: Wants, margin: f64) -> Context {
    Context { wants, margin, max_pairs: 10_000, ..Context::default() }
}

const PATCH: Wants = Wants { patch: true, ..Wants::VERDICT };

/// What a question without patches would have said.
fn without_patches(mut pair: PairAnswer) -> PairAnswer {
    pair.patch = None;
    pair
}

fn stripped(mut item: ItemAnswer) -> ItemAnswer {
    (item.cost.patch_corners, item.cost.patch_cuts) = (0, 0);
    for pair in [&mut item.nearest, &mut item.nearest_self, &mut item.nearest_scene] {
        *pair = pair.take().map(without_patches);
    }
    item.pairs = item.pairs.into_iter().map(without_patches).collect();
    item
}

fn body<'s>(snapshot: &'s Snapshot, side: &Side) -> &'s Body {
    match side {
        Side::Body { id, .. } => snapshot.body(*id).unwrap(),
        Side::Link { .. } | Side::Query { .. } => panic!("only bodies were asked about"),
    }
}

/// The kernel's patch of the two bodies, side A first.
fn by_hand(snapshot: &Snapshot, pair: &PairAnswer, margin: f64) -> ContactPatch {
    let (a, b) = (body(snapshot, &pair.a), body(snapshot, &pair.b));
    let found = separation(&a.shape, &b.shape, &a.placement, &b.placement, &Goal::penetration()).unwrap();
    let goal = PatchGoal { cut_off: margin, ..PatchGoal::default() };
    contact_patch(&a.shape, &b.shape, &a.placement, &b.placement, &found, &goal).unwrap()
}

#[test]
fn a_box_in_a_table_touches_in_its_four_lower_corners() {
    let scene = table();
    let answer = ask(&scene.snapshot(), Subject::All, with(PATCH, 0.0), false);
    assert_eq!((answer.verdict, answer.pairs.len()), (Verdict::Collision, 1), "{answer:?}");
    let patch = answer.pairs[0].patch.as_deref().unwrap();
    let corners = [[0.4, 0.3], [0.6, 0.3], [0.6, 0.7], [0.4, 0.7]];
    for [x, y] in corners {
        let there = |p: &&_| -> bool {
            (clearance::narrow_phase::ContactPoint::middle(p) - Vec3::new(x, y, 0.4995)).norm() < 1e-9
        };
        assert_eq!(patch.points().iter().filter(there).count(), 1, "{patch:?}");
    }
    assert!(patch.points().len() == 4 && patch.points().iter().all(|p| (p.signed_distance + 1e-3).abs() < 1e-9));
    assert!(answer.cost.patch_corners > 0);
}

#[test]
fn a_pair_within_its_margin_has_a_patch_and_one_beyond_it_has_none() {
    let scene = table();
    let snapshot = &scene.snapshot();
    let ids: Vec<_> = snapshot.bodies().map(|body| body.id).collect();
    let (hovers, far) = (Subject::Body(ids[2]), Subject::Body(ids[3]));
    for (margin, told) in [(0.0, false), (0.01, true)] {
        let nearest = ask(snapshot, hovers.clone(), with(PATCH, margin), true).nearest.unwrap();
        assert_eq!(nearest.patch.is_some(), told, "{nearest:?}");
        let nearest = neighbours(snapshot, hovers.clone(), with(PATCH, margin)).nearest.remove(0);
        assert_eq!(nearest.patch.is_some(), told, "{nearest:?}");
        if let Some(patch) = nearest.patch {
            assert!(
                patch.points().len() == 4 && patch.points().iter().all(|p| (p.signed_distance - 5e-3).abs() < 1e-9)
            );
        }
    }
    let nearest = ask(snapshot, far, with(PATCH, 0.01), true);
    assert!(nearest.nearest.unwrap().patch.is_none() && nearest.cost.patch_corners == 0);
}

/// A bare shape and a half-space, side A and side B.
#[test]
fn a_cylinder_on_the_floor_has_a_round_patch_of_as_many_points_as_are_wanted() {
    let scene = table();
    let cylinder = Shape::cylinder(0.2, 0.3).unwrap();
    let subject = Subject::Shape { shape: cylinder, pose: place(3.0, 0.0, -0.301) };
    for most in [1, 4, 32] {
        let context = Context { max_patch_points: most, ..with(PATCH, 0.0) };
        let answer = ask(&scene.snapshot(), subject.clone(), context, true);
        let patch = answer.nearest.unwrap().patch.unwrap();
        assert_eq!(patch.points().len(), most.min(patch.points().len()));
        assert!(patch.points().len() >= most.min(4), "{patch:?}");
        for point in patch.points() {
            let rim = point.middle() - Vec3::new(3.0, 0.0, 0.0);
            assert!((rim.xy().norm() - 0.2).abs() < 1e-9 && (point.signed_distance + 1e-3).abs() < 1e-9, "{point:?}");
        }
    }
}

#[test]
fn patches_are_the_kernels_own_and_change_nothing_else() {
    let scene = pile();
    let snapshot = &scene.snapshot();
    let (mut corners, mut edges, mut points, mut none) = (0, 0, 0, 0);
    let all = Wants { witness: true, depth: true, ..Wants::VERDICT };
    for margin in [0.0, 0.004, 0.05] {
        for subject in [vec![Subject::All], snapshot.bodies().map(|b| Subject::Body(b.id)).collect()].concat() {
            for distance in [false, true] {
                let plain = ask(snapshot, subject.clone(), with(all, margin), distance);
                let asked = ask(snapshot, subject.clone(), with(Wants { patch: true, ..all }, margin), distance);
                assert_eq!((plain.cost.patch_corners, plain.cost.patch_cuts), (0, 0));
                let told = plain.pairs.iter().chain(&plain.nearest);
                assert!(told.into_iter().all(|pair| pair.patch.is_none()));
                for pair in asked.pairs.iter().chain(&asked.nearest) {
                    let Some(patch) = &pair.patch else {
                        assert_eq!(pair.verdict, Verdict::Free);
                        none += 1;
                        continue;
                    };
                    assert_eq!(**patch, by_hand(snapshot, pair, margin));
                    *match patch.polygon().len() {
                        1 => &mut points,
                        2 => &mut edges,
                        _ => &mut corners,
                    } += 1;
                }
                assert_eq!(stripped(asked), plain);
            }
            let Subject::Body(_) = subject else { continue };
            let plain = neighbours(snapshot, subject.clone(), with(all, margin));
            let mut asked = neighbours(snapshot, subject, with(Wants { patch: true, ..all }, margin));
            asked.nearest = asked.nearest.into_iter().map(without_patches).collect();
            asked.cost = Cost { patch_corners: 0, patch_cuts: 0, ..asked.cost };
            assert_eq!(asked, plain);
        }
    }
    assert!(corners > 100 && edges > 100 && points > 100 && none > 10, "{corners} {edges} {points} {none}");
}

#[test]
fn clearances_have_patches_of_pairs_that_are_not_proved_apart() {
    let scene = pile();
    let snapshot = &scene.snapshot();
    let ask = |wants: Wants, margin: f64| {
        let subjects = PairQuery { items: vec![Subject::All], mode: Mode::All, context: with(wants, margin) };
        let question = Clearance { subjects: ClearanceOf::Subjects(subjects), within: 0.1 };
        Prepared::clearance(&**snapshot, &question).unwrap().answer(&|| false).items.remove(0)
    };
    let all = Wants { witness: true, depth: true, ..Wants::VERDICT };
    for margin in [0.0, 0.05] {
        let (plain, asked) = (ask(all, margin), ask(Wants { patch: true, ..all }, margin));
        let (mut with_patch, mut without) = (0, 0);
        for pair in &asked.pairs {
            assert_eq!(pair.patch.is_some(), pair.verdict != Verdict::Free, "{pair:?}");
            match &pair.patch {
                Some(patch) => assert_eq!(**patch, by_hand(snapshot, pair, margin)),
                None => without += 1,
            }
            with_patch += usize::from(pair.patch.is_some());
        }
        assert!(with_patch > 30 && without > 5, "{with_patch} {without}");
        assert_eq!(stripped(asked), plain);
    }
}

/// A box on a slide goes down onto a table. Oracle: the same state asked as a state.
#[test]
fn a_motion_has_the_patch_of_the_state_that_it_meets_in() {
    let urdf = r#"<robot name="press"><link name="frame"/>
      <link name="die"><collision><geometry><box size="0.2 0.4 0.1"/></geometry></collision></link>
      <joint name="slide" type="prismatic"><parent link="frame"/><child link="die"/><axis xyz="0 0 1"/>
        <limit lower="-2" upper="2" velocity="1" effort="1"/></joint></robot>"#;
    let model = RobotModel::from_urdf(urdf, None, &mut |_| Err("no meshes".to_owned()), &ModelOptions::default());
    let mut scene = table();
    let base = place(0.0, 0.5, 0.0);
    let arm = Edit::AddRobot { name: "arm".to_owned(), model: Arc::new(model.unwrap()), base };
    scene.apply(&[arm], None).unwrap();
    let snapshot = &*scene.snapshot();
    let ends = [1.5, 0.51];
    let question = CheckMotions {
        robot: "arm".to_owned(),
        positions: ends.to_vec(),
        motions: Motions::Edges,
        mode: Mode::All,
        find: Find::FirstContact,
        resolution: 1e-3,
        max_states: CheckMotions::DEFAULT_MAX_STATES,
        context: with(PATCH, 0.0),
    };
    let item = Prepared::check_motions(snapshot, &question).unwrap().answer(&|| false).items.remove(0);
    let [_, at] = item.motion.unwrap().reached.unwrap();
    let patch = item.nearest.unwrap().patch.unwrap();
    assert_eq!(patch.polygon().len(), 4);
    let positions = vec![if at == 1.0 { ends[1] } else { ends[0] + at * (ends[1] - ends[0]) }];
    let state = CheckStates { robot: "arm".to_owned(), positions, mode: Mode::All, context: with(PATCH, 0.0) };
    let state = Prepared::check_states(snapshot, &state).unwrap().answer(&|| false).items.remove(0);
    assert_eq!(state.nearest.unwrap().patch, Some(patch));
}

/// Ten boxes overlap one; the nearest is met first, as its box is no farther and its id the least, and the others never lead.
#[test]
fn of_pairs_that_are_not_told_no_patch_is_made() {
    let mut bodies = vec![(cuboid(0.5, 0.5, 0.5), Pose::identity())];
    bodies.extend((0..10).map(|i| (cuboid(0.1, 0.1, 0.1), place(0.0, 0.0, 0.5 + 0.002 * i as f64))));
    let snapshot = scene_of(bodies).snapshot();
    let ask_one = |context| {
        let query =
            PairQuery { items: vec![Subject::Body(snapshot.bodies().next().unwrap().id)], mode: Mode::All, context };
        Prepared::distance(&*snapshot, &query).unwrap().answer(&|| false).items.remove(0)
    };
    let one = ask_one(with(PATCH, 0.0));
    let all = ask_one(with(Wants { pairs: true, ..PATCH }, 0.0));
    assert_eq!((one.pairs.len(), all.pairs.len()), (0, 10));
    assert_eq!(all.cost.patch_corners, 10 * one.cost.patch_corners);
    assert_eq!(one.nearest, all.nearest);
}

#[test]
fn tracked_contacts_have_their_patches() {
    let mut scene = table();
    let question =
        ContactQuestion { threshold: Threshold::Margin(0.01), wants: PATCH, stays: true, ..ContactQuestion::default() };
    let mut tracker = ContactTracker::new(question);
    let first = tracker.advance(&scene.snapshot(), &|| false).unwrap();
    let patches = |events: &[clearance::query::ContactEvent]| -> Vec<usize> {
        events
            .iter()
            .filter_map(|event| event.pair.as_ref()?.patch.as_deref())
            .map(|patch| patch.points().len())
            .collect()
    };
    assert_eq!(patches(&first.events), [4, 4], "{first:?}");
    let ball = clearance::scene::BodyRef::Name("body 3".to_owned());
    scene.apply(&[Edit::MoveBody { body: ball, pose: place(0.0, 0.5, 0.8) }], None).unwrap();
    let second = tracker.advance(&scene.snapshot(), &|| false).unwrap();
    assert_eq!(patches(&second.events).len(), 3, "{second:?}");
}

#[test]
fn as_many_points_as_no_patch_has_are_refused() {
    let scene = table();
    for max_patch_points in [0, 33] {
        let context = Context { max_patch_points, ..Context::default() };
        let query = PairQuery { items: vec![Subject::All], mode: Mode::All, context };
        let refused = Prepared::collide(&*scene.snapshot(), &query).err();
        let problem = format!("is {max_patch_points}, not from 1 to 32");
        assert_eq!(refused, Some(Refused::Invalid { field: "context.max_patch_points".to_owned(), problem }));
    }
}
