//! `clearance study`: what accuracy costs on this machine, as a folder with a report and its numbers.

use std::collections::BTreeMap;
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use super::exit_code::Failed;
use super::sample;
use super::scene_file::SceneEntry;
use crate::robot::{LinkOptions, MeshRequest, MeshUse, ModelOptions, RobotModel};
use crate::scene::NewBody;
use crate::study::{Effort, NoStudy, Planner, PlannerScene, Progress, Study};

/// Flags of `clearance study`.
#[derive(clap::Args, Clone, Debug)]
pub struct StudyFlags {
    /// In under two minutes, with few pairs: tails are rough.
    #[arg(long)]
    pub quick: bool,
    /// The folder for `index.html` and the CSV files; made if it is not there.
    #[arg(long, value_name = "DIR", default_value = "study")]
    pub out: PathBuf,
    /// What `clearance bench transports --json` wrote, to show the doors, too.
    #[arg(long, value_name = "FILE")]
    pub doors: Option<PathBuf>,
    /// Figures of other libraries, as `benches/peers/compare --save` writes them; if not given,
    /// `benches/results/peers.csv` where there is one.
    #[arg(long, value_name = "FILE")]
    pub peers: Option<PathBuf>,
    /// Only this experiment, by the name of its CSV file, such as `distance`; may be given several times.
    #[arg(long, value_name = "NAME")]
    pub only: Vec<String>,
    /// Seconds that times are taken for, instead of those of the quick or full run.
    #[arg(long, value_name = "SECONDS", hide = true)]
    pub budget: Option<f64>,
}

const PEERS: &str = "benches/results/peers.csv";

/// Seconds. Rounds are many enough before the time is over in most experiments; pairs, truths and pieces are made beside that.
fn expected(effort: Effort) -> f64 {
    0.6 * effort.seconds + 10.0 + 60.0 * effort.part
}

/// Measures, and says where the report is.
///
/// # Errors
/// Files that cannot be read or written.
pub fn run(flags: &StudyFlags, output: &mut dyn Write) -> Result<(), Failed> {
    let effort = effort(flags)?;
    let peers = flags.peers.clone().or_else(|| Path::new(PEERS).is_file().then(|| PathBuf::from(PEERS)));
    let study = Study {
        effort,
        out: flags.out.clone(),
        doors: flags.doors.clone(),
        peers,
        planner: Arc::new(planner().map_err(Failed::failure)?),
        command: std::env::args().collect::<Vec<String>>().join(" "),
        only: flags.only.clone(),
    };
    let minutes = (expected(effort) / 60.0).ceil();
    eprintln!("clearance study: takes about {minutes:.0} min; leave the machine alone meanwhile");
    let bar = bar();
    let begun = Instant::now();
    let mut tell = |what: &str, part: f64| {
        bar.set_position((1000.0 * part) as u64);
        let left = Duration::from_secs_f64((expected(effort) - begun.elapsed().as_secs_f64()).max(0.0));
        bar.set_message(format!("{what}, about {} s left", left.as_secs()));
    };
    let made = study.run(&mut Progress { tell: &mut tell });
    bar.finish_and_clear();
    let page = made.map_err(|error| match error {
        NoStudy::File { .. } | NoStudy::Content { .. } | NoStudy::Unknown { .. } => Failed::input(error),
        NoStudy::Own(_) => Failed::failure(error),
    })?;
    writeln!(output, "{}", page.display()).map_err(|error| Failed::output(&error))
}

fn effort(flags: &StudyFlags) -> Result<Effort, Failed> {
    let effort = if flags.quick { Effort::QUICK } else { Effort::FULL };
    match flags.budget {
        None => Ok(effort),
        Some(seconds) if seconds > 0.0 && seconds.is_finite() => {
            Ok(Effort { seconds, part: effort.part * (seconds / effort.seconds).min(1.0) })
        }
        Some(_) => Err(Failed::input("--budget has to be positive")),
    }
}

/// Shown on a terminal only.
fn bar() -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("{bar:30} {msg}").unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(1000).with_style(style)
}

/// The robot that ships with the program, in its scenes; a shelf comes first.
fn planner() -> Result<Planner, String> {
    let files = sample::robot();
    let meshes: BTreeMap<String, Arc<[u8]>> =
        files.meshes.iter().map(|(name, bytes)| (name.clone(), Arc::from(bytes.as_slice()))).collect();
    let mut resolver = |request: &MeshRequest| {
        meshes.get(request.filename).cloned().ok_or_else(|| format!("{} is not built in", request.filename))
    };
    let options = ModelOptions::uniform(LinkOptions { mesh: MeshUse::Hull, ..LinkOptions::default() });
    let robot = RobotModel::from_urdf(&files.urdf, files.srdf.as_deref(), &mut resolver, &options)
        .map_err(|error| error.to_string())?;
    let (scenes, states) = sample::workload(robot.degrees_of_freedom())?;
    let mut of_scene: Vec<Vec<Vec<f64>>> = vec![Vec::new(); scenes.len()];
    states.into_iter().filter_map(|line| line.state.ok()).for_each(|state| of_scene[state.scene].push(state.positions));
    let bodies = |scene: &SceneEntry| {
        let body = |o: &super::scene_file::SceneObject| NewBody::new(o.name.clone(), Arc::clone(&o.shape), o.pose);
        scene.objects.iter().map(body).collect()
    };
    let mut scenes: Vec<PlannerScene> = scenes
        .iter()
        .zip(of_scene)
        .map(|(scene, states)| PlannerScene { name: scene.name.clone(), bodies: bodies(scene), states })
        .collect();
    scenes.sort_by_key(|scene| !scene.name.contains("shelf"));
    Ok(Planner { name: "UR5 with a gripper".to_owned(), robot: Arc::new(robot), scenes })
}
