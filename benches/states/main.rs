//! States of a robot checked in a second: in process, through gRPC, and by the usual checker in the same run.
//!
//! `cargo bench --bench states`, after `benches/peers/setup` for the comparison. The workload is the UR5 of `tests/data`:
//! 400 states in 21 scenes; and those of every third scene again among 10 000 more bodies (`crowd.rs`). All run in turn,
//! round after round, each on one core (`taskset -c 0 cargo bench ...` keeps the daemon and its client on the same one); a
//! figure is the median over the rounds, a ratio the median of the rounds' ratios, so that a machine that slows down
//! slows both sides. Answers among more bodies are first held against those of all pairs.

#[path = "../../tests/query/workload.rs"]
mod workload;

mod crowd;

use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::Arc;
use std::time::Instant;

use clearance::app::{Daemon, GrpcSettings, Settings, SharedMemorySettings, ZenohSettings};
use clearance::geometry::Pose;
use clearance::query::{CheckStates, Context, Mode, Prepared, Verdict, Wants};
use clearance::robot::{LinkOptions, MeshUse, ModelOptions, mesh_files};
use clearance::scene::{NewBody, Snapshot};
use clearance::service::{RobotDescription, Target};
use clearance::transports::grpc::{Client, RemoteEdit};
use tokio::runtime::Runtime;

const ROUNDS: usize = 7;

/// Every pass over the workload is repeated until it has taken this long, seconds.
const LEAST_TIME: f64 = 0.3;

const VERDICT: Wants = Wants::VERDICT;
/// As the usual checker: the least signed distance over all pairs, penetration included.
const DISTANCE: Wants = Wants { distance: true, depth: true, ..Wants::VERDICT };

/// How many states a request holds.
const IN_PROCESS: [(&str, usize); 2] =
    [("in process, a scene's states a request", usize::MAX), ("in process, a state a request", 1)];

/// The states of one scene, joined to one request.
struct Batch {
    snapshot: Arc<Snapshot>,
    positions: Vec<f64>,
}

fn main() {
    let robot = workload::ur5();
    let width = robot.degrees_of_freedom();
    let scenes = workload::scenes(&robot);
    let states = workload::states();
    let batches: Vec<Batch> = (scenes.iter().enumerate())
        .map(|(i, snapshot)| {
            let own = states.iter().filter(|(scene, _, _)| *scene == i);
            Batch { snapshot: Arc::clone(snapshot), positions: own.flat_map(|(_, q, _)| q.clone()).collect() }
        })
        .collect();
    let crowd = crowd::scenes(&robot, &scenes, &states);
    hold_against_all_pairs(&crowd);
    let crowded: Vec<Batch> = (crowd.iter())
        .map(|scene| Batch {
            snapshot: Arc::clone(&scene.snapshot),
            positions: scene.states.iter().flat_map(|(q, _)| q.clone()).collect(),
        })
        .collect();
    let grpc = Grpc::start(&scenes);
    let mut peer = UsualChecker::start();
    let mut peer_in_a_crowd = UsualChecker::start_in_a_crowd(&crowd);
    let mut table = Table::default();
    for _ in 0..ROUNDS {
        let usual = peer.as_mut().map(UsualChecker::pass);
        for (question, wants) in [("verdict", VERDICT), ("distance", DISTANCE)] {
            let usual = usual.as_ref().map(|answer| number(answer, question));
            table.note(question, "pinocchio + Coal", usual, usual);
            for (way, size) in IN_PROCESS {
                table.note(question, way, Some(in_process(&batches, width, size, wants)), usual);
            }
            for (way, size) in [("gRPC, 1 a request", 1), ("gRPC, 64 a request", 64), ("gRPC, 1024 a request", 1024)] {
                table.note(question, way, Some(grpc.ask(&batches, width, size, wants)), usual);
            }
        }
        let usual = peer_in_a_crowd.as_mut().map(UsualChecker::pass);
        for (question, title, wants) in
            [("verdict", "verdict in a crowd", VERDICT), ("distance", "distance in a crowd", DISTANCE)]
        {
            let per_second = usual.as_ref().map(|answer| number(answer, question));
            let way = usual.as_ref().and_then(|answer| answer[format!("{question}_way")].as_str()).unwrap_or_default();
            table.note(title, &format!("pinocchio + Coal, {way}"), per_second, per_second);
            for (way, size) in IN_PROCESS {
                table.note(title, way, Some(in_process(&crowded, width, size, wants)), per_second);
            }
        }
    }
    table.print();
}

