//! The service `Scenes`.

use tonic::{Request, Response, Status};

use super::handlers::{Handlers, respond};
use crate::transports::requests;
use crate::transports::wire::v1;
use crate::transports::wire::v1::scenes_server::Scenes;

#[tonic::async_trait]
impl Scenes for Handlers {
    async fn create_scene(
        &self,
        request: Request<v1::CreateSceneRequest>,
    ) -> Result<Response<v1::CreateSceneResponse>, Status> {
        respond(requests::create_scene(&self.service, request.get_ref()))
    }

    async fn list_scenes(
        &self,
        _request: Request<v1::ListScenesRequest>,
    ) -> Result<Response<v1::ListScenesResponse>, Status> {
        respond(Ok(requests::list_scenes(&self.service)))
    }

    async fn get_scene(&self, request: Request<v1::GetSceneRequest>) -> Result<Response<v1::GetSceneResponse>, Status> {
        self.answer(request, requests::get_scene).await
    }

    async fn get_scene_health(
        &self,
        request: Request<v1::GetSceneHealthRequest>,
    ) -> Result<Response<v1::GetSceneHealthResponse>, Status> {
        respond(requests::get_scene_health(&self.service, request.into_inner()).await)
    }

    async fn delete_scene(
        &self,
        request: Request<v1::DeleteSceneRequest>,
    ) -> Result<Response<v1::DeleteSceneResponse>, Status> {
        respond(requests::delete_scene(&self.service, request.get_ref()))
    }

    async fn apply(&self, request: Request<v1::ApplyRequest>) -> Result<Response<v1::ApplyResponse>, Status> {
        self.answer(request, requests::apply).await
    }
}
