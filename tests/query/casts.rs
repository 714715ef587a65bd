//! Rays, moving shapes, regions and neighbours against whole scenes. Oracle: every body asked one by one through the narrow phase,
//! without a tree; and the same scene with another broad phase, whose answers have to be equal but for what they cost.
#![cfg(feature = "effect-motion")]

use std::sync::Arc;

use clearance::geometry::{Aabb, Compound, Part, Pose, Quaternion, Ray, RigidMotion, Shape, TriangleMesh, Vec3};
use clearance::limits::Limits;
use clearance::narrow_phase::{Cost, Goal, ImpactGoal, Outcome, RayGoal, cast_ray, impact, separation};
use clearance::query::{
    Answers, CastItem, CastMode, CastRays, CastShapes, CastVerdict, Casts, CheckMovingPairs, Context,
    DEFAULT_RESOLUTION, Filter, ItemBatch, Moved, Mover, MovingPairs, NearestBodies, Neighbours, Overlap, Overlaps,
    Rays, Refused, Region, Subject, Verdict, Way,
};
use clearance::scene::{BodyId, BroadPhaseKind, Edit, Epoch, NewBody, Party, Scene, SceneOptions};

/// A linear congruential generator (Knuth's MMIX constants), in -1..1.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self, size: f64) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next()) * size
    }

    fn pose(&mut self, size: f64) -> Pose {
        let q = Quaternion { w: self.next(), x: self.next(), y: self.next(), z: self.next() };
        Pose::new(self.vector(size), q).unwrap()
    }
}

fn tetrahedron(solid: bool) -> Shape {
    let v = Vec3::new;
    let corners = vec![v(0.0, 0.0, 0.0), v(0.6, 0.0, 0.0), v(0.0, 0.6, 0.0), v(0.0, 0.0, 0.6)];
    let faces = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
    let mesh = if solid { TriangleMesh::solid(corners, faces) } else { TriangleMesh::surface(corners, faces) };
    Shape::mesh(Arc::new(mesh.unwrap()))
}

/// Bodies of many kinds in a cube of 8 m, over a floor.
fn clutter(kind: BroadPhaseKind) -> Scene {
    let mut random = Random(3);
    let parts = vec![
        Part { shape: Shape::sphere(0.2).unwrap(), pose: random.pose(0.3) },
        Part { shape: Shape::cuboid(Vec3::new(0.3, 0.1, 0.1)).unwrap(), pose: random.pose(0.3) },
    ];
    let shapes = [
        Shape::cuboid(Vec3::new(0.2, 0.3, 0.1)).unwrap(),
        Shape::sphere(0.25).unwrap(),
        Shape::cylinder(0.15, 0.4).unwrap(),
        Shape::capsule(0.1, 0.3).unwrap(),
        Shape::ellipsoid(Vec3::new(0.1, 0.3, 0.2)).unwrap(),
        tetrahedron(true),
        tetrahedron(false),
        Shape::compound(Arc::new(Compound::new(parts).unwrap())),
    ]
    .map(Arc::new);
    let mut edits: Vec<Edit> = (0..200)
        .map(|i| {
            let mut body = NewBody::new(format!("body {i}"), Arc::clone(&shapes[i % shapes.len()]), random.pose(4.0));
            body.groups = vec![if i % 2 == 0 { "even" } else { "odd" }.to_owned()];
            Edit::AddBody(body)
        })
        .collect();
    let floor = Shape::half_space(Vec3::z(), -5.0).unwrap();
    edits.push(Edit::AddBody(NewBody::new("floor", Arc::new(floor), Pose::identity())));
    let mut scene = Scene::with_options(Epoch(7), Limits::default(), &SceneOptions { broad_phase: kind });
    scene.apply(&edits, None).unwrap();
    scene
}

fn scenes() -> Vec<Scene> {
    [BroadPhaseKind::Tree, BroadPhaseKind::Exhaustive, BroadPhaseKind::SweepAndPrune].map(clutter).into()
}

