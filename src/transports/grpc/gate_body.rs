//! The bodies of a call behind the gate: what is asked comes no faster than its client may send, and the call is under way
//! until the last of the answer has gone.

use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll, ready};

use http_body::{Body as HttpBody, Frame, SizeHint};
use prost::bytes::Bytes;
use tokio::time::{Sleep, sleep};
use tonic::Status;
use tonic::body::Body;

use super::clients::{Call, Client};
use super::connection::OnConnection;
use super::outcome::outcome_of;
use super::refusal::name_message_limit;
use crate::service::{Call as ObservedCall, Traffic};

/// What a client sends.
pub(super) struct Asked {
    inner: Body,
    client: Arc<Client>,
    traffic: Arc<Traffic>,
    /// The client sent too much before.
    wait: Option<Pin<Box<Sleep>>>,
}

impl Asked {
    pub fn new(inner: Body, client: Arc<Client>, traffic: Arc<Traffic>) -> Self {
        Self { inner, client, traffic, wait: None }
    }
}

impl HttpBody for Asked {
    type Data = Bytes;
    type Error = Status;

    fn poll_frame(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<Option<Result<Frame<Bytes>, Status>>> {
        loop {
            if let Some(wait) = &mut self.wait {
                ready!(wait.as_mut().poll(context));
                self.wait = None;
            }
            match self.client.bytes_wait() {
                Some(wait) => self.wait = Some(Box::pin(sleep(wait))),
                None => break,
            }
        }
        let frame = ready!(Pin::new(&mut self.inner).poll_frame(context));
        if let Some(Ok(frame)) = &frame {
            let bytes = frame.data_ref().map_or(0, Bytes::len);
            self.client.take_bytes(bytes);
            self.traffic.received_bytes.add(bytes as u64);
        }
        Poll::Ready(frame)
    }

    fn is_end_stream(&self) -> bool {
        self.inner.is_end_stream()
    }

    fn size_hint(&self) -> SizeHint {
        self.inner.size_hint()
    }
}

/// Of an answer, so much goes on to the connection at a time, bytes. The connection asks for more when the reader has taken
/// nearly all of it; given a large answer in one piece, it would hold all of it for as long as the reader likes, and the call
/// would count as over.
const PIECE: usize = 256 << 10;

/// What a client is sent.
pub(super) struct Answered {
    inner: Body,
    /// What is left of a frame that was larger than a piece.
    rest: Bytes,
    call: Call,
    /// Of a stream: the call as observers see it, which ends with the stream.
    observed: ObservedCall,
    traffic: Arc<Traffic>,
    _on_connection: OnConnection,
}

impl Answered {
    pub fn new(
        inner: Body,
        (call, on_connection): (Call, OnConnection),
        observed: ObservedCall,
        traffic: Arc<Traffic>,
    ) -> Self {
        Self { inner, rest: Bytes::new(), call, observed, traffic, _on_connection: on_connection }
    }
}

impl HttpBody for Answered {
    type Data = Bytes;
    type Error = Status;

    fn poll_frame(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<Option<Result<Frame<Bytes>, Status>>> {
        if self.rest.is_empty() {
            let frame = match ready!(Pin::new(&mut self.inner).poll_frame(context)) {
                Some(Ok(frame)) => frame,
                other => return Poll::Ready(other),
            };
            match frame.into_data() {
                Ok(data) if data.is_empty() => return Poll::Ready(Some(Ok(Frame::data(data)))),
                Ok(data) => {
                    self.call.client().take_bytes(data.len());
                    self.traffic.sent_bytes.add(data.len() as u64);
                    self.rest = data;
                }
                Err(mut frame) => {
                    if let Some(trailers) = frame.trailers_mut() {
                        name_message_limit(trailers);
                        self.observed.end(outcome_of(trailers));
                    }
                    return Poll::Ready(Some(Ok(frame)));
                }
            }
        }
        let size = self.rest.len().min(PIECE);
        let piece = self.rest.split_to(size);
        Poll::Ready(Some(Ok(Frame::data(piece))))
    }

    fn is_end_stream(&self) -> bool {
        self.rest.is_empty() && self.inner.is_end_stream()
    }

    fn size_hint(&self) -> SizeHint {
        if self.rest.is_empty() { self.inner.size_hint() } else { SizeHint::new() }
    }
}
