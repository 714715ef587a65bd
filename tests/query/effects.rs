//! Declared effects and questions. Oracle: the same question to the same scene without declarations, where everything is permitted
//! and every pair is looked at; which pairs that leaves out is said by hand.
#![cfg(all(feature = "effect-derivatives", feature = "effect-motion", feature = "effect-patch"))]

use std::sync::Arc;

use clearance::geometry::{Pose, Quaternion, Shape, Vec3};
use clearance::limits::Limits;
use clearance::narrow_phase::Cost;
use clearance::query::{
    Answer, CastMode, CastShapes, CastVerdict, Casts, CheckMotions, CheckMovingPairs, CheckStates, Clearance,
    ClearanceOf, ContactQuestion, ContactTracker, Context, DEFAULT_RESOLUTION, Filter, Find, ItemBatch, Mode, Motions,
    Moved, Mover, MovingPairs, NearestBodies, Neighbours, NotAdvanced, Overlay, PairQuery, Prepared, Refused, Side,
    Subject, Verdict, Wants, Way, World, Worlds,
};
use clearance::robot::{ModelOptions, RobotModel};
use clearance::scene::{BodyId, BodyRef, Edit, Effect, Effects, Epoch, NewBody, Party, Revision, Scene, Snapshot};

fn place(x: f64, y: f64, z: f64) -> Pose {
    Pose::new(Vec3::new(x, y, z), Quaternion::IDENTITY).unwrap()
}

fn group(name: &str) -> Party {
    Party::Group(name.to_owned())
}

fn arm() -> Party {
    Party::Robot("arm".to_owned())
}

fn declare(a: Party, b: Party, effects: &[Effect]) -> Edit {
    Edit::DeclareEffects { a, b, effects: Some(effects.iter().copied().collect()) }
}

/// A rod of 1 m along x that turns about z, with a ball at its end that goes down a slide.
fn robot() -> Arc<RobotModel> {
    let urdf = r#"<robot name="crane"><link name="foot"/>
      <link name="boom"><collision><origin xyz="0.5 0 0"/><geometry><box size="1 0.1 0.1"/></geometry></collision></link>
      <link name="hook"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
      <joint name="turn" type="revolute"><parent link="foot"/><child link="boom"/><axis xyz="0 0 1"/>
        <limit lower="-3" upper="3" velocity="1" effort="1"/></joint>
      <joint name="lower" type="prismatic"><parent link="boom"/><child link="hook"/><origin xyz="1 0 0"/>
        <axis xyz="0 0 1"/><limit lower="-1" upper="0" velocity="1" effort="1"/></joint></robot>"#;
    let options = ModelOptions::default();
    Arc::new(RobotModel::from_urdf(urdf, None, &mut |_| Err("no meshes".to_owned()), &options).unwrap())
}

/// Crates and shelves in rows, each crate in a shelf and in the next crate; a robot over them.
fn store() -> Scene {
    let mut edits = Vec::new();
    for i in 0..8 {
        let x = 0.19 * i as f64;
        let mut body = |name: &str, group: &str, shape: Shape, pose: Pose| {
            let mut body = NewBody::new(format!("{name} {i}"), Arc::new(shape), pose);
            body.groups = vec![group.to_owned()];
            edits.push(Edit::AddBody(body));
        };
        body("crate", "crates", Shape::cuboid(Vec3::repeat(0.1)).unwrap(), place(x, 0.0, -0.14));
        body("shelf", "shelves", Shape::cuboid(Vec3::new(0.09, 0.3, 0.01)).unwrap(), place(x, 0.0, -0.245));
    }
    edits.push(Edit::AddRobot { name: "arm".to_owned(), model: robot(), base: Pose::identity() });
    let mut scene = Scene::new(Epoch(1));
    scene.apply(&edits, None).unwrap();
    scene
}

fn declared(edits: &[Edit]) -> Arc<Snapshot> {
    let mut scene = store();
    scene.apply(edits, None).unwrap();
    scene.snapshot()
}

fn pairs(items: Vec<Subject>, context: Context) -> PairQuery {
    PairQuery { items, mode: Mode::All, context }
}

fn with(wants: Wants) -> Context {
    Context { wants, max_pairs: 10_000, ..Context::default() }
}

