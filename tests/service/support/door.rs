//! The doors: the same messages in, the same messages out, whatever is between.

use std::collections::VecDeque;
use std::sync::Arc;

use clearance::limits::Limits;
use clearance::service::{Config, ContactWatch, ContentHash, Service, ServiceError};
use clearance::transports::grpc::status_of;
use clearance::transports::requests;
use clearance::transports::wire::v1::assets_client::AssetsClient;
use clearance::transports::wire::v1::put_asset_request::Part;
use clearance::transports::wire::v1::queries_client::QueriesClient;
use clearance::transports::wire::v1::robots_client::RobotsClient;
use clearance::transports::wire::v1::scenes_client::ScenesClient;
use clearance::transports::wire::{to_proto, v1};
use tonic::transport::Channel;
use tonic::{Code, Status, Streaming};

use super::daemon::RunningDaemon;

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
#[allow(async_fn_in_trait, reason = "the tests know both implementations")]
pub trait Contacts {
    async fn message(&mut self) -> Told<v1::WatchContactsResponse>;
}

/// A way to ask the daemon.
#[allow(async_fn_in_trait, reason = "the tests know both implementations")]
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

    /// A scene with the default options.
    async fn create_scene(&self, name: &str) -> Told<v1::SceneSummary> {
        self.create(v1::CreateSceneRequest { name: name.to_owned(), ..v1::CreateSceneRequest::default() }).await
    }
    async fn watch_contacts(&self, request: v1::WatchContactsRequest) -> Told<impl Contacts>;
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

    async fn watch_contacts(&self, request: v1::WatchContactsRequest) -> Told<impl Contacts> {
        let watch = requests::watch_contacts(&self.service, &request, None).await?;
        Ok(InProcessContacts { watch: Some(watch), messages: VecDeque::new() })
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

/// HTTP/2 over loopback.
pub struct Grpc {
    pub daemon: RunningDaemon,
    pub channel: Channel,
}

impl Door for Grpc {
    async fn open(limits: Limits) -> Self {
        let daemon = RunningDaemon::start(limits).await;
        let address = format!("http://{}", daemon.address);
        let channel = Channel::from_shared(address).unwrap().connect().await.unwrap();
        Self { daemon, channel }
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

    async fn watch_contacts(&self, request: v1::WatchContactsRequest) -> Told<impl Contacts> {
        Ok(QueriesClient::new(self.channel.clone()).watch_contacts(request).await?.into_inner())
    }
}

impl Contacts for Streaming<v1::WatchContactsResponse> {
    async fn message(&mut self) -> Told<v1::WatchContactsResponse> {
        Ok(Streaming::message(self).await?.expect("the stream ends with a reason"))
    }
}
