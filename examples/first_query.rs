//! A robot in a cell: which of its states are free, how near is the nearest, and what does the daemon say of a mistake?
//!
//! ```text
//! clearance serve &
//! cargo run --example first_query -- [ADDRESS [FOLDER]]
//! ```
//!
//! FOLDER holds a robot's `ur5.urdf`, `ur5.srdf` and meshes. The examples of all clients print the same text.

use std::collections::BTreeMap;
use std::error::Error;
use std::fs::read_to_string;
use std::io::{Write, stdout};
use std::path::Path;
use std::sync::Arc;

use clearance::geometry::{Pose, Quaternion, Shape, Vec3};
use clearance::query::{CheckStates, Context, Mode, PairQuery, Side, Subject, Verdict, Wants};
use clearance::robot::{LinkOptions, MeshUse, ModelOptions, mesh_files};
use clearance::scene::{BodyId, BodyRef, NewBody, Revision};
use clearance::service::{RevisionRule, RobotDescription, Rule, Target};
use clearance::transports::grpc::{Client, RemoteEdit, RemoteRobot};
use clearance::transports::wire::v1;

/// Joint positions, radians.
#[allow(clippy::approx_constant, reason = "as people write them down")]
const STATES: [[f64; 6]; 3] = [
    [-1.6, -0.6, 0.0, -1.57, -1.57, 3.14],
    [-1.2, -0.6, 0.0, -1.57, -1.57, 3.14],
    [0.4, -0.3, 0.2, -1.57, -1.57, 3.14],
];

type Outcome<T> = Result<T, Box<dyn Error>>;

#[tokio::main]
async fn main() -> Outcome<()> {
    let mut arguments = std::env::args().skip(1);
    let address = arguments.next().unwrap_or_else(|| "127.0.0.1:50551".to_owned());
    let folder = arguments.next().unwrap_or_else(|| "tests/data/robot-ur5".to_owned());
    run(&address, Path::new(&folder), &mut stdout()).await
}

/// Asks the daemon at `address`, and prints.
pub async fn run(address: &str, folder: &Path, out: &mut impl Write) -> Outcome<()> {
    let client = Client::connect(address).await?;
    let robot = load(&client, folder).await?;
    writeln!(out, "robot {}: {} numbers a state, {} links", robot.name, robot.degrees_of_freedom, robot.links.len())?;
    let scene = format!("first query {}", std::process::id());
    client.create_scene(&scene).await?;
    let asked = ask(&client, &scene, &robot, out).await;
    client.delete_scene(&scene).await?;
    asked
}

/// Uploads the meshes that the daemon does not have, and loads the robot.
async fn load(client: &Client, folder: &Path) -> Outcome<RemoteRobot> {
    let urdf = read_to_string(folder.join("ur5.urdf"))?;
    let mut meshes = BTreeMap::new();
    for name in mesh_files(&urdf)? {
        let file = std::fs::read(folder.join(name.trim_start_matches("package://ur5/")))?;
        meshes.insert(name, client.put_asset(&file).await?);
    }
    let options = ModelOptions::uniform(LinkOptions { mesh: MeshUse::Hull, ..LinkOptions::default() });
    let srdf = Some(read_to_string(folder.join("ur5.srdf"))?);
    Ok(client.load_robot(&RobotDescription { urdf, srdf, meshes, options }).await?)
}