/// States a second, in requests of at most `size` states.
fn in_process(batches: &[Batch], width: usize, size: usize, wants: Wants) -> f64 {
    let context = Context { wants, ..Context::default() };
    let requests: Vec<(&Snapshot, CheckStates)> = batches
        .iter()
        .flat_map(|batch| {
            let context = &context;
            batch.positions.chunks(width.saturating_mul(size)).map(move |positions| {
                let (robot, context) = ("ur5".to_owned(), context.clone());
                (&*batch.snapshot, CheckStates { robot, positions: positions.to_vec(), mode: Mode::All, context })
            })
        })
        .collect();
    states_per_second(|| {
        let answers = requests.iter().map(|(snapshot, request)| {
            Prepared::check_states(&**snapshot, request).expect("the workload is in order").answer(&|| false)
        });
        answers.map(|answer| answer.items.len()).sum()
    })
}

/// Every answer among more bodies is that of the search through all pairs.
fn hold_against_all_pairs(crowd: &[crowd::Crowded]) {
    let (mut hits, mut free) = (0, 0);
    for scene in crowd {
        for ((positions, collides), least) in scene.states.iter().zip(&scene.distances) {
            let context = Context { wants: DISTANCE, ..Context::default() };
            let request =
                CheckStates { robot: "ur5".to_owned(), positions: positions.clone(), mode: Mode::All, context };
            let prepared = Prepared::check_states(&scene.snapshot, &request).expect("the workload is in order");
            let answer = prepared.answer(&|| false).items.remove(0);
            assert_eq!(answer.verdict, if *collides { Verdict::Collision } else { Verdict::Free }, "{positions:?}");
            let nearest = answer.nearest.expect("a distance was wanted");
            let room = 1e-9 * least.abs().max(1e-3);
            assert!(
                nearest.bracket.lower - room <= *least && *least <= nearest.bracket.upper + room,
                "{least} {nearest:?}"
            );
            *(if *collides { &mut hits } else { &mut free }) += 1;
        }
    }
    eprintln!("{hits} states in collision and {free} free among {} more bodies answered as by all pairs", crowd::EXTRA);
}

fn number(answer: &serde_json::Value, question: &str) -> f64 {
    answer[question].as_f64().expect("the peer answers with numbers")
}

/// A daemon with one thread for questions, on loopback in this process, and a client of it.
struct Grpc {
    runtime: Runtime,
    client: Client,
}

impl Grpc {
    fn start(scenes: &[Arc<Snapshot>]) -> Self {
        let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build().expect("threads are to be had");
        let client = runtime.block_on(async {
            let grpc = GrpcSettings { address: Some("127.0.0.1:0".to_owned()), ..GrpcSettings::default() };
            let shared_memory = SharedMemorySettings { enabled: Some(false), ..SharedMemorySettings::default() };
            let zenoh = ZenohSettings { enabled: Some(false), ..ZenohSettings::default() };
            let config = Settings { threads: Some(1), grpc, shared_memory, zenoh, ..Settings::default() }
                .resolve()
                .expect("defaults hold");
            let daemon = Daemon::build(&config).await.expect("a port is free");
            let address = daemon.doors()[0].address.to_string();
            tokio::spawn(daemon.run(std::future::pending()));
            let client = Client::connect(&address).await.expect("the daemon listens");
            build_scenes(&client, scenes).await;
            client
        });
        Self { runtime, client }
    }

    /// States a second, in requests of `size` states; a scene's states are repeated to fill them.
    fn ask(&self, batches: &[Batch], width: usize, size: usize, wants: Wants) -> f64 {
        let context = Context { wants, ..Context::default() };
        let requests: Vec<(Target, CheckStates)> = batches
            .iter()
            .enumerate()
            .map(|(scene, batch)| {
                let target = Target { scene: scene.to_string(), ..Target::default() };
                let positions = batch.positions.iter().copied().cycle().take(size * width).collect();
                let (robot, context) = ("ur5".to_owned(), context.clone());
                (target, CheckStates { robot, positions, mode: Mode::All, context })
            })
            .collect();
        let mut turn = requests.iter().cycle();
        states_per_second(|| {
            let (target, request) = turn.next().expect("a cycle has no end");
            let answer = self.runtime.block_on(self.client.check_states(target, request)).expect("the daemon answers");
            answer.items.len()
        })
    }
}

