//! The doors: the same messages in, the same messages out, whatever is between.

use std::collections::VecDeque;
use std::convert::Infallible;
use std::sync::Arc;

use clearance::limits::Limits;
use clearance::service::{Config, ContactWatch, ContentHash, Service, ServiceError};
use clearance::transports::grpc::status_of;
use clearance::transports::requests::{self, PoseMessages, QueryMessages, SceneMessages};
use clearance::transports::wire::v1::assets_client::AssetsClient;
use clearance::transports::wire::v1::put_asset_request::Part;
use clearance::transports::wire::v1::queries_client::QueriesClient;
use clearance::transports::wire::v1::robots_client::RobotsClient;
use clearance::transports::wire::v1::scenes_client::ScenesClient;
use clearance::transports::wire::{to_proto, v1};
use tempfile::TempDir;
use tokio::sync::mpsc;
use tokio_stream::wrappers::ReceiverStream;
use tokio_stream::{Stream, StreamExt};
use tonic::transport::{Channel, Endpoint};
use tonic::{Code, Status, Streaming};

use super::daemon::{RunningDaemon, config};

/// Why a request was refused, as every door tells it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refusal {
    pub code: Code,
    pub reason: String,
    pub field: String,
    pub message: String,
}

impl From<Status> for Refusal {
    fn from(status: Status) -> Self {
        let of = |key: &str| status.metadata().get(key).map_or("", |value| value.to_str().unwrap()).to_owned();
        Self {
            code: status.code(),
            reason: of("clearance-reason"),
            field: of("clearance-field"),
            message: status.message().to_owned(),
        }
    }
}

impl From<ServiceError> for Refusal {
    fn from(error: ServiceError) -> Self {
        status_of(&error).into()
    }
}

pub type Told<T> = Result<T, Refusal>;

/// A stream of contacts.
#[allow(async_fn_in_trait, reason = "the tests know all implementations")]
pub trait Contacts {
    async fn message(&mut self) -> Told<v1::WatchContactsResponse>;
}

/// A stream of messages; none at the end.
#[allow(async_fn_in_trait, reason = "the tests know all implementations")]
pub trait Messages<M> {
    async fn message(&mut self) -> Told<Option<M>>;
}

/// What a caller sends, message by message.
pub type Sent<M> = mpsc::Sender<M>;

/// A way to ask the daemon.
#[allow(async_fn_in_trait, reason = "the tests know all implementations")]
pub trait Door {
    async fn open(limits: Limits) -> Self;
    async fn create(&self, request: v1::CreateSceneRequest) -> Told<v1::SceneSummary>;
    async fn delete_scene(&self, name: &str) -> Told<v1::SceneSummary>;
    async fn get_scene(&self, request: v1::GetSceneRequest) -> Told<v1::SceneContents>;
    async fn scene_health(&self, scene: &str) -> Told<v1::SceneHealth>;
    async fn apply(&self, request: v1::ApplyRequest) -> Told<v1::ApplyResponse>;
    async fn put_asset(&self, announced: v1::AssetHeader, bytes: &[u8]) -> Told<v1::PutAssetResponse>;
    async fn describe_mesh(&self, request: v1::DescribeMeshRequest) -> Told<v1::MeshCard>;
    async fn load_robot(&self, request: v1::LoadRobotRequest) -> Told<v1::RobotModel>;
    async fn check_states(&self, request: v1::CheckStatesRequest) -> Told<v1::Answer>;
    async fn collide(&self, request: v1::CollideRequest) -> Told<v1::Answer>;
    async fn distance(&self, request: v1::DistanceRequest) -> Told<v1::Answer>;
    async fn cast_rays(&self, request: v1::CastRaysRequest) -> Told<v1::CastRaysResponse>;
    async fn cast_shapes(&self, request: v1::CastShapesRequest) -> Told<v1::CastShapesResponse>;
    async fn check_moving_pairs(&self, request: v1::CheckMovingPairsRequest) -> Told<v1::CheckMovingPairsResponse>;
    async fn overlap(&self, request: v1::OverlapRequest) -> Told<v1::OverlapResponse>;
    async fn nearest_bodies(&self, request: v1::NearestBodiesRequest) -> Told<v1::NearestBodiesResponse>;
    async fn check_motions(&self, request: v1::CheckMotionsRequest) -> Told<v1::CheckMotionsResponse>;
    async fn check_path(&self, request: v1::CheckPathRequest) -> Told<v1::CheckPathResponse>;
    async fn clearance(&self, request: v1::ClearanceRequest) -> Told<v1::Answer>;
    async fn estimate(&self, request: v1::EstimateRequest) -> Told<v1::EstimateResponse>;

