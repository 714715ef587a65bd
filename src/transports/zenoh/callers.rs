//! Is the caller still there? zenoh does not tell the one who answers; a caller that wants its work to stop with it declares a
//! liveliness token, and names it in its queries.

use std::sync::Arc;

use tokio::sync::broadcast;
use tokio::sync::broadcast::error::RecvError;
use zenoh::liveliness::LivelinessToken;
use zenoh::pubsub::Subscriber;
use zenoh::sample::SampleKind;
use zenoh::{Result, Session};

use super::keys::Keys;

/// Departures that a call may have to catch up with. One that is overtaken by more misses some, and ends at its timeout.
const DEPARTURES: usize = 1024;

/// Tells calls whose callers leave.
#[derive(Debug)]
pub(super) struct Callers {
    left: broadcast::Sender<Arc<str>>,
    _tokens: Subscriber<()>,
}

impl Callers {
    /// Begins to look.
    pub async fn new(session: &Session, keys: &Keys) -> Result<Self> {
        let (left, _) = broadcast::channel(DEPARTURES);
        let (told, keys) = (left.clone(), keys.clone());
        let tokens = session.liveliness().declare_subscriber(keys.all_clients()).callback(move |sample| {
            if sample.kind() == SampleKind::Delete
                && let Some(client) = keys.client_of(sample.key_expr().as_str())
            {
                // Nobody waits: then nobody works for the caller.
                _ = told.send(client.into());
            }
        });
        Ok(Self { left, _tokens: tokens.await? })
    }

    /// Waits until the caller leaves.
    pub fn departure(&self, client: String) -> impl Future<Output = ()> + use<> {
        let mut left = self.left.subscribe();
        async move {
            loop {
                match left.recv().await {
                    Ok(one) if *one == *client => return,
                    Ok(_) | Err(RecvError::Lagged(_)) => {}
                    Err(RecvError::Closed) => std::future::pending().await,
                }
            }
        }
    }
}

/// A token that lasts as long as it is kept.
pub(super) async fn token(session: &Session, key: String) -> Result<LivelinessToken> {
    session.liveliness().declare_token(key).await
}
