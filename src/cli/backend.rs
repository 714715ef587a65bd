//! Who answers: the service in this process, or a daemon? Both are asked in the same words.

use std::sync::Arc;

use super::daemon_flags::DaemonFlags;
use super::exit_code::Failed;
use super::robot_files::RobotFiles;
use crate::geometry::Pose;
use crate::query::{Answer, CheckStates};
use crate::robot::{LinkOptions, MeshUse, ModelOptions};
use crate::scene::{BodyId, Edit, Effects, NewBody, Party, Revision, SceneOptions};
use crate::service::{self, Change, ContentHash, Patience, RobotDescription, Service, ServiceError, Target};
#[cfg(feature = "grpc")]
use crate::transports::grpc::{Client, RemoteEdit};

/// One that answers.
pub enum Backend {
    /// In this process.
    Library(Arc<Service>),
    /// Over the network.
    #[cfg(feature = "grpc")]
    Daemon(Client),
}

/// A robot that the backend has loaded.
#[derive(Clone, Debug)]
pub struct LoadedModel {
    /// Names it in the backend.
    pub id: String,
    /// Names of its links, in the order of the indices in answers.
    pub links: Vec<String>,
    /// How many numbers a state has.
    pub degrees_of_freedom: usize,
}

/// A scene that was made.
#[derive(Clone, Debug)]
pub struct MadeScene {
    /// The revision with everything in it.
    pub revision: Revision,
    /// The ids of its bodies, in their order.
    pub bodies: Vec<BodyId>,
}

impl Backend {
    /// A service of our own, with default limits.
    ///
    /// # Errors
    /// The system gives no threads.
    pub fn library() -> Result<Self, Failed> {
        Service::new(&service::Config::default()).map(Self::Library).map_err(Failed::failure)
    }

    /// The daemon at `address`, for example `http://127.0.0.1:50551`, which is shown what `flags` name.
    ///
    /// # Errors
    /// A file cannot be read, nobody listens there, or this program was built without gRPC.
    #[cfg(feature = "grpc")]
    pub async fn daemon(address: &str, flags: &DaemonFlags) -> Result<Self, Failed> {
        let credentials = flags.credentials()?;
        Client::connect_as(address, &credentials).await.map(Self::Daemon).map_err(Failed::daemon)
    }

    /// # Errors
    /// This program was built without gRPC.
    #[cfg(not(feature = "grpc"))]
    pub async fn daemon(address: &str, _flags: &DaemonFlags) -> Result<Self, Failed> {
        Err(Failed::daemon(format!("{address}: this program was built without the feature grpc")))
    }

    /// Uploads what the daemon does not have, and loads the robot.
    ///
    /// # Errors
    /// The description makes no robot, or a limit is in the way.
    pub async fn load_robot(&mut self, files: &RobotFiles, mesh: MeshUse) -> Result<LoadedModel, Failed> {
        let hashes = files.meshes.iter().map(|(name, bytes)| (name.clone(), ContentHash::of(bytes)));
        let description = RobotDescription {
            urdf: files.urdf.clone(),
            srdf: files.srdf.clone(),
            meshes: hashes.collect(),
            options: ModelOptions::uniform(LinkOptions { mesh, ..LinkOptions::default() }),
        };
        match self {
            Self::Library(service) => {
                for bytes in files.meshes.values() {
                    put(service, bytes).await.map_err(Failed::failure)?;
                }
                let loaded = service.load_robot(move || Ok(description)).await.map_err(Failed::input)?;
                Ok(LoadedModel {
                    id: loaded.id,
                    links: loaded.model.links().iter().map(|link| link.name.clone()).collect(),
                    degrees_of_freedom: loaded.model.degrees_of_freedom(),
                })
            }
            #[cfg(feature = "grpc")]
            Self::Daemon(client) => {
                for bytes in files.meshes.values() {
                    client.put_asset(bytes).await.map_err(Failed::daemon)?;
                }
                let model = client.load_robot(&description).await.map_err(Failed::daemon)?;
                Ok(LoadedModel { id: model.id, links: model.links, degrees_of_freedom: model.degrees_of_freedom })
            }
        }
    }

    /// A new scene with a robot at the origin and bodies around it, and what may be asked of pairs: one edit list, one revision.
    ///
    /// # Errors
    /// The scene cannot be, for example two bodies of one name.
    pub async fn make_scene(
        &mut self,
        name: &str,
        (robot, model): (&str, &LoadedModel),
        bodies: Vec<NewBody>,
        declared: Vec<(Party, Party, Effects)>,
    ) -> Result<MadeScene, Failed> {
        match self {
            Self::Library(service) => {
                service.create_scene(name, &SceneOptions::default()).map_err(Failed::failure)?;
                let model = service.robots().get(&model.id).map_err(Failed::failure)?.model;
                let robot = Edit::AddRobot { name: robot.to_owned(), model, base: Pose::identity() };
                let declare = |(a, b, effects)| Edit::DeclareEffects { a, b, effects: Some(effects) };
                let edits = std::iter::once(robot).chain(bodies.into_iter().map(Edit::AddBody));
                let edits = edits.chain(declared.into_iter().map(declare)).collect();
                let change = Change { edits, ..Change::default() };
                let applied =
                    service.apply(name, Patience::default(), move || Ok(change)).await.map_err(Failed::input)?.applied;
                Ok(MadeScene { revision: applied.revision, bodies: applied.added })
            }
            #[cfg(feature = "grpc")]
            Self::Daemon(client) => {
                client.create_scene(name).await.map_err(Failed::daemon)?;
                let (robot, model) = (robot.to_owned(), model.id.clone());
                let robot = RemoteEdit::AddRobot { name: robot, model, base: Pose::identity() };
                let declare = |(a, b, effects)| RemoteEdit::DeclareEffects { a, b, effects: Some(effects) };
                let edits = std::iter::once(robot).chain(bodies.into_iter().map(RemoteEdit::AddBody));
                let edits: Vec<RemoteEdit> = edits.chain(declared.into_iter().map(declare)).collect();
                let applied = client.apply(name, &edits).await.map_err(Failed::daemon)?.applied;
                Ok(MadeScene { revision: applied.revision, bodies: applied.added })
            }
        }
    }

    /// Asks for states.
    ///
    /// # Errors
    /// The question is refused.
    pub async fn check_states(&mut self, target: &Target, question: CheckStates) -> Result<Answer, Failed> {
        match self {
            Self::Library(service) => service
                .ask(target, Patience::default(), move |view| view.check_states(&question))
                .await
                .map_err(Failed::failure),
            #[cfg(feature = "grpc")]
            Self::Daemon(client) => client.check_states(target, &question).await.map_err(Failed::daemon),
        }
    }

    /// The scene is not needed any more.
    ///
    /// # Errors
    /// It is not there.
    pub async fn delete_scene(&mut self, name: &str) -> Result<(), Failed> {
        match self {
            Self::Library(service) => service.delete_scene(name).map(drop).map_err(Failed::failure),
            #[cfg(feature = "grpc")]
            Self::Daemon(client) => client.delete_scene(name).await.map_err(Failed::daemon),
        }
    }
}

async fn put(service: &Arc<Service>, bytes: &[u8]) -> Result<(), ServiceError> {
    let mut upload = service.begin_upload(ContentHash::of(bytes), bytes.len() as u64)?;
    upload.push(bytes)?;
    service.finish_upload(upload).await.map(drop)
}
