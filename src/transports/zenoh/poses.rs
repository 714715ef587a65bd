//! Poses as plain puts: every scene that somebody puts poses for has a feed, which makes revisions of what waits and tells what
//! became of it.

use std::collections::BTreeMap;
use std::convert::Infallible;
use std::sync::Arc;
use std::time::{Duration, Instant};

use prost::Message;
use tokio::sync::mpsc;
use tokio::task::JoinSet;
use tokio_stream::StreamExt;
use tokio_stream::wrappers::ReceiverStream;
use zenoh::bytes::Encoding;
use zenoh::handlers::{FifoChannel, FifoChannelHandler};
use zenoh::pubsub::Subscriber;
use zenoh::sample::{Sample, SampleKind};
use zenoh::{Result, Session};

use super::calls::Desk;
use super::keys::{Of, Posed};
use crate::limits::LimitExceeded;
use crate::service::{Seldom, ServiceError};
use crate::transports::requests;
use crate::transports::wire::v1::body_ref::By;
use crate::transports::wire::{to_proto, v1};

/// Puts that wait for the daemon before those who put have to.
const WAITING: usize = 256;
/// Messages that wait for a feed.
const WAITING_FOR_FEED: usize = 64;
/// A feed without puts ends after so long.
const IDLE: Duration = Duration::from_secs(10);

type Puts = Subscriber<FifoChannelHandler<Sample>>;

/// Takes puts.
#[derive(Debug)]
pub(super) struct Poses {
    desk: Arc<Desk>,
    session: Session,
    many: Puts,
    single: Puts,
    /// Where messages for a scene go.
    feeds: BTreeMap<String, Feed>,
    running: JoinSet<()>,
    refused: Seldom,
}

#[derive(Debug)]
struct Feed {
    messages: mpsc::Sender<v1::PoseStreamRequest>,
    last: Instant,
}

impl Poses {
    /// Begins to listen.
    pub async fn new(session: &Session, desk: &Arc<Desk>) -> Result<Self> {
        let [many, single] = desk.keys.all_poses();
        Ok(Self {
            desk: Arc::clone(desk),
            session: session.clone(),
            many: session.declare_subscriber(many).with(FifoChannel::new(WAITING)).await?,
            single: session.declare_subscriber(single).with(FifoChannel::new(WAITING)).await?,
            feeds: BTreeMap::new(),
            running: JoinSet::new(),
            refused: Seldom::new(),
        })
    }

    /// Takes puts until it is dropped; the feeds end with it.
    pub async fn run(mut self) {
        loop {
            let idle_since = self.feeds.values().map(|feed| feed.last).min();
            let look = async {
                match idle_since {
                    Some(last) => tokio::time::sleep_until((last + IDLE).into()).await,
                    None => std::future::pending().await,
                }
            };
            let put = tokio::select! {
                put = self.many.recv_async() => put,
                put = self.single.recv_async() => put,
                () = look => {
                    // A feed that gets no more messages makes what waits, and ends.
                    self.feeds.retain(|_, feed| feed.last.elapsed() < IDLE);
                    continue;
                }
                Some(_) = self.running.join_next() => continue,
            };
            // The session is closed.
            let Ok(put) = put else { return };
            if put.kind() == SampleKind::Put
                && let Some((scene, posed)) = self.desk.keys.posed(put.key_expr().as_str())
            {
                match self.read(&put, posed) {
                    Ok(message) => self.feed(scene, message).await,
                    Err(error) => self.refuse(&scene, &error).await,
                }
            }
        }
    }

    /// The message that a put is, whatever its key.
    fn read(&self, put: &Sample, posed: Posed) -> std::result::Result<v1::PoseStreamRequest, ServiceError> {
        let bytes = put.payload().to_bytes();
        self.desk.received(bytes.len());
        LimitExceeded::check("max_message_bytes", bytes.len(), self.desk.service.limits().max_message_bytes)?;
        let malformed = |error| ServiceError::invalid("message", error);
        let Posed::One(of) = posed else {
            let message = v1::PoseStreamRequest::decode(&*bytes).map_err(malformed)?;
            return alone(message);
        };
        let pose = Some(v1::Pose::decode(&*bytes).map_err(malformed)?);
        let of_body = |by| v1::PoseStreamRequest {
            bodies: vec![v1::BodyPose { body: Some(v1::BodyRef { by: Some(by) }), pose }],
            ..v1::PoseStreamRequest::default()
        };
        Ok(match of {
            Of::Body(name) => of_body(By::Name(name)),
            Of::Id(id) => of_body(By::Id(id)),
            Of::Robot(robot) => v1::PoseStreamRequest {
                robots: vec![v1::RobotPose { robot, base: pose }],
                ..v1::PoseStreamRequest::default()
            },
        })
    }

