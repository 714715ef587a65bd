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

    async fn watch_contacts(
        &self,
        request: Request<v1::WatchContactsRequest>,
    ) -> Result<Response<ContactStream>, Status> {
        respond(self.watch(request).await)
    }
}

impl Handlers {
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
        let patience = from_proto::patience(grpc_timeout(metadata)?, context)?;
        let form = from_proto::answer_form(context)?;
        let target = from_proto::target(context)?;
        let encoded = move |view: &View| Ok(to_proto::answer(&question(view)?, form));
        self.service.ask(&target, patience, encoded).await
    }
}
