//! What all handlers share: the service they call, and how an outcome becomes a response.

use std::sync::Arc;

use tonic::{Response, Status};

use super::status::status_of;
use crate::service::{Service, ServiceError};

/// Implements every service of `proto/clearance/v1`, one file each.
#[derive(Clone, Debug)]
pub(super) struct Handlers {
    pub service: Arc<Service>,
}

/// The end of every handler.
pub(super) fn respond<T>(outcome: Result<T, ServiceError>) -> Result<Response<T>, Status> {
    outcome.map(Response::new).map_err(|error| status_of(&error))
}
