//! The service `Queries`: decode, ask, encode, all three on the threads that answer questions.

use std::sync::Arc;

use tonic::metadata::MetadataMap;
use tonic::{Request, Response, Status};

use super::grpc_timeout::grpc_timeout;
use super::handlers::{Handlers, respond};
use crate::query::Answer;
use crate::service::{ServiceError, View};
use crate::transports::wire::v1::queries_server::Queries;
use crate::transports::wire::{from_proto, to_proto, v1};

#[tonic::async_trait]
impl Queries for Handlers {
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
    async fn ask(
        &self,
        metadata: &MetadataMap,
        context: Option<&v1::Context>,
        question: impl FnOnce(&View) -> Result<Answer, ServiceError> + Send + 'static,
    ) -> Result<v1::Answer, ServiceError> {
        let patience = from_proto::patience(grpc_timeout(metadata)?, context)?;
        let form = from_proto::answer_form(context)?;
        let target = from_proto::target(context)?;
        let encoded = move |view: &View| Ok(to_proto::answer(&question(view)?, form));
        self.service.ask(&target, patience, encoded).await
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
