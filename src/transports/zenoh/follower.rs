//! Follows a scene: steps as the daemon publishes them, and what was missed from the scene's own log.

use std::collections::VecDeque;
use std::time::Duration;

use prost::Message;
use zenoh::handlers::{RingChannel, RingChannelHandler};
use zenoh::pubsub::Subscriber;
use zenoh::sample::{Sample, SampleKind};
use zenoh_ext::{AdvancedSubscriber, AdvancedSubscriberBuilderExt, HistoryConfig, RecoveryConfig};

use super::client::{Client, ClientError};
use crate::transports::wire::v1;

/// Steps that wait to be read. A reader that is slower misses the oldest, sees the gap, and asks for what leads on; nobody else on
/// the connection waits for it.
const WAITING: usize = 256;
/// How long the log is waited for.
const PATIENCE: Duration = Duration::from_secs(10);
/// A log that cannot be asked is asked again after so long.
const AGAIN: Duration = Duration::from_millis(200);

/// Leads a copy of a scene from revision to revision.
#[derive(Debug)]
pub struct Follower<'a> {
    client: &'a Client,
    scene: String,
    published: AdvancedSubscriber<RingChannelHandler<Sample>>,
    /// The daemon comes and goes.
    alive: Subscriber<RingChannelHandler<Sample>>,
    /// Life of the scene and revision that the copy is at.
    at: Option<(u64, u64)>,
    /// Messages of steps that are not told yet.
    ready: VecDeque<v1::WatchResponse>,
    /// A published step in parts, as far as it came.
    parts: Vec<v1::WatchResponse>,
    behind: bool,
}

impl Client {
    /// Follows a scene, beginning with its whole content.
    ///
    /// # Errors
    /// [`ClientError::System`].
    pub async fn follow(&self, scene: &str) -> Result<Follower<'_>, ClientError> {
        let system = |error: zenoh::Error| ClientError::System(error.to_string());
        let published = self
            .session()
            .declare_subscriber(self.keys().changes(scene))
            .with(RingChannel::new(WAITING))
            .history(HistoryConfig::default().detect_late_publishers())
            .recovery(RecoveryConfig::default().heartbeat())
            .await
            .map_err(system)?;
        let alive = self.session().liveliness().declare_subscriber(self.keys().alive()).history(true);
        let alive = alive.with(RingChannel::new(WAITING)).await.map_err(system)?;
        Ok(Follower {
            client: self,
            scene: scene.to_owned(),
            published,
            alive,
            at: None,
            ready: VecDeque::new(),
            parts: Vec::new(),
            behind: true,
        })
    }
}

impl Follower<'_> {
    /// The next message: each leads on from the one before, in the sense of `WatchResponse`.
    ///
    /// # Errors
    /// The daemon refuses, for example because the scene is gone. Nobody who answers is waited for.
    pub async fn next(&mut self) -> Result<v1::WatchResponse, ClientError> {
        loop {
            if let Some(message) = self.ready.pop_front() {
                return Ok(message);
            }
            if self.behind {
                self.catch_up().await?;
                continue;
            }
            tokio::select! {
                sample = self.published.recv_async() => {
                    let sample = sample.map_err(|error| ClientError::System(error.to_string()))?;
                    self.take(v1::WatchResponse::decode(&*sample.payload().to_bytes())?);
                }
                token = self.alive.recv_async() => {
                    let token = token.map_err(|error| ClientError::System(error.to_string()))?;
                    // It is back, perhaps another one, and may have told steps meanwhile.
                    self.behind = token.kind() == SampleKind::Put;
                }
            }
        }
    }

    /// A published message counts if it leads on from where the copy is; if it should and does not, something is missing.
    fn take(&mut self, message: v1::WatchResponse) {
        let Some((epoch, revision)) = self.at else { return self.behind = true };
        if message.epoch == epoch && message.revision <= revision {
            return;
        }
        if message.epoch != epoch || message.from_revision != Some(revision) {
            self.parts.clear();
            self.behind = true;
            return;
        }
        let complete = !message.more;
        self.parts.push(message);
        if complete {
            self.tell();
        }
    }

    /// The step is complete.
    fn tell(&mut self) {
        self.at = self.parts.last().map(|last| (last.epoch, last.revision));
        self.ready.extend(self.parts.drain(..));
    }

    /// What leads to the newest revision, out of the scene's log.
    async fn catch_up(&mut self) -> Result<(), ClientError> {
        self.parts.clear();
        let request = v1::WatchRequest {
            scene: self.scene.clone(),
            epoch: self.at.map(|(epoch, _)| epoch),
            from_revision: self.at.map(|(_, revision)| revision),
            shapes: true,
        };
        let mut watch = self.client.watch("Scenes/Watch", request.encode_to_vec(), PATIENCE, Some(1)).await?;
        loop {
            match watch.next().await {
                Ok(Some(message)) => self.parts.push(v1::WatchResponse::decode(message)?),
                Ok(None) if self.parts.last().is_some_and(|last| !last.more) => break,
                // Nobody is there, for now.
                Ok(None) | Err(ClientError::Timeout(_)) => {
                    self.parts.clear();
                    tokio::time::sleep(AGAIN).await;
                    return Ok(());
                }
                // Another life of the scene: everything comes anew.
                Err(ClientError::Refused(refusal)) if refusal.reason == "WRONG_EPOCH" => {
                    self.at = None;
                    return Ok(());
                }
                Err(error) => return Err(error),
            }
        }
        let is_news = |message: &v1::WatchResponse| message.from_revision != Some(message.revision);
        if self.parts.iter().any(is_news) {
            self.tell();
        } else {
            self.parts.clear();
        }
        self.behind = false;
        Ok(())
    }
}
