//! Batches of robot states whose positions and verdicts go as arrays, the form for large batches: what the benches of the
//! doors ask with.

use prost::Message;
use prost::bytes::Bytes;
use tokio::sync::mpsc;
use tokio_stream::StreamExt;
use tokio_stream::wrappers::ReceiverStream;
use tonic::transport::{Channel, Endpoint};

use super::client::{ClientError, WINDOW};
use crate::query::CheckStates;
use crate::service::Target;
use crate::transports::wire::v1::queries_client::QueriesClient;
use crate::transports::wire::v1::query_stream_request::Question;
use crate::transports::wire::v1::query_stream_response::Outcome;
use crate::transports::wire::{to_proto, v1};

/// A batch as it is sent, any number of times.
#[derive(Clone, Debug)]
pub struct BulkStates(v1::CheckStatesRequest);

impl BulkStates {
    /// A question with its answer as arrays.
    #[must_use]
    pub fn new(target: &Target, question: &CheckStates) -> Self {
        let mut message = to_proto::check_states_request(target, question);
        if let Some(context) = &mut message.context {
            context.answer_form = v1::AnswerForm::Bulk.into();
        }
        Self(message)
    }

    /// Bytes of the message.
    #[must_use]
    pub fn message_bytes(&self) -> usize {
        self.0.encoded_len()
    }

    /// The message, for doors that carry any message as bytes.
    #[must_use]
    pub fn encoded(&self) -> Vec<u8> {
        self.0.encode_to_vec()
    }
}

/// The verdicts of a batch.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct BulkVerdicts {
    verdicts: Bytes,
    message_bytes: usize,
}

impl BulkVerdicts {
    /// From the bytes of the response message.
    ///
    /// # Errors
    /// There are none in it.
    pub fn decode(message: Bytes) -> Result<Self, ClientError> {
        let response = v1::CheckStatesResponse::decode(message).map_err(|_| ClientError::Missing("message"))?;
        Self::of(response)
    }

    fn of(response: v1::CheckStatesResponse) -> Result<Self, ClientError> {
        let message_bytes = response.encoded_len();
        let bulk = response.answer.and_then(|answer| answer.bulk).ok_or(ClientError::Missing("answer.bulk"))?;
        Ok(Self { verdicts: bulk.verdicts, message_bytes })
    }

    /// For each state whether it is proved free.
    #[must_use]
    pub fn free(&self) -> Vec<bool> {
        self.verdicts.iter().map(|&verdict| i32::from(verdict) == v1::Verdict::Free as i32).collect()
    }

    /// Bytes of the response message.
    #[must_use]
    pub fn message_bytes(&self) -> usize {
        self.message_bytes
    }
}

/// A connection that batches go over. Cloning shares it.
#[derive(Clone, Debug)]
pub struct BulkClient {
    queries: QueriesClient<Channel>,
}

impl BulkClient {
    /// Connects to `HOST:PORT` or `unix:PATH`.
    ///
    /// # Errors
    /// [`ClientError::Unreachable`].
    pub async fn connect(address: &str) -> Result<Self, ClientError> {
        let unreachable = |source| ClientError::Unreachable { address: address.to_owned(), source };
        let url = if address.starts_with("unix:") { address.to_owned() } else { format!("http://{address}") };
        let endpoint = Endpoint::from_shared(url).map_err(unreachable)?;
        let endpoint =
            endpoint.tcp_nodelay(true).initial_stream_window_size(WINDOW).initial_connection_window_size(WINDOW);
        let channel = endpoint.connect().await.map_err(unreachable)?;
        Ok(Self { queries: QueriesClient::new(channel).max_decoding_message_size(usize::MAX) })
    }

    /// One batch, by a call of its own.
    ///
    /// # Errors
    /// [`ClientError`].
    pub async fn check_states(&self, batch: &BulkStates) -> Result<BulkVerdicts, ClientError> {
        BulkVerdicts::of(self.queries.clone().check_states(batch.0.clone()).await?.into_inner())
    }

    /// The same batch again and again through one stream, so many under way, as long as there are `more`. How many were
    /// answered.
    ///
    /// # Errors
    /// [`ClientError`].
    pub async fn stream(
        &self,
        batch: &BulkStates,
        under_way: usize,
        mut more: impl FnMut() -> bool,
    ) -> Result<usize, ClientError> {
        let (sender, sent) = mpsc::channel(under_way.max(1));
        let request = || v1::QueryStreamRequest { id: 0, question: Some(Question::CheckStates(batch.0.clone())) };
        for _ in 0..under_way {
            // The other end is kept until the call.
            _ = sender.send(request()).await;
        }
        let mut answers = self.queries.clone().query_stream(ReceiverStream::new(sent)).await?.into_inner();
        let (mut sender, mut answered) = (Some(sender), 0);
        while let Some(answer) = answers.next().await {
            let Some(Outcome::CheckStates(response)) = answer?.outcome else {
                return Err(ClientError::Missing("check_states"));
            };
            BulkVerdicts::of(response)?;
            answered += 1;
            // The end of the questions is the end of the answers, once all are there.
            sender = sender.filter(|_| more());
            if let Some(sender) = &sender {
                // A stream that has ended says so by its next answer.
                _ = sender.send(request()).await;
            }
        }
        Ok(answered)
    }
}
