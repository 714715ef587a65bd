//! What-if questions. Oracle: a scene in which the same edits were applied answers the same, byte for byte, but for the
//! revision. Of bodies that a robot holds: each state with the body moved to where its link takes it.

use std::sync::Arc;

use clearance::geometry::{Pose, Quaternion, Shape, Vec3};
use clearance::limits::Limits;
use clearance::query::{
    Answer, Attached, CheckStates, Context, Filter, ItemAnswer, Mode, NotSupposed, Overlay, PairAnswer, PairQuery,
    Prepared, Refused, Side, Subject, Verdict, Wants, World, Worlds,
};
use clearance::robot::{MeshRequest, ModelOptions, RobotModel};
use clearance::scene::{BodyId, BodyRef, Edit, Epoch, NewBody, Party, Revision, Scene, SceneOptions, Snapshot};

use crate::moving_scene::Chance;

/// A rod that turns about z, and a ball at its end that a slide moves along z.
const CRANE: &str = r#"<robot name="crane">
  <link name="foot"><collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
  <link name="boom"><collision><origin xyz="0.5 0 0"/><geometry><box size="1 0.1 0.1"/></geometry></collision></link>
  <link name="hook"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <joint name="turn" type="continuous"><parent link="foot"/><child link="boom"/><axis xyz="0 0 1"/></joint>
  <joint name="lower" type="prismatic"><parent link="boom"/><child link="hook"/><origin xyz="1 0 0"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="0"/></joint>
</robot>"#;

const LINKS: [&str; 3] = ["foot", "boom", "hook"];

fn crane() -> Arc<RobotModel> {
    let mut none = |_: &MeshRequest| Err("none".to_owned());
    Arc::new(RobotModel::from_urdf(CRANE, None, &mut none, &ModelOptions::default()).unwrap())
}

fn unit(chance: &mut Chance) -> f64 {
    chance.below(1 << 20) as f64 / f64::from(1 << 20)
}

fn pose(chance: &mut Chance) -> Pose {
    let mut number = |scale: f64| scale * (unit(chance) - 0.5);
    let t = Vec3::new(number(3.0), number(3.0), number(2.0));
    let [x, y, z, w] = [number(1.0), number(1.0), number(1.0), 0.75 + number(0.4)];
    Pose::new(t, Quaternion { w, x, y, z }).unwrap()
}

fn shape(chance: &mut Chance) -> Arc<Shape> {
    let size = 0.05 + 0.3 * unit(chance);
    Arc::new(match chance.below(12) {
        0 => Shape::half_space(Vec3::new(0.1, 0.2, 1.0), -1.0).unwrap(),
        1..=5 => Shape::cuboid(Vec3::new(size, 0.5 * size, 0.8 * size)).unwrap(),
        6..=8 => Shape::cylinder(size, 0.5 * size).unwrap(),
        _ => Shape::sphere(size).unwrap(),
    })
}

fn party(chance: &mut Chance) -> Party {
    match chance.below(8) {
        0 => Party::Everything,
        1 => Party::Group("g".to_owned()),
        2 => Party::Robot("arm".to_owned()),
        3 | 4 => Party::Link { robot: "arm".to_owned(), link: LINKS[chance.below(3)].to_owned() },
        _ => Party::Body(name(chance)),
    }
}

fn name(chance: &mut Chance) -> BodyRef {
    BodyRef::Name(format!("{}", chance.below(16)))
}