fn answer<B: ItemBatch>(batch: &B) -> Answers<B::Item> {
    let whole = batch.answer_all(&|| false);
    // In parts, as threads would.
    let middle = batch.len() / 3;
    let parts = batch.join([batch.run(0..middle, &|| false), batch.run(middle..batch.len(), &|| false)]);
    assert_eq!(parts.items.len(), whole.items.len());
    assert!(!whole.out_of_time && whole.answered == batch.len());
    whole
}

/// Without what it cost: a tree looks at fewer boxes.
fn free_of_cost(items: &[CastItem]) -> Vec<CastItem> {
    items.iter().map(|item| CastItem { cost: Cost::default(), ..item.clone() }).collect()
}

fn rays(count: usize, mode: CastMode, context: Context) -> CastRays {
    let mut random = Random(11);
    let (mut origins, mut directions) = (Vec::new(), Vec::new());
    for _ in 0..count {
        origins.extend(<[f64; 3]>::from(random.vector(5.0)));
        directions.extend(<[f64; 3]>::from(random.vector(2.0)));
    }
    CastRays { origins, directions, lengths: vec![20.0], mode, context }
}

fn everything() -> Context {
    Context { max_pairs: 1000, ..Context::default() }
}

#[test]
fn rays_meet_what_every_body_alone_is_met_at_whatever_the_broad_phase() {
    let scenes = scenes();
    for margin in [0.0, 0.1] {
        let (first, all, any) = (
            rays(300, CastMode::First, Context { margin, ..everything() }),
            rays(300, CastMode::All, Context { margin, ..everything() }),
            rays(300, CastMode::Any, Context { margin, ..everything() }),
        );
        let mut told: Option<[Vec<CastItem>; 3]> = None;
        for scene in &scenes {
            let snapshot = &scene.snapshot();
            let of = |request: &CastRays| free_of_cost(&answer(&Rays::new(snapshot, request).unwrap()).items);
            let answers = [of(&first), of(&all), of(&any)];
            let expected = told.get_or_insert_with(|| answers.clone());
            assert_eq!(*expected, answers, "another broad phase");
        }
        let [of_first, of_all, of_any] = told.unwrap();
        let snapshot = scenes[0].snapshot();
        let (mut hits, mut misses, mut many) = (0, 0, 0);
        for i in 0..300 {
            let vector = |numbers: &[f64]| Vec3::new(numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]);
            let ray = Ray::new(vector(&first.origins), vector(&first.directions), 20.0).unwrap();
            let goal = RayGoal { margin, ..RayGoal::whole() };
            let alone = |id: &BodyId| {
                let body = snapshot.body(*id).unwrap();
                cast_ray(&ray, &body.shape, &body.placement, &goal).unwrap()
            };
            let ids: Vec<BodyId> = snapshot.bodies().map(|body| body.id).collect();
            let met: Vec<(BodyId, _)> =
                ids.iter().map(|id| (*id, alone(id))).filter(|(_, found)| found.outcome == Outcome::Hit).collect();
            let mut expected: Vec<BodyId> = of_all[i].hits.iter().map(|hit| hit.body).collect();
            expected.sort_unstable();
            assert_eq!(expected, met.iter().map(|(id, _)| *id).collect::<Vec<_>>(), "ray {i}");
            assert!(of_all[i].hits.windows(2).all(|two| two[0].upper <= two[1].upper));
            let soonest = met.iter().min_by(|a, b| a.1.bracket.upper.total_cmp(&b.1.bracket.upper));
            match (soonest, of_first[i].hits.first()) {
                (Some((id, found)), Some(hit)) => {
                    assert_eq!((hit.body, hit.upper, hit.lower), (*id, found.bracket.upper, found.bracket.lower));
                    assert!(of_first[i].free_until <= hit.lower);
                    assert_eq!(of_any[i].verdict, CastVerdict::Hit);
                    hits += 1;
                    many += usize::from(met.len() > 1);
                }
                (None, None) => {
                    assert_eq!(of_first[i].verdict, of_any[i].verdict);
                    if of_first[i].verdict == CastVerdict::Clear {
                        assert_eq!(of_first[i].free_until, 20.0);
                        misses += 1;
                    }
                }
                other => panic!("ray {i}: {other:?}"),
            }
        }
        assert!(hits > 50 && misses > 20 && many > 20, "{hits} hits, {misses} misses, {many} with more than one");
    }
}