fn collide(snapshot: &Snapshot, items: Vec<Subject>, context: Context) -> Result<Answer, Refused> {
    let query = pairs(items, context);
    Prepared::collide(snapshot, &query).map(|prepared| prepared.answer(&|| false))
}

fn states(context: Context) -> CheckStates {
    let positions = vec![0.0, 0.0, 0.4, -0.2, 1.5, -0.5, -0.3, -0.02];
    CheckStates { robot: "arm".to_owned(), positions, mode: Mode::All, context }
}

fn in_states(snapshot: &Snapshot, context: Context) -> Result<Answer, Refused> {
    Prepared::check_states(snapshot, &states(context)).map(|prepared| prepared.answer(&|| false))
}

fn motions(context: Context) -> CheckMotions {
    CheckMotions {
        robot: "arm".to_owned(),
        positions: vec![0.0, 0.0, 0.4, -0.2],
        motions: Motions::Edges,
        mode: Mode::All,
        find: Find::FirstContact,
        resolution: CheckMotions::DEFAULT_RESOLUTION,
        max_states: CheckMotions::DEFAULT_MAX_STATES,
        context,
    }
}

fn not_declared(effect: Effect, a: Party, b: Party) -> Option<Refused> {
    Some(Refused::NotDeclared { effect, a, b })
}

/// The same answer from another revision.
fn at(mut answer: Answer, revision: Revision) -> Answer {
    answer.revision = revision;
    answer
}

#[test]
fn each_want_is_refused_by_its_name_where_it_is_not_declared() {
    let on = |declared: bool| Wants { distance: declared, ..Wants::VERDICT };
    let cases = [
        (on(true), 0.0, Effect::Distance),
        (Wants { witness: true, ..on(false) }, 0.0, Effect::Witness),
        (Wants { depth: true, ..on(false) }, 0.0, Effect::Depth),
        (Wants { patch: true, ..on(false) }, 0.0, Effect::Patch),
        (Wants { derivatives: true, ..on(false) }, 0.0, Effect::Derivatives),
        (on(false), 0.1, Effect::Margin),
    ];
    for (wants, margin, effect) in cases {
        // Everything but what is wanted, and what needs it.
        let others: Vec<Effect> = Effect::EACH.into_iter().filter(|e| !Effects::of(*e).contains(effect)).collect();
        let scene =
            declared(&[declare(group("crates"), group("shelves"), &others), declare(arm(), group("shelves"), &others)]);
        let context = Context { margin, ..with(wants) };
        let refused = not_declared(effect, group("crates"), group("shelves"));
        assert_eq!(collide(&scene, vec![Subject::All], context.clone()).err(), refused);
        assert_eq!(collide(&scene, vec![Subject::ChangedSince(Revision(0))], context.clone()).err(), refused);
        assert_eq!(collide(&scene, vec![Subject::Body(BodyId(1))], context.clone()).err(), refused);
        assert_eq!(in_states(&scene, context.clone()).err(), not_declared(effect, arm(), group("shelves")));
        // A filter that leaves the shelves out has nothing to do with them.
        let filter = Filter { groups: vec!["crates".to_owned()], ..Filter::default() };
        let only_crates = Context { filter, ..context.clone() };
        assert!(collide(&scene, vec![Subject::All], only_crates.clone()).is_ok());
        assert!(in_states(&scene, only_crates).is_ok());
        // A bare shape is in no pair of the scene.
        let bare = Subject::Shape { shape: Shape::sphere(0.1).unwrap(), pose: place(0.0, 0.0, -0.2) };
        assert!(collide(&scene, vec![bare], context).is_ok());
    }
}

