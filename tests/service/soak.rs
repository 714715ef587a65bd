//! All kinds of clients at a time, well behaved and not, for as long as `SOAK_SECONDS` says: the daemon answers all the while, and
//! its memory stays flat. What counts is the memory of the process (`VmRSS`), its last third against the third before.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use clearance::query::{CheckStates, Context, Mode};
use clearance::service::Target;
use clearance::transports::shared_memory::{Ask, Client, Options};
use clearance::transports::wire::v1;
use clearance::transports::wire::v1::queries_client::QueriesClient;
use clearance::transports::wire::v1::query_stream_request::Question;
use clearance::transports::wire::v1::robots_client::RobotsClient;
use clearance::transports::wire::v1::scenes_client::ScenesClient;
use clearance::transports::wire::v1::server_client::ServerClient;
use tokio::io::AsyncWriteExt;
use tokio::net::TcpStream;
use tokio_stream::StreamExt;
use tonic::transport::{Channel, Endpoint};

use crate::process::{Killed, serve_with};
use crate::support::messages::*;
use crate::support::shared_memory_door::unused_name;
use crate::support::watchdog::watched;

/// What the memory may grow by from one third to the next: a part, and a size in kB for what settles late.
const GROWTH: f64 = 0.05;
const SLACK: u64 = 4096;

/// What each kind of client has done.
#[derive(Debug, Default)]
struct Done {
    questions: AtomicU64,
    edits: AtomicU64,
    scenes: AtomicU64,
    streamed: AtomicU64,
    watched: AtomicU64,
    posed: AtomicU64,
    shared: AtomicU64,
    visited: AtomicU64,
    rude: AtomicU64,
    /// Of what went through shared memory: the longest two calls, microseconds.
    slowest: AtomicU64,
}

fn count(counter: &AtomicU64) {
    counter.fetch_add(1, Ordering::Relaxed);
}

#[derive(Clone)]
struct Soak {
    address: String,
    /// Where zenoh's door is.
    zenoh: String,
    name: String,
    root: PathBuf,
    end: Instant,
    done: Arc<Done>,
}

impl Soak {
    fn goes_on(&self) -> bool {
        Instant::now() < self.end
    }

    async fn channel(&self) -> Channel {
        Endpoint::from_shared(format!("http://{}", self.address)).unwrap().connect().await.unwrap()
    }

    /// Asks and edits; a new connection every now and then.
    async fn planner(self) {
        while self.goes_on() {
            let channel = self.channel().await;
            let (mut queries, mut scenes) = (QueriesClient::new(channel.clone()), ScenesClient::new(channel));
            for _ in 0..50 {
                queries.check_states(states([0.3, -0.4].repeat(64))).await.unwrap();
                queries.distance(distance(vec![all_pairs()])).await.unwrap();
                count(&self.done.questions);
                scenes.apply(apply(vec![add("passing", sphere(0.1), at(9.0, 0.0, 0.0))])).await.unwrap();
                scenes.apply(apply(vec![remove(named("passing"))])).await.unwrap();
                count(&self.done.edits);
            }
        }
    }

    /// Scenes that come and go.
    async fn builder(self) {
        let mut scenes = ScenesClient::new(self.channel().await);
        while self.goes_on() {
            let name = "of a moment".to_owned();
            let create = v1::CreateSceneRequest { name: name.clone(), ..v1::CreateSceneRequest::default() };
            scenes.create_scene(create).await.unwrap();
            let edits = (0..200).map(|i| add(&format!("b{i}"), sphere(0.4), at(f64::from(i), 0.0, 0.0))).collect();
            let apply = v1::ApplyRequest { scene: name.clone(), edits, ..v1::ApplyRequest::default() };
            scenes.apply(apply).await.unwrap();
            scenes.delete_scene(v1::DeleteSceneRequest { scene: name }).await.unwrap();
            count(&self.done.scenes);
        }
    }

    /// Streams of questions, of which every other is left in the middle.
    async fn streamer(self) {
        while self.goes_on() {
            // h2 gives a connection up on which its own side has left too many streams.
            let mut queries = QueriesClient::new(self.channel().await);
            let question = |id| v1::QueryStreamRequest {
                id,
                question: Some(Question::CheckStates(states([0.3, -0.4].repeat(32)))),
            };
            let sent = tokio_stream::iter((0..40).map(question));
            let mut answers = queries.query_stream(sent).await.unwrap().into_inner();
            let read = if self.done.streamed.load(Ordering::Relaxed).is_multiple_of(2) { 40 } else { 3 };
            for _ in 0..read {
                answers.next().await.unwrap().unwrap();
            }
            count(&self.done.streamed);
        }
    }