    /// A scene with the default options.
    async fn create_scene(&self, name: &str) -> Told<v1::SceneSummary> {
        self.create(v1::CreateSceneRequest { name: name.to_owned(), ..v1::CreateSceneRequest::default() }).await
    }
}

/// A way to ask that has watches, too.
#[allow(async_fn_in_trait, reason = "the tests know all implementations")]
pub trait Watches: Door {
    async fn watch_contacts(&self, request: v1::WatchContactsRequest) -> Told<impl Contacts>;
    async fn watch_scene(&self, request: v1::WatchRequest) -> Told<impl Messages<v1::WatchResponse>>;
}

/// A way to ask that has streams of what is sent, too.
#[allow(async_fn_in_trait, reason = "the tests know all implementations")]
pub trait Streams: Watches {
    async fn pose_stream(&self) -> Told<(Sent<v1::PoseStreamRequest>, impl Messages<v1::PoseStreamResponse>)>;
    async fn query_stream(&self) -> Told<(Sent<v1::QueryStreamRequest>, impl Messages<v1::QueryStreamResponse>)>;
}

/// Messages on their way.
fn sending<M>() -> (Sent<M>, ReceiverStream<M>) {
    let (sender, receiver) = mpsc::channel(64);
    (sender, ReceiverStream::new(receiver))
}

/// No socket: messages are decoded and encoded, and nothing else.
pub struct InProcess {
    pub service: Arc<Service>,
}

impl Door for InProcess {
    async fn open(limits: Limits) -> Self {
        Self { service: Service::new(&Config { threads: 2, limits }).unwrap() }
    }

    async fn create(&self, request: v1::CreateSceneRequest) -> Told<v1::SceneSummary> {
        Ok(requests::create_scene(&self.service, &request)?.scene.unwrap())
    }

    async fn delete_scene(&self, name: &str) -> Told<v1::SceneSummary> {
        let request = v1::DeleteSceneRequest { scene: name.to_owned() };
        Ok(requests::delete_scene(&self.service, &request)?.scene.unwrap())
    }

    async fn get_scene(&self, request: v1::GetSceneRequest) -> Told<v1::SceneContents> {
        Ok(requests::get_scene(&self.service, request, None).await?.scene.unwrap())
    }

    async fn scene_health(&self, scene: &str) -> Told<v1::SceneHealth> {
        let request = v1::GetSceneHealthRequest { scene: scene.to_owned(), against_rebuilt: true };
        Ok(requests::get_scene_health(&self.service, request).await?.health.unwrap())
    }

    async fn apply(&self, request: v1::ApplyRequest) -> Told<v1::ApplyResponse> {
        Ok(requests::apply(&self.service, request, None).await?)
    }

    async fn put_asset(&self, announced: v1::AssetHeader, bytes: &[u8]) -> Told<v1::PutAssetResponse> {
        let hash: ContentHash = announced.sha256.parse().map_err(|e| ServiceError::invalid("header.sha256", e))?;
        let mut upload = self.service.begin_upload(hash, announced.bytes)?;
        for chunk in bytes.chunks(7) {
            upload.push(chunk)?;
        }
        Ok(requests::put_asset_response(&self.service.finish_upload(upload).await?))
    }

    async fn describe_mesh(&self, request: v1::DescribeMeshRequest) -> Told<v1::MeshCard> {
        Ok(requests::describe_mesh(&self.service, &request, None).await?.card.unwrap())
    }

    async fn load_robot(&self, request: v1::LoadRobotRequest) -> Told<v1::RobotModel> {
        Ok(requests::load_robot(&self.service, request).await?.robot.unwrap())
    }

    async fn check_states(&self, request: v1::CheckStatesRequest) -> Told<v1::Answer> {
        Ok(requests::check_states(&self.service, request, None).await?.answer.unwrap())
    }

