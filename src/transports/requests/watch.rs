//! The rpc `Watch`: steps of a scene as messages, made when they are asked for.

use std::sync::Arc;
use std::time::Duration;

use crate::scene::{Epoch, Revision};
use crate::service::{Patience, SceneStep, SceneWatch, Service, ServiceError};
use crate::transports::wire::to_proto::Told;
use crate::transports::wire::{to_proto, v1};

/// A watch, and what is left of its last step.
#[derive(Debug)]
pub struct SceneMessages {
    service: Arc<Service>,
    watch: SceneWatch,
    shapes: bool,
    rest: Option<(Arc<SceneStep>, Told)>,
}

/// # Errors
/// As [`Service::watch_scene`].
pub fn watch(
    service: &Arc<Service>,
    message: &v1::WatchRequest,
    timeout: Option<Duration>,
) -> Result<SceneMessages, ServiceError> {
    let (epoch, from) = (message.epoch.map(Epoch), message.from_revision.map(Revision));
    let patience = Patience { timeout, time_budget: None };
    let watch = service.watch_scene(&message.scene, epoch, from, patience)?;
    Ok(SceneMessages { service: Arc::clone(service), watch, shapes: message.shapes, rest: None })
}

impl SceneMessages {
    /// The next message, once there is one.
    ///
    /// # Errors
    /// As [`SceneWatch::next`].
    pub async fn next(&mut self) -> Result<v1::WatchResponse, ServiceError> {
        let (step, told) = match self.rest.take() {
            Some(rest) => rest,
            None => (Arc::new(self.watch.next().await?), Told::NOTHING),
        };
        let (shapes, service, of) = (self.shapes, Arc::clone(&self.service), Arc::clone(&step));
        let made = move || Ok(to_proto::watch_response(&of, told, shapes, service.robots()));
        let (message, left) = self.watch.work(made).await?;
        self.rest = left.map(|told| (step, told));
        Ok(message)
    }
}
