//! Scenes that are watched. Oracle: a copy of the scene that is led by the messages alone is at every step what `GetScene`
//! lists at its revision, and has the entries for pairs that a watch from nothing tells.

use std::collections::BTreeMap;
use std::time::Duration;

use clearance::limits::Limits;
use clearance::transports::wire::v1;
use tonic::Code;

use super::through_doors_with_watches;
use crate::support::door::{Messages, Watches};
use crate::support::messages::*;

through_doors_with_watches!(
    a_copy_that_is_led_by_messages_is_the_scene,
    a_watch_begins_where_its_reader_is,
    a_reader_that_is_too_far_behind_is_given_the_whole_content,
    a_reader_that_is_ahead_waits,
    long_contents_come_in_several_messages,
    shapes_are_told_where_asked,
    a_deleted_scene_ends_a_watch,
    what_cannot_be_watched_is_refused,
    watches_of_scenes_and_contacts_are_counted_together,
);

fn limits() -> Limits {
    Limits { snapshots_kept: 4, max_watchers: 2, ..Limits::default() }
}

fn watch_scene() -> v1::WatchRequest {
    v1::WatchRequest { scene: SCENE.to_owned(), ..v1::WatchRequest::default() }
}

fn from(revision: u64) -> v1::WatchRequest {
    v1::WatchRequest { from_revision: Some(revision), ..watch_scene() }
}

async fn contents(door: &impl Watches, revision: u64) -> v1::SceneContents {
    let rule = v1::revision_rule::Rule::Exactly(revision);
    let revision = Some(v1::RevisionRule { epoch: None, rule: Some(rule) });
    door.get_scene(v1::GetSceneRequest { scene: SCENE.to_owned(), revision, ..Default::default() }).await.unwrap()
}

/// A copy of a scene. Entries by what they are about, in one order.
#[derive(Clone, Debug, Default, PartialEq)]
struct Copy {
    revision: u64,
    bodies: BTreeMap<u64, v1::Body>,
    shapes: BTreeMap<u64, v1::Shape>,
    robots: BTreeMap<String, v1::RobotInScene>,
    entries: BTreeMap<String, v1::PairEntry>,
}

fn names_robot(party: &Option<v1::Party>, robot: &str) -> bool {
    match party.as_ref().and_then(|party| party.kind.as_ref()) {
        Some(v1::party::Kind::Robot(name)) => name == robot,
        Some(v1::party::Kind::Link(link)) => link.robot == robot,
        _ => false,
    }
}

fn names_body(party: &Option<v1::Party>, id: u64) -> bool {
    matches!(party.as_ref().and_then(|p| p.kind.as_ref()), Some(v1::party::Kind::Body(body)) if *body == numbered(id))
}

/// How often each regime was met.
#[derive(Debug, Default)]
struct Reached {
    messages: usize,
    merged: usize,
    compacted: usize,
    moved: usize,
    removed: usize,
    removed_robots: usize,
    entries: usize,
    taken_back: usize,
}

impl Copy {
    /// Makes a message; whether the step is complete.
    fn follow(&mut self, message: v1::WatchResponse, inside: &mut bool, reached: &mut Reached) -> bool {
        if !*inside && message.from_revision.is_none() {
            *self = Self::default();
        }
        if !*inside && message.from_revision.is_some() {
            assert_eq!(message.from_revision, Some(self.revision), "a gap");
        }
        *inside = message.more;
        reached.messages += 1;
        reached.compacted += usize::from(message.compacted);
        reached.merged += usize::from(message.from_revision.is_some_and(|from| message.revision > from + 1));
        reached.moved += message.moved.len();
        reached.removed += message.removed_bodies.len();
        reached.removed_robots += message.removed_robots.len();
        for name in message.removed_robots {
            self.robots.remove(&name);
            self.entries.retain(|_, e| !names_robot(&e.a, &name) && !names_robot(&e.b, &name));
        }
        for id in message.removed_bodies {
            assert!(self.bodies.remove(&id).is_some(), "body {id} was never told of");
            self.shapes.remove(&id);
            self.entries.retain(|_, e| !names_body(&e.a, id) && !names_body(&e.b, id));
        }
        for watched in message.bodies {
            let body = watched.body.unwrap();
            if let Some(shape) = watched.shape {
                self.shapes.insert(body.id, shape);
            }
            self.bodies.insert(body.id, body);
        }
        for v1::MovedBody { id, pose, bounds } in message.moved {
            let body = self.bodies.get_mut(&id).expect("a body that moves was told of");
            (body.pose, body.bounds) = (pose, bounds);
        }
        for robot in message.robots {
            self.robots.insert(robot.name.clone(), robot);
        }
        for entry in message.entries {
            let mut sides = [format!("{:?}", entry.a), format!("{:?}", entry.b)];
            sides.sort();
            reached.entries += 1;
            if entry.allowed.is_none() && entry.margin.is_none() {
                reached.taken_back += 1;
                self.entries.remove(&sides.concat());
            } else {
                let (a, b) = if sides[0] <= format!("{:?}", entry.a) { (entry.a, entry.b) } else { (entry.b, entry.a) };
                self.entries.insert(sides.concat(), v1::PairEntry { a, b, ..entry });
            }
        }
        self.revision = message.revision;
        !message.more
    }
}

