//! How does a Rust program ask a daemon? The generated clients behind the library's own words: plain structs in and out,
//! as if the service were in the same process.

use std::time::Duration;

use tonic::service::interceptor::InterceptedService;
use tonic::transport::{Channel, Endpoint};
use tonic::{Code, Status};

use super::credentials::{Bearer, Credentials};
use crate::geometry::Pose;
use crate::query::{Answer, CheckMotions, CheckStates, Clearance, Motions, PairQuery};
use crate::scene::{Applied, BodyId, BodyRef, Epoch, NewBody, Revision};
use crate::service::{Changed, ContentHash, RobotDescription, Target};
use crate::transports::wire::from_proto::NotAnAnswer;
use crate::transports::wire::v1::assets_client::AssetsClient;
use crate::transports::wire::v1::put_asset_request::Part;
use crate::transports::wire::v1::queries_client::QueriesClient;
use crate::transports::wire::v1::robots_client::RobotsClient;
use crate::transports::wire::v1::scenes_client::ScenesClient;
use crate::transports::wire::v1::server_client::ServerClient;
use crate::transports::wire::{from_proto, to_proto, v1};

/// Bytes of a file in one message of an upload.
const CHUNK: usize = 1 << 20;
/// How much the server may send before it has to wait, bytes.
pub(super) const WINDOW: u32 = 8 << 20;
/// Answers are as large as the daemon cares to send.
const LARGEST_ANSWER: usize = usize::MAX;
/// A daemon that does not take the connection by then is not there.
const CONNECT_TIMEOUT: Duration = Duration::from_secs(10);

/// Why a daemon gave no answer.
#[derive(Debug, thiserror::Error)]
pub enum ClientError {
    /// It cannot be reached.
    #[error("{address}: {source}")]
    Unreachable {
        /// As asked for.
        address: String,
        /// What the connection says.
        source: tonic::transport::Error,
    },
    /// The token cannot be sent.
    #[error("the token is not printable ASCII")]
    BadToken,
    /// It refused the request.
    #[error("{message} ({code:?})")]
    Refused {
        /// gRPC's code.
        code: Code,
        /// The reason for programs, as in `ErrorReason`; empty if the daemon gave none.
        reason: String,
        /// The reason for people.
        message: String,
    },
    /// It answered with something this version does not know.
    #[error(transparent)]
    NotAnAnswer(#[from] NotAnAnswer),
    /// It left out something that has to be there.
    #[error("the daemon's answer has no {0}")]
    Missing(&'static str),
}

impl From<Status> for ClientError {
    fn from(status: Status) -> Self {
        let reason = status.metadata().get("clearance-reason").and_then(|reason| reason.to_str().ok());
        Self::Refused {
            code: status.code(),
            reason: reason.unwrap_or_default().to_owned(),
            message: status.message().to_owned(),
        }
    }
}

/// A change of a scene, as far as a client needs it.
#[derive(Clone, Debug)]
pub enum RemoteEdit {
    /// A body enters the scene.
    AddBody(NewBody),
    /// A body is somewhere else from now on.
    MoveBody {
        /// Which.
        body: BodyRef,
        /// Its frame in the world, metres.
        pose: Pose,
    },
    /// A body leaves the scene.
    RemoveBody {
        /// Which.
        body: BodyRef,
    },
    /// A robot that was loaded before stands in the scene.
    AddRobot {
        /// Its name in the scene.
        name: String,
        /// The model's id.
        model: String,
        /// The root link's frame in the world, metres.
        base: Pose,
    },
}

/// What a client knows of a robot the daemon has loaded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RemoteRobot {
    /// The model's id.
    pub id: String,
    /// As in the URDF.
    pub name: String,
    /// Length of a vector of joint positions.
    pub degrees_of_freedom: usize,
    /// Names of the joints, in the order of a vector of joint positions.
    pub joints: Vec<String>,
    /// Names of the links, by the indices that answers use.
    pub links: Vec<String>,
}

/// What a daemon says of itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RemoteServer {
    /// Its version.
    pub version: String,
    /// Threads that answer questions.
    pub threads: usize,
}

/// A connection on which every call brings the token.
pub type Way = InterceptedService<Channel, Bearer>;

/// A connection to a daemon. Cloning shares it.
#[derive(Clone, Debug)]
pub struct Client {
    scenes: ScenesClient<Way>,
    assets: AssetsClient<Way>,
    robots: RobotsClient<Way>,
    queries: QueriesClient<Way>,
    server: ServerClient<Way>,
}

