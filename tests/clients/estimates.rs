//! Does the Rust client say what an estimate's message says? A plain answer is made a message again and has to be that message; times
//! are new at each asking, so one message is read twice.

use std::sync::Arc;

use clearance::geometry::{Pose, Quaternion, Shape, Vec3};
use clearance::limits::Limits;
use clearance::query::{BatchQuestion, Context, Mode, Output, PairQuery, Subject};
use clearance::scene::NewBody;
use clearance::service::{Estimate, EstimateEnd, Target};
use clearance::transports::grpc::{Client, RemoteEdit, RemoteOverlay};
use clearance::transports::wire::{from_proto, to_proto};

use crate::daemon::{RunningDaemon, config};
use crate::messages::SCENE;
use crate::watchdog::watched;

#[tokio::test(flavor = "multi_thread")]
async fn prices_come_in_the_librarys_words() {
    let daemon = RunningDaemon::start(&config(Limits { max_estimate_seconds: 60, ..Limits::default() })).await;
    let client = Client::connect(&daemon.address).await.unwrap();
    watched("estimates", async {
        client.create_scene(SCENE).await.unwrap();
        let cone = Arc::new(Shape::cone(0.3, 0.4).unwrap());
        let turned = |i: u32| Quaternion { w: 1.0, x: 0.1 * f64::from(i), y: 0.2, z: 0.0 };
        let at = |i: u32| Pose::new(Vec3::new(1.5 * f64::from(i), 0.0, 0.0), turned(i)).unwrap();
        let add = |i: u32| RemoteEdit::AddBody(NewBody::new(format!("cone{i}"), Arc::clone(&cone), at(i)));
        let ids = client.apply(SCENE, &(0..5).map(add).collect::<Vec<_>>()).await.unwrap().applied.added;
        let target = Target { scene: SCENE.to_owned(), ..Target::default() };
        let items = ids.iter().map(|id| Subject::Body(*id)).collect();
        let estimate = Estimate {
            question: BatchQuestion::Distance(PairQuery { items, mode: Mode::All, context: Context::default() }),
            tolerances: vec![1e-2, 1e-6],
            outputs: vec![Output::Distance, Output::Depth],
            sample: Some(3),
            time: None,
        };
        let request = to_proto::estimate_request(&target, &estimate);
        let message = client.queries().estimate(request).await.unwrap().into_inner();
        assert_eq!(to_proto::estimate_response(&from_proto::estimated(&message).unwrap()), message);

        let told = client.estimate(&target, &estimate).await.unwrap();
        assert_eq!((told.end, told.items, told.sample, told.rows.len()), (EstimateEnd::Complete, 5, 3, 4));
        let rows: Vec<_> = told.rows.iter().map(|row| (row.output, row.tolerance)).collect();
        let [rough, fine] = [Some(1e-2), Some(1e-6)];
        let (distance, depth) = (Output::Distance, Output::Depth);
        assert_eq!(rows, [(distance, rough), (distance, fine), (depth, rough), (depth, fine)]);
        assert!(told.rows.iter().all(|row| row.complete && row.times.is_some() && row.verdicts.free == 3));

        // A ball that only this question sees is in all of them.
        let ball = NewBody::new("ball", Arc::new(Shape::sphere(9.0).unwrap()), at(2));
        let changes = RemoteOverlay { edits: vec![RemoteEdit::AddBody(ball)], attached: Vec::new() };
        let supposed = client.supposing(&changes).estimate(&target, &estimate).await.unwrap();
        assert!(supposed.rows.iter().all(|row| row.verdicts.collision == 3), "{supposed:?}");
    })
    .await;
    drop(client);
    daemon.stop().await;
}