/// The robot and the scenes of the workload, in the daemon.
async fn build_scenes(client: &Client, scenes: &[Arc<Snapshot>]) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/robot-ur5");
    let read = |name: &str| std::fs::read_to_string(folder.join(name)).expect("the workload is there");
    let urdf = read("ur5.urdf");
    let mut meshes = std::collections::BTreeMap::new();
    for name in mesh_files(&urdf).expect("the workload is in order") {
        let bytes = std::fs::read(folder.join(name.trim_start_matches("package://ur5/"))).expect("the mesh is there");
        meshes.insert(name, client.put_asset(&bytes).await.expect("the daemon takes it"));
    }
    let options = ModelOptions::uniform(LinkOptions { mesh: MeshUse::Hull, ..LinkOptions::default() });
    let description = RobotDescription { urdf, srdf: Some(read("ur5.srdf")), meshes, options };
    let robot = client.load_robot(&description).await.expect("the robot is in order");
    for (i, snapshot) in scenes.iter().enumerate() {
        let scene = i.to_string();
        client.create_scene(&scene).await.expect("the name is free");
        let model = robot.id.clone();
        let arm = RemoteEdit::AddRobot { name: "ur5".to_owned(), model, base: Pose::identity() };
        let bodies = snapshot
            .bodies()
            .map(|body| RemoteEdit::AddBody(NewBody::new(body.name.to_string(), Arc::clone(&body.shape), body.pose)));
        let edits: Vec<RemoteEdit> = std::iter::once(arm).chain(bodies).collect();
        client.apply(&scene, &edits).await.expect("the scene is in order");
    }
}

/// Repeats a pass, which returns the states it answered, for long enough to time it.
fn states_per_second(mut pass: impl FnMut() -> usize) -> f64 {
    let (mut states, start) = (0, Instant::now());
    loop {
        states += pass();
        let seconds = start.elapsed().as_secs_f64();
        if seconds > LEAST_TIME {
            return states as f64 / seconds;
        }
    }
}

/// The peer's process; it makes one pass for each line it is sent.
struct UsualChecker {
    _process: Child,
    to: ChildStdin,
    from: BufReader<ChildStdout>,
}

impl UsualChecker {
    /// The workload as it is.
    fn start() -> Option<Self> {
        let python = root().join("target/peers/bin/python");
        let script = root().join("benches/peers/usual_checker.py");
        Self::start_program(&python, &[&script, &root().join("tests/data/robot-ur5"), Path::new("ur5")])
    }

    /// Among more bodies.
    fn start_in_a_crowd(crowd: &[crowd::Crowded]) -> Option<Self> {
        let folder = root().join("target/peers/comparison");
        let (program, scenes) = (folder.join("crowded_checker"), folder.join("crowded_scenes.txt"));
        if program.exists() {
            std::fs::write(&scenes, crowd::text(crowd)).expect("the folder of the program takes a file");
        }
        Self::start_program(&program, &[&root().join("tests/data/robot-ur5"), Path::new("ur5"), &scenes])
    }

    fn start_program(program: &Path, arguments: &[&Path]) -> Option<Self> {
        if !program.exists() {
            eprintln!("no comparison: benches/peers/setup makes {}", program.display());
            return None;
        }
        let mut process = Command::new(program)
            .args(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("the peer starts");
        let to = process.stdin.take().expect("stdin is piped");
        let mut from = BufReader::new(process.stdout.take().expect("stdout is piped"));
        let mut ready = String::new();
        from.read_line(&mut ready).expect("the peer answers");
        Some(Self { _process: process, to, from })
    }

    fn pass(&mut self) -> serde_json::Value {
        writeln!(self.to).expect("the peer listens");
        let mut line = String::new();
        self.from.read_line(&mut line).expect("the peer answers");
        let answer: serde_json::Value = serde_json::from_str(&line).expect("the peer answers in JSON");
        assert_eq!(answer["wrong_verdicts"], 0, "the peer is asked the same question");
        answer
    }
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Figures of all rounds, in the order they first came.
#[derive(Default)]
struct Table {
    rows: Vec<Row>,
}

struct Row {
    question: &'static str,
    way: String,
    per_second: Vec<f64>,
    ratios: Vec<f64>,
}

impl Table {
    fn note(&mut self, question: &'static str, way: &str, per_second: Option<f64>, usual: Option<f64>) {
        let Some(per_second) = per_second else { return };
        let place = self.rows.iter().position(|r| r.question == question && r.way == way).unwrap_or_else(|| {
            self.rows.push(Row { question, way: way.to_owned(), per_second: Vec::new(), ratios: Vec::new() });
            self.rows.len() - 1
        });
        self.rows[place].per_second.push(per_second);
        self.rows[place].ratios.extend(usual.map(|usual| per_second / usual));
    }

    fn print(&mut self) {
        println!("{:<20} {:<52} {:>12} {:>10}", "question", "way", "states/s", "ratio");
        for row in &mut self.rows {
            let ratio = if row.ratios.is_empty() { "-".to_owned() } else { format!("{:.2}", median(&mut row.ratios)) };
            println!("{:<20} {:<52} {:>12.0} {ratio:>10}", row.question, row.way, median(&mut row.per_second));
        }
    }
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