/// Some of them cannot be made.
fn edit(chance: &mut Chance) -> Edit {
    match chance.below(20) {
        0..=3 => {
            let groups = if chance.below(3) == 0 { vec!["g".to_owned()] } else { Vec::new() };
            let (shape, pose) = (shape(chance), pose(chance));
            Edit::AddBody(NewBody { groups, ..NewBody::new(format!("{}", chance.below(16)), shape, pose) })
        }
        4..=8 => Edit::MoveBody { body: name(chance), pose: pose(chance) },
        9 => Edit::RemoveBody { body: name(chance) },
        10 | 11 => Edit::SetEnabled { body: name(chance), enabled: chance.below(3) == 0 },
        12 => Edit::ReplaceShape { body: name(chance), shape: shape(chance), scale: 1.0, padding: 0.02 },
        13 => Edit::SetGroups { body: name(chance), groups: vec!["g".to_owned()] },
        14 => Edit::SetLayers { body: name(chance), layers: 1 << chance.below(2), mask: u32::MAX },
        15 => Edit::MoveRobot { robot: "arm".to_owned(), base: pose(chance) },
        16 | 17 => Edit::SetPairMargin { a: party(chance), b: party(chance), margin: Some(0.3 * unit(chance)) },
        _ => {
            let allowed = [Some(true), Some(false), None][chance.below(3)];
            Edit::SetAllowedCollision { a: party(chance), b: party(chance), allowed }
        }
    }
}

/// Edits that can be made one after the other in a snapshot.
fn fitting(chance: &mut Chance, snapshot: &Snapshot, wanted: usize) -> Vec<Edit> {
    let mut edits = Vec::new();
    while edits.len() < wanted {
        edits.push(edit(chance));
        if snapshot.suppose(&edits, &Limits::default()).is_err() {
            edits.pop();
        }
    }
    edits
}

/// The lists of edits that lead to a scene of a robot and some bodies.
fn history(chance: &mut Chance) -> Vec<Vec<Edit>> {
    let robot = Edit::AddRobot { name: "arm".to_owned(), model: crane(), base: Pose::identity() };
    let bodies = (0..9).map(|i| Edit::AddBody(NewBody::new(format!("{i}"), shape(chance), pose(chance))));
    let mut lists = vec![std::iter::once(robot).chain(bodies).collect::<Vec<_>>()];
    for _ in 0..3 {
        let edits = fitting(chance, &after(&lists).snapshot(), 3);
        lists.push(edits);
    }
    lists
}

fn after(lists: &[Vec<Edit>]) -> Scene {
    let mut scene = Scene::with_options(Epoch(1), Limits::default(), &SceneOptions::default());
    lists.iter().for_each(|edits| drop(scene.apply(edits, None).unwrap()));
    scene
}

fn under(edits: &[Edit]) -> Overlay {
    Overlay { edits: edits.to_vec(), attached: Vec::new() }
}

/// What is asked, item by item.
fn subjects(chance: &mut Chance, revision: Revision) -> Vec<Subject> {
    (0..12)
        .map(|i| match i % 4 {
            0 => Subject::All,
            1 => Subject::Body(BodyId(1 + chance.below(12) as u64)),
            2 => Subject::ChangedSince(Revision(revision.0 - chance.below(2) as u64)),
            _ => Subject::Shape { shape: Shape::sphere(0.3).unwrap(), pose: pose(chance) },
        })
        .collect()
}

fn canonical(answer: Answer) -> Vec<ItemAnswer> {
    answer.canonical().items
}