/// A watch, as soon as a connection has told that another is not read any more.
async fn open<D: Watches>(door: &D, request: v1::WatchRequest) -> impl Messages<v1::WatchResponse> + use<'_, D> {
    let mut tries = 0;
    loop {
        match door.watch_scene(request.clone()).await {
            Ok(watch) => return watch,
            Err(refusal) => assert!(refusal.code == Code::ResourceExhausted && tries < 500, "{refusal:?}"),
        }
        tries += 1;
        tokio::time::sleep(Duration::from_millis(2)).await;
    }
}

async fn whole(door: &impl Watches, request: v1::WatchRequest) -> Copy {
    let mut watch = open(door, request).await;
    let (mut copy, mut inside, mut reached) = (Copy::default(), false, Reached::default());
    while !copy.follow(watch.message().await.unwrap().unwrap(), &mut inside, &mut reached) {}
    copy
}

struct Random(u64);

impl Random {
    fn below(&mut self, count: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % count
    }

    fn pose(&mut self) -> v1::Pose {
        at(self.below(9) as f64, self.below(9) as f64, 0.5)
    }

    fn name(&mut self) -> String {
        format!("{}", self.below(8))
    }

    fn party(&mut self) -> Option<v1::Party> {
        use v1::party::Kind;
        let kind = match self.below(7) {
            0 => Kind::Everything(v1::Everything {}),
            1 | 2 => Kind::Group(["g", "h"][self.below(2)].to_owned()),
            3 => Kind::Robot("arm".to_owned()),
            4 => Kind::Link(v1::LinkRef { robot: "arm".to_owned(), link: "boom".to_owned() }),
            _ => Kind::Body(named(&self.name())),
        };
        Some(v1::Party { kind: Some(kind) })
    }

    /// Some of them cannot be made; then none of their list is.
    fn edit(&mut self, model: &str) -> v1::Edit {
        use v1::edit::Kind;
        let body = Some(named(&self.name()));
        edit(match self.below(20) {
            0..=2 => {
                let (name, pose) = (self.name(), Some(self.pose()));
                let groups = if self.below(2) == 0 { vec!["g".to_owned()] } else { Vec::new() };
                let shape = if self.below(4) == 0 { voxels() } else { sphere(0.5) };
                Kind::AddBody(v1::AddBody { name, shape: Some(shape), pose, groups, ..v1::AddBody::default() })
            }
            3..=7 => Kind::MoveBody(v1::MoveBody { body, pose: Some(self.pose()) }),
            8 => Kind::RemoveBody(v1::RemoveBody { body }),
            9 => Kind::ReplaceShape(v1::ReplaceShape {
                body,
                shape: Some(cuboid(0.5, 0.5, 0.1 + 0.1 * self.below(3) as f64)),
                scale: Some(2.0),
                padding: 0.1,
            }),
            10 => Kind::SetEnabled(v1::SetEnabled { body, enabled: self.below(2) == 0 }),
            11 => Kind::SetGroups(v1::SetGroups { body, groups: vec!["h".to_owned()] }),
            12 => Kind::SetLayers(v1::SetLayers { body, layers: Some(3), mask: None }),
            13 => {
                let points = v1::numbers::Form::Packed(v1::PackedDoubles { values: vec![self.below(50) as f64; 3] });
                Kind::InsertPoints(v1::InsertPoints { body, points: Some(v1::Numbers { form: Some(points) }) })
            }
            14 => Kind::AddRobot(v1::AddRobot { name: "arm".to_owned(), model: model.to_owned(), base: None }),
            15 => Kind::MoveRobot(v1::MoveRobot { robot: "arm".to_owned(), base: Some(self.pose()) }),
            16 if self.below(2) == 0 => Kind::RemoveRobot(v1::RemoveRobot { robot: "arm".to_owned() }),
            16 | 17 => {
                let margin = (self.below(3) > 0).then_some(0.1);
                Kind::SetPairMargin(v1::SetPairMargin { a: self.party(), b: self.party(), margin })
            }
            _ => {
                let allowed = [Some(true), Some(false), None][self.below(3)];
                Kind::SetAllowedCollision(v1::SetAllowedCollision { a: self.party(), b: self.party(), allowed })
            }
        })
    }
}

