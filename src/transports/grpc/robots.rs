//! The service `Robots`.

use tonic::{Request, Response, Status};

use super::handlers::{Handlers, respond};
use crate::transports::wire::v1::robots_server::Robots;
use crate::transports::wire::{from_proto, to_proto, v1};

#[tonic::async_trait]
impl Robots for Handlers {
    async fn load_robot(
        &self,
        request: Request<v1::LoadRobotRequest>,
    ) -> Result<Response<v1::LoadRobotResponse>, Status> {
        let message = request.into_inner();
        let loaded = self.service.load_robot(move || from_proto::robot_description(message)).await;
        respond(loaded.map(|robot| v1::LoadRobotResponse { robot: Some(to_proto::robot_model(&robot)) }))
    }

    async fn list_robots(
        &self,
        _request: Request<v1::ListRobotsRequest>,
    ) -> Result<Response<v1::ListRobotsResponse>, Status> {
        let robots = self.service.robots().list().iter().map(to_proto::robot_summary).collect();
        respond(Ok(v1::ListRobotsResponse { robots }))
    }

    async fn get_robot(&self, request: Request<v1::GetRobotRequest>) -> Result<Response<v1::GetRobotResponse>, Status> {
        let robot = self.service.robots().get(&request.into_inner().id);
        respond(robot.map(|robot| v1::GetRobotResponse { robot: Some(to_proto::robot_model(&robot)) }))
    }
}