impl Client {
    /// Connects to `http://HOST:PORT`, `https://HOST:PORT`, `HOST:PORT` or `unix:PATH`, without showing anything.
    ///
    /// # Errors
    /// [`ClientError::Unreachable`].
    pub async fn connect(address: &str) -> Result<Self, ClientError> {
        Self::connect_as(address, &Credentials::default()).await
    }

    /// Connects with a token, a certificate, or whatever else the daemon wants to see. A bare `HOST:PORT` means TLS where
    /// `credentials` have anything of TLS.
    ///
    /// # Errors
    /// [`ClientError::Unreachable`], [`ClientError::BadToken`].
    pub async fn connect_as(address: &str, credentials: &Credentials) -> Result<Self, ClientError> {
        let unreachable = |source| ClientError::Unreachable { address: address.to_owned(), source };
        let scheme = if credentials.has_tls() { "https" } else { "http" };
        let has_scheme = address.contains("://") || address.starts_with("unix:");
        let url = if has_scheme { address.to_owned() } else { format!("{scheme}://{address}") };
        let encrypted = url.starts_with("https://");
        let endpoint = Endpoint::from_shared(url).map_err(unreachable)?;
        let mut endpoint = endpoint
            .connect_timeout(CONNECT_TIMEOUT)
            .tcp_nodelay(true)
            .initial_stream_window_size(WINDOW)
            .initial_connection_window_size(WINDOW);
        if encrypted {
            endpoint = endpoint.tls_config(credentials.tls()).map_err(unreachable)?;
        }
        let bearer = credentials.bearer().ok_or(ClientError::BadToken)?;
        let channel = InterceptedService::new(endpoint.connect().await.map_err(unreachable)?, bearer);
        Ok(Self {
            scenes: ScenesClient::new(channel.clone()),
            assets: AssetsClient::new(channel.clone()),
            robots: RobotsClient::new(channel.clone()).max_decoding_message_size(LARGEST_ANSWER),
            queries: QueriesClient::new(channel.clone()).max_decoding_message_size(LARGEST_ANSWER),
            server: ServerClient::new(channel),
        })
    }

    /// The generated client of scenes, for what has no method here. It is cheap to make, and brings the token.
    #[must_use]
    pub fn scenes(&self) -> ScenesClient<Way> {
        self.scenes.clone()
    }

    /// The generated client of assets.
    #[must_use]
    pub fn assets(&self) -> AssetsClient<Way> {
        self.assets.clone()
    }

    /// The generated client of robots.
    #[must_use]
    pub fn robots(&self) -> RobotsClient<Way> {
        self.robots.clone()
    }

    /// The generated client of questions.
    #[must_use]
    pub fn queries(&self) -> QueriesClient<Way> {
        self.queries.clone()
    }

    /// The generated client of the daemon itself.
    #[must_use]
    pub fn server(&self) -> ServerClient<Way> {
        self.server.clone()
    }

    /// Version and threads of the daemon.
    ///
    /// # Errors
    /// [`ClientError`].
    pub async fn server_info(&self) -> Result<RemoteServer, ClientError> {
        let info = self.server().get_server_info(v1::GetServerInfoRequest {}).await?.into_inner();
        Ok(RemoteServer { version: info.version, threads: info.threads as usize })
    }

    /// Uploads a file unless the daemon has it already.
    ///
    /// # Errors
    /// [`ClientError`].
    pub async fn put_asset(&self, file: &[u8]) -> Result<ContentHash, ClientError> {
        let hash = ContentHash::of(file);
        let sha256 = hash.to_string();
        let asked = v1::HasAssetsRequest { sha256: vec![sha256.clone()] };
        if self.assets().has_assets(asked).await?.into_inner().present == [true] {
            return Ok(hash);
        }
        let header = Part::Header(v1::AssetHeader { sha256, bytes: file.len() as u64 });
        let chunks = file.chunks(CHUNK).map(|chunk| Part::Chunk(chunk.to_vec().into()));
        let parts: Vec<v1::PutAssetRequest> =
            std::iter::once(header).chain(chunks).map(|part| v1::PutAssetRequest { part: Some(part) }).collect();
        self.assets().put_asset(tokio_stream::iter(parts)).await?;
        Ok(hash)
    }

    /// Loads a robot whose meshes were uploaded before.
    ///
    /// # Errors
    /// [`ClientError`].
    pub async fn load_robot(&self, description: &RobotDescription) -> Result<RemoteRobot, ClientError> {
        let request = to_proto::load_robot_request(description);
        let robot = self.robots().load_robot(request).await?.into_inner().robot.ok_or(ClientError::Missing("robot"))?;
        Ok(RemoteRobot {
            id: robot.id,
            name: robot.name,
            degrees_of_freedom: robot.degrees_of_freedom as usize,
            joints: robot.joints.into_iter().map(|joint| joint.name).collect(),
            links: robot.links.into_iter().map(|link| link.name).collect(),
        })
    }

