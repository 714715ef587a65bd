//! `clearance states`: is a robot free in these states, how far is it from what, and which pair decides?
//!
//! Scenes are made one after the other, and all states of a scene are asked in batches; answers come out in the order of
//! the input. The library and a daemon give the same bytes.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::path::PathBuf;
use std::time::{SystemTime, UNIX_EPOCH};

use indicatif::ProgressBar;
use serde_json::Value;

use super::backend::{Backend, LoadedModel, MadeScene};
use super::daemon_flags::DaemonFlags;
use super::exit_code::Failed;
use super::robot_files::{Package, RobotFiles};
use super::scene_file::{SceneEntry, SceneObject, State, StateLine, read_scenes, read_states};
use super::state_line::{AnswerLine, Names};
use crate::query::{CheckStates, Context, Mode, Wants};
use crate::robot::MeshUse;
use crate::scene::{BodyId, NewBody, Revision};
use crate::service::{RevisionRule, Rule, Target};

/// Flags of `clearance states`.
#[derive(clap::Args, Clone, Debug)]
pub struct States {
    /// The robot's URDF.
    #[arg(long, value_name = "FILE")]
    pub robot: PathBuf,
    /// Its SRDF, which says which links may touch; without it only adjacent ones.
    #[arg(long, value_name = "FILE")]
    pub srdf: Option<PathBuf>,
    /// What the robot's meshes stand for: their surface as it is, or their convex hull.
    #[arg(long, value_enum, default_value = "exact")]
    pub mesh: MeshMode,
    /// Scenes: a JSON list of `{name, objects: [{name, shape, pose, groups}], effects}`.
    #[arg(long, value_name = "FILE")]
    pub scenes: PathBuf,
    /// Joint vectors: JSON lines `{id, scene, q}`.
    #[arg(long, value_name = "FILE")]
    pub states: PathBuf,
    /// The verdict alone, or also the distances.
    #[arg(long, value_enum, default_value = "distance")]
    pub want: Want,
    /// Where `package://NAME/...` is; a package that is not named is the URDF's folder. May be given again.
    #[arg(long = "package", value_name = "NAME=DIR")]
    pub packages: Vec<Package>,
    /// Who is asked.
    #[command(flatten)]
    pub daemon: DaemonFlags,
    /// Accepted like everywhere; the output is JSON lines with or without it.
    #[arg(long)]
    pub json: bool,
}

/// `--mesh`.
#[derive(clap::ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshMode {
    /// The surface as it is.
    Exact,
    /// The convex hull of the vertices.
    Hull,
    /// A few convex hulls that together are nearly the mesh.
    Decompose,
}

/// `--want`.
#[derive(clap::ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum Want {
    /// The verdict alone.
    Verdict,
    /// Distances, and depths where bodies overlap.
    Distance,
}

/// States asked in one question.
const BATCH: usize = 1024;

/// Answers every state of the input in order, one line each.
///
/// # Errors
/// A file that makes no sense, a daemon that cannot be reached or refuses, output that cannot be written. A bad line among
/// the states is no error, but a line that says so.
pub fn run(states: &States, output: &mut dyn Write) -> Result<(), Failed> {
    let runtime = tokio::runtime::Builder::new_multi_thread().worker_threads(2).enable_all().build();
    runtime.map_err(Failed::failure)?.block_on(answer_all(states, output))
}

async fn answer_all(states: &States, output: &mut dyn Write) -> Result<(), Failed> {
    let files = RobotFiles::read(&states.robot, states.srdf.as_deref(), &states.packages).map_err(Failed::input)?;
    let scenes = read_scenes(&states.scenes).map_err(Failed::input)?;
    let mut backend = match &states.daemon.server {
        Some(address) => Backend::daemon(address, &states.daemon).await?,
        None => Backend::library()?,
    };
    let mesh = match states.mesh {
        MeshMode::Exact => MeshUse::Exact,
        MeshMode::Hull => MeshUse::Hull,
        MeshMode::Decompose => MeshUse::Decompose,
    };
    let model = backend.load_robot(&files, mesh).await?;
    let lines = read_states(&states.states, scenes.len(), model.degrees_of_freedom).map_err(Failed::input)?;

    let progress = ProgressBar::new(lines.len() as u64);
    let mut answers: Vec<Option<AnswerLine>> = lines
        .iter()
        .map(|line| line.state.as_ref().err().map(|message| AnswerLine::of_bad_line(&line.id, message)))
        .collect();
    let mut written = write_ready(&answers, output)?;
    for (scene, of_scene) in by_scene(&lines) {
        let stage = Stage::build(&mut backend, &model, &scenes[scene], scene).await?;
        let answered = stage.answer(&mut backend, &of_scene, states.want, &mut answers, &progress).await;
        // The scene goes even when a question failed; a daemon should not keep it.
        let deleted = backend.delete_scene(&stage.name).await;
        answered.and(deleted)?;
        written += write_ready(&answers[written..], output)?;
    }
    progress.finish_and_clear();
    Ok(())
}

