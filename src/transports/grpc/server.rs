//! The service `Server`: the daemon itself.

use tonic::{Request, Response, Status};

use super::handlers::{Handlers, respond};
use crate::transports::wire::v1::server_server::Server;
use crate::transports::wire::{to_proto, v1};

#[tonic::async_trait]
impl Server for Handlers {
    async fn get_server_info(
        &self,
        _request: Request<v1::GetServerInfoRequest>,
    ) -> Result<Response<v1::GetServerInfoResponse>, Status> {
        let service = &self.service;
        respond(Ok(v1::GetServerInfoResponse {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            doors: service.doors().iter().map(to_proto::door).collect(),
            limits: service.limits().table().iter().map(to_proto::limit).collect(),
            scenes: service.scenes().iter().map(to_proto::scene_summary).collect(),
            threads: u32::try_from(service.threads()).unwrap_or(u32::MAX),
        }))
    }
}
