//! Bodies and bare shapes against a scene. Oracle: every admitted pair measured one by one, without tree or cut-off.

use std::sync::Arc;

use clearance::geometry::{Compound, Part, Pose, Quaternion, Shape, Vec3};
use clearance::narrow_phase::{Accuracy, Goal, separation};
use clearance::query::{Answer, Context, Filter, ItemAnswer, Mode, PairQuery, Prepared, Side, Subject, Verdict, Wants};
use clearance::scene::{BodyId, Edit, Epoch, NewBody, Party, Scene, Snapshot};

fn pose(x: f64, y: f64, z: f64) -> Pose {
    Pose::new(Vec3::new(x, y, z), Quaternion { w: 0.9, x: 0.1 * x, y: 0.2, z: 0.1 * z }).unwrap()
}

/// Sixty boxes, balls and cylinders in a loose lattice, some of them overlapping, over a floor.
fn clutter() -> Scene {
    let shapes = [
        Shape::cuboid(Vec3::new(0.2, 0.3, 0.1)).unwrap(),
        Shape::sphere(0.25).unwrap(),
        Shape::cylinder(0.15, 0.4).unwrap(),
    ]
    .map(Arc::new);
    let body = |i: usize| {
        let step = |n: usize| (i * i % n) as f64 * 0.47 + (i % 4) as f64 * 0.11;
        let place = pose(step(11), step(7), step(9));
        let mut body = NewBody::new(format!("body {i}"), Arc::clone(&shapes[i % 3]), place);
        body.groups = vec![if i.is_multiple_of(2) { "even" } else { "odd" }.to_owned()];
        Edit::AddBody(body)
    };
    let mut edits: Vec<Edit> = (0..60).map(body).collect();
    let floor = Shape::half_space(Vec3::z(), -0.1).unwrap();
    edits.push(Edit::AddBody(NewBody::new("floor", Arc::new(floor), Pose::identity())));
    let mut scene = Scene::new(Epoch(7));
    scene.apply(&edits, None).unwrap();
    scene
}

fn ask(snapshot: &Snapshot, subject: Subject, context: Context, distance: bool) -> ItemAnswer {
    let query = PairQuery { items: vec![subject], mode: Mode::All, context };
    let prepared = if distance { Prepared::distance(snapshot, &query) } else { Prepared::collide(snapshot, &query) };
    let Answer { mut items, epoch, revision, .. } = prepared.unwrap().answer(&|| false);
    assert_eq!((epoch, revision), (snapshot.epoch(), snapshot.revision()));
    items.remove(0)
}

/// Signed distance of every pair of bodies, measured in full; pairs of unbounded bodies have none.
fn all_pairs(snapshot: &Snapshot) -> Vec<(BodyId, BodyId, f64)> {
    let mut pairs = Vec::new();
    for a in snapshot.bodies() {
        for b in snapshot.bodies().filter(|b| b.id > a.id) {
            let found = separation(&a.shape, &b.shape, &a.placement, &b.placement, &Goal::penetration());
            pairs.extend(found.map(|s| (a.id, b.id, s.signed_distance)));
        }
    }
    pairs
}

fn ids(answer: &ItemAnswer) -> Vec<(BodyId, BodyId)> {
    let id = |side: &Side| match side {
        Side::Body { id, .. } => *id,
        Side::Link { .. } | Side::Query { .. } => panic!("only bodies were asked about"),
    };
    answer.pairs.iter().map(|p| (id(&p.a), id(&p.b))).collect()
}

fn with(wants: Wants) -> Context {
    Context { wants, max_pairs: 10_000, ..Context::default() }
}

#[test]
fn all_against_all_finds_the_colliding_and_the_near_pairs() {
    let scene = clutter();
    let snapshot = &scene.snapshot();
    let pairs = all_pairs(snapshot);
    for margin in [0.0, 0.05] {
        let context = Context { margin, ..with(Wants::VERDICT) };
        let answer = ask(snapshot, Subject::All, context, false);
        let expected: Vec<_> = pairs.iter().filter(|(_, _, d)| *d <= margin).map(|(a, b, _)| (*a, *b)).collect();
        assert_eq!(ids(&answer), expected, "margin {margin}");
        assert!(expected.len() > 10 && expected.len() < pairs.len() / 2);
        assert_eq!(answer.verdict, Verdict::Collision);
    }
    let deepest = pairs.iter().map(|(_, _, d)| *d).fold(f64::INFINITY, f64::min);
    let nearest = ask(snapshot, Subject::All, with(Wants::ALL), true).nearest.unwrap();
    assert!((nearest.signed_distance - deepest).abs() < 1e-9, "{nearest:?}, {deepest}");
}

