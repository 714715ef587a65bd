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
use crate::service::{ContentHash, RobotDescription, Service, ServiceError, Target};
use crate::transports::requests;
use crate::transports::wire::{to_proto, v1};

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
    pub message: v1::CheckStatesRequest,
}

impl Workload {
    /// A UR5 with a gripper before a shelf, as a planner asks about it.
    pub async fn planner(service: &Arc<Service>) -> Result<Self, Failed> {
        let files = sample::robot();
        let mut meshes = BTreeMap::new();
        for (name, mesh) in &files.meshes {
            let hash = ContentHash::of(mesh);
            let mut upload = service.begin_upload(hash, mesh.len() as u64).map_err(Failed::failure)?;
            upload.push(mesh).map_err(Failed::failure)?;
            service.finish_upload(upload).await.map_err(Failed::failure)?;
            meshes.insert(name.clone(), hash);
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
        Self::with(service, name, description, objects.collect(), states).await.map_err(Failed::failure)
    }

    /// A robot of which next to nothing has to be looked at.
    pub async fn probe(service: &Arc<Service>) -> Result<Self, Failed> {
        let description = RobotDescription {
            urdf: PROBE.to_owned(),
            srdf: None,
            meshes: BTreeMap::new(),
            options: ModelOptions::default(),
        };
        let shape = Shape::cuboid(Vec3::new(0.2, 0.2, 0.2)).map_err(Failed::failure)?;
        let pose = Pose::new(Vec3::new(0.6, 0.0, 0.6), Quaternion::IDENTITY).map_err(Failed::failure)?;
        let states = (0..PROBE_STATES).map(|i| (0..6).map(|joint| libm::sin((i * 6 + joint) as f64)).collect());
        let block = vec![NewBody::new("block", Arc::new(shape), pose)];
        Self::with(service, "probe", description, block, states.collect()).await.map_err(Failed::failure)
    }

    async fn with(
        service: &Arc<Service>,
        scene: &str,
        description: RobotDescription,
        bodies: Vec<NewBody>,
        states: Vec<Vec<f64>>,
    ) -> Result<Self, ServiceError> {
        let robot = service.load_robot(move || Ok(description)).await?;
        let create = v1::CreateSceneRequest { name: scene.to_owned(), ..v1::CreateSceneRequest::default() };
        requests::create_scene(service, &create)?;
        let arm = v1::AddRobot {
            name: ROBOT.to_owned(),
            model: robot.id.to_string(),
            base: Some(to_proto::pose(&Pose::identity())),
            ..v1::AddRobot::default()
        };
        let bodies = bodies.iter().map(|body| v1::edit::Kind::AddBody(to_proto::add_body(body)));
        let edits = std::iter::once(v1::edit::Kind::AddRobot(arm)).chain(bodies);
        let edits = edits.map(|kind| v1::Edit { kind: Some(kind) }).collect();
        let apply = v1::ApplyRequest { scene: scene.to_owned(), edits, ..v1::ApplyRequest::default() };
        requests::apply(service, apply, None).await?;
        Ok(Self { target: Target { scene: scene.to_owned(), ..Target::default() }, states })
    }

    /// So many states, those of the workload over and over.
    pub fn batch(&self, items: usize) -> Batch {
        let width = self.states.first().map_or(0, Vec::len);
        let positions = self.states.iter().cycle().take(items).flatten().copied().collect();
        let context = Context { wants: Wants::VERDICT, ..Context::default() };
        let question = CheckStates { robot: ROBOT.to_owned(), positions, mode: Mode::All, context };
        let mut message = to_proto::check_states_request(&self.target, &question);
        if let Some(context) = &mut message.context {
            context.answer_form = v1::AnswerForm::Bulk.into();
        }
        Batch { items, target: self.target.clone(), question: Arc::new(question), width, message }
    }
}