fn movers(count: usize) -> Vec<Mover> {
    let mut random = Random(5);
    let shapes = [
        Shape::sphere(0.1).unwrap(),
        Shape::cuboid(Vec3::new(0.3, 0.1, 0.05)).unwrap(),
        Shape::capsule(0.05, 0.4).unwrap(),
        tetrahedron(false),
    ];
    let mover = |i: usize| {
        let start = random.pose(4.0);
        let way = match i % 4 {
            0 => Way::By { displacement: random.vector(3.0), turn: Vec3::zeros() },
            1 => Way::By { displacement: random.vector(2.0), turn: random.vector(4.0) },
            2 => Way::To(random.pose(4.0)),
            _ => Way::By { displacement: random.vector(1.0), turn: random.vector(0.3) },
        };
        Mover { moved: Moved::Shape(shapes[i % shapes.len()].clone()), start: Some(start), way }
    };
    (0..count).map(mover).collect()
}

fn motion(mover: &Mover) -> RigidMotion {
    let start = mover.start.unwrap();
    match mover.way {
        Way::Still => RigidMotion::still(start),
        Way::To(end) => RigidMotion::between(start, end),
        Way::By { displacement, turn } => RigidMotion::by(start, displacement, turn).unwrap(),
    }
}

#[test]
fn moving_shapes_meet_what_every_body_alone_is_met_by_whatever_the_broad_phase() {
    let scenes = scenes();
    let items = movers(60);
    let question =
        |mode| CastShapes { items: items.clone(), mode, resolution: DEFAULT_RESOLUTION, context: everything() };
    let (first, all) = (question(CastMode::First), question(CastMode::All));
    let mut told: Option<[Vec<CastItem>; 2]> = None;
    for scene in &scenes {
        let snapshot = &scene.snapshot();
        let of = |request: &CastShapes| free_of_cost(&answer(&Casts::new(snapshot, request).unwrap()).items);
        let answers = [of(&first), of(&all)];
        let expected = told.get_or_insert_with(|| answers.clone());
        assert_eq!(*expected, answers, "another broad phase");
    }
    let [of_first, of_all] = told.unwrap();
    let snapshot = scenes[0].snapshot();
    let (mut hits, mut clear, mut at_start) = (0, 0, 0);
    for (i, mover) in items.iter().enumerate() {
        let Moved::Shape(shape) = &mover.moved else { unreachable!("all are shapes") };
        let alone = |body: &clearance::scene::Body| {
            impact(shape, &body.shape, &motion(mover), &RigidMotion::still(body.pose), &ImpactGoal::touch()).unwrap()
        };
        let mut met = Vec::new();
        for body in snapshot.bodies() {
            let found = alone(body);
            if found.outcome == Outcome::Hit {
                met.push((found.touching_at.unwrap(), body.id, found));
            }
        }
        let mut listed: Vec<BodyId> = of_all[i].hits.iter().map(|hit| hit.body).collect();
        listed.sort_unstable();
        assert_eq!(listed, met.iter().map(|(_, id, _)| *id).collect::<Vec<_>>(), "item {i}");
        met.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        match met.first() {
            Some((upper, id, found)) => {
                let hit = &of_first[i].hits[0];
                assert_eq!((hit.body, hit.upper, hit.lower), (*id, *upper, found.free_until), "item {i}");
                hits += 1;
                at_start += usize::from(hit.at_start);
            }
            None => {
                assert!(of_first[i].hits.is_empty());
                clear += usize::from(of_first[i].verdict == CastVerdict::Clear);
            }
        }
    }
    assert!(hits > 20 && clear > 3 && at_start > 1, "{hits} hits, {clear} clear, {at_start} at the start");
}

