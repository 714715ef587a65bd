//! The service `Queries`.

use tonic::{Request, Response, Status, Streaming};

use super::contacts::ContactStream;
use super::grpc_timeout::grpc_timeout;
use super::handlers::{Handlers, respond};
use super::streams::MessageStream;
use crate::service::ServiceError;
use crate::transports::requests::{self, QueryMessages};
use crate::transports::wire::v1;
use crate::transports::wire::v1::queries_server::Queries;

#[tonic::async_trait]
impl Queries for Handlers {
    type WatchContactsStream = ContactStream;
    type QueryStreamStream = MessageStream<QueryMessages<Streaming<v1::QueryStreamRequest>>>;

    async fn check_states(
        &self,
        request: Request<v1::CheckStatesRequest>,
    ) -> Result<Response<v1::CheckStatesResponse>, Status> {
        self.answer(request, requests::check_states).await
    }

    async fn collide(&self, request: Request<v1::CollideRequest>) -> Result<Response<v1::CollideResponse>, Status> {
        self.answer(request, requests::collide).await
    }

    async fn distance(&self, request: Request<v1::DistanceRequest>) -> Result<Response<v1::DistanceResponse>, Status> {
        self.answer(request, requests::distance).await
    }

    async fn cast_rays(&self, request: Request<v1::CastRaysRequest>) -> Result<Response<v1::CastRaysResponse>, Status> {
        self.answer(request, requests::cast_rays).await
    }

    async fn cast_shapes(
        &self,
        request: Request<v1::CastShapesRequest>,
    ) -> Result<Response<v1::CastShapesResponse>, Status> {
        self.answer(request, requests::cast_shapes).await
    }

    async fn check_moving_pairs(
        &self,
        request: Request<v1::CheckMovingPairsRequest>,
    ) -> Result<Response<v1::CheckMovingPairsResponse>, Status> {
        self.answer(request, requests::check_moving_pairs).await
    }

    async fn overlap(&self, request: Request<v1::OverlapRequest>) -> Result<Response<v1::OverlapResponse>, Status> {
        self.answer(request, requests::overlap).await
    }

    async fn nearest_bodies(
        &self,
        request: Request<v1::NearestBodiesRequest>,
    ) -> Result<Response<v1::NearestBodiesResponse>, Status> {
        self.answer(request, requests::nearest_bodies).await
    }

    async fn check_motions(
        &self,
        request: Request<v1::CheckMotionsRequest>,
    ) -> Result<Response<v1::CheckMotionsResponse>, Status> {
        self.answer(request, requests::check_motions).await
    }

    async fn check_path(
        &self,
        request: Request<v1::CheckPathRequest>,
    ) -> Result<Response<v1::CheckPathResponse>, Status> {
        self.answer(request, requests::check_path).await
    }

    async fn clearance(
        &self,
        request: Request<v1::ClearanceRequest>,
    ) -> Result<Response<v1::ClearanceResponse>, Status> {
        self.answer(request, requests::clearance).await
    }

    async fn estimate(&self, request: Request<v1::EstimateRequest>) -> Result<Response<v1::EstimateResponse>, Status> {
        self.answer(request, requests::estimate).await
    }

    async fn watch_contacts(
        &self,
        request: Request<v1::WatchContactsRequest>,
    ) -> Result<Response<ContactStream>, Status> {
        respond(self.watch(request).await)
    }

    async fn query_stream(
        &self,
        request: Request<Streaming<v1::QueryStreamRequest>>,
    ) -> Result<Response<Self::QueryStreamStream>, Status> {
        respond(self.questions(request))
    }
}

impl Handlers {
    async fn watch(&self, request: Request<v1::WatchContactsRequest>) -> Result<ContactStream, ServiceError> {
        let timeout = grpc_timeout(request.metadata())?;
        Ok(ContactStream::new(requests::watch_contacts(&self.service, request.get_ref(), timeout).await?))
    }
}