    async fn collide(&self, request: v1::CollideRequest) -> Told<v1::Answer> {
        Ok(requests::collide(&self.service, request, None).await?.answer.unwrap())
    }

    async fn distance(&self, request: v1::DistanceRequest) -> Told<v1::Answer> {
        Ok(requests::distance(&self.service, request, None).await?.answer.unwrap())
    }

    async fn clearance(&self, request: v1::ClearanceRequest) -> Told<v1::Answer> {
        Ok(requests::clearance(&self.service, request, None).await?.answer.unwrap())
    }

    async fn estimate(&self, request: v1::EstimateRequest) -> Told<v1::EstimateResponse> {
        Ok(requests::estimate(&self.service, request, None).await?)
    }

    async fn check_motions(&self, request: v1::CheckMotionsRequest) -> Told<v1::CheckMotionsResponse> {
        Ok(requests::check_motions(&self.service, request, None).await?)
    }

    async fn check_path(&self, request: v1::CheckPathRequest) -> Told<v1::CheckPathResponse> {
        Ok(requests::check_path(&self.service, request, None).await?)
    }

    async fn cast_rays(&self, request: v1::CastRaysRequest) -> Told<v1::CastRaysResponse> {
        Ok(requests::cast_rays(&self.service, request, None).await?)
    }

    async fn cast_shapes(&self, request: v1::CastShapesRequest) -> Told<v1::CastShapesResponse> {
        Ok(requests::cast_shapes(&self.service, request, None).await?)
    }

    async fn check_moving_pairs(&self, request: v1::CheckMovingPairsRequest) -> Told<v1::CheckMovingPairsResponse> {
        Ok(requests::check_moving_pairs(&self.service, request, None).await?)
    }

    async fn overlap(&self, request: v1::OverlapRequest) -> Told<v1::OverlapResponse> {
        Ok(requests::overlap(&self.service, request, None).await?)
    }

    async fn nearest_bodies(&self, request: v1::NearestBodiesRequest) -> Told<v1::NearestBodiesResponse> {
        Ok(requests::nearest_bodies(&self.service, request, None).await?)
    }
}

impl Watches for InProcess {
    async fn watch_contacts(&self, request: v1::WatchContactsRequest) -> Told<impl Contacts> {
        let watch = requests::watch_contacts(&self.service, &request, None).await?;
        Ok(InProcessContacts { watch: Some(watch), messages: VecDeque::new() })
    }

    async fn watch_scene(&self, request: v1::WatchRequest) -> Told<impl Messages<v1::WatchResponse>> {
        Ok(requests::watch(&self.service, &request, None)?)
    }
}

impl Streams for InProcess {
    async fn pose_stream(&self) -> Told<(Sent<v1::PoseStreamRequest>, impl Messages<v1::PoseStreamResponse>)> {
        let (sender, sent) = sending();
        Ok((sender, requests::pose_stream(&self.service, sent.map(Ok::<_, Infallible>), None)))
    }

    async fn query_stream(&self) -> Told<(Sent<v1::QueryStreamRequest>, impl Messages<v1::QueryStreamResponse>)> {
        let (sender, sent) = sending();
        Ok((sender, requests::query_stream(&self.service, sent.map(Ok::<_, Infallible>), None)?))
    }
}

impl Messages<v1::WatchResponse> for SceneMessages {
    async fn message(&mut self) -> Told<Option<v1::WatchResponse>> {
        Ok(Some(self.next().await?))
    }
}

impl<S> Messages<v1::PoseStreamResponse> for PoseMessages<S>
where
    S: Stream<Item = Result<v1::PoseStreamRequest, Infallible>> + Unpin,
{
    async fn message(&mut self) -> Told<Option<v1::PoseStreamResponse>> {
        Ok(self.next().await?)
    }
}

impl<S> Messages<v1::QueryStreamResponse> for QueryMessages<S>
where
    S: Stream<Item = Result<v1::QueryStreamRequest, Infallible>> + Unpin,
{
    async fn message(&mut self) -> Told<Option<v1::QueryStreamResponse>> {
        Ok(self.next().await?)
    }
}

struct InProcessContacts {
    watch: Option<ContactWatch>,
    messages: VecDeque<v1::WatchContactsResponse>,
}