#[test]
fn filters_margins_and_allowed_collisions_count_for_moving_bodies() {
    let ball = |name: &str, x: f64| {
        let at = Pose::new(Vec3::x() * x, Quaternion::IDENTITY).unwrap();
        Edit::AddBody(NewBody::new(name, Arc::new(Shape::sphere(0.5).unwrap()), at))
    };
    let mut scene = Scene::new(Epoch(1));
    scene.apply(&[ball("mover", 0.0), ball("near", 4.0), ball("far", 8.0)], None).unwrap();
    let id = |scene: &Scene, name: &str| scene.snapshot().body_named(name).unwrap().id;
    let (mover, near, far) = (id(&scene, "mover"), id(&scene, "near"), id(&scene, "far"));
    let way = Way::By { displacement: Vec3::x() * 10.0, turn: Vec3::zeros() };
    let ask = |scene: &Scene, context: Context| {
        let items = vec![Mover { moved: Moved::Body(mover), start: None, way }];
        let question = CastShapes { items, mode: CastMode::First, resolution: DEFAULT_RESOLUTION, context };
        answer(&Casts::new(&scene.snapshot(), &question).unwrap()).items.remove(0)
    };
    let first = |item: &CastItem| (item.hits[0].body, (item.hits[0].lower * 1e6).round() / 1e6);
    assert_eq!(first(&ask(&scene, Context::default())), (near, 0.3));
    assert_eq!(first(&ask(&scene, Context { margin: 0.5, ..Context::default() })), (near, 0.25));
    let ignoring = Filter { ignore: vec![near], ..Filter::default() };
    assert_eq!(first(&ask(&scene, Context { filter: ignoring, ..Context::default() })), (far, 0.7));
    let entry = Edit::SetPairMargin { a: Party::Body(mover.into()), b: Party::Body(near.into()), margin: Some(1.0) };
    scene.apply(&[entry], None).unwrap();
    assert_eq!(first(&ask(&scene, Context::default())), (near, 0.2), "the pair's own margin");
    let entry = Edit::SetPairMargin { a: Party::Body(mover.into()), b: Party::Body(far.into()), margin: Some(6.0) };
    scene.apply(&[entry], None).unwrap();
    assert_eq!(first(&ask(&scene, Context::default())), (far, 0.1), "boxes are grown by the largest margin");
    let allow = |b: BodyId| Edit::SetAllowedCollision {
        a: Party::Body(mover.into()),
        b: Party::Body(b.into()),
        allowed: Some(true),
    };
    scene.apply(&[allow(far)], None).unwrap();
    assert_eq!(first(&ask(&scene, Context::default())), (near, 0.2));
    let filter = Filter { disregard_allowed_collisions: true, ..Filter::default() };
    assert_eq!(first(&ask(&scene, Context { filter, ..Context::default() })), (far, 0.1));
    // A moving pair, and one that is allowed.
    let pair = |a: BodyId, b: BodyId| {
        let items = vec![[
            Mover { moved: Moved::Body(a), start: None, way },
            Mover { moved: Moved::Body(b), start: None, way: Way::Still },
        ]];
        let question = CheckMovingPairs { items, resolution: DEFAULT_RESOLUTION, context: Context::default() };
        answer(&MovingPairs::new(&scene.snapshot(), &question).unwrap()).items.remove(0)
    };
    assert_eq!(first(&pair(mover, near)), (near, 0.2));
    assert_eq!(pair(mover, far).verdict, CastVerdict::Clear);
    // A ray and a bare shape have layers and masks of their own.
    let nobody = Context { filter: Filter { layers: Some(0), ..Filter::default() }, ..Context::default() };
    let question = CastRays {
        origins: vec![-5.0, 0.0, 0.0],
        directions: vec![1.0, 0.0, 0.0],
        lengths: vec![100.0],
        mode: CastMode::First,
        context: nobody,
    };
    let snapshot = scene.snapshot();
    assert_eq!(answer(&Rays::new(&snapshot, &question).unwrap()).items[0].verdict, CastVerdict::Clear);
    let seen = CastRays { context: Context::default(), ..question };
    assert_eq!(answer(&Rays::new(&snapshot, &seen).unwrap()).items[0].hits[0].body, mover);
}