/// Writes lines up to the first that is not answered yet; returns how many.
fn write_ready(answers: &[Option<AnswerLine>], output: &mut dyn Write) -> Result<usize, Failed> {
    let ready: Vec<&AnswerLine> = answers.iter().map_while(Option::as_ref).collect();
    for line in &ready {
        write_line(output, line).map_err(|error| Failed::output(&error))?;
    }
    output.flush().map_err(|error| Failed::output(&error))?;
    Ok(ready.len())
}

fn write_line(output: &mut dyn Write, line: &AnswerLine) -> io::Result<()> {
    serde_json::to_writer(&mut *output, line)?;
    output.write_all(b"\n")
}

/// A state and its place in the input.
struct Asked<'a> {
    place: usize,
    id: &'a Value,
    positions: &'a [f64],
}

/// The states of each scene, scenes in the order they first occur.
fn by_scene(lines: &[StateLine]) -> Vec<(usize, Vec<Asked<'_>>)> {
    let mut groups: Vec<(usize, Vec<Asked>)> = Vec::new();
    let mut group_of = BTreeMap::new();
    for (place, line) in lines.iter().enumerate() {
        let Ok(State { scene, positions }) = &line.state else { continue };
        let group = *group_of.entry(*scene).or_insert_with(|| {
            groups.push((*scene, Vec::new()));
            groups.len() - 1
        });
        groups[group].1.push(Asked { place, id: &line.id, positions });
    }
    groups
}

/// A scene with the robot in it, ready to be asked.
struct Stage<'a> {
    model: &'a LoadedModel,
    name: String,
    robot: String,
    revision: Revision,
    body_names: BTreeMap<BodyId, String>,
}

impl<'a> Stage<'a> {
    async fn build(
        backend: &mut Backend,
        model: &'a LoadedModel,
        scene: &SceneEntry,
        index: usize,
    ) -> Result<Self, Failed> {
        // Unique enough for a daemon that others use, too; it shows nowhere.
        let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_nanos();
        let name = format!("clearance states {} {now} {index}", std::process::id());
        let mut robot = "robot".to_owned();
        while scene.objects.iter().any(|object| object.name == robot) {
            robot.push('_');
        }
        let body = |object: &SceneObject| NewBody {
            groups: object.groups.clone(),
            ..NewBody::new(object.name.clone(), object.shape.clone(), object.pose)
        };
        let bodies = scene.objects.iter().map(body).collect();
        let declared = scene.effects.iter().map(|pair| {
            let [a, b] = &pair.between;
            (a.in_scene(&robot), b.in_scene(&robot), pair.effects)
        });
        let made = backend.make_scene(&name, (&robot, model), bodies, declared.collect()).await;
        let MadeScene { revision, bodies } = made.map_err(|mut failed| {
            failed.message = format!("scenes[{index}] ({}): {}", scene.name, failed.message);
            failed
        })?;
        let names = scene.objects.iter().map(|object| object.name.clone());
        Ok(Self { model, name, robot, revision, body_names: bodies.into_iter().zip(names).collect() })
    }

    async fn answer(
        &self,
        backend: &mut Backend,
        states: &[Asked<'_>],
        want: Want,
        answers: &mut [Option<AnswerLine>],
        progress: &ProgressBar,
    ) -> Result<(), Failed> {
        let revision = RevisionRule { epoch: None, rule: Rule::Exactly(self.revision) };
        let target = Target { scene: self.name.clone(), revision };
        let distance = want == Want::Distance;
        let wants = Wants { distance, depth: distance, ..Wants::VERDICT };
        let names = Names { links: &self.model.links, bodies: &self.body_names };
        for batch in states.chunks(BATCH) {
            let question = CheckStates {
                robot: self.robot.clone(),
                positions: batch.iter().flat_map(|asked| asked.positions).copied().collect(),
                mode: Mode::All,
                context: Context { wants, ..Context::default() },
            };
            let answer = backend.check_states(&target, question).await?;
            if answer.items.len() != batch.len() {
                let counts = format!("{} answers to {} states", answer.items.len(), batch.len());
                return Err(Failed::failure(counts));
            }
            for (asked, item) in batch.iter().zip(&answer.items) {
                let line = AnswerLine::of_answer(asked.id, item, answer.revision, names);
                answers[asked.place] = Some(line.leaving_out(&answer.coverage, names));
            }
            progress.inc(batch.len() as u64);
        }
        Ok(())
    }
}
