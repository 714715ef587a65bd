//! The service `Robots`.

use tonic::{Request, Response, Status};

use super::handlers::{Handlers, respond};
use crate::transports::requests;
use crate::transports::wire::v1;
use crate::transports::wire::v1::robots_server::Robots;

#[tonic::async_trait]
impl Robots for Handlers {
    async fn load_robot(
        &self,
        request: Request<v1::LoadRobotRequest>,
    ) -> Result<Response<v1::LoadRobotResponse>, Status> {
        respond(requests::load_robot(&self.service, request.into_inner()).await)
    }

    async fn list_robots(
        &self,
        _request: Request<v1::ListRobotsRequest>,
    ) -> Result<Response<v1::ListRobotsResponse>, Status> {
        respond(Ok(requests::list_robots(&self.service)))
    }

    async fn get_robot(&self, request: Request<v1::GetRobotRequest>) -> Result<Response<v1::GetRobotResponse>, Status> {
        respond(requests::get_robot(&self.service, request.get_ref()))
    }
}
