//! What is asked: robot states against a scene. A planner's for the throughput; for what a door costs beside its work, a robot
//! of which next to nothing has to be looked at, so that the work does not drown the cost.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::super::exit_code::Failed;
use super::super::sample;
use crate::geometry::{Pose, Quaternion, Shape, Vec3};
use crate::query::{CheckStates, Context, Mode, Wants};
use crate::robot::{LinkOptions, MeshUse, ModelOptions};
use crate::scene::NewBody;
use crate::service::{RobotDescription, Target};
use crate::transports::grpc::{BulkStates, Client, ClientError, RemoteEdit};

/// The robot's name in every scene.
const ROBOT: &str = "arm";
/// Which of the tour's scenes a planner asks about.
const SHELF: usize = 1;
/// States of the probe, over and over.
const PROBE_STATES: usize = 997;

/// An arm with six joints that has a shape at its wrist alone.
const PROBE: &str = r#"<robot name="probe">
  <link name="base"/><link name="l1"/><link name="l2"/><link name="l3"/><link name="l4"/><link name="l5"/>
  <link name="wrist"><collision><geometry><sphere radius="0.05"/></geometry></collision></link>
  <joint name="j1" type="continuous"><parent link="base"/><child link="l1"/><axis xyz="0 0 1"/></joint>
  <joint name="j2" type="continuous"><parent link="l1"/><child link="l2"/><origin xyz="0 0 0.3"/><axis xyz="0 1 0"/></joint>
  <joint name="j3" type="continuous"><parent link="l2"/><child link="l3"/><origin xyz="0 0 0.4"/><axis xyz="0 1 0"/></joint>
  <joint name="j4" type="continuous"><parent link="l3"/><child link="l4"/><origin xyz="0 0 0.4"/><axis xyz="0 1 0"/></joint>
  <joint name="j5" type="continuous"><parent link="l4"/><child link="l5"/><origin xyz="0 0 0.1"/><axis xyz="0 0 1"/></joint>
  <joint name="j6" type="continuous"><parent link="l5"/><child link="wrist"/><origin xyz="0 0 0.1"/><axis xyz="0 1 0"/></joint>
</robot>"#;

/// A scene that is there, and states to ask it about.
#[derive(Debug)]
pub(super) struct Workload {
    target: Target,
    states: Vec<Vec<f64>>,
}

/// One question, in the form that each way of asking takes.
#[derive(Clone, Debug)]
pub(super) struct Batch {
    /// How many states.
    pub items: usize,
    /// Which scene.
    pub target: Target,
    /// As the library takes it.
    pub question: Arc<CheckStates>,
    /// Numbers of one state.
    pub width: usize,
    /// As gRPC and zenoh take it, positions and answer in bulk.
    pub message: BulkStates,
}

impl Workload {
    /// A UR5 with a gripper before a shelf, as a planner asks about it.
    pub async fn planner(client: &Client) -> Result<Self, Failed> {
        let files = sample::robot();
        let mut meshes = BTreeMap::new();
        for (name, mesh) in &files.meshes {
            meshes.insert(name.clone(), client.put_asset(mesh).await.map_err(Failed::daemon)?);
        }
        let options = ModelOptions::uniform(LinkOptions { mesh: MeshUse::Hull, ..LinkOptions::default() });
        let description = RobotDescription { urdf: files.urdf, srdf: files.srdf, meshes, options };
        let (_, name) = sample::SCENES[SHELF];
        let joints = 6;
        let (scenes, states) = sample::workload(joints).map_err(Failed::failure)?;
        let index = scenes.iter().position(|scene| scene.name == name);
        let index = index.ok_or_else(|| Failed::failure("the scene is not built in"))?;
        let objects = scenes[index].objects.iter().map(|o| NewBody::new(o.name.clone(), o.shape.clone(), o.pose));
        let own = states.into_iter().filter_map(|line| line.state.ok()).filter(|state| state.scene == index);
        let states = own.map(|state| state.positions).collect();
        Self::with(client, name, &description, objects.collect(), states).await.map_err(Failed::daemon)
    }

    /// A robot of which next to nothing has to be looked at.
    pub async fn probe(client: &Client) -> Result<Self, Failed> {
        let description = RobotDescription {
            urdf: PROBE.to_owned(),
            srdf: None,
            meshes: BTreeMap::new(),
            options: ModelOptions::default(),
        };
        let shape = Shape::cuboid(Vec3::new(0.2, 0.2, 0.2)).map_err(Failed::failure)?;
        let pose = Pose::new(Vec3::new(0.6, 0.0, 0.6), Quaternion::IDENTITY).map_err(Failed::failure)?;
        // Positions from -3 to 3 radians that follow no pattern.
        let position = |number: usize| ((number * 7919) % 6007) as f64 / 1000.0 - 3.0;
        let states = (0..PROBE_STATES).map(|i| (0..6).map(|joint| position(i * 6 + joint)).collect());
        let block = vec![NewBody::new("block", Arc::new(shape), pose)];
        Self::with(client, "probe", &description, block, states.collect()).await.map_err(Failed::daemon)
    }

    async fn with(
        client: &Client,
        scene: &str,
        description: &RobotDescription,
        bodies: Vec<NewBody>,
        states: Vec<Vec<f64>>,
    ) -> Result<Self, ClientError> {
        let model = client.load_robot(description).await?.id;
        client.create_scene(scene).await?;
        let arm = RemoteEdit::AddRobot { name: ROBOT.to_owned(), model, base: Pose::identity() };
        let edits: Vec<RemoteEdit> = std::iter::once(arm).chain(bodies.into_iter().map(RemoteEdit::AddBody)).collect();
        client.apply(scene, &edits).await?;
        Ok(Self { target: Target { scene: scene.to_owned(), ..Target::default() }, states })
    }

    /// So many states, those of the workload over and over.
    pub fn batch(&self, items: usize) -> Batch {
        let width = self.states.first().map_or(0, Vec::len);
        let positions = self.states.iter().cycle().take(items).flatten().copied().collect();
        let context = Context { wants: Wants::VERDICT, ..Context::default() };
        let question = CheckStates { robot: ROBOT.to_owned(), positions, mode: Mode::All, context };
        let message = BulkStates::new(&self.target, &question);
        Batch { items, target: self.target.clone(), question: Arc::new(question), width, message }
    }
}
