//! Poses as plain puts: every scene that somebody puts poses for has a feed, which makes revisions of what waits and tells what
//! became of it.

use std::collections::BTreeMap;
use std::convert::Infallible;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use prost::Message;
use tokio::runtime::Handle;
use tokio::sync::mpsc;
use tokio::task::JoinSet;
use tokio_stream::StreamExt;
use tokio_stream::wrappers::UnboundedReceiverStream;
use zenoh::bytes::Encoding;
use zenoh::handlers::{FifoChannel, FifoChannelHandler};
use zenoh::pubsub::Subscriber;
use zenoh::sample::{Sample, SampleKind};
use zenoh::{Result, Session, Wait};

use super::calls::Desk;
use super::keys::{Of, Posed};
use crate::limits::LimitExceeded;
use crate::service::{Seldom, ServiceError};
use crate::transports::requests;
use crate::transports::wire::v1::body_ref::By;
use crate::transports::wire::{to_proto, v1};

/// Puts that wait for the daemon before those who put have to.
const WAITING: usize = 256;
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
    /// Each tells its scene when it ends.
    running: JoinSet<String>,
    refused: Seldom,
}

#[derive(Debug)]
struct Feed {
    messages: mpsc::UnboundedSender<Waiting>,
    /// Bytes of those that wait. A scene that is slow to change holds up no other, and nobody's calls.
    bytes: Arc<AtomicUsize>,
    last: Instant,
}

/// A message that waits for its scene.
#[derive(Debug)]
struct Waiting {
    message: v1::PoseStreamRequest,
    bytes: usize,
}

