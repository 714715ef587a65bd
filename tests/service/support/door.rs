//! The doors: the same messages in, the same messages out, whatever is between.

use std::collections::VecDeque;
use std::sync::Arc;

use clearance::limits::Limits;
use clearance::query::Answer;
use clearance::service::{Config, ContactWatch, ContentHash, Patience, Service, ServiceError, Target, View};
use clearance::transports::grpc::status_of;
use clearance::transports::wire::v1::assets_client::AssetsClient;
use clearance::transports::wire::v1::put_asset_request::Part;
use clearance::transports::wire::v1::queries_client::QueriesClient;
use clearance::transports::wire::v1::robots_client::RobotsClient;
use clearance::transports::wire::v1::scenes_client::ScenesClient;
use clearance::transports::wire::{from_proto, to_proto, v1};
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

impl InProcess {
    /// A question whose answer is a message of its own.
    async fn ask_for<T: Send + 'static>(
        &self,
        context: Option<v1::Context>,
        question: impl FnOnce(&View) -> Result<T, ServiceError> + Send + 'static,
    ) -> Told<T> {
        let patience = from_proto::patience(None, context.as_ref())?;
        let target = from_proto::target(context.as_ref())?;
        Ok(self.service.ask(&target, patience, question).await?)
    }

    async fn ask_for_motions(
        &self,
        context: Option<v1::Context>,
        question: impl FnOnce(&View) -> Result<Answer, ServiceError> + Send + 'static,
    ) -> Told<(v1::Answer, Vec<v1::Motion>, Option<v1::BulkMotions>)> {
        let form = from_proto::answer_form(context.as_ref())?;
        let patience = from_proto::patience(None, context.as_ref())?;
        let target = from_proto::target(context.as_ref())?;
        let encoded = move |view: &View| {
            let answer = question(view)?;
            let (motions, bulk) = to_proto::motions(&answer, form);
            Ok((to_proto::answer(&answer, form), motions, bulk))
        };
        Ok(self.service.ask(&target, patience, encoded).await?)
    }
}

impl Door for InProcess {
    async fn open(limits: Limits) -> Self {
        Self { service: Service::new(&Config { threads: 2, limits }).unwrap() }
    }

    async fn create(&self, request: v1::CreateSceneRequest) -> Told<v1::SceneSummary> {
        let options = from_proto::scene_options(&request)?;
        Ok(to_proto::scene_summary(&self.service.create_scene(&request.name, &options)?))
    }

    async fn delete_scene(&self, name: &str) -> Told<v1::SceneSummary> {
        Ok(to_proto::scene_summary(&self.service.delete_scene(name)?))
    }

    async fn get_scene(&self, request: v1::GetSceneRequest) -> Told<v1::SceneContents> {
        let revision = from_proto::revision_rule(request.revision.as_ref());
        let target = Target { scene: request.scene.clone(), revision };
        let page = from_proto::body_page(&request, self.service.limits())?;
        let robots = Arc::clone(self.service.robots());
        let contents = move |view: &View| {
            let oldest = view.oldest_revision();
            Ok(to_proto::scene_contents(&request.scene, view.snapshot(), oldest, &robots, page))
        };
        Ok(self.service.ask(&target, Patience::default(), contents).await?)
    }

    async fn scene_health(&self, scene: &str) -> Told<v1::SceneHealth> {
        Ok(to_proto::scene_health(&self.service.scene_health(scene, true).await?))
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

    async fn check_motions(&self, request: v1::CheckMotionsRequest) -> Told<v1::CheckMotionsResponse> {
        let (answer, motions, bulk) = self
            .ask_for_motions(request.context.clone(), move |view| {
                view.check_motions(&from_proto::check_motions(&request, view.snapshot())?)
            })
            .await?;
        Ok(v1::CheckMotionsResponse { answer: Some(answer), motions, bulk })
    }

    async fn check_path(&self, request: v1::CheckPathRequest) -> Told<v1::CheckPathResponse> {
        let (answer, motions, bulk) = self
            .ask_for_motions(request.context.clone(), move |view| {
                view.check_motions(&from_proto::check_path(&request, view.snapshot())?)
            })
            .await?;
        Ok(v1::CheckPathResponse { answer: Some(answer), motions, bulk })
    }

    async fn clearance(&self, request: v1::ClearanceRequest) -> Told<v1::Answer> {
        let library = Arc::clone(self.service.library());
        self.ask(request.context.clone(), move |view| {
            view.clearance(&from_proto::clearance(&request, view.snapshot(), &library)?)
        })
        .await
    }

    async fn cast_rays(&self, request: v1::CastRaysRequest) -> Told<v1::CastRaysResponse> {
        self.ask_for(request.context.clone(), move |view| {
            let answers = view.cast_rays(&from_proto::cast_rays(&request, view.snapshot())?)?;
            Ok(to_proto::cast_rays_response(&answers))
        })
        .await
    }

    async fn cast_shapes(&self, request: v1::CastShapesRequest) -> Told<v1::CastShapesResponse> {
        let library = Arc::clone(self.service.library());
        self.ask_for(request.context.clone(), move |view| {
            let answers = view.cast_shapes(&from_proto::cast_shapes(&request, view.snapshot(), &library)?)?;
            Ok(to_proto::cast_shapes_response(&answers))
        })
        .await
    }

    async fn check_moving_pairs(&self, request: v1::CheckMovingPairsRequest) -> Told<v1::CheckMovingPairsResponse> {
        let library = Arc::clone(self.service.library());
        self.ask_for(request.context.clone(), move |view| {
            let asked = from_proto::check_moving_pairs(&request, view.snapshot(), &library)?;
            Ok(to_proto::check_moving_pairs_response(&view.check_moving_pairs(&asked)?))
        })
        .await
    }

    async fn overlap(&self, request: v1::OverlapRequest) -> Told<v1::OverlapResponse> {
        let library = Arc::clone(self.service.library());
        self.ask_for(request.context.clone(), move |view| {
            let answers = view.overlap(&from_proto::overlap(&request, view.snapshot(), &library)?)?;
            Ok(to_proto::overlap_response(&answers))
        })
        .await
    }

    async fn nearest_bodies(&self, request: v1::NearestBodiesRequest) -> Told<v1::NearestBodiesResponse> {
        let library = Arc::clone(self.service.library());
        self.ask_for(request.context.clone(), move |view| {
            let answers = view.nearest_bodies(&from_proto::nearest_bodies(&request, view.snapshot(), &library)?)?;
            Ok(to_proto::nearest_bodies_response(&answers))
        })
        .await
    }

    async fn watch_contacts(&self, request: v1::WatchContactsRequest) -> Told<impl Contacts> {
        let target = from_proto::target(request.context.as_ref())?;
        let watch = self.service.watch_contacts(&target, Patience::default(), |snapshot, limits| {
            from_proto::contact_question(&request, snapshot, limits)
        });
        Ok(InProcessContacts { watch: Some(watch.await?), messages: VecDeque::new() })
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
