//! The doors: the same messages in, the same messages out, whatever is between.

use std::sync::Arc;

use clearance::limits::Limits;
use clearance::query::Answer;
use clearance::service::{Config, ContentHash, Patience, Service, ServiceError, Target, View};
use clearance::transports::grpc::status_of;
use clearance::transports::wire::v1::assets_client::AssetsClient;
use clearance::transports::wire::v1::put_asset_request::Part;
use clearance::transports::wire::v1::queries_client::QueriesClient;
use clearance::transports::wire::v1::robots_client::RobotsClient;
use clearance::transports::wire::v1::scenes_client::ScenesClient;
use clearance::transports::wire::{from_proto, to_proto, v1};
use tonic::transport::Channel;
use tonic::{Code, Status};

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

/// A way to ask the daemon.
#[allow(async_fn_in_trait, reason = "the tests know both implementations")]
pub trait Door {
    async fn open(limits: Limits) -> Self;
    async fn create_scene(&self, name: &str) -> Told<v1::SceneSummary>;
    async fn delete_scene(&self, name: &str) -> Told<v1::SceneSummary>;
    async fn get_scene(&self, request: v1::GetSceneRequest) -> Told<v1::SceneContents>;
    async fn apply(&self, request: v1::ApplyRequest) -> Told<v1::ApplyResponse>;
    async fn put_asset(&self, announced: v1::AssetHeader, bytes: &[u8]) -> Told<v1::PutAssetResponse>;
    async fn describe_mesh(&self, request: v1::DescribeMeshRequest) -> Told<v1::MeshCard>;
    async fn load_robot(&self, request: v1::LoadRobotRequest) -> Told<v1::RobotModel>;
    async fn check_states(&self, request: v1::CheckStatesRequest) -> Told<v1::Answer>;
    async fn collide(&self, request: v1::CollideRequest) -> Told<v1::Answer>;
    async fn distance(&self, request: v1::DistanceRequest) -> Told<v1::Answer>;
}

/// No socket: messages are decoded and encoded, and nothing else.
pub struct InProcess {
    pub service: Arc<Service>,
}

impl InProcess {
    async fn ask(
        &self,
        context: Option<v1::Context>,
        question: impl FnOnce(&View) -> Result<Answer, ServiceError> + Send + 'static,
    ) -> Told<v1::Answer> {
        let form = from_proto::answer_form(context.as_ref())?;
        let patience = from_proto::patience(None, context.as_ref())?;
        let target = from_proto::target(context.as_ref())?;
        Ok(self.service.ask(&target, patience, move |view| Ok(to_proto::answer(&question(view)?, form))).await?)
    }
}

impl Door for InProcess {
    async fn open(limits: Limits) -> Self {
        Self { service: Service::new(&Config { threads: 2, limits }).unwrap() }
    }

    async fn create_scene(&self, name: &str) -> Told<v1::SceneSummary> {
        Ok(to_proto::scene_summary(&self.service.create_scene(name)?))
    }

    async fn delete_scene(&self, name: &str) -> Told<v1::SceneSummary> {
        Ok(to_proto::scene_summary(&self.service.delete_scene(name)?))
    }

    async fn get_scene(&self, request: v1::GetSceneRequest) -> Told<v1::SceneContents> {
        let revision = from_proto::revision_rule(request.revision.as_ref());
        let target = Target { scene: request.scene.clone(), revision };
        let oldest = self.service.oldest_revision(&request.scene)?;
        let robots = Arc::clone(self.service.robots());
        let contents =
            move |view: &View| Ok(to_proto::scene_contents(&request.scene, view.snapshot(), oldest, &robots));
        Ok(self.service.ask(&target, Patience::default(), contents).await?)
    }

    async fn apply(&self, request: v1::ApplyRequest) -> Told<v1::ApplyResponse> {
        let (library, robots) = (Arc::clone(self.service.library()), Arc::clone(self.service.robots()));
        let scene = request.scene.clone();
        let change = move || from_proto::change(&request, &library, &robots);
        Ok(to_proto::apply_response(&self.service.apply(&scene, Patience::default(), change).await?))
    }

    async fn put_asset(&self, announced: v1::AssetHeader, bytes: &[u8]) -> Told<v1::PutAssetResponse> {
        let hash: ContentHash = announced.sha256.parse().map_err(|e| ServiceError::invalid("header.sha256", e))?;
        let mut upload = self.service.begin_upload(hash, announced.bytes)?;
        for chunk in bytes.chunks(7) {
            upload.push(chunk)?;
        }
        let stored = self.service.finish_upload(upload).await?;
        Ok(v1::PutAssetResponse {
            sha256: stored.hash.to_string(),
            bytes: stored.bytes as u64,
            already_present: stored.already_present,
        })
    }

    async fn describe_mesh(&self, request: v1::DescribeMeshRequest) -> Told<v1::MeshCard> {
        let asked = from_proto::mesh_card_request(&request)?;
        let card = self.service.mesh_card(asked, Patience::default(), from_proto::unusable_mesh).await?;
        Ok(to_proto::mesh_card(&card))
    }

    async fn load_robot(&self, request: v1::LoadRobotRequest) -> Told<v1::RobotModel> {
        let robot = self.service.load_robot(move || from_proto::robot_description(request)).await?;
        Ok(to_proto::robot_model(&robot))
    }

    async fn check_states(&self, request: v1::CheckStatesRequest) -> Told<v1::Answer> {
        self.ask(request.context.clone(), move |view| {
            view.check_states(&from_proto::check_states(&request, view.snapshot())?)
        })
        .await
    }

    async fn collide(&self, request: v1::CollideRequest) -> Told<v1::Answer> {
        let library = Arc::clone(self.service.library());
        self.ask(request.context.clone(), move |view| {
            view.collide(&from_proto::collide(&request, view.snapshot(), &library)?)
        })
        .await
    }

    async fn distance(&self, request: v1::DistanceRequest) -> Told<v1::Answer> {
        let library = Arc::clone(self.service.library());
        self.ask(request.context.clone(), move |view| {
            view.distance(&from_proto::distance(&request, view.snapshot(), &library)?)
        })
        .await
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

    async fn create_scene(&self, name: &str) -> Told<v1::SceneSummary> {
        let request = v1::CreateSceneRequest { name: name.to_owned() };
        Ok(ScenesClient::new(self.channel.clone()).create_scene(request).await?.into_inner().scene.unwrap())
    }

    async fn delete_scene(&self, name: &str) -> Told<v1::SceneSummary> {
        let request = v1::DeleteSceneRequest { scene: name.to_owned() };
        Ok(ScenesClient::new(self.channel.clone()).delete_scene(request).await?.into_inner().scene.unwrap())
    }

    async fn get_scene(&self, request: v1::GetSceneRequest) -> Told<v1::SceneContents> {
        Ok(ScenesClient::new(self.channel.clone()).get_scene(request).await?.into_inner().scene.unwrap())
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
}
