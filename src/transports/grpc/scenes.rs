//! The service `Scenes`.

use std::sync::Arc;

use tonic::{Request, Response, Status};

use super::grpc_timeout::grpc_timeout;
use super::handlers::{Handlers, respond};
use crate::service::{Patience, ServiceError, Target};
use crate::transports::wire::v1::scenes_server::Scenes;
use crate::transports::wire::{from_proto, to_proto, v1};

#[tonic::async_trait]
impl Scenes for Handlers {
    async fn create_scene(
        &self,
        request: Request<v1::CreateSceneRequest>,
    ) -> Result<Response<v1::CreateSceneResponse>, Status> {
        let request = request.into_inner();
        let options = from_proto::scene_options(&request);
        let created = options.and_then(|options| self.service.create_scene(&request.name, &options));
        respond(created.map(|scene| v1::CreateSceneResponse { scene: Some(to_proto::scene_summary(&scene)) }))
    }

    async fn list_scenes(
        &self,
        _request: Request<v1::ListScenesRequest>,
    ) -> Result<Response<v1::ListScenesResponse>, Status> {
        let scenes = self.service.scenes().iter().map(to_proto::scene_summary).collect();
        respond(Ok(v1::ListScenesResponse { scenes }))
    }

    async fn get_scene(&self, request: Request<v1::GetSceneRequest>) -> Result<Response<v1::GetSceneResponse>, Status> {
        respond(self.contents(request).await)
    }

    async fn get_scene_health(
        &self,
        request: Request<v1::GetSceneHealthRequest>,
    ) -> Result<Response<v1::GetSceneHealthResponse>, Status> {
        let request = request.into_inner();
        let health = self.service.scene_health(&request.scene, request.against_rebuilt).await;
        respond(health.map(|health| v1::GetSceneHealthResponse { health: Some(to_proto::scene_health(&health)) }))
    }

    async fn delete_scene(
        &self,
        request: Request<v1::DeleteSceneRequest>,
    ) -> Result<Response<v1::DeleteSceneResponse>, Status> {
        let deleted = self.service.delete_scene(&request.into_inner().scene);
        respond(deleted.map(|scene| v1::DeleteSceneResponse { scene: Some(to_proto::scene_summary(&scene)) }))
    }

    async fn apply(&self, request: Request<v1::ApplyRequest>) -> Result<Response<v1::ApplyResponse>, Status> {
        respond(self.change(request).await)
    }
}

impl Handlers {
    async fn contents(&self, request: Request<v1::GetSceneRequest>) -> Result<v1::GetSceneResponse, ServiceError> {
        let timeout = grpc_timeout(request.metadata())?;
        let message = request.into_inner();
        let revision = from_proto::revision_rule(message.revision.as_ref());
        let page = from_proto::body_page(&message, self.service.limits())?;
        let target = Target { scene: message.scene, revision };
        let (name, robots) = (target.scene.clone(), Arc::clone(self.service.robots()));
        let patience = Patience { timeout, time_budget: None };
        let question = self.service.ask(&target, patience, move |view| {
            let oldest = view.oldest_revision();
            let contents = to_proto::scene_contents(&name, view.snapshot(), oldest, &robots, page);
            Ok(v1::GetSceneResponse { scene: Some(contents) })
        });
        question.await
    }

    async fn change(&self, request: Request<v1::ApplyRequest>) -> Result<v1::ApplyResponse, ServiceError> {
        let patience = Patience { timeout: grpc_timeout(request.metadata())?, time_budget: None };
        let message = request.into_inner();
        let scene = message.scene.clone();
        let (library, robots) = (Arc::clone(self.service.library()), Arc::clone(self.service.robots()));
        let change = move || from_proto::change(&message, &library, &robots);
        let applied = self.service.apply(&scene, patience, change).await?;
        Ok(to_proto::apply_response(&applied))
    }
}