impl Contacts for InProcessContacts {
    async fn message(&mut self) -> Told<v1::WatchContactsResponse> {
        if self.messages.is_empty() {
            let (watch, messages) = self.watch.take().unwrap().next(to_proto::contact_messages).await?;
            self.watch = Some(watch);
            self.messages.extend(messages);
        }
        Ok(self.messages.pop_front().unwrap())
    }
}

/// gRPC, over one thing or another.
pub struct Http2<W> {
    pub daemon: RunningDaemon,
    pub channel: Channel,
    /// What has to stay as long as the daemon.
    _way: W,
}

/// HTTP/2 over loopback.
pub type Grpc = Http2<Loopback>;
/// HTTP/2 over a Unix socket.
pub type GrpcUnix = Http2<UnixSocket>;

/// What HTTP/2 goes over.
pub trait Way: Sized {
    fn prepare() -> Self;
    /// Where the daemon is to listen.
    fn address(&self) -> String;
}

pub struct Loopback;

impl Way for Loopback {
    fn prepare() -> Self {
        Self
    }

    fn address(&self) -> String {
        "127.0.0.1:0".to_owned()
    }
}

pub struct UnixSocket(TempDir);

impl Way for UnixSocket {
    fn prepare() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn address(&self) -> String {
        format!("unix:{}", self.0.path().join("clearance.sock").display())
    }
}

impl<W: Way> Door for Http2<W> {
    async fn open(limits: Limits) -> Self {
        let way = W::prepare();
        let mut config = config(limits);
        config.grpc.address = way.address();
        let daemon = RunningDaemon::start(&config).await;
        let unix = daemon.address.starts_with("unix:");
        let address = if unix { daemon.address.clone() } else { format!("http://{}", daemon.address) };
        let channel = Endpoint::from_shared(address).unwrap().connect().await.unwrap();
        Self { daemon, channel, _way: way }
    }

    async fn create(&self, request: v1::CreateSceneRequest) -> Told<v1::SceneSummary> {
        Ok(ScenesClient::new(self.channel.clone()).create_scene(request).await?.into_inner().scene.unwrap())
    }

    async fn delete_scene(&self, name: &str) -> Told<v1::SceneSummary> {
        let request = v1::DeleteSceneRequest { scene: name.to_owned() };
        Ok(ScenesClient::new(self.channel.clone()).delete_scene(request).await?.into_inner().scene.unwrap())
    }

    async fn get_scene(&self, request: v1::GetSceneRequest) -> Told<v1::SceneContents> {
        Ok(ScenesClient::new(self.channel.clone()).get_scene(request).await?.into_inner().scene.unwrap())
    }

    async fn scene_health(&self, scene: &str) -> Told<v1::SceneHealth> {
        let request = v1::GetSceneHealthRequest { scene: scene.to_owned(), against_rebuilt: true };
        Ok(ScenesClient::new(self.channel.clone()).get_scene_health(request).await?.into_inner().health.unwrap())
    }

    async fn apply(&self, request: v1::ApplyRequest) -> Told<v1::ApplyResponse> {
        Ok(ScenesClient::new(self.channel.clone()).apply(request).await?.into_inner())
    }

    async fn put_asset(&self, announced: v1::AssetHeader, bytes: &[u8]) -> Told<v1::PutAssetResponse> {
        let chunks = bytes.chunks(7).map(|chunk| Part::Chunk(chunk.to_vec().into()));
        let parts = std::iter::once(Part::Header(announced)).chain(chunks);
        let parts: Vec<_> = parts.map(|part| v1::PutAssetRequest { part: Some(part) }).collect();
        Ok(AssetsClient::new(self.channel.clone()).put_asset(tokio_stream::iter(parts)).await?.into_inner())
    }

    async fn describe_mesh(&self, request: v1::DescribeMeshRequest) -> Told<v1::MeshCard> {
        Ok(AssetsClient::new(self.channel.clone()).describe_mesh(request).await?.into_inner().card.unwrap())
    }

    async fn load_robot(&self, request: v1::LoadRobotRequest) -> Told<v1::RobotModel> {
        Ok(RobotsClient::new(self.channel.clone()).load_robot(request).await?.into_inner().robot.unwrap())
    }