#[test]
fn each_body_has_the_nearest_that_brute_force_finds() {
    let scene = clutter();
    let snapshot = &scene.snapshot();
    let pairs = all_pairs(snapshot);
    let (mut apart, mut overlapping) = (0, 0);
    for body in snapshot.bodies() {
        let own = pairs.iter().filter(|(a, b, _)| *a == body.id || *b == body.id);
        let least = own.map(|(_, _, d)| *d).fold(f64::INFINITY, f64::min);
        let answer = ask(snapshot, Subject::Body(body.id), with(Wants::ALL), true);
        let found = answer.nearest.unwrap();
        assert!((found.signed_distance - least).abs() < 1e-9, "{}: {found:?}, {least}", body.name);
        assert!(found.bracket.lower <= least + 1e-9 && least - 1e-9 <= found.bracket.upper);
        if least > 0.0 {
            apart += 1
        } else {
            overlapping += 1
        }
        // Without depth an overlap is only proved.
        let loose = ask(snapshot, Subject::Body(body.id), with(Wants::VERDICT), true).nearest.unwrap();
        assert!(loose.bracket.lower <= least + 1e-9 && (least > 0.0 || loose.bracket.upper <= 0.0), "{loose:?}");
    }
    assert!(apart >= 5 && overlapping >= 5, "{apart} apart, {overlapping} overlapping");
}

#[test]
fn filters_margins_and_cut_offs_do_what_they_say() {
    let mut scene = clutter();
    let ball = || Subject::Shape { shape: Shape::sphere(0.1).unwrap(), pose: pose(0.4, 0.4, 8.0) };
    let nearest = |context: Context| ask(&clutter().snapshot(), ball(), context, true);
    let first = nearest(with(Wants::VERDICT)).nearest.unwrap();
    assert_eq!(first.a, Side::Query { subshape: 0 });
    let Side::Body { id, .. } = first.b else { panic!("a body is nearest") };

    let ignoring = Filter { ignore: vec![id], ..Filter::default() };
    let second = nearest(Context { filter: ignoring, ..with(Wants::VERDICT) }).nearest.unwrap();
    assert!(second.signed_distance > first.signed_distance);

    for (group, parity) in [("even", 1), ("odd", 0)] {
        let filter = Filter { groups: vec![group.to_owned()], ..Filter::default() };
        let found = nearest(Context { filter, ..with(Wants::VERDICT) }).nearest.unwrap();
        assert!(matches!(found.b, Side::Body { id, .. } if id.0 % 2 == parity), "ids begin with 1: {found:?}");
    }
    let nobody = Filter { layers: Some(0), ..Filter::default() };
    let alone = nearest(Context { filter: nobody, ..with(Wants::VERDICT) });
    assert_eq!((alone.verdict, alone.nearest), (Verdict::Free, None));

    let distance = first.signed_distance;
    let beyond = nearest(Context { cut_off: Some(distance * 0.9), ..with(Wants::VERDICT) });
    assert_eq!((beyond.verdict, beyond.nearest), (Verdict::Free, None));
    let within = nearest(Context { cut_off: Some(distance * 1.1), ..with(Wants::VERDICT) });
    assert_eq!(within.nearest.as_ref(), Some(&first));
    assert_eq!(nearest(Context { margin: distance * 1.1, ..with(Wants::VERDICT) }).verdict, Verdict::Margin);

    // The scene's margin for a pair takes the place of the question's.
    let top = snapshot_top(&scene);
    let lower = Party::Body("floor".into());
    let entry = |margin| Edit::SetPairMargin { a: Party::Body(top.into()), b: lower.clone(), margin };
    scene.apply(&[entry(Some(100.0))], None).unwrap();
    let context = with(Wants { pairs: true, ..Wants::VERDICT });
    let answer = ask(&scene.snapshot(), Subject::Body(top), context.clone(), false);
    let floor = scene.snapshot().body_named("floor").unwrap().id;
    assert!(ids(&answer).contains(&(top, floor)), "{answer:?}");
    scene.apply(&[entry(None)], None).unwrap();
    assert!(!ids(&ask(&scene.snapshot(), Subject::Body(top), context, false)).contains(&(top, floor)));
}