    /// A new, empty scene.
    ///
    /// # Errors
    /// [`ClientError`].
    pub async fn create_scene(&self, name: &str) -> Result<Epoch, ClientError> {
        let request = v1::CreateSceneRequest { name: name.to_owned(), ..v1::CreateSceneRequest::default() };
        let scene = self.scenes().create_scene(request).await?.into_inner().scene;
        Ok(Epoch(scene.ok_or(ClientError::Missing("scene"))?.epoch))
    }

    /// A scene is gone.
    ///
    /// # Errors
    /// [`ClientError`].
    pub async fn delete_scene(&self, name: &str) -> Result<(), ClientError> {
        self.scenes().delete_scene(v1::DeleteSceneRequest { scene: name.to_owned() }).await?;
        Ok(())
    }

    /// Changes a scene: all edits or none.
    ///
    /// # Errors
    /// [`ClientError`].
    pub async fn apply(&self, scene: &str, edits: &[RemoteEdit]) -> Result<Changed, ClientError> {
        let request = v1::ApplyRequest {
            scene: scene.to_owned(),
            edits: edits.iter().map(edit).collect(),
            ..v1::ApplyRequest::default()
        };
        let response = self.scenes().apply(request).await?.into_inner();
        let added = response.added.into_iter().map(BodyId).collect();
        let applied = Applied { revision: Revision(response.revision), added };
        Ok(Changed { epoch: Epoch(response.epoch), applied })
    }

    /// Is the robot free in these states?
    ///
    /// # Errors
    /// [`ClientError`].
    pub async fn check_states(&self, target: &Target, question: &CheckStates) -> Result<Answer, ClientError> {
        let request = to_proto::check_states_request(target, question);
        let response = self.queries().check_states(request).await?.into_inner();
        plain(response.answer)
    }

    /// Is the robot free all along these motions, or this path?
    ///
    /// # Errors
    /// [`ClientError`].
    pub async fn check_motions(&self, target: &Target, question: &CheckMotions) -> Result<Answer, ClientError> {
        let mut queries = self.queries();
        let answer = match question.motions {
            Motions::Edges => {
                let request = to_proto::check_motions_request(target, question);
                let response = queries.check_motions(request).await?.into_inner();
                from_proto::motions(response.answer.as_ref(), &response.motions)
            }
            Motions::Path => {
                let request = to_proto::check_path_request(target, question);
                let response = queries.check_path(request).await?.into_inner();
                from_proto::motions(response.answer.as_ref(), &response.motions)
            }
        };
        Ok(answer?)
    }

    /// Which pairs are within a distance?
    ///
    /// # Errors
    /// [`ClientError`].
    pub async fn clearance(&self, target: &Target, question: &Clearance) -> Result<Answer, ClientError> {
        let request = to_proto::clearance_request(target, question);
        plain(self.queries().clearance(request).await?.into_inner().answer)
    }

    /// What touches?
    ///
    /// # Errors
    /// [`ClientError`].
    pub async fn collide(&self, target: &Target, question: &PairQuery) -> Result<Answer, ClientError> {
        let request = to_proto::collide_request(target, question);
        plain(self.queries().collide(request).await?.into_inner().answer)
    }

    /// How far is the nearest?
    ///
    /// # Errors
    /// [`ClientError`].
    pub async fn distance(&self, target: &Target, question: &PairQuery) -> Result<Answer, ClientError> {
        let request = to_proto::distance_request(target, question);
        plain(self.queries().distance(request).await?.into_inner().answer)
    }
}

fn plain(answer: Option<v1::Answer>) -> Result<Answer, ClientError> {
    Ok(from_proto::answer(&answer.ok_or(ClientError::Missing("answer"))?)?)
}

fn edit(edit: &RemoteEdit) -> v1::Edit {
    use v1::edit::Kind;
    let kind = match edit {
        RemoteEdit::AddBody(body) => Kind::AddBody(to_proto::add_body(body)),
        RemoteEdit::MoveBody { body, pose } => {
            Kind::MoveBody(v1::MoveBody { body: Some(to_proto::body_ref(body)), pose: Some(to_proto::pose(pose)) })
        }
        RemoteEdit::RemoveBody { body } => Kind::RemoveBody(v1::RemoveBody { body: Some(to_proto::body_ref(body)) }),
        RemoteEdit::AddRobot { name, model, base } => {
            Kind::AddRobot(v1::AddRobot { name: name.clone(), model: model.clone(), base: Some(to_proto::pose(base)) })
        }
    };
    v1::Edit { kind: Some(kind) }
}
