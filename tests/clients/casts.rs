//! Do the Rust client's words for rays, motions, regions, neighbours and overlays say what the messages say? A plain answer is made
//! a message again and has to be the very message that came.

use clearance::geometry::{Aabb, Pose, Quaternion, Shape, Vec3};
use clearance::limits::Limits;
use clearance::query::{
    CastMode, CastRays, CastShapes, CastVerdict, CheckMovingPairs, Context, DEFAULT_RESOLUTION, Mode, Moved, Mover,
    NearestBodies, Overlap, PairQuery, Region, Subject, Verdict, Wants, Way,
};
use clearance::scene::{BodyId, BodyRef, NewBody};
use clearance::service::Target;
use clearance::transports::grpc::{Client, RemoteEdit, RemoteOverlay};
use clearance::transports::wire::{to_proto, v1};
use std::sync::Arc;

use crate::daemon::{RunningDaemon, config};
use crate::messages::SCENE;
use crate::watchdog::watched;

fn at(x: f64, y: f64, z: f64) -> Pose {
    Pose::new(Vec3::new(x, y, z), Quaternion::IDENTITY).unwrap()
}

fn ball(radius: f64) -> Shape {
    Shape::sphere(radius).unwrap()
}

/// Three balls of radius 0.5 along x, 2 m from each other, and one behind them that others only graze.
async fn scene(client: &Client) -> Vec<BodyId> {
    client.create_scene(SCENE).await.unwrap();
    let places = [at(0.0, 0.0, 0.0), at(2.0, 0.0, 0.0), at(4.0, 0.0, 0.0), at(6.0, 0.5, 0.0)];
    let add = |(i, pose)| RemoteEdit::AddBody(NewBody::new(format!("ball{i}"), Arc::new(ball(0.5)), pose));
    let edits: Vec<RemoteEdit> = places.into_iter().enumerate().map(add).collect();
    client.apply(SCENE, &edits).await.unwrap().applied.added
}

