//! What lasts: watches of a scene and of its contacts, poses at a high rate, questions one after the other. They speak the
//! messages of `proto/clearance/v1`; docs/streams.md says how they go on.

use tokio_stream::Stream;
use tonic::Streaming;

use super::client::Client;
use super::error::ClientError;
use crate::transports::wire::v1;

/// Messages of a daemon, for as long as it sends any. Dropping this ends the stream, and the work for it.
#[derive(Debug)]
pub struct Messages<M>(Streaming<M>);

impl<M> Messages<M> {
    /// The next one; none when the daemon is done.
    ///
    /// # Errors
    /// [`ClientError::Refused`] says why the daemon ended the stream.
    pub async fn next(&mut self) -> Result<Option<M>, ClientError> {
        Ok(self.0.message().await?)
    }
}

impl Client {
    /// What changes in a scene, revision by revision.
    ///
    /// # Errors
    /// [`ClientError`].
    pub async fn watch(&self, request: v1::WatchRequest) -> Result<Messages<v1::WatchResponse>, ClientError> {
        Ok(Messages(self.scenes().watch(request).await?.into_inner()))
    }

    /// Which contacts begin, stay and end, revision by revision.
    ///
    /// # Errors
    /// [`ClientError`].
    pub async fn watch_contacts(
        &self,
        request: v1::WatchContactsRequest,
    ) -> Result<Messages<v1::WatchContactsResponse>, ClientError> {
        Ok(Messages(self.queries().watch_contacts(request).await?.into_inner()))
    }

    /// Poses at a high rate; the last one of a body wins. The first message names the scene.
    ///
    /// # Errors
    /// [`ClientError`].
    pub async fn pose_stream(
        &self,
        poses: impl Stream<Item = v1::PoseStreamRequest> + Send + 'static,
    ) -> Result<Messages<v1::PoseStreamResponse>, ClientError> {
        Ok(Messages(self.scenes().pose_stream(poses).await?.into_inner()))
    }

    /// Questions of any kind, many at a time. One that is refused does not end the stream: `ClientError::from` its error.
    ///
    /// # Errors
    /// [`ClientError`].
    pub async fn query_stream(
        &self,
        questions: impl Stream<Item = v1::QueryStreamRequest> + Send + 'static,
    ) -> Result<Messages<v1::QueryStreamResponse>, ClientError> {
        Ok(Messages(self.queries().query_stream(questions).await?.into_inner()))
    }
}
