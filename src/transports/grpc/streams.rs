//! Streams of messages: each is made when the connection has room for it and the client may have more, and not before.

use std::pin::Pin;
use std::task::{Context, Poll, ready};

use tokio_stream::Stream;
use tonic::{Request, Status, Streaming};

use super::gate::Caller;
use super::grpc_timeout::grpc_timeout;
use super::handlers::Handlers;
use super::items::Items;
use super::status::status_of;
use crate::service::ServiceError;
use crate::transports::requests::{self, PoseMessages, QueryMessages, SceneMessages};
use crate::transports::wire::v1;

/// What makes the messages of a stream, one after the other.
pub trait Messages: Send + Sized + 'static {
    /// A message.
    type Message: Items + Send + 'static;

    /// The next one; none at the end.
    fn next_message(&mut self) -> impl Future<Output = Result<Option<Self::Message>, ServiceError>> + Send;
}

impl Messages for SceneMessages {
    type Message = v1::WatchResponse;

    async fn next_message(&mut self) -> Result<Option<Self::Message>, ServiceError> {
        self.next().await.map(Some)
    }
}

impl Messages for PoseMessages<Streaming<v1::PoseStreamRequest>> {
    type Message = v1::PoseStreamResponse;

    async fn next_message(&mut self) -> Result<Option<Self::Message>, ServiceError> {
        self.next().await
    }
}

impl Messages for QueryMessages<Streaming<v1::QueryStreamRequest>> {
    type Message = v1::QueryStreamResponse;

    async fn next_message(&mut self) -> Result<Option<Self::Message>, ServiceError> {
        self.next().await
    }
}

type Step<M> = Pin<Box<dyn Future<Output = (M, Result<Option<<M as Messages>::Message>, ServiceError>)> + Send>>;

/// Messages as gRPC draws on them. Dropping it ends what makes them.
pub struct MessageStream<M: Messages> {
    /// Makes the next message once it is polled; none after the end.
    step: Option<Step<M>>,
    /// Whose share of items the messages are taken off.
    caller: Option<Caller>,
}

impl<M: Messages> MessageStream<M> {
    fn new(messages: M, caller: Option<Caller>) -> Self {
        Self { step: Some(step(messages, caller.clone())), caller }
    }
}

fn step<M: Messages>(mut messages: M, caller: Option<Caller>) -> Step<M> {
    Box::pin(async move {
        while let Some(wait) = caller.as_ref().and_then(|Caller(client)| client.items_wait()) {
            tokio::time::sleep(wait).await;
        }
        let message = messages.next_message().await;
        (messages, message)
    })
}

impl<M: Messages> Stream for MessageStream<M> {
    type Item = Result<M::Message, Status>;

    fn poll_next(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<Option<Self::Item>> {
        let Some(under_way) = &mut self.step else { return Poll::Ready(None) };
        let (messages, message) = ready!(under_way.as_mut().poll(context));
        self.step = None;
        match message {
            Ok(Some(message)) => {
                if let Some(Caller(client)) = &self.caller {
                    client.take_items(message.items());
                }
                self.step = Some(step(messages, self.caller.clone()));
                Poll::Ready(Some(Ok(message)))
            }
            Ok(None) => Poll::Ready(None),
            Err(error) => Poll::Ready(Some(Err(status_of(&error)))),
        }
    }
}

impl Handlers {
    pub(super) fn watch_scene(
        &self,
        request: &Request<v1::WatchRequest>,
    ) -> Result<MessageStream<SceneMessages>, ServiceError> {
        let timeout = grpc_timeout(request.metadata())?;
        let steps = requests::watch(&self.service, request.get_ref(), timeout)?;
        Ok(MessageStream::new(steps, caller(request)))
    }

    pub(super) fn poses(
        &self,
        request: Request<Streaming<v1::PoseStreamRequest>>,
    ) -> Result<MessageStream<PoseMessages<Streaming<v1::PoseStreamRequest>>>, ServiceError> {
        let timeout = grpc_timeout(request.metadata())?;
        let caller = caller(&request);
        Ok(MessageStream::new(requests::pose_stream(&self.service, request.into_inner(), timeout), caller))
    }

    pub(super) fn questions(
        &self,
        request: Request<Streaming<v1::QueryStreamRequest>>,
    ) -> Result<MessageStream<QueryMessages<Streaming<v1::QueryStreamRequest>>>, ServiceError> {
        let timeout = grpc_timeout(request.metadata())?;
        let caller = caller(&request);
        let questions = requests::query_stream(&self.service, request.into_inner(), timeout)?;
        Ok(MessageStream::new(questions, caller))
    }
}

fn caller<T>(request: &Request<T>) -> Option<Caller> {
    request.extensions().get::<Caller>().cloned()
}