#[test]
fn motions_and_events_are_effects() {
    let scene = declared(&[
        declare(arm(), group("shelves"), &[Effect::Patch]),
        declare(group("crates"), Party::Everything, &[Effect::Patch]),
    ]);
    let refused = Prepared::check_motions(&*scene, &motions(Context::default())).err();
    assert_eq!(refused, not_declared(Effect::Motion, arm(), group("shelves")));
    let still = Mover { moved: Moved::Body(BodyId(1)), start: None, way: Way::To(place(0.0, 0.0, 1.0)) };
    let cast = CastShapes {
        items: vec![still],
        mode: CastMode::First,
        resolution: DEFAULT_RESOLUTION,
        context: Context::default(),
    };
    let refused = Casts::new(&scene, &cast).err();
    assert_eq!(refused, not_declared(Effect::Motion, group("crates"), Party::Everything));
    let tracked = ContactTracker::new(ContactQuestion::default()).advance(&scene, &|| false).unwrap_err();
    let NotAdvanced::Refused(refused) = tracked else { panic!("{tracked:?}") };
    assert_eq!(Some(refused), not_declared(Effect::Events, group("crates"), Party::Everything));
    let near = NearestBodies { items: vec![Subject::Body(BodyId(1))], count: 2, context: Context::default() };
    assert!(Neighbours::new(&scene, &near).is_ok());
    // Overlaps are ordered by their depths, so that these have to be declared.
    let shallow = declared(&[declare(group("crates"), Party::Everything, &[Effect::Distance])]);
    let refused = Neighbours::new(&shallow, &near).err();
    assert_eq!(refused, not_declared(Effect::Depth, group("crates"), Party::Everything));
}

#[test]
fn what_is_declared_changes_no_bit_of_an_answer() {
    let plain = store().snapshot();
    let all = declared(&[
        declare(group("crates"), group("shelves"), &Effect::EACH),
        declare(group("crates"), group("crates"), &Effect::EACH),
        declare(arm(), Party::Everything, &Effect::EACH),
    ]);
    for wants in [Wants::VERDICT, Wants { distance: true, ..Wants::VERDICT }, Wants::ALL] {
        for margin in [0.0, 0.05] {
            let context = Context { margin, ..with(wants) };
            let subjects: Vec<Subject> =
                plain.bodies().map(|body| Subject::Body(body.id)).chain([Subject::All]).collect();
            let [one, two] = [&plain, &all].map(|s| collide(s, subjects.clone(), context.clone()).unwrap());
            assert_eq!(at(two, one.revision), one);
            let [one, two] = [&plain, &all].map(|s| in_states(s, context.clone()).unwrap());
            assert_eq!(at(two, one.revision), one);
        }
    }
}

/// Whether a side is a crate, a shelf or neither.
fn kind(snapshot: &Snapshot, side: &Side) -> String {
    match side {
        Side::Body { id, .. } => snapshot.body(*id).unwrap().groups[0].to_string(),
        Side::Link { .. } | Side::Query { .. } => String::new(),
    }
}

#[test]
fn pairs_declared_empty_are_never_looked_at_and_the_answer_says_so() {
    let plain = store().snapshot();
    let empty = declared(&[
        declare(group("crates"), group("shelves"), &[]),
        declare(arm(), group("shelves"), &[]),
        declare(arm(), arm(), &[]),
    ]);
    let ours = (group("crates"), group("shelves"));
    for disregard_allowed_collisions in [false, true] {
        let filter = Filter { disregard_allowed_collisions, ..Filter::default() };
        let context = Context { filter, ..with(Wants::ALL) };
        let one = collide(&plain, vec![Subject::All], context.clone()).unwrap();
        let two = collide(&empty, vec![Subject::All], context.clone()).unwrap();
        assert_eq!(two.coverage.declared_empty, std::slice::from_ref(&ours));
        assert!(one.coverage.declared_empty.is_empty());
        let kept = |pair: &&_| -> bool {
            let clearance::query::PairAnswer { a, b, .. } = pair;
            kind(&plain, a) == kind(&plain, b)
        };
        let expected: Vec<_> = one.items[0].pairs.iter().filter(kept).cloned().collect();
        assert!(expected.len() >= 7 && expected.len() < one.items[0].pairs.len());
        assert_eq!(two.items[0].pairs, expected);
        assert!(two.cost.pairs < one.cost.pairs);
        // A shelf meets nobody but crates: nothing at all is measured.
        let shelf =
            collide(&empty, vec![Subject::Body(BodyId(2))], Context { wants: Wants::VERDICT, ..context.clone() });
        let shelf = shelf.unwrap();
        assert_eq!(
            (shelf.items[0].verdict, shelf.coverage.declared_empty),
            (Verdict::Free, vec![(ours.1.clone(), ours.0.clone())])
        );
        assert_eq!((shelf.cost.pairs, shelf.cost.supports, shelf.cost.patch_corners), (0, 0, 0));
        // Nor is the robot against shelves, or against itself.
        let of_robot = in_states(&empty, context).unwrap();
        assert_eq!(of_robot.coverage.declared_empty, [(arm(), group("shelves")), (arm(), arm())]);
        for item in &of_robot.items {
            assert!(item.nearest_self.is_none());
            assert!(item.pairs.iter().chain(&item.nearest).all(|pair| kind(&empty, &pair.b) == "crates"), "{item:?}");
        }
    }
}