#[tokio::test(flavor = "multi_thread")]
async fn casts_regions_and_neighbours_come_in_the_librarys_words() {
    let daemon = RunningDaemon::start(&config(Limits::default())).await;
    let client = Client::connect(&daemon.address).await.unwrap();
    watched("casts", async {
        let ids = scene(&client).await;
        let target = Target { scene: SCENE.to_owned(), ..Target::default() };
        for mode in [CastMode::First, CastMode::All, CastMode::Any] {
            let question = CastRays {
                origins: vec![-3.0, 0.0, 0.0, 0.0, 9.0, 0.0, 0.0, 0.0, 0.0],
                directions: vec![1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0],
                lengths: vec![20.0],
                mode,
                context: Context::default(),
            };
            let plain = client.cast_rays(&target, &question).await.unwrap();
            let message = client.queries().cast_rays(to_proto::cast_rays_request(&target, &question)).await.unwrap();
            assert_eq!(to_proto::cast_rays_response(&plain), message.into_inner());
            assert_eq!(plain.answered, 3);
            let verdicts: Vec<CastVerdict> = plain.items.iter().map(|item| item.verdict).collect();
            assert_eq!(verdicts, [CastVerdict::Hit, CastVerdict::Clear, CastVerdict::Hit]);
            if mode == CastMode::First {
                let hit = &plain.items[0].hits[0];
                assert!(hit.body == ids[0] && hit.lower <= 2.5 && 2.5 <= hit.upper, "{hit:?}");
                assert!(plain.items[2].hits[0].at_start);
            }
        }

        let mover = |moved, way| Mover { moved, start: None, way };
        let flying =
            Mover { start: Some(at(-3.0, 0.0, 0.0)), ..mover(Moved::Shape(ball(0.25)), Way::To(at(9.0, 0.0, 0.0))) };
        let turning = Way::By { displacement: Vec3::new(3.0, 0.0, 0.0), turn: Vec3::new(0.0, 0.0, 1.0) };
        let moving = mover(Moved::Body(ids[0]), turning);
        let question = CastShapes {
            items: vec![flying.clone(), moving.clone()],
            mode: CastMode::All,
            resolution: DEFAULT_RESOLUTION,
            context: Context::default(),
        };
        let plain = client.cast_shapes(&target, &question).await.unwrap();
        let message = client.queries().cast_shapes(to_proto::cast_shapes_request(&target, &question)).await.unwrap();
        assert_eq!(to_proto::cast_shapes_response(&plain), message.into_inner());
        assert!(plain.items[0].hits.len() >= 3 && plain.items[1].hits[0].body == ids[1], "{plain:?}");

        let still = mover(Moved::Body(ids[3]), Way::Still);
        let question = CheckMovingPairs {
            items: vec![[flying, still], [moving, mover(Moved::Body(ids[2]), Way::Still)]],
            resolution: 1e-6,
            context: Context::default(),
        };
        let plain = client.check_moving_pairs(&target, &question).await.unwrap();
        let request = to_proto::check_moving_pairs_request(&target, &question);
        let message = client.queries().check_moving_pairs(request).await.unwrap();
        assert_eq!(to_proto::check_moving_pairs_response(&plain), message.into_inner());
        assert_eq!(plain.items[0].verdict, CastVerdict::Hit);

        for bounds_only in [false, true] {
            let question = Overlap {
                items: vec![
                    Region::Box(Aabb { min: Vec3::new(-1.0, -1.0, -1.0), max: Vec3::new(2.0, 1.0, 1.0) }),
                    Region::Ball { center: Vec3::new(0.0, 5.0, 0.0), radius: 1.0 },
                    Region::Shape { shape: ball(1.0), pose: at(4.0, 0.0, 0.0) },
                ],
                bounds_only,
                context: Context::default(),
            };
            let plain = client.overlap(&target, &question).await.unwrap();
            let message = client.queries().overlap(to_proto::overlap_request(&target, &question)).await.unwrap();
            assert_eq!(to_proto::overlap_response(&plain), message.into_inner());
            let bodies: Vec<usize> = plain.items.iter().map(|item| item.bodies.len()).collect();
            assert_eq!(bodies, [2, 0, 1]);
        }

        let wants = Wants { distance: true, witness: true, ..Wants::VERDICT };
        let question = NearestBodies {
            items: vec![Subject::Body(ids[0]), Subject::Shape { shape: ball(0.1), pose: at(3.0, 3.0, 0.0) }],
            count: 2,
            context: Context { wants, ..Context::default() },
        };
        let plain = client.nearest_bodies(&target, &question).await.unwrap();
        let request = to_proto::nearest_bodies_request(&target, &question);
        let message = client.queries().nearest_bodies(request).await.unwrap();
        assert_eq!(to_proto::nearest_bodies_response(&plain), message.into_inner());
        assert_eq!(plain.items[0].nearest.len(), 2);
    })
    .await;
    drop(client);
    daemon.stop().await;
}

#[tokio::test(flavor = "multi_thread")]
async fn a_question_that_supposes_something_is_alone_with_it() {
    let daemon = RunningDaemon::start(&config(Limits::default())).await;
    let client = Client::connect(&daemon.address).await.unwrap();
    watched("supposing", async {
        let ids = scene(&client).await;
        let target = Target { scene: SCENE.to_owned(), ..Target::default() };
        let question = PairQuery { items: vec![Subject::Body(ids[0])], mode: Mode::All, context: Context::default() };
        let moved = RemoteEdit::MoveBody { body: BodyRef::Id(ids[1]), pose: at(0.5, 0.0, 0.0) };
        let supposing = client.supposing(&RemoteOverlay { edits: vec![moved], attached: Vec::new() });
        let verdict = |answer: clearance::query::Answer| answer.items[0].verdict;
        assert_eq!(verdict(supposing.collide(&target, &question).await.unwrap()), Verdict::Collision);
        assert_eq!(verdict(client.collide(&target, &question).await.unwrap()), Verdict::Free);
        // Rays do not suppose, and say so.
        let rays = CastRays {
            origins: vec![0.0; 3],
            directions: vec![1.0, 0.0, 0.0],
            lengths: vec![1.0],
            mode: CastMode::First,
            context: Context::default(),
        };
        let error = supposing.cast_rays(&target, &rays).await.unwrap_err();
        assert_eq!(error.refusal().unwrap().field.as_deref(), Some("context.overlay"));

        // Every edit is made.
        let edits = [
            RemoteEdit::ReplaceShape { body: BodyRef::Id(ids[1]), shape: ball(1.5) },
            RemoteEdit::SetEnabled { body: BodyRef::Id(ids[2]), enabled: false },
            RemoteEdit::RemoveBody { body: BodyRef::Id(ids[3]) },
        ];
        client.apply(SCENE, &edits).await.unwrap();
        assert_eq!(verdict(client.collide(&target, &question).await.unwrap()), Verdict::Collision);
        let contents = v1::GetSceneRequest { scene: SCENE.to_owned(), ..v1::GetSceneRequest::default() };
        let contents = client.scenes().get_scene(contents).await.unwrap().into_inner().scene.unwrap();
        let enabled: Vec<bool> = contents.bodies.iter().map(|body| body.enabled).collect();
        assert_eq!(enabled, [true, true, false]);
    })
    .await;
    drop(client);
    daemon.stop().await;
}