async fn ask(client: &Client, scene: &str, robot: &RemoteRobot, out: &mut impl Write) -> Outcome<()> {
    let at = |x, y, z| Pose::new(Vec3::new(x, y, z), Quaternion::IDENTITY);
    let ball = Pose::new(Vec3::new(0.2, 0.8, 1.3), Quaternion { w: 0.8, x: 0.2, y: 0.4, z: 0.4 })?;
    let body = |name: &str, shape, pose| RemoteEdit::AddBody(NewBody::new(name, Arc::new(shape), pose));
    let edits = [
        RemoteEdit::AddRobot { name: "arm".to_owned(), model: robot.id.clone(), base: Pose::identity() },
        body("table", Shape::cuboid(Vec3::new(1.0, 1.0, 0.02))?, at(0.0, 0.0, 0.7)?),
        body("post", Shape::capsule(0.05, 0.3)?, at(0.5, 0.3, 1.2)?),
        body("ball", Shape::ellipsoid(Vec3::new(0.3, 0.2, 0.1))?, ball),
    ];
    let applied = client.apply(scene, &edits).await?.applied;
    let names: BTreeMap<BodyId, &str> = applied.added.iter().copied().zip(["table", "post", "ball"]).collect();
    let name = |side: &Side| match *side {
        Side::Link { link, .. } => robot.links[link as usize].as_str(),
        Side::Body { id, .. } => names[&id],
        Side::Query { .. } => "the question's shape",
    };
    writeln!(out, "the scene is at revision {}", applied.revision.0)?;
    let from = |revision: Revision| Target {
        scene: scene.to_owned(),
        revision: RevisionRule { epoch: None, rule: Rule::AtLeast(revision) },
    };
    let target = from(applied.revision);

    // A batch of states: verdicts and proved brackets.
    let wants = Wants { distance: true, depth: true, pairs: true, ..Wants::VERDICT };
    let states = CheckStates {
        robot: "arm".to_owned(),
        positions: STATES.concat(),
        mode: Mode::All,
        context: Context { wants, ..Context::default() },
    };
    let answer = client.check_states(&target, &states).await?;
    for (i, state) in answer.items.iter().enumerate() {
        let nearest = state.nearest_scene.as_ref().ok_or("the scene has bodies")?.bracket;
        let nearest = bracket(nearest.lower, nearest.upper);
        writeln!(out, "state {i}: {}, to the scene {nearest}", word(state.verdict))?;
    }
    writeln!(out, "{} are free", answer.items.iter().filter(|state| state.verdict == Verdict::Free).count())?;
    for pair in &answer.items[1].pairs {
        writeln!(out, "state 1: {} and {}, {}", name(&pair.a), name(&pair.b), word(pair.verdict))?;
    }

    // Bodies.
    let wants = Wants { distance: true, depth: true, witness: true, ..Wants::VERDICT };
    let of_ball = |wants| PairQuery {
        items: vec![Subject::Body(applied.added[2])],
        mode: Mode::All,
        context: Context { wants, ..Context::default() },
    };
    let answer = client.distance(&target, &of_ball(wants)).await?;
    let pair = answer.items[0].nearest.as_ref().ok_or("the scene has other bodies")?;
    let witness = pair.witness.as_ref().ok_or("a witness was wanted")?;
    writeln!(out, "{} and {}: {}", name(&pair.a), name(&pair.b), bracket(pair.bracket.lower, pair.bracket.upper))?;
    writeln!(out, "from {} to {}", point(witness.point_on_a), point(witness.point_on_b))?;

    // An edit, and a question that sees it.
    let named = |name: &str| BodyRef::Name(name.to_owned());
    let moved = RemoteEdit::MoveBody { body: named("ball"), pose: at(0.5, 0.3, 1.6)? };
    let revision = client.apply(scene, &[moved]).await?.applied.revision;
    let answer = client.collide(&from(revision), &of_ball(Wants::VERDICT)).await?;
    let pairs: Vec<String> =
        answer.items[0].pairs.iter().map(|pair| format!("{} and {}", name(&pair.a), name(&pair.b))).collect();
    writeln!(out, "at revision {} {}: {}", revision.0, word(answer.items[0].verdict), pairs.join(", "))?;

    // The library itself makes no such box; a message may say anything.
    let half_extents = Some(v1::Vec3 { x: 1.0, y: -1.0, z: 0.1 });
    let core = Some(v1::shape::Core::Box(v1::Box { half_extents }));
    let flag = v1::AddBody {
        name: "flag".to_owned(),
        shape: Some(v1::Shape { core, ..v1::Shape::default() }),
        ..v1::AddBody::default()
    };
    let mistake = [
        RemoteEdit::MoveBody { body: named("table"), pose: at(0.0, 0.0, 0.6)? },
        RemoteEdit::Message(v1::Edit { kind: Some(v1::edit::Kind::AddBody(flag)) }),
    ];
    let Err(error) = client.apply(scene, &mistake).await else { return Err("a negative box was taken".into()) };
    let Some(refusal) = error.refusal() else { return Err(error.into()) };
    let (item, field) = (refusal.item.unwrap_or_default(), refusal.field.as_deref().unwrap_or_default());
    writeln!(out, "refused: {}, item {item}, field {field}", refusal.reason)?;
    Ok(())
}

fn word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Free => "FREE",
        Verdict::Margin => "MARGIN",
        Verdict::Collision => "COLLISION",
        Verdict::Indeterminate(_) => "INDETERMINATE",
        Verdict::NotRun => "NOT_RUN",
        Verdict::InvalidInput => "INVALID_INPUT",
    }
}

/// Enough digits to see both ends; adding zero takes the sign off zero.
fn bracket(lower: f64, upper: f64) -> String {
    format!("[{:.17}, {:.17}] m", lower + 0.0, upper + 0.0)
}

fn point(p: Vec3) -> String {
    format!("({:.9}, {:.9}, {:.9})", p.x + 0.0, p.y + 0.0, p.z + 0.0)
}