/// The highest body.
fn snapshot_top(scene: &Scene) -> BodyId {
    let snapshot = scene.snapshot();
    let bodies = snapshot.bodies().filter(|b| b.bounds.is_some());
    bodies.max_by(|a, b| a.pose.translation().z.total_cmp(&b.pose.translation().z)).unwrap().id
}

#[test]
fn allowed_collisions_are_not_looked_at_unless_asked() {
    let mut scene = clutter();
    let context = with(Wants::VERDICT);
    let before = ids(&ask(&scene.snapshot(), Subject::All, context.clone(), false));
    let (a, b) = before[0];
    let allow = Edit::SetAllowedCollision { a: Party::Body(a.into()), b: Party::Body(b.into()), allowed: Some(true) };
    scene.apply(&[allow], None).unwrap();
    assert_eq!(ids(&ask(&scene.snapshot(), Subject::All, context.clone(), false)), before[1..]);
    let filter = Filter { disregard_allowed_collisions: true, ..Filter::default() };
    let all = ask(&scene.snapshot(), Subject::All, Context { filter, ..context }, false);
    assert_eq!(ids(&all), before);
}

#[test]
fn a_list_that_is_too_long_is_cut_and_says_so() {
    let scene = clutter();
    let all = ids(&ask(&scene.snapshot(), Subject::All, with(Wants::VERDICT), false));
    let context = Context { max_pairs: 3, ..Context::default() };
    let cut = ask(&scene.snapshot(), Subject::All, context, false);
    assert!(cut.truncated);
    assert_eq!(ids(&cut), all[..3]);
}

#[test]
fn what_cannot_be_asked_is_invalid_by_name() {
    let scene = clutter();
    let unknown = ask(&scene.snapshot(), Subject::Body(BodyId(999)), Context::default(), true);
    assert_eq!(unknown.verdict, Verdict::InvalidInput);
    assert_eq!(unknown.problem.as_deref(), Some("items[0].body: no body 999 in the scene"));
    let wall = Subject::Shape { shape: Shape::plane(Vec3::x(), 0.0).unwrap(), pose: Pose::identity() };
    let unbounded = ask(&scene.snapshot(), wall, Context::default(), true);
    assert_eq!(unbounded.verdict, Verdict::InvalidInput);
    let problem = unbounded.problem.unwrap();
    assert!(problem.contains("unbounded, and so is body 61"), "{problem}");
}

#[test]
fn an_empty_scene_answers_free_without_a_distance() {
    let scene = Scene::new(Epoch(1));
    for subject in [Subject::All, Subject::Shape { shape: Shape::point(), pose: Pose::identity() }] {
        let answer = ask(&scene.snapshot(), subject, with(Wants::ALL), true);
        assert_eq!((answer.verdict, answer.nearest), (Verdict::Free, None));
    }
}

#[test]
fn points_of_an_overlap_come_with_its_depth_only() {
    let scene = clutter();
    let snapshot = &scene.snapshot();
    let witness = Wants { witness: true, ..Wants::VERDICT };
    let proved = ask(snapshot, Subject::All, with(witness), true).nearest.unwrap();
    assert!(proved.bracket.upper <= 0.0 && proved.witness.is_none());
    let measured = ask(snapshot, Subject::All, with(Wants { depth: true, ..witness }), true).nearest.unwrap();
    let points = measured.witness.unwrap();
    let gap = points.point_on_b - points.point_on_a - points.normal * measured.signed_distance;
    assert!(gap.norm() < 1e-9, "{measured:?}");
}