#[test]
fn an_overlay_is_answered_like_a_scene_with_its_edits() {
    let limits = Limits::default();
    let [mut free, mut colliding, mut within, mut invalid, mut added, mut changed, mut unlike] = [0_usize; 7];
    for seed in 0..60 {
        let chance = &mut Chance::new(seed);
        let lists = history(chance);
        let scene = after(&lists);
        let base = scene.snapshot();
        let common_edits = fitting(chance, &base, seed as usize % 4);
        let common = World::as_is(&base).under(&under(&common_edits), &limits).unwrap();
        let alternatives: Vec<Vec<Edit>> = (0..4).map(|n| fitting(chance, &common.snapshot, n)).collect();
        let worlds = alternatives.iter().map(|edits| common.under(&under(edits), &limits).unwrap()).collect();
        let of_item: Vec<u32> = (0..12).map(|_| chance.below(5) as u32).collect();
        let worlds = Worlds::new(common, worlds, of_item.clone()).unwrap();
        for world in worlds.all() {
            assert_eq!(world.snapshot.validate(), Ok(()), "seed {seed}");
        }

        let wants = [Wants::VERDICT, Wants::ALL, Wants { distance: true, ..Wants::VERDICT }][seed as usize % 3];
        let context = Context { wants, margin: 0.1, max_pairs: 20, ..Context::default() };
        let items = subjects(chance, base.revision());
        let pairs = PairQuery { items, mode: Mode::All, context: context.clone() };
        let positions = (0..12).flat_map(|_| [6.0 * unit(chance) - 3.0, -unit(chance)]).collect();
        let states = CheckStates { robot: "arm".to_owned(), positions, mode: Mode::All, context };
        let asked = [
            Prepared::collide(&worlds, &pairs).unwrap().answer(&|| false),
            Prepared::distance(&worlds, &pairs).unwrap().answer(&|| false),
            Prepared::check_states(&worlds, &states).unwrap().answer(&|| false),
        ];
        for answer in &asked {
            assert_eq!((answer.epoch, answer.revision), (base.epoch(), base.revision()));
        }
        let plain = Prepared::check_states(&*base, &states).unwrap().answer(&|| false);
        unlike += usize::from(plain.items != asked[2].items);
        let asked = asked.map(canonical);
        for number in 0..=4_u32 {
            let edits = number.checked_sub(1).map_or(&[][..], |index| &alternatives[index as usize]);
            let mut oracle = after(&lists);
            let applied = oracle.apply(&[&common_edits, edits].concat(), None).unwrap();
            let snapshot = oracle.snapshot();
            let expected = [
                Prepared::collide(&*snapshot, &pairs).unwrap().answer(&|| false),
                Prepared::distance(&*snapshot, &pairs).unwrap().answer(&|| false),
                Prepared::check_states(&*snapshot, &states).unwrap().answer(&|| false),
            ];
            let expected = expected.map(canonical);
            for item in (0..12).filter(|item| of_item[*item] == number) {
                for (told, oracle) in asked.iter().zip(&expected) {
                    assert_eq!(told[item], oracle[item], "seed {seed}, item {item}, overlay {number}");
                    match told[item].verdict {
                        Verdict::Free => free += 1,
                        Verdict::Collision => colliding += 1,
                        Verdict::Margin => within += 1,
                        Verdict::InvalidInput => invalid += 1,
                        Verdict::Indeterminate(_) | Verdict::NotRun => {}
                    }
                }
                changed += usize::from(item % 4 == 2 && !asked[0][item].pairs.is_empty());
            }
            let own = number.checked_sub(1).map_or(&[][..], |_| &worlds.all()[number as usize].added[..]);
            let named = [&worlds.all()[0].added, own].concat();
            assert_eq!(named, applied.added, "seed {seed}, overlay {number}");
            added += named.len();
        }
        // Nobody else is told, and nothing was used up.
        assert_eq!((scene.snapshot().revision(), base.validate()), (base.revision(), Ok(())));
    }
    for count in [free, colliding, within, invalid, added, changed, unlike] {
        assert!(count >= 10, "{:?}", [free, colliding, within, invalid, added, changed, unlike]);
    }
}

#[test]
fn an_edit_that_cannot_be_made_is_refused_as_the_scene_refuses_it() {
    let limits = Limits::default();
    let [mut refused, mut later, mut made] = [0; 3];
    for seed in 0..300 {
        let chance = &mut Chance::new(seed);
        let lists = history(chance);
        let mut scene = after(&lists);
        let edits: Vec<Edit> = (0..3).map(|_| edit(chance)).collect();
        let supposed = World::as_is(&scene.snapshot()).under(&under(&edits), &limits);
        match (supposed, scene.apply(&edits, None)) {
            (Ok(world), Ok(applied)) => {
                assert_eq!(world.added, applied.added);
                made += 1;
            }
            (Err(NotSupposed::Edit(told)), Err(refusal)) => {
                assert_eq!(told, refusal, "seed {seed}");
                refused += 1;
                later += usize::from(!told.to_string().starts_with("edits[0]"));
            }
            (supposed, applied) => panic!("seed {seed}: {:?}, {applied:?}", supposed.map(|world| world.added)),
        }
    }
    assert!(refused > 20 && later > 5 && made > 20, "{refused}, {later}, {made}");
}