#[tokio::test(flavor = "multi_thread")]
async fn streams_tell_their_messages_and_why_they_end() {
    use v1::query_stream_request::Question;
    let daemon = RunningDaemon::start(&config(Limits::default())).await;
    let client = Client::connect(&daemon.address).await.unwrap();
    watched("streams", async {
        let ids = scene(&client).await;
        let mut scenes =
            client.watch(v1::WatchRequest { scene: SCENE.to_owned(), ..v1::WatchRequest::default() }).await.unwrap();
        assert_eq!(scenes.next().await.unwrap().unwrap().bodies.len(), 4);
        let context = || Some(v1::Context { scene: SCENE.to_owned(), ..v1::Context::default() });
        let asked = v1::WatchContactsRequest { context: context(), ..v1::WatchContactsRequest::default() };
        let mut contacts = client.watch_contacts(asked).await.unwrap();
        assert_eq!(contacts.next().await.unwrap().unwrap().contacts, 0);

        let pose = v1::BodyPose {
            body: Some(v1::BodyRef { by: Some(v1::body_ref::By::Id(ids[1].0)) }),
            pose: Some(to_proto::pose(&at(0.5, 0.0, 0.0))),
        };
        let poses =
            v1::PoseStreamRequest { scene: SCENE.to_owned(), bodies: vec![pose], ..v1::PoseStreamRequest::default() };
        let mut made = client.pose_stream(tokio_stream::iter([poses])).await.unwrap();
        let made = made.next().await.unwrap().unwrap();
        assert_eq!((made.messages, made.poses), (1, 1));
        assert_eq!(scenes.next().await.unwrap().unwrap().revision, made.revision);
        assert_eq!(contacts.next().await.unwrap().unwrap().contacts, 1);

        let question = |margin| {
            let context = context().map(|context| v1::Context { margin, ..context });
            Question::Collide(v1::CollideRequest { context, items: vec![crate::messages::all_pairs()], mode: 0 })
        };
        let asked = [question(0.0), question(-1.0)].into_iter().zip(7..);
        let asked = asked.map(|(question, id)| v1::QueryStreamRequest { id, question: Some(question) });
        let mut answers = client.query_stream(tokio_stream::iter(asked.collect::<Vec<_>>())).await.unwrap();
        let mut refused = 0;
        while let Some(answer) = answers.next().await.unwrap() {
            if let Some(v1::query_stream_response::Outcome::Error(error)) = &answer.outcome {
                let error = clearance::transports::grpc::ClientError::from(error);
                assert_eq!(error.refusal().unwrap().field.as_deref(), Some("context.margin"));
                assert_eq!(answer.id, 8);
                refused += 1;
            }
        }
        assert_eq!(refused, 1);

        client.delete_scene(SCENE).await.unwrap();
        let end = scenes.next().await.unwrap_err();
        assert_eq!(end.refusal().unwrap().reason, "NOT_FOUND");
    })
    .await;
    drop(client);
    daemon.stop().await;
}
