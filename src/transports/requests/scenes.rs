//! The service `Scenes`.

use std::sync::Arc;
use std::time::Duration;

use crate::service::{Patience, Service, ServiceError, Target};
use crate::transports::wire::{from_proto, to_proto, v1};

/// # Errors
/// As [`Service::create_scene`].
pub fn create_scene(
    service: &Service,
    message: &v1::CreateSceneRequest,
) -> Result<v1::CreateSceneResponse, ServiceError> {
    let created = service.create_scene(&message.name, &from_proto::scene_options(message)?)?;
    Ok(v1::CreateSceneResponse { scene: Some(to_proto::scene_summary(&created)) })
}

/// All scenes.
#[must_use]
pub fn list_scenes(service: &Service) -> v1::ListScenesResponse {
    v1::ListScenesResponse { scenes: service.scenes().iter().map(to_proto::scene_summary).collect() }
}

/// # Errors
/// As [`Service::ask`].
pub async fn get_scene(
    service: &Arc<Service>,
    message: v1::GetSceneRequest,
    timeout: Option<Duration>,
) -> Result<v1::GetSceneResponse, ServiceError> {
    let revision = from_proto::revision_rule(message.revision.as_ref());
    let page = from_proto::body_page(&message, service.limits())?;
    let target = Target { scene: message.scene, revision };
    let (name, robots) = (target.scene.clone(), Arc::clone(service.robots()));
    let contents = service.ask(&target, Patience { timeout, time_budget: None }, move |view| {
        let oldest = view.oldest_revision();
        let contents = to_proto::scene_contents(&name, view.snapshot(), oldest, &robots, page);
        Ok(v1::GetSceneResponse { scene: Some(contents) })
    });
    contents.await
}

/// # Errors
/// As [`Service::scene_health`].
pub async fn get_scene_health(
    service: &Arc<Service>,
    message: v1::GetSceneHealthRequest,
) -> Result<v1::GetSceneHealthResponse, ServiceError> {
    let health = service.scene_health(&message.scene, message.against_rebuilt).await?;
    Ok(v1::GetSceneHealthResponse { health: Some(to_proto::scene_health(&health)) })
}

/// # Errors
/// As [`Service::delete_scene`].
pub fn delete_scene(
    service: &Service,
    message: &v1::DeleteSceneRequest,
) -> Result<v1::DeleteSceneResponse, ServiceError> {
    let deleted = service.delete_scene(&message.scene)?;
    Ok(v1::DeleteSceneResponse { scene: Some(to_proto::scene_summary(&deleted)) })
}

/// # Errors
/// As [`Service::apply`].
pub async fn apply(
    service: &Arc<Service>,
    message: v1::ApplyRequest,
    timeout: Option<Duration>,
) -> Result<v1::ApplyResponse, ServiceError> {
    let scene = message.scene.clone();
    let (library, robots) = (Arc::clone(service.library()), Arc::clone(service.robots()));
    let change = move || from_proto::change(&message, &library, &robots);
    let applied = service.apply(&scene, Patience { timeout, time_budget: None }, change).await?;
    Ok(to_proto::apply_response(&applied))
}