fn voxels() -> v1::Shape {
    shape(v1::shape::Core::Voxels(v1::Voxels { resolution: 0.5, points: None, cells: vec![0, 0, 0] }))
}

async fn a_copy_that_is_led_by_messages_is_the_scene(door: &impl Watches) {
    door.create_scene(SCENE).await.unwrap();
    let model = door.load_robot(load(ROBOT)).await.unwrap().id;
    let random = &mut Random(7);
    let mut reached = Reached::default();
    let (mut copy, mut inside) = (Copy::default(), false);
    let mut watch = Some(open(door, v1::WatchRequest { shapes: true, ..watch_scene() }).await);
    let message = watch.as_mut().unwrap().message().await.unwrap().unwrap();
    assert!(copy.follow(message, &mut inside, &mut reached));
    let mut revision = 0;
    for round in 0..300 {
        // A reader that comes back finds several revisions at once, whatever the connection has sent ahead.
        let away = round % 3 == 0;
        if away {
            watch = None;
        }
        // Mostly one list of edits, sometimes more than are kept.
        for _ in 0..[1, 1, 1, 2, 3, 7][random.below(6)] {
            let edits = (0..1 + random.below(3)).map(|_| random.edit(&model)).collect();
            if let Ok(told) = door.apply(apply(edits)).await {
                revision = told.revision;
            }
        }
        if watch.is_none() {
            watch = Some(open(door, v1::WatchRequest { shapes: true, ..from(copy.revision) }).await);
        }
        let watch = watch.as_mut().unwrap();
        while copy.revision < revision {
            if copy.follow(watch.message().await.unwrap().unwrap(), &mut inside, &mut reached) {
                // A step may lead only part of the way; what is not kept any more cannot be compared.
                if copy.revision + 3 < revision {
                    continue;
                }
                let scene = contents(door, copy.revision).await;
                assert_eq!(copy.bodies.values().cloned().collect::<Vec<_>>(), scene.bodies);
                assert_eq!(copy.robots.values().cloned().collect::<Vec<_>>(), scene.robots);
            }
        }
        let fresh = whole(door, v1::WatchRequest { shapes: true, ..watch_scene() }).await;
        assert_eq!(copy, fresh);
    }
    let Reached { messages, merged, compacted, moved, removed, removed_robots, entries, taken_back } = reached;
    let regimes = [messages, merged, compacted, moved, removed, removed_robots, entries, taken_back];
    assert!(regimes.iter().all(|count| *count >= 3), "{reached:?}");
}

async fn balls(door: &impl Watches, count: usize) {
    door.create_scene(SCENE).await.unwrap();
    let ball = |i: usize| add(&format!("{i}"), sphere(0.1), at(i as f64, 0.0, 0.0));
    door.apply(apply((0..count).map(ball).collect())).await.unwrap();
}

async fn a_watch_begins_where_its_reader_is(door: &impl Watches) {
    balls(door, 3).await;
    door.apply(apply(vec![move_to(named("1"), at(1.0, 5.0, 0.0)), remove(named("2"))])).await.unwrap();
    let mut watch = door.watch_scene(from(1)).await.unwrap();
    let message = watch.message().await.unwrap().unwrap();
    assert_eq!((message.from_revision, message.revision, message.compacted), (Some(1), 2, false));
    assert_eq!((message.removed_bodies, message.bodies.len()), (vec![3], 0));
    assert_eq!(message.moved.iter().map(|moved| moved.id).collect::<Vec<_>>(), [2]);
    drop(watch);
    // One that is up to date is told so at once.
    let mut watch = door.watch_scene(from(2)).await.unwrap();
    let message = watch.message().await.unwrap().unwrap();
    assert_eq!((message.from_revision, message.revision, message.moved.len()), (Some(2), 2, 0));
    // The next message comes with the next revision, even of an empty list.
    let (message, _) = tokio::join!(watch.message(), door.apply(apply(Vec::new())));
    let message = message.unwrap().unwrap();
    assert_eq!((message.from_revision, message.revision, message.bodies.len()), (Some(2), 3, 0));
}