#[test]
fn overlaps_are_those_of_every_body_alone_and_bounds_tell_a_superset() {
    let scenes = scenes();
    let mut random = Random(17);
    let items: Vec<Region> = (0..40)
        .map(|i| match i % 3 {
            0 => {
                let (low, size) = (random.vector(4.0), random.vector(1.0).abs());
                Region::Box(Aabb { min: low, max: low + size })
            }
            1 => Region::Ball { center: random.vector(4.0), radius: 0.7 + 0.5 * random.next() },
            _ => Region::Shape { shape: Shape::cylinder(0.5, 0.5).unwrap(), pose: random.pose(4.0) },
        })
        .collect();
    let ask = |scene: &Scene, bounds_only, margin| {
        let context = Context { margin, ..everything() };
        let question = Overlap { items: items.clone(), bounds_only, context };
        answer(&Overlaps::new(&scene.snapshot(), &question).unwrap()).items
    };
    let mut found = 0;
    for margin in [0.0, 0.2] {
        let exact: Vec<Vec<_>> =
            scenes.iter().map(|s| ask(s, false, margin).into_iter().map(|i| i.bodies).collect()).collect();
        assert!(exact.iter().all(|other| *other == exact[0]));
        let loose = ask(&scenes[0], true, margin);
        let snapshot = scenes[0].snapshot();
        for (i, region) in items.iter().enumerate() {
            let (shape, pose) = match region {
                Region::Box(Aabb { min, max }) => {
                    let half = (max - min) * 0.5;
                    let at = Pose::new(min + half, Quaternion::IDENTITY).unwrap();
                    (Shape::cuboid(half).unwrap(), at)
                }
                Region::Ball { center, radius } => {
                    (Shape::sphere(*radius).unwrap(), Pose::new(*center, Quaternion::IDENTITY).unwrap())
                }
                Region::Shape { shape, pose } => (shape.clone(), *pose),
            };
            let alone = |body: &clearance::scene::Body| {
                separation(&shape, &body.shape, &pose.placement(), &body.placement, &Goal::penetration()).unwrap()
            };
            let expected: Vec<BodyId> =
                snapshot.bodies().filter(|body| alone(body).signed_distance <= margin).map(|body| body.id).collect();
            let told: Vec<BodyId> = exact[0][i].iter().map(|one| one.body).collect();
            assert_eq!(told, expected, "region {i}, margin {margin}");
            found += told.len();
            let superset: Vec<BodyId> = loose[i].bodies.iter().map(|one| one.body).collect();
            assert!(expected.iter().all(|id| superset.contains(id)));
            assert!(loose[i].bodies.iter().all(|one| one.verdict == Verdict::NotRun));
        }
    }
    assert!(found > 60, "{found}");
    let question =
        Overlap { items, bounds_only: false, context: Context { max_pairs: 1, margin: 1.0, ..Context::default() } };
    let cut = answer(&Overlaps::new(&scenes[0].snapshot(), &question).unwrap()).items;
    assert!(cut.iter().any(|item| item.truncated && item.bodies.len() == 1));
}

