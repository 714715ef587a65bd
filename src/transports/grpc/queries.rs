//! The service `Queries`: decode, ask, encode, all three on the threads that answer questions.

use std::sync::Arc;

use tonic::metadata::MetadataMap;
use tonic::{Request, Response, Status};

use super::contacts::ContactStream;
use super::grpc_timeout::grpc_timeout;
use super::handlers::{Handlers, respond};
use crate::query::Answer;
use crate::service::{Patience, ServiceError, View};
use crate::transports::wire::v1::queries_server::Queries;
use crate::transports::wire::{from_proto, to_proto, v1};

#[tonic::async_trait]
impl Queries for Handlers {
    type WatchContactsStream = ContactStream;

    async fn check_states(
        &self,
        request: Request<v1::CheckStatesRequest>,
    ) -> Result<Response<v1::CheckStatesResponse>, Status> {
        let (metadata, _, message) = request.into_parts();
        let context = message.context.clone();
        let question = move |view: &View| view.check_states(&from_proto::check_states(&message, view.snapshot())?);
        let answer = self.ask(&metadata, context.as_ref(), question).await;
        respond(answer.map(|answer| v1::CheckStatesResponse { answer: Some(answer) }))
    }

    async fn collide(&self, request: Request<v1::CollideRequest>) -> Result<Response<v1::CollideResponse>, Status> {
        let (metadata, _, message) = request.into_parts();
        let (context, library) = (message.context.clone(), Arc::clone(self.service.library()));
        let question = move |view: &View| view.collide(&from_proto::collide(&message, view.snapshot(), &library)?);
        let answer = self.ask(&metadata, context.as_ref(), question).await;
        respond(answer.map(|answer| v1::CollideResponse { answer: Some(answer) }))
    }

    async fn distance(&self, request: Request<v1::DistanceRequest>) -> Result<Response<v1::DistanceResponse>, Status> {
        let (metadata, _, message) = request.into_parts();
        let (context, library) = (message.context.clone(), Arc::clone(self.service.library()));
        let question = move |view: &View| view.distance(&from_proto::distance(&message, view.snapshot(), &library)?);
        let answer = self.ask(&metadata, context.as_ref(), question).await;
        respond(answer.map(|answer| v1::DistanceResponse { answer: Some(answer) }))
    }

    async fn cast_rays(&self, request: Request<v1::CastRaysRequest>) -> Result<Response<v1::CastRaysResponse>, Status> {
        let (metadata, _, message) = request.into_parts();
        let context = message.context.clone();
        let question = move |view: &View| {
            let answers = view.cast_rays(&from_proto::cast_rays(&message, view.snapshot())?)?;
            Ok(to_proto::cast_rays_response(&answers))
        };
        respond(self.ask_for(&metadata, context.as_ref(), question).await)
    }

    async fn cast_shapes(
        &self,
        request: Request<v1::CastShapesRequest>,
    ) -> Result<Response<v1::CastShapesResponse>, Status> {
        let (metadata, _, message) = request.into_parts();
        let (context, library) = (message.context.clone(), Arc::clone(self.service.library()));
        let question = move |view: &View| {
            let answers = view.cast_shapes(&from_proto::cast_shapes(&message, view.snapshot(), &library)?)?;
            Ok(to_proto::cast_shapes_response(&answers))
        };
        respond(self.ask_for(&metadata, context.as_ref(), question).await)
    }

    async fn check_moving_pairs(
        &self,
        request: Request<v1::CheckMovingPairsRequest>,
    ) -> Result<Response<v1::CheckMovingPairsResponse>, Status> {
        let (metadata, _, message) = request.into_parts();
        let (context, library) = (message.context.clone(), Arc::clone(self.service.library()));
        let question = move |view: &View| {
            let asked = from_proto::check_moving_pairs(&message, view.snapshot(), &library)?;
            Ok(to_proto::check_moving_pairs_response(&view.check_moving_pairs(&asked)?))
        };
        respond(self.ask_for(&metadata, context.as_ref(), question).await)
    }

    async fn overlap(&self, request: Request<v1::OverlapRequest>) -> Result<Response<v1::OverlapResponse>, Status> {
        let (metadata, _, message) = request.into_parts();
        let (context, library) = (message.context.clone(), Arc::clone(self.service.library()));
        let question = move |view: &View| {
            let answers = view.overlap(&from_proto::overlap(&message, view.snapshot(), &library)?)?;
            Ok(to_proto::overlap_response(&answers))
        };
        respond(self.ask_for(&metadata, context.as_ref(), question).await)
    }