/// What is told of a pair, but for how it was found.
fn told(pairs: &[PairAnswer]) -> Vec<(&Side, &Side, Verdict)> {
    pairs.iter().map(|pair| (&pair.a, &pair.b, pair.verdict)).collect()
}

fn held(body: &str, link: &str, body_in_link: Pose, may_touch: &[&str]) -> Attached {
    Attached {
        body: body.into(),
        robot: "arm".to_owned(),
        link: link.to_owned(),
        body_in_link,
        may_touch: may_touch.iter().map(|link| (*link).to_owned()).collect(),
    }
}

#[test]
fn a_held_body_is_where_its_link_takes_it() {
    let limits = Limits::default();
    let model = crane();
    let [mut by_itself, mut by_scene, mut apart, mut touching_allowed] = [0; 4];
    for seed in 0..120 {
        let chance = &mut Chance::new(1000 + seed);
        let lists = history(chance);
        let base = after(&lists).snapshot();
        let bounded = base.bodies().filter(|body| body.enabled && body.shape.bounds().is_some());
        let bounded: Vec<&str> = bounded.map(|body| &*body.name).collect();
        let Some(body) = (!bounded.is_empty()).then(|| bounded[chance.below(bounded.len())]) else { continue };
        let (link, touched) = [("hook", None), ("hook", Some("boom")), ("boom", Some("foot"))][seed as usize % 3];
        let grip = Pose::new(Vec3::new(0.1, 0.0, -0.2 * unit(chance)), Quaternion::IDENTITY).unwrap();
        let attached = held(body, link, grip, touched.as_slice());
        let overlay = Overlay { edits: Vec::new(), attached: vec![attached] };
        let world = World::as_is(&base).under(&overlay, &limits).unwrap();
        let worlds = Worlds::new(world, Vec::new(), Vec::new()).unwrap();
        let q = [6.0 * unit(chance) - 3.0, -unit(chance)];
        let context = Context { wants: Wants::ALL, margin: 0.05, max_pairs: 1000, ..Context::default() };
        let question =
            |context| CheckStates { robot: "arm".to_owned(), positions: q.to_vec(), mode: Mode::All, context };
        let asked = question(context.clone());
        let found = Prepared::check_states(&worlds, &asked).unwrap().answer(&|| false).items.remove(0);

        // The body where the link takes it, and the pairs that do not count allowed.
        let mut poses = Vec::new();
        model.link_poses(&q, &base.robot("arm").unwrap().base, &mut poses);
        let place = poses[model.link(link).unwrap() as usize].compose(&grip);
        let mut edits = vec![Edit::MoveBody { body: body.into(), pose: place }];
        edits.extend(std::iter::once(link).chain(touched).map(|link| Edit::SetAllowedCollision {
            a: Party::Link { robot: "arm".to_owned(), link: link.to_owned() },
            b: Party::Body(body.into()),
            allowed: Some(true),
        }));
        let oracle = after(&[&lists[..], &[edits]].concat()).snapshot();
        let id = oracle.body_named(body).unwrap().id;
        let robot = Prepared::check_states(&*oracle, &asked).unwrap().answer(&|| false).items.remove(0);
        let items = vec![Subject::Body(id)];
        let around = PairQuery { items, mode: Mode::All, context };
        let around = Prepared::collide(&*oracle, &around).unwrap().answer(&|| false).items.remove(0);

        let mut pairs = [&robot.pairs[..], &around.pairs].concat();
        pairs.sort_by(|one, two| (&one.a, &one.b).cmp(&(&two.a, &two.b)));
        assert_eq!(told(&found.pairs), told(&pairs), "seed {seed}");
        let least = [&robot, &around].into_iter().filter_map(|item| item.nearest.as_ref());
        let least = least.map(|pair| pair.signed_distance).fold(f64::INFINITY, f64::min);
        let nearest = found.nearest.as_ref().map_or(f64::INFINITY, |pair| pair.signed_distance);
        assert!(nearest == least || (nearest - least).abs() < 1e-9, "seed {seed}: {nearest}, {least}");
        let is_held = |side: &Side| matches!(side, Side::Body { id: other, .. } if *other == id);
        for pair in &found.pairs {
            match (&pair.a, &pair.b) {
                (Side::Link { .. }, b) if is_held(b) => by_itself += 1,
                (a, b) if is_held(a) || is_held(b) => by_scene += 1,
                _ => {}
            }
        }
        apart += usize::from(found.verdict == Verdict::Free);
        touching_allowed += usize::from(touched.is_some() && found.verdict != Verdict::Collision);
    }
    let reached = [by_itself, by_scene, apart, touching_allowed];
    assert!(reached.iter().all(|count| *count >= 3), "{reached:?}");
}

