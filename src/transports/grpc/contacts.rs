//! A watch of contacts as a stream of messages. It is drawn on by whoever reads: nothing is worked out, and nothing kept but
//! the rest of one step, before there is room for it in the connection.

use std::collections::VecDeque;
use std::pin::Pin;
use std::task::{Context, Poll, ready};

use tokio_stream::Stream;
use tonic::Status;

use super::status::status_of;
use crate::service::{ContactWatch, ServiceError};
use crate::transports::wire::{to_proto, v1};

type Messages = Vec<v1::WatchContactsResponse>;
type Step = Pin<Box<dyn Future<Output = Result<(ContactWatch, Messages), ServiceError>> + Send>>;

/// The messages of a watch. Dropping it ends the watch.
pub struct ContactStream {
    /// Works out the next step once it is polled; none after an error.
    step: Option<Step>,
    /// What is left of the last step.
    messages: VecDeque<v1::WatchContactsResponse>,
}

impl ContactStream {
    pub(super) fn new(watch: ContactWatch) -> Self {
        Self { step: Some(step(watch)), messages: VecDeque::new() }
    }
}

fn step(watch: ContactWatch) -> Step {
    Box::pin(watch.next(to_proto::contact_messages))
}

impl Stream for ContactStream {
    type Item = Result<v1::WatchContactsResponse, Status>;

    fn poll_next(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<Option<Self::Item>> {
        loop {
            if let Some(message) = self.messages.pop_front() {
                return Poll::Ready(Some(Ok(message)));
            }
            let Some(under_way) = &mut self.step else { return Poll::Ready(None) };
            match ready!(under_way.as_mut().poll(context)) {
                Ok((watch, messages)) => {
                    self.messages = messages.into();
                    self.step = Some(step(watch));
                }
                Err(error) => {
                    self.step = None;
                    return Poll::Ready(Some(Err(status_of(&error))));
                }
            }
        }
    }
}
