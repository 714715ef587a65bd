//! What all handlers share: the service they call, and how an outcome becomes a response.

use std::sync::Arc;
use std::time::Duration;

use tonic::{Request, Response, Status};

use super::grpc_timeout::grpc_timeout;
use super::status::status_of;
use crate::service::{Service, ServiceError};

/// Implements every service of `proto/clearance/v1`, one file each.
#[derive(Clone, Debug)]
pub(super) struct Handlers {
    pub service: Arc<Service>,
}

impl Handlers {
    /// A call that ends when its caller stops listening.
    pub async fn answer<M, T>(
        &self,
        request: Request<M>,
        call: impl AsyncFnOnce(&Arc<Service>, M, Option<Duration>) -> Result<T, ServiceError>,
    ) -> Result<Response<T>, Status> {
        let timeout = grpc_timeout(request.metadata()).map_err(|error| status_of(&error))?;
        respond(call(&self.service, request.into_inner(), timeout).await)
    }
}

/// The end of every handler.
pub(super) fn respond<T>(outcome: Result<T, ServiceError>) -> Result<Response<T>, Status> {
    outcome.map(Response::new).map_err(|error| status_of(&error))
}