    /// Watches that begin, read a while, and end.
    async fn watcher(self) {
        let mut scenes = ScenesClient::new(self.channel().await);
        while self.goes_on() {
            let request = v1::WatchRequest { scene: SCENE.to_owned(), shapes: true, ..v1::WatchRequest::default() };
            let mut steps = scenes.watch(request).await.unwrap().into_inner();
            for _ in 0..20 {
                // Nothing changes once the others have ended.
                if let Ok(step) = tokio::time::timeout(Duration::from_secs(5), steps.message()).await {
                    step.unwrap();
                    count(&self.done.watched);
                }
            }
        }
    }

    /// Poses as fast as they are acknowledged.
    async fn poser(self) {
        let mut scenes = ScenesClient::new(self.channel().await);
        while self.goes_on() {
            let pose = |i: u32| v1::PoseStreamRequest {
                scene: if i == 0 { SCENE.to_owned() } else { String::new() },
                bodies: vec![v1::BodyPose {
                    body: Some(named("block")),
                    pose: Some(at(1.0, 0.001 * f64::from(i), -1.0)),
                }],
                ..v1::PoseStreamRequest::default()
            };
            let sent = tokio_stream::iter((0..100).map(pose));
            let mut made = scenes.pose_stream(sent).await.unwrap().into_inner();
            while let Some(answer) = made.next().await {
                answer.unwrap();
                count(&self.done.posed);
            }
        }
    }

    /// Through shared memory; connects anew every now and then.
    fn neighbour(&self) {
        let question = CheckStates {
            robot: "arm".to_owned(),
            positions: [0.3, -0.4].repeat(100),
            mode: Mode::All,
            context: Context::default(),
        };
        let target = Target { scene: SCENE.to_owned(), ..Target::default() };
        while self.goes_on() {
            let mut client = Client::connect(&self.name, &self.root).unwrap();
            for _ in 0..200 {
                let begun = Instant::now();
                let answer = client.ask(&target, Ask::States(&question, 2), &Options::default());
                answer.unwrap_or_else(|error| panic!("{error} after {:?}", self.done));
                let scenes = client.call("Scenes/ListScenes", &[], Duration::from_secs(10));
                scenes.unwrap_or_else(|error| panic!("{error} after {:?}", self.done));
                let took = u64::try_from(begun.elapsed().as_micros()).unwrap();
                self.done.slowest.fetch_max(took, Ordering::Relaxed);
                count(&self.done.shared);
            }
        }
    }

    /// Through zenoh: questions, poses, watches that are left; connects anew every now and then.
    async fn visitor(self) {
        use clearance::geometry::{Pose, Quaternion, Vec3};
        use clearance::transports::zenoh::{Client, Of};
        use prost::Message as _;
        let patience = Duration::from_secs(10);
        let question = states([0.3, -0.4].repeat(64)).encode_to_vec();
        let watch = v1::WatchRequest { scene: SCENE.to_owned(), ..v1::WatchRequest::default() }.encode_to_vec();
        while self.goes_on() {
            let client = Client::connect(&self.zenoh, "clearance").await.unwrap();
            let mut follower = client.follow(SCENE).await.unwrap();
            for i in 0..100 {
                client.call("Queries/CheckStates", question.clone(), patience).await.unwrap();
                let pose = Pose::new(Vec3::new(2.0, 0.001 * f64::from(i), -1.0), Quaternion::IDENTITY).unwrap();
                client.put_pose(SCENE, &Of::Body("block".to_owned()), &pose).await.unwrap();
                let mut left = client.watch("Scenes/Watch", watch.clone(), patience, None).await.unwrap();
                left.next().await.unwrap();
                follower.next().await.unwrap();
                count(&self.done.visited);
            }
        }
    }

    /// Garbage, half messages, and calls that nobody waits for.
    async fn lout(self) {
        while self.goes_on() {
            for bytes in
                [b"GET / HTTP/1.1\r\n\r\n".as_slice(), b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n\xff\xff\xff", &[0; 100]]
            {
                let mut socket = TcpStream::connect(&self.address).await.unwrap();
                // It may be closed before all of it is sent.
                _ = socket.write_all(bytes).await;
            }
            let mut queries = QueriesClient::new(self.channel().await);
            let long = queries.distance(distance(vec![all_pairs(); 5_000]));
            assert!(tokio::time::timeout(Duration::from_millis(20), long).await.is_err());
            let wrong = queries.collide(collide(vec![placed(sphere(f64::NAN), at(0.0, 0.0, 0.0))])).await;
            assert_eq!(wrong.unwrap_err().code(), tonic::Code::InvalidArgument);
            count(&self.done.rude);
        }
    }
}

fn resident(process: u32) -> u64 {
    let status = std::fs::read_to_string(Path::new("/proc").join(process.to_string()).join("status")).unwrap();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).unwrap();
    line.trim().trim_end_matches(" kB").parse().unwrap()
}