#[test]
fn the_nearest_are_those_that_measuring_every_body_finds() {
    let scenes = scenes();
    let mut random = Random(23);
    let mut items: Vec<Subject> =
        (0..20).map(|_| Subject::Shape { shape: Shape::sphere(0.1).unwrap(), pose: random.pose(5.0) }).collect();
    items.extend((1..20).map(|id| Subject::Body(BodyId(id))));
    for count in [1, 3, 10, 500] {
        let question = NearestBodies { items: items.clone(), count, context: everything() };
        let of = |scene: &Scene| answer(&Neighbours::new(&scene.snapshot(), &question).unwrap()).items;
        let told = of(&scenes[0]);
        for scene in &scenes[1..] {
            let other = of(scene);
            assert!(told.iter().zip(&other).all(|(a, b)| a.nearest == b.nearest && a.set_is_proved == b.set_is_proved));
        }
        let snapshot = scenes[0].snapshot();
        let (mut sets, mut orders) = (0, 0);
        for (item, subject) in told.iter().zip(&items) {
            let (shape, at, own) = match subject {
                Subject::Shape { shape, pose } => (shape.clone(), pose.placement(), None),
                Subject::Body(id) => {
                    let body = snapshot.body(*id).unwrap();
                    ((*body.shape).clone(), body.placement, Some(*id))
                }
                Subject::All | Subject::ChangedSince(_) => unreachable!("none was asked"),
            };
            let mut all: Vec<f64> = snapshot
                .bodies()
                .filter(|body| Some(body.id) != own)
                .map(|body| separation(&shape, &body.shape, &at, &body.placement, &Goal::penetration()).unwrap())
                .map(|found| found.signed_distance)
                .collect();
            all.sort_by(f64::total_cmp);
            assert_eq!(item.nearest.len(), count.min(all.len()));
            for (pair, expected) in item.nearest.iter().zip(&all) {
                assert!((pair.signed_distance - expected).abs() < 1e-7, "{pair:?}, {expected}");
            }
            assert!(item.nearest.windows(2).all(|two| two[0].signed_distance <= two[1].signed_distance));
            sets += usize::from(item.set_is_proved);
            orders += usize::from(item.order_is_proved);
        }
        assert!(sets > items.len() / 2 && (count > 10 || orders > 5), "{count}: {sets} sets, {orders} orders");
    }
}

#[test]
fn equals_are_told_by_their_ids_and_the_order_is_called_open() {
    let ball = |i: u32| {
        let x = if i.is_multiple_of(2) { 2.0 } else { -2.0 };
        let at = Pose::new(Vec3::new(x, 0.0, 0.0), Quaternion::IDENTITY).unwrap();
        Edit::AddBody(NewBody::new(format!("ball {i}"), Arc::new(Shape::sphere(0.5).unwrap()), at))
    };
    let mut scene = Scene::new(Epoch(1));
    scene.apply(&(0..4).map(ball).collect::<Vec<_>>(), None).unwrap();
    let items = vec![Subject::Shape { shape: Shape::point(), pose: Pose::identity() }];
    let question = NearestBodies { items, count: 2, context: Context::default() };
    let snapshot = scene.snapshot();
    let item = answer(&Neighbours::new(&snapshot, &question).unwrap()).items.remove(0);
    let ids: Vec<String> = item.nearest.iter().map(|pair| format!("{:?}", pair.b)).collect();
    assert_eq!(ids, ["Body { id: BodyId(1), subshape: 0 }", "Body { id: BodyId(2), subshape: 0 }"]);
    assert!(!item.set_is_proved || !item.order_is_proved, "{item:?}");
}

