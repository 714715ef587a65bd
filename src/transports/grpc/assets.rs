//! The service `Assets`.

use std::time::Duration;

use tonic::{Request, Response, Status, Streaming};

use super::handlers::{Handlers, respond};
use super::status::status_of;
use crate::service::{ServiceError, Stored};
use crate::transports::requests;
use crate::transports::wire::v1;
use crate::transports::wire::v1::assets_server::Assets;
use crate::transports::wire::v1::put_asset_request::Part;

#[tonic::async_trait]
impl Assets for Handlers {
    async fn has_assets(
        &self,
        request: Request<v1::HasAssetsRequest>,
    ) -> Result<Response<v1::HasAssetsResponse>, Status> {
        respond(requests::has_assets(&self.service, request.get_ref()))
    }

    async fn describe_mesh(
        &self,
        request: Request<v1::DescribeMeshRequest>,
    ) -> Result<Response<v1::DescribeMeshResponse>, Status> {
        let describe = async |service: &_, message, timeout| requests::describe_mesh(service, &message, timeout).await;
        self.answer(request, describe).await
    }

    async fn put_asset(
        &self,
        request: Request<Streaming<v1::PutAssetRequest>>,
    ) -> Result<Response<v1::PutAssetResponse>, Status> {
        let longest = Duration::from_secs(self.service.limits().max_deadline_seconds as u64);
        // A caller that falls silent gives its place to others in the end.
        let stored = tokio::time::timeout(longest, self.receive(request.into_inner())).await;
        let stored = stored.unwrap_or_else(|_| Err(status_of(&ServiceError::DeadlineExceeded)))?;
        respond(Ok(requests::put_asset_response(&stored)))
    }
}

impl Handlers {
    async fn receive(&self, mut parts: Streaming<v1::PutAssetRequest>) -> Result<Stored, Status> {
        let refused = |error: ServiceError| status_of(&error);
        let first = parts.message().await?.and_then(|message| message.part);
        let Some(Part::Header(v1::AssetHeader { sha256, bytes })) = first else {
            return Err(refused(ServiceError::invalid("header", "is missing: it has to be the first message")));
        };
        let hash = sha256.parse().map_err(|error| refused(ServiceError::invalid("header.sha256", error)))?;
        let mut upload = self.service.begin_upload(hash, bytes).map_err(refused)?;
        while let Some(message) = parts.message().await? {
            let Some(Part::Chunk(chunk)) = message.part else {
                return Err(refused(ServiceError::invalid("chunk", "is missing: only the first message is a header")));
            };
            upload.push(&chunk).map_err(refused)?;
        }
        self.service.finish_upload(upload).await.map_err(refused)
    }
}