fn median(values: &[u64]) -> u64 {
    let mut sorted = values.to_vec();
    sorted.sort_unstable();
    sorted[sorted.len() / 2]
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
#[ignore = "as long as SOAK_SECONDS says, ten minutes if it says nothing; ./test long"]
async fn memory_stays_flat_under_mixed_clients() {
    let seconds = std::env::var("SOAK_SECONDS").map_or(600, |seconds| seconds.parse().unwrap());
    let (name, root) = (unused_name(), tempfile::tempdir().unwrap());
    let mut command = serve_with(&["--shared-memory-name", &name, "--limit", "max_shared_memory_clients=2"]);
    command.arg("--shared-memory-root").arg(root.path());
    command.args(["--zenoh-listen", "tcp/127.0.0.1:0"]);
    let (daemon, address) = Killed::listening(&mut command).await;
    let mut scenes = ScenesClient::connect(format!("http://{address}")).await.unwrap();
    let mut robots = RobotsClient::connect(format!("http://{address}")).await.unwrap();
    let robot = robots.load_robot(load(ROBOT)).await.unwrap().into_inner().robot.unwrap();
    let create = v1::CreateSceneRequest { name: SCENE.to_owned(), ..v1::CreateSceneRequest::default() };
    scenes.create_scene(create).await.unwrap();
    let block = add("block", cuboid(0.2, 0.2, 0.2), at(1.0, 0.0, -1.0));
    let others = (0..100).map(|i| add(&format!("b{i}"), sphere(0.6), at(f64::from(i), 5.0, 0.0)));
    let edits = [add_robot("arm", &robot.id), block].into_iter().chain(others).collect();
    scenes.apply(apply(edits)).await.unwrap();

    let mut server = ServerClient::connect(format!("http://{address}")).await.unwrap();
    let doors = server.get_server_info(v1::GetServerInfoRequest {}).await.unwrap().into_inner().doors;
    let zenoh = doors.iter().find(|door| door.kind == "zenoh").map_or("", |door| &door.address).to_owned();
    let soak = Soak {
        address,
        zenoh,
        name: name.to_string(),
        root: root.path().to_owned(),
        end: Instant::now() + Duration::from_secs(seconds),
        done: Arc::default(),
    };
    let (sizes, process) = (Arc::new(Mutex::new(Vec::new())), daemon.id());
    let measuring = {
        let (soak, sizes) = (soak.clone(), Arc::clone(&sizes));
        tokio::spawn(async move {
            while soak.goes_on() {
                sizes.lock().unwrap().push(resident(process));
                tokio::time::sleep(Duration::from_millis(500)).await;
            }
        })
    };
    let neighbour = soak.clone();
    let neighbour = tokio::task::spawn_blocking(move || neighbour.neighbour());
    let clients = vec![
        tokio::spawn(soak.clone().planner()),
        tokio::spawn(soak.clone().builder()),
        tokio::spawn(soak.clone().streamer()),
        tokio::spawn(soak.clone().watcher()),
        tokio::spawn(soak.clone().poser()),
        tokio::spawn(soak.clone().lout()),
        tokio::spawn(soak.clone().visitor()),
        neighbour,
        measuring,
    ];
    tokio::time::sleep_until(soak.end.into()).await;
    for client in clients {
        watched("the end of a client", client).await.unwrap();
    }
    let (code, log) = daemon.stopped().await;
    assert_eq!(code, Some(0), "{log}");

    let Done { questions, edits, scenes, streamed, watched, posed, shared, visited, rude, slowest: _ } = &*soak.done;
    let done = [questions, edits, scenes, streamed, watched, posed, shared, visited, rude];
    let done = done.map(|done| done.load(Ordering::Relaxed));
    assert!(done.iter().all(|done| *done > 5), "every kind of client has done something: {done:?}");
    let sizes = sizes.lock().unwrap();
    let third = sizes.len() / 3;
    let (before, after) = (median(&sizes[third..2 * third]), median(&sizes[2 * third..]));
    println!("{:?} done; {before} kB, then {after} kB", soak.done);
    assert!(after as f64 <= before as f64 * (1.0 + GROWTH) + SLACK as f64, "{before} kB, then {after} kB: {sizes:?}");
}