#[test]
fn nearest_bodies_clearances_and_contacts_leave_them_out_too() {
    let empty = declared(&[declare(group("crates"), group("shelves"), &[])]);
    let turned = [(group("crates"), group("shelves"))];
    let near = NearestBodies { items: vec![Subject::Body(BodyId(1))], count: 99, context: Context::default() };
    let found = Neighbours::new(&empty, &near).unwrap().answer_all(&|| false);
    assert_eq!(found.coverage.declared_empty, turned);
    assert_eq!(found.items[0].nearest.len(), 7);
    let of = pairs(vec![Subject::Body(BodyId(1))], with(Wants::VERDICT));
    let clearance = Clearance { subjects: ClearanceOf::Subjects(of), within: 99.0 };
    let found = Prepared::clearance(&*empty, &clearance).unwrap().answer(&|| false);
    assert_eq!((found.items[0].pairs.len(), found.coverage.declared_empty.as_slice()), (7, turned.as_slice()));
    // Contacts end when their pair is declared empty.
    let mut scene = store();
    let mut tracker = ContactTracker::new(ContactQuestion::default());
    let before = tracker.advance(&scene.snapshot(), &|| false).unwrap();
    scene.apply(&[declare(group("shelves"), group("crates"), &[])], None).unwrap();
    let after = tracker.advance(&scene.snapshot(), &|| false).unwrap();
    assert!(before.coverage.declared_empty.is_empty() && after.coverage.declared_empty == turned);
    assert_eq!(before.contacts - after.contacts, after.events.len());
    assert!(after.events.len() >= 8 && after.contacts >= 7);
}

#[test]
fn an_overlay_may_declare_and_take_back() {
    let snapshot = declared(&[declare(arm(), group("crates"), &[])]);
    let take_back = Edit::DeclareEffects { a: arm(), b: group("crates"), effects: None };
    let world = World::as_is(&snapshot)
        .under(&Overlay { edits: vec![take_back], attached: Vec::new() }, &Limits::default())
        .unwrap();
    let worlds = Worlds::new(world, Vec::new(), Vec::new()).unwrap();
    let question = states(with(Wants::VERDICT));
    let supposed = Prepared::check_states(&worlds, &question).unwrap().answer(&|| false);
    let as_is = Prepared::check_states(&*snapshot, &question).unwrap().answer(&|| false);
    let plain = Prepared::check_states(&*store().snapshot(), &question).unwrap().answer(&|| false);
    assert!(supposed.coverage.declared_empty.is_empty() && !as_is.coverage.declared_empty.is_empty());
    assert_eq!(supposed.items, plain.items);
    assert_ne!(as_is.items, plain.items);
}

#[test]
fn a_closed_scene_is_open_where_it_says_so() {
    let closed = declare(Party::Everything, Party::Everything, &[]);
    let snapshot = declared(&[closed, declare(group("crates"), group("crates"), &[Effect::Depth])]);
    let wants = Wants { depth: true, ..Wants::VERDICT };
    let answer = collide(&snapshot, vec![Subject::All], with(wants)).unwrap();
    assert_eq!(answer.coverage.declared_empty, [(Party::Everything, Party::Everything)]);
    assert!(answer.items[0].pairs.len() >= 7);
    let both = answer.items[0].pairs.iter().flat_map(|pair| [&pair.a, &pair.b]);
    assert!(both.into_iter().all(|side| kind(&snapshot, side) == "crates"));
    let robot = in_states(&snapshot, with(wants)).unwrap();
    // Nothing is looked for, either: not even in the broad phase.
    assert!(robot.items.iter().all(|item| item.verdict == Verdict::Free && item.cost == Cost::default()));
    let shelf = collide(&snapshot, vec![Subject::Body(BodyId(2))], with(wants)).unwrap();
    assert_eq!((shelf.items[0].verdict, shelf.cost), (Verdict::Free, Cost::default()));
    let moved = Mover { moved: Moved::Body(BodyId(2)), start: None, way: Way::To(place(0.0, 0.0, 1.0)) };
    let cast = CastShapes {
        items: vec![moved],
        mode: CastMode::All,
        resolution: DEFAULT_RESOLUTION,
        context: Context::default(),
    };
    let cast = Casts::new(&snapshot, &cast).unwrap().answer_all(&|| false);
    assert_eq!(cast.items[0].cost, Cost::default());
    let near = NearestBodies { items: vec![Subject::Body(BodyId(2))], count: 3, context: Context::default() };
    let near = Neighbours::new(&snapshot, &near).unwrap().answer_all(&|| false);
    assert_eq!((near.items[0].nearest.len(), near.items[0].cost), (0, Cost::default()));
}