    async fn nearest_bodies(
        &self,
        request: Request<v1::NearestBodiesRequest>,
    ) -> Result<Response<v1::NearestBodiesResponse>, Status> {
        let (metadata, _, message) = request.into_parts();
        let (context, library) = (message.context.clone(), Arc::clone(self.service.library()));
        let question = move |view: &View| {
            let answers = view.nearest_bodies(&from_proto::nearest_bodies(&message, view.snapshot(), &library)?)?;
            Ok(to_proto::nearest_bodies_response(&answers))
        };
        respond(self.ask_for(&metadata, context.as_ref(), question).await)
    }

    async fn watch_contacts(
        &self,
        request: Request<v1::WatchContactsRequest>,
    ) -> Result<Response<ContactStream>, Status> {
        respond(self.watch(request).await)
    }

    async fn check_motions(
        &self,
        request: Request<v1::CheckMotionsRequest>,
    ) -> Result<Response<v1::CheckMotionsResponse>, Status> {
        let (metadata, _, message) = request.into_parts();
        let context = message.context.clone();
        let question = move |view: &View| view.check_motions(&from_proto::check_motions(&message, view.snapshot())?);
        let answer = self.ask_for_motions(&metadata, context.as_ref(), question).await;
        respond(answer.map(|(answer, motions, bulk)| v1::CheckMotionsResponse { answer: Some(answer), motions, bulk }))
    }

    async fn check_path(
        &self,
        request: Request<v1::CheckPathRequest>,
    ) -> Result<Response<v1::CheckPathResponse>, Status> {
        let (metadata, _, message) = request.into_parts();
        let context = message.context.clone();
        let question = move |view: &View| view.check_motions(&from_proto::check_path(&message, view.snapshot())?);
        let answer = self.ask_for_motions(&metadata, context.as_ref(), question).await;
        respond(answer.map(|(answer, motions, bulk)| v1::CheckPathResponse { answer: Some(answer), motions, bulk }))
    }

    async fn clearance(
        &self,
        request: Request<v1::ClearanceRequest>,
    ) -> Result<Response<v1::ClearanceResponse>, Status> {
        let (metadata, _, message) = request.into_parts();
        let (context, library) = (message.context.clone(), Arc::clone(self.service.library()));
        let question = move |view: &View| view.clearance(&from_proto::clearance(&message, view.snapshot(), &library)?);
        let answer = self.ask(&metadata, context.as_ref(), question).await;
        respond(answer.map(|answer| v1::ClearanceResponse { answer: Some(answer) }))
    }
}

impl Handlers {
    /// Asks a question whose answer is encoded where it is found.
    async fn ask_for<T: Send + 'static>(
        &self,
        metadata: &MetadataMap,
        context: Option<&v1::Context>,
        question: impl FnOnce(&View) -> Result<T, ServiceError> + Send + 'static,
    ) -> Result<T, ServiceError> {
        let patience = from_proto::patience(grpc_timeout(metadata)?, context)?;
        let target = from_proto::target(context)?;
        self.service.ask(&target, patience, question).await
    }

    async fn watch(&self, request: Request<v1::WatchContactsRequest>) -> Result<ContactStream, ServiceError> {
        let (metadata, _, message) = request.into_parts();
        let patience = Patience { timeout: grpc_timeout(&metadata)?, time_budget: None };
        let target = from_proto::target(message.context.as_ref())?;
        let watch = self.service.watch_contacts(&target, patience, |snapshot, limits| {
            from_proto::contact_question(&message, snapshot, limits)
        });
        Ok(ContactStream::new(watch.await?))
    }

    async fn ask(
        &self,
        metadata: &MetadataMap,
        context: Option<&v1::Context>,
        question: impl FnOnce(&View) -> Result<Answer, ServiceError> + Send + 'static,
    ) -> Result<v1::Answer, ServiceError> {
        let form = from_proto::answer_form(context)?;
        let encoded = move |view: &View| Ok(to_proto::answer(&question(view)?, form));
        self.ask_for(metadata, context, encoded).await
    }

    async fn ask_for_motions(
        &self,
        metadata: &MetadataMap,
        context: Option<&v1::Context>,
        question: impl FnOnce(&View) -> Result<Answer, ServiceError> + Send + 'static,
    ) -> Result<(v1::Answer, Vec<v1::Motion>, Option<v1::BulkMotions>), ServiceError> {
        let patience = from_proto::patience(grpc_timeout(metadata)?, context)?;
        let form = from_proto::answer_form(context)?;
        let target = from_proto::target(context)?;
        let encoded = move |view: &View| {
            let answer = question(view)?;
            let (motions, bulk) = to_proto::motions(&answer, form);
            Ok((to_proto::answer(&answer, form), motions, bulk))
        };
        self.service.ask(&target, patience, encoded).await
    }
}
