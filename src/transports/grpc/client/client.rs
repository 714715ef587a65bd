//! A connection to a daemon: what it shows, scenes, uploads and robots.

use std::time::Duration;

use tonic::service::interceptor::InterceptedService;
use tonic::transport::{Channel, Endpoint};

use super::edits::{RemoteEdit, edit};
use super::error::ClientError;
use crate::scene::{Applied, BodyId, Epoch, Revision};
use crate::service::{Changed, ContentHash, RobotDescription};
use crate::transports::grpc::credentials::{Bearer, Credentials};
use crate::transports::wire::v1::assets_client::AssetsClient;
use crate::transports::wire::v1::put_asset_request::Part;
use crate::transports::wire::v1::queries_client::QueriesClient;
use crate::transports::wire::v1::robots_client::RobotsClient;
use crate::transports::wire::v1::scenes_client::ScenesClient;
use crate::transports::wire::v1::server_client::ServerClient;
use crate::transports::wire::{to_proto, v1};

/// Bytes of a file in one message of an upload.
const CHUNK: usize = 1 << 20;
/// How much the server may send before it has to wait, bytes.
pub(in crate::transports::grpc) const WINDOW: u32 = 8 << 20;
/// Answers are as large as the daemon cares to send.
const LARGEST_ANSWER: usize = usize::MAX;
/// A daemon that does not take the connection by then is not there.
const CONNECT_TIMEOUT: Duration = Duration::from_secs(10);

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
///
/// A call takes as long as it takes: for a deadline put `tokio::time::timeout` around it. A call that is dropped is cancelled, and the
/// daemon stops working on it.
#[derive(Clone, Debug)]
pub struct Client {
    scenes: ScenesClient<Way>,
    assets: AssetsClient<Way>,
    robots: RobotsClient<Way>,
    queries: QueriesClient<Way>,
    server: ServerClient<Way>,
    /// What questions are asked with.
    pub(super) supposed: Option<Box<v1::Overlay>>,
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
            supposed: None,
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
}
