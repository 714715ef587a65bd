//! The service `Server`: the daemon itself.

use tonic::{Request, Response, Status};

use super::handlers::{Handlers, respond};
use crate::transports::requests;
use crate::transports::wire::v1;
use crate::transports::wire::v1::server_server::Server;

#[tonic::async_trait]
impl Server for Handlers {
    async fn get_server_info(
        &self,
        _request: Request<v1::GetServerInfoRequest>,
    ) -> Result<Response<v1::GetServerInfoResponse>, Status> {
        respond(Ok(requests::get_server_info(&self.service)))
    }
}