    async fn check_states(&self, request: v1::CheckStatesRequest) -> Told<v1::Answer> {
        Ok(QueriesClient::new(self.channel.clone()).check_states(request).await?.into_inner().answer.unwrap())
    }

    async fn collide(&self, request: v1::CollideRequest) -> Told<v1::Answer> {
        Ok(QueriesClient::new(self.channel.clone()).collide(request).await?.into_inner().answer.unwrap())
    }

    async fn distance(&self, request: v1::DistanceRequest) -> Told<v1::Answer> {
        Ok(QueriesClient::new(self.channel.clone()).distance(request).await?.into_inner().answer.unwrap())
    }

    async fn check_motions(&self, request: v1::CheckMotionsRequest) -> Told<v1::CheckMotionsResponse> {
        Ok(QueriesClient::new(self.channel.clone()).check_motions(request).await?.into_inner())
    }

    async fn check_path(&self, request: v1::CheckPathRequest) -> Told<v1::CheckPathResponse> {
        Ok(QueriesClient::new(self.channel.clone()).check_path(request).await?.into_inner())
    }

    async fn clearance(&self, request: v1::ClearanceRequest) -> Told<v1::Answer> {
        Ok(QueriesClient::new(self.channel.clone()).clearance(request).await?.into_inner().answer.unwrap())
    }

    async fn estimate(&self, request: v1::EstimateRequest) -> Told<v1::EstimateResponse> {
        Ok(QueriesClient::new(self.channel.clone()).estimate(request).await?.into_inner())
    }

    async fn cast_rays(&self, request: v1::CastRaysRequest) -> Told<v1::CastRaysResponse> {
        Ok(QueriesClient::new(self.channel.clone()).cast_rays(request).await?.into_inner())
    }

    async fn cast_shapes(&self, request: v1::CastShapesRequest) -> Told<v1::CastShapesResponse> {
        Ok(QueriesClient::new(self.channel.clone()).cast_shapes(request).await?.into_inner())
    }

    async fn check_moving_pairs(&self, request: v1::CheckMovingPairsRequest) -> Told<v1::CheckMovingPairsResponse> {
        Ok(QueriesClient::new(self.channel.clone()).check_moving_pairs(request).await?.into_inner())
    }

    async fn overlap(&self, request: v1::OverlapRequest) -> Told<v1::OverlapResponse> {
        Ok(QueriesClient::new(self.channel.clone()).overlap(request).await?.into_inner())
    }

    async fn nearest_bodies(&self, request: v1::NearestBodiesRequest) -> Told<v1::NearestBodiesResponse> {
        Ok(QueriesClient::new(self.channel.clone()).nearest_bodies(request).await?.into_inner())
    }
}

impl<W: Way> Watches for Http2<W> {
    async fn watch_contacts(&self, request: v1::WatchContactsRequest) -> Told<impl Contacts> {
        Ok(QueriesClient::new(self.channel.clone()).watch_contacts(request).await?.into_inner())
    }

    async fn watch_scene(&self, request: v1::WatchRequest) -> Told<impl Messages<v1::WatchResponse>> {
        Ok(ScenesClient::new(self.channel.clone()).watch(request).await?.into_inner())
    }
}

impl<W: Way> Streams for Http2<W> {
    async fn pose_stream(&self) -> Told<(Sent<v1::PoseStreamRequest>, impl Messages<v1::PoseStreamResponse>)> {
        let (sender, sent) = sending();
        Ok((sender, ScenesClient::new(self.channel.clone()).pose_stream(sent).await?.into_inner()))
    }

    async fn query_stream(&self) -> Told<(Sent<v1::QueryStreamRequest>, impl Messages<v1::QueryStreamResponse>)> {
        let (sender, sent) = sending();
        Ok((sender, QueriesClient::new(self.channel.clone()).query_stream(sent).await?.into_inner()))
    }
}

impl<M> Messages<M> for Streaming<M> {
    async fn message(&mut self) -> Told<Option<M>> {
        Ok(Streaming::message(self).await?)
    }
}

impl Contacts for Streaming<v1::WatchContactsResponse> {
    async fn message(&mut self) -> Told<v1::WatchContactsResponse> {
        Ok(Streaming::message(self).await?.expect("the stream ends with a reason"))
    }
}