#[test]
fn a_loose_distance_keeps_the_verdict_and_its_bracket_holds_the_truth() {
    let scene = clutter();
    let snapshot = &scene.snapshot();
    let pairs = all_pairs(snapshot);
    for body in snapshot.bodies() {
        let own = pairs.iter().filter(|(a, b, _)| *a == body.id || *b == body.id);
        let least = own.map(|(_, _, d)| *d).fold(f64::INFINITY, f64::min);
        for cut_off in [None, Some(0.02)] {
            let accuracy = Accuracy { absolute: 1.0, relative: 0.0 };
            let context = Context { accuracy, cut_off, margin: 0.03, ..with(Wants { depth: true, ..Wants::VERDICT }) };
            let answer = ask(snapshot, Subject::Body(body.id), context, true);
            let expected = match least {
                d if d <= 0.0 => Verdict::Collision,
                d if d <= 0.03 => Verdict::Margin,
                _ => Verdict::Free,
            };
            assert_eq!(answer.verdict, expected, "{}: {answer:?}, {least}", body.name);
            match answer.nearest {
                Some(p) => {
                    assert!(p.bracket.lower <= least + 1e-12 && least - 1e-12 <= p.bracket.upper, "{p:?}, {least}")
                }
                None => assert!(least > 0.02, "{least}"),
            }
        }
    }
}

#[test]
fn of_equally_near_pairs_the_one_with_the_lesser_sides_is_told() {
    let here = |x: f64| Pose::new(Vec3::new(x, 0.0, 0.0), Quaternion::IDENTITY).unwrap();
    let ball = Shape::sphere(0.25).unwrap();
    let part = |x| Part { shape: ball.clone(), pose: here(x) };
    let dumbbell = Shape::compound(Arc::new(Compound::new(vec![part(-1.0), part(1.0)]).unwrap()));
    for places in [[3.0, -3.0], [-3.0, 3.0]] {
        let mut scene = Scene::new(Epoch(1));
        let body =
            |(i, x): (usize, &f64)| Edit::AddBody(NewBody::new(format!("body {i}"), Arc::new(ball.clone()), here(*x)));
        scene.apply(&places.iter().enumerate().map(body).collect::<Vec<_>>(), None).unwrap();
        let subject = Subject::Shape { shape: dumbbell.clone(), pose: here(0.0) };
        let found = ask(&scene.snapshot(), subject, with(Wants::VERDICT), true).nearest.unwrap();
        assert_eq!(found.signed_distance, 1.5);
        assert_eq!(found.a, Side::Query { subshape: 0 }, "part 0 comes before part 1, whichever body was met first");
    }
}

/// A cut-off of zero once said that a contact was known, so that no digit more was spent on a touch.
#[test]
fn boxes_that_touch_exactly_are_decided_whatever_is_wanted_and_whatever_was_found_before() {
    let cuboid = Arc::new(Shape::cuboid(Vec3::new(0.25, 0.25, 0.25)).unwrap());
    let turned = Quaternion { w: 1e-160, x: 0.0, y: 0.0, z: 1e-160 };
    let at = |x: f64| Pose::new(Vec3::new(x, 0.6, 0.5), turned).unwrap();
    let body = |(i, x): (usize, &f64)| Edit::AddBody(NewBody::new(format!("box {i}"), Arc::clone(&cuboid), at(*x)));
    // The first two overlap, the last two touch at a face.
    for places in [&[5.0, 5.25, 0.0, 0.5][..], &[0.0, 0.5]] {
        let mut scene = Scene::new(Epoch(1));
        scene.apply(&places.iter().enumerate().map(body).collect::<Vec<_>>(), None).unwrap();
        for wants in [Wants::VERDICT, Wants { distance: true, ..Wants::VERDICT }, Wants::ALL] {
            for cut_off in [None, Some(0.0)] {
                let context = Context { cut_off, ..with(wants) };
                let listed = ask(&scene.snapshot(), Subject::All, context.clone(), false);
                assert!(listed.pairs.iter().all(|pair| pair.verdict == Verdict::Collision), "{wants:?}: {listed:?}");
                assert_eq!(listed.pairs.len(), places.len() / 2);
                assert_eq!(ask(&scene.snapshot(), Subject::All, context, true).verdict, Verdict::Collision);
            }
        }
    }
}
