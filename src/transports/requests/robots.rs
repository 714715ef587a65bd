//! The service `Robots`.

use std::sync::Arc;

use crate::service::{Service, ServiceError};
use crate::transports::wire::{from_proto, to_proto, v1};

/// # Errors
/// As [`Service::load_robot`].
pub async fn load_robot(
    service: &Arc<Service>,
    message: v1::LoadRobotRequest,
) -> Result<v1::LoadRobotResponse, ServiceError> {
    let loaded = service.load_robot(move || from_proto::robot_description(message)).await?;
    Ok(v1::LoadRobotResponse { robot: Some(to_proto::robot_model(&loaded)) })
}

/// All robot models.
#[must_use]
pub fn list_robots(service: &Service) -> v1::ListRobotsResponse {
    v1::ListRobotsResponse { robots: service.robots().list().iter().map(to_proto::robot_summary).collect() }
}

/// # Errors
/// There is no such model.
pub fn get_robot(service: &Service, message: &v1::GetRobotRequest) -> Result<v1::GetRobotResponse, ServiceError> {
    let robot = service.robots().get(&message.id)?;
    Ok(v1::GetRobotResponse { robot: Some(to_proto::robot_model(&robot)) })
}