#[test]
fn bodies_that_are_quiet_among_themselves_do_not_walk_the_tree() {
    let plain = store().snapshot();
    let quiet = declared(&[declare(group("crates"), group("crates"), &[])]);
    let question = |snapshot: &Snapshot| collide(snapshot, vec![Subject::All], with(Wants::VERDICT)).unwrap();
    let (plain, quiet) = (question(&plain), question(&quiet));
    assert!(quiet.cost.nodes < plain.cost.nodes, "{} {}", quiet.cost.nodes, plain.cost.nodes);
    assert!(quiet.items[0].pairs.len() < plain.items[0].pairs.len());
}

#[test]
fn what_is_left_out_is_listed_as_far_as_pairs_are() {
    let empty = declared(&[
        declare(group("crates"), group("shelves"), &[]),
        declare(arm(), group("shelves"), &[]),
        declare(arm(), arm(), &[]),
    ]);
    let whole = in_states(&empty, with(Wants::VERDICT)).unwrap().coverage;
    assert_eq!((whole.declared_empty.len(), whole.not_listed), (2, 0));
    let cut = in_states(&empty, Context { max_pairs: 1, ..with(Wants::VERDICT) }).unwrap().coverage;
    assert_eq!((cut.declared_empty.as_slice(), cut.not_listed), (&whole.declared_empty[..1], 1));
    let none = in_states(&empty, Context { max_pairs: 0, ..with(Wants::VERDICT) }).unwrap().coverage;
    assert_eq!((none.declared_empty.len(), none.not_listed), (0, 2));
}

#[test]
fn moving_pairs_need_what_is_declared_of_exactly_these_two() {
    let crate_and_shelf = [BodyId(1), BodyId(2)];
    let ask = |snapshot: &Snapshot, ids: [BodyId; 2]| {
        let item = ids.map(|id| Mover { moved: Moved::Body(id), start: None, way: Way::Still });
        let question =
            CheckMovingPairs { items: vec![item], resolution: DEFAULT_RESOLUTION, context: Context::default() };
        MovingPairs::new(snapshot, &question).map(|pairs| pairs.answer_all(&|| false))
    };
    let by_id = |id: BodyId| Party::Body(BodyRef::Id(id));
    let snapshot = declared(&[
        declare(group("crates"), group("crates"), &[Effect::Depth]),
        declare(group("crates"), group("shelves"), &[]),
    ]);
    let two_crates = [BodyId(1), BodyId(3)];
    assert_eq!(
        ask(&snapshot, two_crates).err(),
        not_declared(Effect::Motion, by_id(two_crates[0]), by_id(two_crates[1]))
    );
    // That crates and crates have no motion does not matter to a crate and a shelf.
    let empty = ask(&snapshot, crate_and_shelf).unwrap();
    assert_eq!(empty.items[0].verdict, CastVerdict::Clear);
    assert_eq!(empty.coverage.declared_empty, [(by_id(crate_and_shelf[0]), by_id(crate_and_shelf[1]))]);
    let shelves = ask(&snapshot, [BodyId(2), BodyId(4)]).unwrap();
    assert!(shelves.coverage.declared_empty.is_empty());
    let allowed = declared(&[
        declare(group("crates"), group("shelves"), &[]),
        declare(by_id(BodyId(1)), by_id(BodyId(2)), &[Effect::Motion]),
    ]);
    assert_eq!(ask(&allowed, crate_and_shelf).unwrap().items[0].verdict, CastVerdict::Hit);
}
