//! The tour: what the daemon is asked, in the order a person would ask it.

use std::collections::BTreeMap;
use std::io::Write;
#[cfg(feature = "shared-memory")]
use std::time::Duration;

use serde_json::{Value, json};
use tokio::sync::oneshot;

use super::super::exit_code::Failed;
use super::super::folder::Folder;
#[cfg(feature = "shared-memory")]
use super::super::own_name::OwnName;
use super::super::sample;
use super::super::scene_file::{SceneEntry, StateLine};
use super::super::state_line::{AnswerLine, Names};
use super::super::words;
use super::doors::{Asked, Doors};
use super::report::{Cast, HEADINGS, row};

#[cfg(any(feature = "shared-memory", feature = "zenoh"))]
use crate::app::DoorChoice;
#[cfg(feature = "zenoh")]
use crate::app::defaults::ZENOH_PREFIX;
use crate::app::{Daemon, GrpcSettings, Settings, stop_signal};
use crate::geometry::Pose;
use crate::query::{Answer, CheckStates, Context, ItemAnswer, Mode, Side, Verdict, Wants};
use crate::robot::{LinkOptions, MeshUse, ModelOptions};
use crate::scene::{BodyRef, NewBody, Revision};
use crate::service::{ContentHash, RevisionRule, RobotDescription, Rule, Target};
use crate::transports::grpc::{Client, RemoteEdit, RemoteRobot};
#[cfg(feature = "shared-memory")]
use crate::transports::shared_memory;
#[cfg(feature = "zenoh")]
use crate::transports::zenoh as zenoh_door;

/// Flags of `clearance demo`.
#[derive(clap::Args, Clone, Debug)]
pub struct Demo {
    /// Leave the daemon up until Ctrl-C, and say how to ask it from Python.
    #[arg(long)]
    pub keep: bool,
    /// JSON lines instead of tables.
    #[arg(long)]
    pub json: bool,
}

/// The robot's name in every scene.
const ROBOT: &str = "ur5";
/// Rows of a table.
const ROWS: usize = 6;
/// States on the straight line from start to goal.
const LINE: usize = 200;
/// States of a large question.
const BATCH: usize = 1024;
/// Its largest message in shared memory: some megabytes of it are everywhere, in a container, too.
#[cfg(feature = "shared-memory")]
const TOUR_BYTES: usize = 1 << 20;

/// Runs the tour against a daemon of its own.
///
/// # Errors
/// No free port, or output that cannot be written.
pub fn run(demo: &Demo, output: &mut dyn Write) -> Result<(), Failed> {
    let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build().map_err(Failed::failure)?;
    let ended = runtime.block_on(with_daemon(demo, output));
    runtime.shutdown_background();
    ended
}

async fn with_daemon(demo: &Demo, output: &mut dyn Write) -> Result<(), Failed> {
    let grpc = GrpcSettings { address: Some("127.0.0.1:0".to_owned()), ..GrpcSettings::default() };
    // A name and a folder of its own: those of the defaults stay with the daemon that serves. What is made first goes last.
    #[cfg(feature = "shared-memory")]
    let own = OwnName::new("demo");
    let folder = Folder::new()?;
    #[allow(unused_mut, reason = "there may be one door alone")]
    let mut config = Settings { grpc, ..Settings::default() }.resolve().map_err(Failed::failure)?;
    #[cfg(feature = "shared-memory")]
    {
        // A tour without it is better than none.
        let limits = &mut config.service.limits;
        limits.max_shared_memory_clients = 1;
        limits.max_shared_memory_request_bytes = TOUR_BYTES;
        limits.max_shared_memory_response_bytes = TOUR_BYTES;
        let (name, root) = (own.name().to_owned(), folder.path().to_owned());
        config.shared_memory = DoorChoice::IfPossible(shared_memory::Config { name, root, spin: Duration::ZERO });
    }
    #[cfg(feature = "zenoh")]
    {
        config.zenoh = DoorChoice::On(zenoh_door::Config::on_loopback(ZENOH_PREFIX));
    }
    let daemon = Daemon::build(&config).await.map_err(Failed::failure)?;
    let doors = Doors { open: daemon.doors(), folder: folder.path().to_owned() };
    let grpc = doors.open.iter().find(|door| door.kind == "grpc");
    let address = grpc.ok_or_else(|| Failed::failure("the daemon has no gRPC door"))?.address.clone();
    let (stop, told_to_stop) = oneshot::channel::<()>();
    let serving = tokio::spawn(daemon.run(async { told_to_stop.await.unwrap_or_default() }));

    let client = Client::connect(&address).await.map_err(Failed::daemon)?;
    let mut tour = Tour { client, doors, output, json: demo.json };
    tour.daemon(&address).await?;
    tour.visit_all().await?;
    if demo.keep {
        tour.stay(&address).await?;
    }
    // A daemon that ended before it was told to says why below.
    let _ = stop.send(());
    serving.await.map_err(Failed::failure)?.map_err(Failed::failure)?;
    Ok(())
}