fn at(x: f64, y: f64, z: f64) -> Pose {
    Pose::new(Vec3::new(x, y, z), Quaternion::IDENTITY).unwrap()
}

fn placed(name: &str, shape: Shape, pose: Pose) -> Edit {
    Edit::AddBody(NewBody::new(name, Arc::new(shape), pose))
}

/// A post on the way of a long rod that the hook holds, out of the reach of the crane alone.
fn post() -> Arc<Snapshot> {
    let robot = Edit::AddRobot { name: "arm".to_owned(), model: crane(), base: Pose::identity() };
    let rod = placed("rod", Shape::cuboid(Vec3::new(0.5, 0.05, 0.05)).unwrap(), at(9.0, 0.0, 0.0));
    let post = placed("post", Shape::cuboid(Vec3::new(0.1, 0.1, 2.0)).unwrap(), at(0.0, 1.5, 0.0));
    after(&[vec![robot, rod, post]]).snapshot()
}

#[cfg(feature = "effect-motion")]
#[test]
fn a_motion_takes_what_is_held_along() {
    use clearance::query::{CheckMotions, Find, Motions};
    let base = post();
    let motion = |positions: &[f64]| CheckMotions {
        robot: "arm".to_owned(),
        positions: positions.to_vec(),
        motions: Motions::Edges,
        mode: Mode::All,
        find: Find::FirstContact,
        resolution: CheckMotions::DEFAULT_RESOLUTION,
        max_states: CheckMotions::DEFAULT_MAX_STATES,
        context: Context { wants: Wants { distance: true, ..Wants::VERDICT }, ..Context::default() },
    };
    // A quarter turn and more, twice the same: with the hook empty, and with the rod.
    let question = motion(&[0.0, -0.5, 3.0, -0.5, 0.0, -0.5, 3.0, -0.5]);
    let overlay = Overlay { edits: Vec::new(), attached: vec![held("rod", "hook", at(0.5, 0.0, 0.0), &["boom"])] };
    let common = World::as_is(&base);
    let holding = common.under(&overlay, &Limits::default()).unwrap();
    let worlds = Worlds::new(common, vec![holding], vec![0, 1]).unwrap();
    let items = Prepared::check_motions(&worlds, &question).unwrap().answer(&|| false).items;
    assert_eq!((items[0].verdict, items[1].verdict), (Verdict::Free, Verdict::Collision));
    let [before, after] = items[1].motion.unwrap().reached.unwrap();
    // The rod reaches 2 m; its near corner meets the post a little before the quarter.
    assert!(after - before <= 1e-3 && (0.4..0.53).contains(&after), "{before}, {after}");
    let pair = items[1].nearest.as_ref().unwrap();
    let (rod, post) = (base.body_named("rod").unwrap().id, base.body_named("post").unwrap().id);
    assert!(
        matches!((&pair.a, &pair.b), (Side::Body { id: a, .. }, Side::Body { id: b, .. }) if (*a, *b) == (rod, post))
    );
}