#[test]
fn what_cannot_be_asked_is_named() {
    let scene = clutter(BroadPhaseKind::Tree);
    let snapshot = &scene.snapshot();
    let refused = |error: Refused| error.to_string();
    let good = rays(2, CastMode::First, Context::default());
    let bad = |change: &dyn Fn(&mut CastRays)| {
        let mut question = good.clone();
        change(&mut question);
        Rays::new(snapshot, &question).err().map(refused).unwrap_or_default()
    };
    assert_eq!(bad(&|q| q.origins.truncate(5)), "origins: 5 numbers are no whole number of points of 3 each");
    assert_eq!(bad(&|q| q.directions.push(0.0)), "directions: has 7 numbers, for the 2 rays of origins");
    assert_eq!(bad(&|q| q.lengths.clear()), "lengths: has 0 numbers; one for all, or one for each of the 2 rays");
    assert_eq!(
        bad(&|q| q.context.solver = clearance::narrow_phase::Solver::Gjk),
        "context.solver: has to be the default one: rays and motions are not measured by one solver"
    );
    let mut question = good.clone();
    question.directions[..3].fill(0.0);
    question.lengths = vec![1.0, f64::NAN];
    let answers = answer(&Rays::new(snapshot, &question).unwrap());
    let problems: Vec<&str> = answers.items.iter().map(|item| item.problem.as_deref().unwrap()).collect();
    assert!(problems[0].starts_with("rays[0]: direction is zero"), "{problems:?}");
    assert!(problems[1].starts_with("rays[1]: length is NaN"), "{problems:?}");
    let cast = |mover: Mover, resolution| {
        let question =
            CastShapes { items: vec![mover], mode: CastMode::First, resolution, context: Context::default() };
        match Casts::new(snapshot, &question) {
            Ok(batch) => answer(&batch).items[0].problem.clone().unwrap(),
            Err(error) => error.to_string(),
        }
    };
    let unknown = Mover { moved: Moved::Body(BodyId(999)), start: None, way: Way::Still };
    assert_eq!(cast(unknown.clone(), 1e-9), "items[0].body: no body 999 in the scene");
    assert_eq!(cast(unknown, f64::NAN), "resolution: is NaN, not a part of the motion between 0 and 1");
    let way = Way::By { displacement: Vec3::zeros(), turn: Vec3::x() * 1e9 };
    let spinning = Mover { moved: Moved::Shape(Shape::point()), start: None, way };
    assert_eq!(cast(spinning, 0.0), "items[0].way: turn is more than 10000 radians");
    let wall = Mover { moved: Moved::Shape(Shape::plane(Vec3::x(), 0.0).unwrap()), start: None, way: Way::Still };
    assert!(cast(wall, 0.0).contains("a plane is unbounded, and so is body 201"));
    let none = NearestBodies { items: vec![Subject::All], count: 0, context: Context::default() };
    assert_eq!(
        Neighbours::new(snapshot, &none).err().map(refused).unwrap(),
        "count: is 0: there has to be at least one"
    );
    let all = NearestBodies { count: 1, ..none };
    assert!(answer(&Neighbours::new(snapshot, &all).unwrap()).items[0].problem.is_some());
    let inverted = Region::Box(Aabb { min: Vec3::x(), max: Vec3::zeros() });
    let negative = Region::Ball { center: Vec3::zeros(), radius: -1.0 };
    let question = Overlap { items: vec![inverted, negative], bounds_only: false, context: Context::default() };
    let items = answer(&Overlaps::new(snapshot, &question).unwrap()).items;
    assert_eq!(items[0].problem.as_deref(), Some("items[0].box.x: min 1 is not below max 0"));
    assert!(items[1].problem.as_ref().unwrap().starts_with("items[1].ball.radius"), "{items:?}");
    assert!(items.iter().all(|item| item.verdict == Verdict::InvalidInput));
}

#[test]
fn time_that_is_over_leaves_items_not_run() {
    let scene = clutter(BroadPhaseKind::Tree);
    let snapshot = &scene.snapshot();
    let question = rays(10, CastMode::First, Context::default());
    let batch = Rays::new(snapshot, &question).unwrap();
    let answers = batch.answer_all(&|| true);
    assert!(answers.out_of_time && answers.answered == 0);
    assert!(answers.items.iter().all(|item| item.verdict == CastVerdict::NotRun));
}