struct Tour<'a> {
    client: Client,
    doors: Doors,
    output: &'a mut dyn Write,
    json: bool,
}

/// A scene that was built, with its states in the file's order.
struct Place {
    title: &'static str,
    name: String,
    revision: Revision,
    cast: Cast,
    states: Vec<(String, Vec<f64>)>,
}

impl Tour<'_> {
    /// A line for people, or an object for programs.
    fn say(&mut self, line: &str, object: &Value) -> Result<(), Failed> {
        let written = if self.json { writeln!(self.output, "{object}") } else { writeln!(self.output, "{line}") };
        written.and_then(|()| self.output.flush()).map_err(|error| Failed::output(&error))
    }

    /// A line that programs do not need.
    fn tell(&mut self, line: &str) -> Result<(), Failed> {
        if self.json { Ok(()) } else { self.say(line, &Value::Null) }
    }

    async fn daemon(&mut self, address: &str) -> Result<(), Failed> {
        let server = self.client.server_info().await.map_err(Failed::daemon)?;
        let line = format!(
            "daemon     clearance {} listening on grpc {address}, {} threads for questions",
            server.version, server.threads
        );
        let object = json!({"step": "daemon", "version": server.version, "grpc": address, "threads": server.threads});
        self.say(&line, &object)
    }

    async fn visit_all(&mut self) -> Result<(), Failed> {
        let robot = self.upload_robot().await?;
        let (scenes, states) = sample::workload(robot.degrees_of_freedom).map_err(Failed::failure)?;
        let mut places = Vec::new();
        for (title, name) in sample::SCENES {
            let index = scenes.iter().position(|scene| scene.name == name);
            let index = index.ok_or_else(|| Failed::failure(format!("no scene {name} is built in")))?;
            places.push(self.build(title, &robot, &scenes[index], own_states(&states, index)).await?);
        }
        for place in &places {
            self.show_states(place).await?;
        }
        self.walk_straight(&places[1]).await?;
        self.edit(&places[0]).await?;
        self.compare_doors(&places[1]).await
    }

    async fn upload_robot(&mut self) -> Result<RemoteRobot, Failed> {
        let files = sample::robot();
        let mut meshes = BTreeMap::new();
        let mut bytes = 0;
        for (name, mesh) in &files.meshes {
            bytes += mesh.len();
            let hash: ContentHash = self.client.put_asset(mesh).await.map_err(Failed::daemon)?;
            meshes.insert(name.clone(), hash);
        }
        let options = ModelOptions::uniform(LinkOptions { mesh: MeshUse::Hull, ..LinkOptions::default() });
        let description = RobotDescription { urdf: files.urdf, srdf: files.srdf, meshes, options };
        let robot = self.client.load_robot(&description).await.map_err(Failed::daemon)?;
        let line = format!(
            "robot      {}: {} joints, {} links; {} meshes uploaded ({} kB), each used as its convex hull",
            robot.name,
            robot.degrees_of_freedom,
            robot.links.len(),
            files.meshes.len(),
            bytes / 1000
        );
        self.say(&line, &json!({"step": "robot", "name": robot.name, "joints": robot.joints, "mesh_bytes": bytes}))?;
        Ok(robot)
    }

    /// Makes a scene with one list of edits.
    async fn build(
        &mut self,
        title: &'static str,
        robot: &RemoteRobot,
        scene: &SceneEntry,
        states: Vec<(String, Vec<f64>)>,
    ) -> Result<Place, Failed> {
        self.client.create_scene(&scene.name).await.map_err(Failed::daemon)?;
        let arm = RemoteEdit::AddRobot { name: ROBOT.to_owned(), model: robot.id.clone(), base: Pose::identity() };
        let bodies = scene.objects.iter().map(|o| NewBody::new(o.name.clone(), o.shape.clone(), o.pose));
        let edits: Vec<RemoteEdit> = std::iter::once(arm).chain(bodies.map(RemoteEdit::AddBody)).collect();
        let applied = self.client.apply(&scene.name, &edits).await.map_err(Failed::daemon)?.applied;
        let names = scene.objects.iter().map(|object| object.name.clone());
        let cast = Cast { links: robot.links.clone(), bodies: applied.added.iter().copied().zip(names).collect() };
        let (revision, count) = (applied.revision, scene.objects.len());
        let line = format!("scene      {title} ({}): {count} objects, revision {revision}", scene.name);
        let object = json!({"step": "scene", "name": scene.name, "objects": count, "revision": revision.0});
        self.say(&line, &object)?;
        Ok(Place { title, name: scene.name.clone(), revision, cast, states })
    }

    async fn ask(
        &mut self,
        place: &Place,
        rule: Rule,
        positions: Vec<f64>,
        (wants, mode): (Wants, Mode),
    ) -> Result<Answer, Failed> {
        let target = Target { scene: place.name.clone(), revision: RevisionRule { epoch: None, rule } };
        let context = Context { wants, ..Context::default() };
        let question = CheckStates { robot: ROBOT.to_owned(), positions, mode, context };
        self.client.check_states(&target, &question).await.map_err(Failed::daemon)
    }

    fn state(&mut self, place: &Place, name: &str, item: &ItemAnswer, revision: Revision) -> Result<(), Failed> {
        let names = Names { links: &place.cast.links, bodies: &place.cast.bodies };
        let answer = AnswerLine::of_answer(&json!(name), item, revision, names);
        let object = json!({"step": "state", "scene": place.name, "answer": answer});
        self.say(&row(name, item, &place.cast), &object)
    }

    /// Verdicts, clearances with their brackets, the deciding pairs, and what they cost.
    async fn show_states(&mut self, place: &Place) -> Result<(), Failed> {
        let positions = place.states.iter().flat_map(|(_, q)| q).copied().collect();
        let answer = self.ask(place, Rule::Latest, positions, (Wants::ALL, Mode::All)).await?;
        self.tell(&format!("\n{} (revision {})\n{HEADINGS}", place.title, answer.revision))?;
        for ((name, _), item) in place.states.iter().zip(&answer.items).take(ROWS) {
            self.state(place, name, item, answer.revision)?;
        }
        let count = |verdict| answer.items.iter().filter(|item| item.verdict == verdict).count();
        let (free, hits) = (count(Verdict::Free), count(Verdict::Collision));
        let all = answer.items.len();
        let line = format!("  of {all} states {free} are free, {hits} collide, {} undecided", all - free - hits);
        self.say(
            &line,
            &json!({"step": "verdicts", "scene": place.name, "states": all, "free": free, "collision": hits}),
        )
    }

    /// The straight line through joint space, up to where it is first blocked.
    async fn walk_straight(&mut self, place: &Place) -> Result<(), Failed> {
        let [(_, start), (_, goal)] = &place.states[..2] else { return Ok(()) };
        let at = |i: usize| i as f64 / (LINE - 1) as f64;
        let state = |i: usize| start.iter().zip(goal).map(move |(s, g)| s + at(i) * (g - s));
        let positions = (0..LINE).flat_map(state).collect();
        let answer = self.ask(place, Rule::Latest, positions, (Wants::VERDICT, Mode::StopAtFirst)).await?;
        let object = json!({"step": "path", "scene": place.name, "states": LINE, "blocked_at": answer.stopped_at});
        let title = place.title;
        let line = match answer.stopped_at {
            None => format!("\npath       {title}: the straight line from start to goal is free at all {LINE} states"),
            Some(first) => {
                let pair = answer.items[first].nearest.as_ref().map_or_else(String::new, |p| place.cast.pair(p));
                let percent = 100.0 * at(first);
                format!("\npath       {title}: straight from start to goal, first blocked at {percent:.0} % by {pair}")
            }
        };
        self.say(&line, &object)
    }

    /// What an edit changes, and which revision contains it.
    async fn edit(&mut self, place: &Place) -> Result<(), Failed> {
        let (name, positions) = &place.states[1];
        let before = self.ask(place, Rule::Latest, positions.clone(), (Wants::ALL, Mode::All)).await?;
        let nearest = before.items[0].nearest_scene.as_ref();
        let (Some(pair), Some(witness)) = (nearest, nearest.and_then(|pair| pair.witness)) else {
            return Err(Failed::failure("the scene of the tour is empty"));
        };
        let Side::Body { id, .. } = pair.b else { return Err(Failed::failure("side B is not a body")) };
        let moved = place.cast.side(&pair.b);
        let pose = Pose::new(witness.point_on_a, Pose::identity().rotation()).map_err(Failed::failure)?;
        let edit = RemoteEdit::MoveBody { body: BodyRef::Id(id), pose };
        let revision = self.client.apply(&place.name, &[edit]).await.map_err(Failed::daemon)?.applied.revision;
        let line = format!("\nedit       {moved} is moved onto {}: revision {revision}", place.cast.side(&pair.a));
        self.say(&line, &json!({"step": "edit", "moved": moved, "revision": revision.0}))?;
        self.tell(HEADINGS)?;
        for rule in [Rule::AtLeast(revision), Rule::Exactly(place.revision)] {
            let answer = self.ask(place, rule, positions.clone(), (Wants::ALL, Mode::All)).await?;
            let item = &answer.items[0];
            self.state(place, name, item, answer.revision)?;
            let verdict = words::verdict(item.verdict);
            self.tell(&format!("             ^ {verdict} at revision {}", answer.revision))?;
        }
        Ok(())
    }

    /// The same states through every door: the answers are equal, and each door takes its time.
    async fn compare_doors(&mut self, place: &Place) -> Result<(), Failed> {
        let target = Target { scene: place.name.clone(), ..Target::default() };
        let width = place.states.first().map_or(0, |(_, positions)| positions.len());
        self.tell("")?;
        for items in [1, BATCH] {
            let cycle = place.states.iter().map(|(_, q)| q).cycle();
            let positions: Vec<f64> = cycle.take(items).flatten().copied().collect();
            let context = Context { wants: Wants::VERDICT, ..Context::default() };
            let question = CheckStates { robot: ROBOT.to_owned(), positions, mode: Mode::All, context };
            let through = self.doors.ask(&Asked { target: &target, question: &question, width }).await?;
            for one in &through {
                let microseconds = one.median * 1e6;
                let line = format!(
                    "door       {:<14} {items:>5} states {microseconds:>8.0} us, {:>7.0} states a second",
                    one.door,
                    items as f64 / one.median
                );
                let object = json!({"step": "door", "door": one.door, "states": items, "microseconds": microseconds});
                self.say(&line, &object)?;
            }
            let equal = through.iter().all(|one| one.free == through[0].free && one.free.len() == items);
            if !equal {
                return Err(Failed::failure("the doors answer differently"));
            }
            let free = through.first().map_or(0, |one| one.free.iter().filter(|free| **free).count());
            let line = format!("           the {} doors agree: {free} of {items} free", through.len());
            self.say(&line, &json!({"step": "doors", "doors": through.len(), "states": items, "free": free}))?;
        }
        Ok(())
    }

    /// Waits for Ctrl-C or SIGTERM.
    async fn stay(&mut self, address: &str) -> Result<(), Failed> {
        let stop = stop_signal().map_err(Failed::failure)?;
        let (_, scene) = sample::SCENES[0];
        let line = format!(
            "\nThe daemon stays up; Ctrl-C ends it. From Python, after `pip install ./clients/python`:\n
    import clearance
    scene = clearance.Client(\"{address}\").scene(\"{scene}\")
    answer = scene.check_states(\"{ROBOT}\", [[1.57, -1.57, 0.0, -1.57, -1.57, 3.14]])
    print(answer.verdicts, answer.lower, answer.upper)"
        );
        self.say(&line, &json!({"step": "staying", "grpc": address}))?;
        stop.await;
        Ok(())
    }
}

/// The states of one scene, named by their kind: `start`, `goal`, `line 1` and so on.
fn own_states(states: &[StateLine], scene: usize) -> Vec<(String, Vec<f64>)> {
    let own = states.iter().filter_map(|line| line.state.as_ref().ok()).filter(|state| state.scene == scene);
    let name = |i: usize| match i {
        0 => "start".to_owned(),
        1 => "goal".to_owned(),
        _ => format!("state {i}"),
    };
    own.enumerate().map(|(i, state)| (name(i), state.positions.clone())).collect()
}
