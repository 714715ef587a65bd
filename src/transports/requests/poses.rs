//! The rpc `PoseStream`: poses in, what became of them out. It goes on when its answers are read: a caller that reads none is
//! not read from either, when its connection is full.

use std::sync::Arc;
use std::time::Duration;

use tokio_stream::{Stream, StreamExt};

use crate::scene::Epoch;
use crate::service::{Patience, PoseFeed, Service, ServiceError};
use crate::transports::wire::{from_proto, to_proto, v1};

/// A stream of poses that is under way. Dropping it ends it; what waits then is not made.
#[derive(Debug)]
pub struct PoseMessages<S> {
    service: Arc<Service>,
    timeout: Option<Duration>,
    sent: S,
    /// Since the first message.
    feed: Option<PoseFeed>,
    /// Messages taken since something was made.
    taken: usize,
    ended: bool,
}

/// Messages that are taken before something is made, however fast they come.
const TAKEN_AT_ONCE: usize = 64;

/// Takes poses from `sent`. An error among them ends the stream, and what waits is not made: the caller is gone.
#[must_use]
pub fn pose_stream<S>(service: &Arc<Service>, sent: S, timeout: Option<Duration>) -> PoseMessages<S> {
    PoseMessages { service: Arc::clone(service), timeout, sent, feed: None, taken: 0, ended: false }
}

impl<S, E> PoseMessages<S>
where
    S: Stream<Item = Result<v1::PoseStreamRequest, E>> + Unpin,
{
    /// What became of the poses since the last time; none once the caller has ended the stream and all is told.
    ///
    /// # Errors
    /// As [`Service::feed_poses`], [`PoseFeed::take`] and [`PoseFeed::make`]; a first message that cannot be. Then the stream has
    /// ended.
    pub async fn next(&mut self) -> Result<Option<v1::PoseStreamResponse>, ServiceError> {
        loop {
            let Some(feed) = &mut self.feed else {
                match self.sent.next().await {
                    Some(Ok(first)) => self.begin(&first)?,
                    Some(Err(_)) | None => return Ok(None),
                }
                continue;
            };
            // What has come already is taken before anything is made, so that it is made together.
            let message = if self.ended {
                None
            } else if feed.is_idle() {
                tokio::select! {
                    message = self.sent.next() => message,
                    error = feed.ends() => return Err(error),
                }
            } else {
                let more = self.taken < TAKEN_AT_ONCE || !feed.is_due();
                tokio::select! {
                    biased;
                    message = self.sent.next(), if more => message,
                    error = feed.ends() => return Err(error),
                    () = feed.pause() => {
                        self.taken = 0;
                        return Ok(Some(to_proto::pose_stream_response(feed.make().await?)));
                    }
                }
            };
            self.taken += 1;
            match message {
                Some(Ok(message)) => take(feed, &message)?,
                Some(Err(_)) => return Ok(None),
                None if feed.is_idle() => return Ok(None),
                None => {
                    self.ended = true;
                    return Ok(Some(to_proto::pose_stream_response(feed.make().await?)));
                }
            }
        }
    }

    fn begin(&mut self, first: &v1::PoseStreamRequest) -> Result<(), ServiceError> {
        if first.scene.is_empty() {
            return Err(ServiceError::invalid("scene", "is empty in the first message"));
        }
        let interval = from_proto::pose_interval(first.interval)?;
        let patience = Patience { timeout: self.timeout, time_budget: None };
        let mut feed = self.service.feed_poses(&first.scene, first.epoch.map(Epoch), interval, patience)?;
        let (poses, refused) = from_proto::poses(first);
        feed.take(poses, refused)?;
        self.feed = Some(feed);
        Ok(())
    }
}

fn take(feed: &mut PoseFeed, message: &v1::PoseStreamRequest) -> Result<(), ServiceError> {
    for (field, said) in [
        ("scene", !message.scene.is_empty()),
        ("epoch", message.epoch.is_some()),
        ("interval", message.interval != 0.0),
    ] {
        if said {
            return Err(ServiceError::invalid(field, "is for the first message"));
        }
    }
    let (poses, refused) = from_proto::poses(message);
    feed.take(poses, refused)
}