    /// Gives a message to its scene's feed, which begins if there is none.
    async fn feed(&mut self, scene: String, mut message: v1::PoseStreamRequest) {
        if let Some(feed) = self.feeds.get_mut(&scene) {
            feed.last = Instant::now();
            match feed.messages.send(message).await {
                Ok(()) => return,
                // It has ended; the message begins the next one.
                Err(mpsc::error::SendError(back)) => message = back,
            }
        }
        let (messages, sent) = mpsc::channel(WAITING_FOR_FEED);
        message.scene.clone_from(&scene);
        // There is room for the first.
        _ = messages.try_send(message);
        self.running.spawn(fed(Arc::clone(&self.desk), self.session.clone(), scene.clone(), sent));
        self.feeds.insert(scene, Feed { messages, last: Instant::now() });
    }

    async fn refuse(&self, scene: &str, error: &ServiceError) {
        if let Some(times) = self.refused.due() {
            tracing::warn!(scene, times, "poses put through zenoh were refused: {error}");
        }
        refuse(&self.desk, &self.session, scene, error).await;
    }
}

/// A put says nothing of its scene, which is in its key, nor what is for streams alone.
fn alone(message: v1::PoseStreamRequest) -> std::result::Result<v1::PoseStreamRequest, ServiceError> {
    let said = [
        ("scene", !message.scene.is_empty()),
        ("epoch", message.epoch.is_some()),
        ("interval", message.interval != 0.0),
    ];
    match said.into_iter().find(|(_, said)| *said) {
        Some((field, _)) => Err(ServiceError::invalid(field, "has no meaning in a put")),
        None => Ok(message),
    }
}

/// Makes what comes, and tells what became of it, until no more comes or the scene is gone.
async fn fed(desk: Arc<Desk>, session: Session, scene: String, sent: mpsc::Receiver<v1::PoseStreamRequest>) {
    let sent = ReceiverStream::new(sent).map(Ok::<_, Infallible>);
    let mut made = requests::pose_stream(&desk.service, sent, None);
    let key = desk.keys.poses_made(&scene);
    loop {
        match made.next().await {
            Ok(Some(told)) => publish(&desk, &session, &key, told.encode_to_vec()).await,
            Ok(None) => return,
            Err(error) => {
                tracing::debug!(scene, "a feed of poses has ended: {error}");
                return refuse(&desk, &session, &scene, &error).await;
            }
        }
    }
}

async fn refuse(desk: &Desk, session: &Session, scene: &str, error: &ServiceError) {
    let message = to_proto::query_error(error).encode_to_vec();
    publish(desk, session, &desk.keys.poses_refused(scene), message).await;
}

/// Nobody has to listen, and nobody waits for those who listen slowly.
async fn publish(desk: &Desk, session: &Session, key: &str, message: Vec<u8>) {
    desk.sent(message.len());
    if let Err(error) = session.put(key, message).encoding(Encoding::APPLICATION_PROTOBUF).await {
        tracing::debug!(key, "not told through zenoh: {error}");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_put_says_nothing_that_is_for_streams() {
        let field = |message| alone(message).unwrap_err().to_string();
        let plain = v1::PoseStreamRequest::default;
        assert!(alone(plain()).is_ok());
        assert!(field(v1::PoseStreamRequest { scene: "cell".to_owned(), ..plain() }).starts_with("scene: "));
        assert!(field(v1::PoseStreamRequest { epoch: Some(0), ..plain() }).starts_with("epoch: "));
        assert!(field(v1::PoseStreamRequest { interval: f64::NAN, ..plain() }).starts_with("interval: "));
    }
}