fn refused(asked: &Worlds, question: &PairQuery) -> String {
    let Some(Refused::Invalid { field, .. }) = Prepared::collide(asked, question).err() else { panic!("it passed") };
    field
}

#[test]
fn what_cannot_be_supposed_is_refused_by_field() {
    let base = post();
    let limits = Limits::default();
    let as_is = World::as_is(&base);
    let attach = |attached: Vec<Attached>| Overlay { edits: Vec::new(), attached };
    let fault = |world: &World, overlay: &Overlay| world.under(overlay, &limits).unwrap_err().to_string();
    let rod = || held("rod", "hook", Pose::identity(), &[]);
    let floor = placed("floor", Shape::half_space(Vec3::z(), -3.0).unwrap(), Pose::identity());
    let cases = [
        (attach(vec![held("rope", "hook", Pose::identity(), &[])]), "attached[0].body: no body is named \"rope\""),
        (attach(vec![rod(), held("rod", "boom", Pose::identity(), &[])]), "attached[1].body: is attached already"),
        (attach(vec![Attached { robot: "leg".to_owned(), ..rod() }]), "attached[0].robot: no robot is named \"leg\""),
        (
            attach(vec![held("rod", "toe", Pose::identity(), &[])]),
            "attached[0].link: the robot \"arm\" has no link \"toe\"",
        ),
        (
            attach(vec![held("rod", "hook", Pose::identity(), &["boom", "toe"])]),
            "attached[0].may_touch: the robot \"arm\" has no link \"toe\"",
        ),
        (
            Overlay { edits: vec![floor], attached: vec![held("floor", "hook", Pose::identity(), &[])] },
            "attached[0].body: the body \"floor\" is a half_space, which has no bounds and cannot be held",
        ),
    ];
    for (overlay, text) in cases {
        assert_eq!(fault(&as_is, &overlay), text);
    }
    let holding = as_is.under(&attach(vec![rod()]), &limits).unwrap();
    let endless = Edit::ReplaceShape {
        body: "rod".into(),
        shape: Arc::new(Shape::half_space(Vec3::z(), 0.0).unwrap()),
        scale: 1.0,
        padding: 0.0,
    };
    assert!(fault(&holding, &under(&[endless])).starts_with("edits: the body \"rod\" is a half_space"));
    // What is held may leave, and then is held no longer.
    let gone = holding.under(&under(&[Edit::RemoveBody { body: "rod".into() }]), &limits).unwrap();
    let context = Context { filter: Filter::default(), ..Context::default() };
    let pairs = PairQuery { items: vec![Subject::All], mode: Mode::All, context: context.clone() };
    let only = |world: &World| Worlds::new(world.clone(), Vec::new(), Vec::new()).unwrap();
    assert!(Prepared::collide(&only(&gone), &pairs).is_ok());

    // Questions that are not about the robot, or about another; items that name what is not there.
    assert_eq!(refused(&only(&holding), &pairs), "context.overlay.attached");
    let second = Worlds::new(as_is.clone(), vec![holding.clone()], vec![1]).unwrap();
    assert_eq!(refused(&second, &pairs), "context.alternatives[0].attached");
    let other = Edit::AddRobot { name: "leg".to_owned(), model: crane(), base: at(5.0, 0.0, 0.0) };
    let both = holding.under(&under(&[other]), &limits).unwrap();
    let leg = CheckStates { robot: "leg".to_owned(), positions: vec![0.0, 0.0], mode: Mode::All, context };
    let text = Prepared::check_states(&only(&both), &leg).err().unwrap().to_string();
    assert_eq!(text, "context.overlay.attached: names the robot \"arm\", and the question is about \"leg\"");
    let unknown = Worlds::new(as_is.clone(), Vec::new(), vec![0, 1]).unwrap_err().to_string();
    assert_eq!(unknown, "context.item_alternatives[1]: is 1, and there are 0 alternatives");
    let too_few = Worlds::new(as_is, Vec::new(), vec![0, 0]).unwrap();
    assert_eq!(refused(&too_few, &pairs), "context.item_alternatives");
}