async fn a_reader_that_is_too_far_behind_is_given_the_whole_content(door: &impl Watches) {
    balls(door, 2).await;
    for i in 0..6 {
        door.apply(apply(vec![move_to(named("0"), at(f64::from(i), 1.0, 0.0))])).await.unwrap();
    }
    let mut watch = door.watch_scene(from(2)).await.unwrap();
    let message = watch.message().await.unwrap().unwrap();
    assert_eq!((message.from_revision, message.revision, message.compacted), (None, 7, true));
    assert_eq!((message.oldest_revision, message.bodies.len()), (4, 2));
    drop(watch);
    // From the oldest that it names on, a watch is led by what changed.
    let mut watch = door.watch_scene(from(message.oldest_revision)).await.unwrap();
    let message = watch.message().await.unwrap().unwrap();
    assert_eq!((message.from_revision, message.compacted, message.moved.len()), (Some(4), false, 1));
}

async fn a_reader_that_is_ahead_waits(door: &impl Watches) {
    balls(door, 1).await;
    let mut watch = door.watch_scene(from(2)).await.unwrap();
    let early = tokio::time::timeout(Duration::from_millis(100), watch.message()).await;
    assert!(early.is_err(), "{early:?}");
    drop(watch);
    let mut watch = door.watch_scene(from(2)).await.unwrap();
    for _ in 0..2 {
        door.apply(apply(Vec::new())).await.unwrap();
    }
    let message = watch.message().await.unwrap().unwrap();
    assert_eq!((message.from_revision, message.revision), (Some(2), 3));
}

async fn long_contents_come_in_several_messages(door: &impl Watches) {
    balls(door, 12_000).await;
    let mut watch = door.watch_scene(watch_scene()).await.unwrap();
    let (mut copy, mut inside, mut messages) = (Copy::default(), false, 1);
    while !copy.follow(watch.message().await.unwrap().unwrap(), &mut inside, &mut Reached::default()) {
        messages += 1;
        // Edits between two messages of a step are of the next.
        if messages == 2 {
            door.apply(apply(vec![remove(named("11999"))])).await.unwrap();
        }
    }
    assert!(messages >= 2, "{messages}");
    assert_eq!((copy.revision, copy.bodies.len()), (1, 12_000));
    let message = watch.message().await.unwrap().unwrap();
    assert_eq!((message.from_revision, message.removed_bodies.as_slice()), (Some(1), &[12_000][..]));
}

async fn shapes_are_told_where_asked(door: &impl Watches) {
    door.create_scene(SCENE).await.unwrap();
    let body = v1::AddBody { padding: 0.25, scale: Some(2.0), ..v1::AddBody::default() };
    let body = v1::AddBody { name: "ball".to_owned(), shape: Some(sphere(0.5)), ..body };
    door.apply(apply(vec![edit(v1::edit::Kind::AddBody(body))])).await.unwrap();
    let told = |copy: Copy| copy.shapes.into_values().map(|shape| shape.swept_radius).collect::<Vec<_>>();
    assert_eq!(told(whole(door, watch_scene()).await), [0.0; 0]);
    assert_eq!(told(whole(door, v1::WatchRequest { shapes: true, ..watch_scene() }).await), [1.25]);
}

async fn a_deleted_scene_ends_a_watch(door: &impl Watches) {
    balls(door, 1).await;
    let mut watch = door.watch_scene(watch_scene()).await.unwrap();
    watch.message().await.unwrap();
    let (told, _) = tokio::join!(watch.message(), door.delete_scene(SCENE));
    let refusal = told.unwrap_err();
    assert_eq!((refusal.code, refusal.message.as_str()), (Code::NotFound, "no scene \"cell\""));
}

async fn what_cannot_be_watched_is_refused(door: &impl Watches) {
    balls(door, 1).await;
    let refused = |request| async { door.watch_scene(request).await.err().unwrap() };
    let elsewhere = refused(v1::WatchRequest { scene: "elsewhere".to_owned(), ..watch_scene() }).await;
    assert_eq!((elsewhere.code, elsewhere.message.as_str()), (Code::NotFound, "no scene \"elsewhere\""));
    let before = refused(v1::WatchRequest { epoch: Some(1), ..from(1) }).await;
    assert_eq!((before.code, before.reason.as_str()), (Code::FailedPrecondition, "WRONG_EPOCH"));
}

async fn watches_of_scenes_and_contacts_are_counted_together(door: &impl Watches) {
    balls(door, 1).await;
    let kept = (door.watch_scene(watch_scene()).await.unwrap(), door.watch_contacts(watch()).await.unwrap());
    let refusal = door.watch_scene(watch_scene()).await.err().unwrap();
    assert_eq!(refusal.message, "max_watchers exceeded: asked for 3, allowed is 2");
    drop(kept);
    let mut tries = 0;
    while let Err(refusal) = door.watch_scene(watch_scene()).await {
        assert!(refusal.code == Code::ResourceExhausted && tries < 200, "{refusal:?}");
        tries += 1;
        tokio::time::sleep(Duration::from_millis(20)).await;
    }
}