impl Feed {
    /// Takes a message; it comes back if the feed has ended.
    fn take(&self, waiting: Waiting) -> std::result::Result<(), Waiting> {
        self.bytes.fetch_add(waiting.bytes, Ordering::AcqRel);
        self.messages.send(waiting).map_err(|mpsc::error::SendError(back)| back)
    }
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
                Some(ended) = self.running.join_next() => {
                    self.forget(ended.ok());
                    continue;
                }
            };
            // The session is closed.
            let Ok(put) = put else { return };
            if put.kind() == SampleKind::Put
                && let Some((scene, posed)) = self.desk.keys.posed(put.key_expr().as_str())
            {
                let taken = self.read(&put, posed).and_then(|waiting| self.feed(&scene, waiting));
                if let Err(error) = taken {
                    self.refuse(&scene, &error);
                }
            }
        }
    }

    /// The message that a put is, whatever its key.
    fn read(&self, put: &Sample, posed: Posed) -> std::result::Result<Waiting, ServiceError> {
        let bytes = put.payload().to_bytes();
        self.desk.received(bytes.len());
        LimitExceeded::check("max_message_bytes", bytes.len(), self.desk.service.limits().max_message_bytes)?;
        let malformed = |error| ServiceError::invalid("message", error);
        let Posed::One(of) = posed else {
            let message = v1::PoseStreamRequest::decode(&*bytes).map_err(malformed)?;
            return Ok(Waiting { message: alone(message)?, bytes: bytes.len() });
        };
        let pose = Some(v1::Pose::decode(&*bytes).map_err(malformed)?);
        let of_body = |by| v1::PoseStreamRequest {
            bodies: vec![v1::BodyPose { body: Some(v1::BodyRef { by: Some(by) }), pose }],
            ..v1::PoseStreamRequest::default()
        };
        let message = match of {
            Of::Body(name) => of_body(By::Name(name)),
            Of::Id(id) => of_body(By::Id(id)),
            Of::Robot(robot) => v1::PoseStreamRequest {
                robots: vec![v1::RobotPose { robot, base: pose }],
                ..v1::PoseStreamRequest::default()
            },
        };
        Ok(Waiting { message, bytes: bytes.len() })
    }

    /// A feed has ended: names of scenes that are not there must not gather, however many are put to.
    fn forget(&mut self, scene: Option<String>) {
        if let Some(scene) = scene
            && self.feeds.get(&scene).is_some_and(|feed| feed.messages.is_closed())
        {
            self.feeds.remove(&scene);
        }
    }

    /// Gives a message to its scene's feed, which begins if there is none.
    fn feed(&mut self, scene: &str, waiting: Waiting) -> std::result::Result<(), ServiceError> {
        let most = self.desk.service.limits().max_message_bytes;
        let waiting = match self.feeds.get_mut(scene) {
            None => waiting,
            Some(feed) => {
                LimitExceeded::check("max_message_bytes", feed.bytes.load(Ordering::Acquire) + waiting.bytes, most)?;
                feed.last = Instant::now();
                match feed.take(waiting) {
                    Ok(()) => return Ok(()),
                    // It has ended; the message begins the next one.
                    Err(back) => back,
                }
            }
        };
        let (messages, sent) = mpsc::unbounded_channel();
        let feed = Feed { messages, bytes: Arc::default(), last: Instant::now() };
        let begun =
            fed(Arc::clone(&self.desk), self.session.clone(), scene.to_owned(), (sent, Arc::clone(&feed.bytes)));
        // As with publications: what a task holds of zenoh must not be dropped inside `spawn`.
        self.running.spawn_on(begun, &Handle::current());
        let message = v1::PoseStreamRequest { scene: scene.to_owned(), ..waiting.message };
        // Its other end waits in the task.
        _ = feed.take(Waiting { message, ..waiting });
        self.feeds.insert(scene.to_owned(), feed);
        Ok(())
    }

    fn refuse(&self, scene: &str, error: &ServiceError) {
        if let Some(times) = self.refused.due() {
            tracing::warn!(scene, times, "poses put through zenoh were refused: {error}");
        }
        refuse(&self.desk, &self.session, scene, error);
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

/// Makes what comes, and tells what became of it, until no more comes or the scene is gone; returns the scene's name.
async fn fed(
    desk: Arc<Desk>,
    session: Session,
    scene: String,
    (sent, bytes): (mpsc::UnboundedReceiver<Waiting>, Arc<AtomicUsize>),
) -> String {
    let sent = UnboundedReceiverStream::new(sent).map(|waiting| {
        bytes.fetch_sub(waiting.bytes, Ordering::AcqRel);
        Ok::<_, Infallible>(waiting.message)
    });
    let mut made = requests::pose_stream(&desk.service, sent, None);
    let key = desk.keys.poses_made(&scene);
    loop {
        match made.next().await {
            Ok(Some(told)) => publish(&desk, &session, &key, told.encode_to_vec()),
            Ok(None) => return scene,
            Err(error) => {
                tracing::debug!(scene, "a feed of poses has ended: {error}");
                refuse(&desk, &session, &scene, &error);
                return scene;
            }
        }
    }
}

fn refuse(desk: &Desk, session: &Session, scene: &str, error: &ServiceError) {
    let message = to_proto::query_error(error).encode_to_vec();
    publish(desk, session, &desk.keys.poses_refused(scene), message);
}

/// Nobody has to listen. Where somebody listens and does not read, this waits a while before the message is dropped.
fn publish(desk: &Desk, session: &Session, key: &str, message: Vec<u8>) {
    desk.sent(message.len());
    let put = || session.put(key, message).encoding(Encoding::APPLICATION_PROTOBUF).wait();
    if let Err(error) = tokio::task::block_in_place(put) {
        tracing::debug!(key, "not told through zenoh: {error}");
    }
}

#[cfg(test)]
mod tests {
    use super::super::config::Config;
    use super::*;
    use crate::service::Service;

    #[tokio::test(flavor = "multi_thread")]
    async fn scenes_that_are_not_there_leave_nothing_behind() {
        let service = Service::new(&crate::service::Config { threads: 1, ..Default::default() }).unwrap();
        let config = Config::on_loopback("clearance");
        let session = zenoh::open(config.of_zenoh(service.limits()).unwrap()).await.unwrap();
        let desk = Desk::new(&session, &service, &config.keys().unwrap()).await.unwrap();
        let mut poses = Poses::new(&session, &desk).await.unwrap();
        for i in 0..100 {
            let waiting = Waiting { message: v1::PoseStreamRequest::default(), bytes: 0 };
            poses.feed(&format!("nowhere {i}"), waiting).unwrap();
        }
        while let Some(ended) = poses.running.join_next().await {
            poses.forget(ended.ok());
        }
        assert!(poses.feeds.is_empty(), "{:?}", poses.feeds);
    }

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
