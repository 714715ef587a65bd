//! Asks a daemon through zenoh. A call that is dropped is only stopped by its timeout; a client that is gone stops all of its
//! own, and a watch that is dropped stops by its token.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::time::Duration;

use prost::Message;
use prost::bytes::Bytes;
use serde_json::json;
use tokio::sync::mpsc;
use zenoh::Session;
use zenoh::bytes::Encoding;
use zenoh::handlers::{DefaultHandler, FifoChannel};
use zenoh::liveliness::LivelinessToken;
use zenoh::qos::CongestionControl;
use zenoh::query::{ConsolidationMode, Reply};
use zenoh::session::SessionGetBuilder;

use super::callers::token;
use super::keys::{BadPrefix, Keys, Of};
use crate::geometry::Pose;
use crate::transports::wire::to_proto;
use crate::transports::wire::v1::{self, QueryError};

/// Why there is no answer.
#[derive(Debug, thiserror::Error)]
pub enum ClientError {
    /// What the keys are to begin with.
    #[error(transparent)]
    Prefix(#[from] BadPrefix),
    /// No daemon with that prefix is in reach.
    #[error("no daemon answers under {prefix:?}")]
    NoDaemon {
        /// What its keys begin with.
        prefix: String,
    },
    /// No answer came in time.
    #[error("no answer came in {0:?}")]
    Timeout(Duration),
    /// The daemon refuses.
    #[error(transparent)]
    Refused(Box<Refusal>),
    /// What came is no answer.
    #[error("not an answer: {0}")]
    Malformed(#[from] prost::DecodeError),
    /// A watch was read so slowly that it was given up.
    #[error("more than {WAITING} bytes of a watch waited to be read")]
    TooSlow,
    /// zenoh refuses.
    #[error("zenoh: {0}")]
    System(String),
}

/// A request that was refused.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message} ({reason})")]
pub struct Refusal {
    /// The number of the gRPC status.
    pub code: i32,
    /// The reason for programs, as in `ErrorReason`, for example `INVALID_FIELD`.
    pub reason: &'static str,
    /// The reason for people.
    pub message: String,
    /// What else is known by name, for example `clearance-field`.
    pub details: BTreeMap<String, String>,
}

impl Refusal {
    /// Reads the payload of an error reply.
    fn read(payload: &[u8]) -> Result<Self, prost::DecodeError> {
        let error = QueryError::decode(payload)?;
        let reason = to_proto::reason_name(error.reason());
        Ok(Self { code: error.code, reason, message: error.message, details: error.details.into_iter().collect() })
    }

    /// The field that cannot be as it is.
    #[must_use]
    pub fn field(&self) -> Option<&str> {
        self.details.get("clearance-field").map(String::as_str)
    }
}

fn system(error: zenoh::Error) -> ClientError {
    ClientError::System(error.to_string())
}

/// The daemon gives up first, so that its own answer arrives.
const LONGER: Duration = Duration::from_millis(500);
/// Bytes of a watch that may wait to be read. Nobody else on the connection waits for a slow reader.
const WAITING: usize = 64 << 20;

/// A connection to the network of a daemon.
#[derive(Debug)]
pub struct Client {
    session: Session,
    keys: Keys,
    /// What the daemon knows the client by.
    id: String,
    watches: AtomicU64,
    _token: LivelinessToken,
}

impl Client {
    /// Connects to a daemon or a router at `endpoint`, for example `tcp/127.0.0.1:50552`, and looks for nobody else.
    ///
    /// # Errors
    /// [`ClientError::Prefix`], or [`ClientError::System`] where nobody listens.
    pub async fn connect(endpoint: &str, prefix: &str) -> Result<Self, ClientError> {
        Self::open(client_of(endpoint).map_err(system)?, prefix).await
    }

    /// Joins the network as a configuration of zenoh says.
    ///
    /// # Errors
    /// [`ClientError::Prefix`], [`ClientError::System`].
    pub async fn open(config: zenoh::Config, prefix: &str) -> Result<Self, ClientError> {
        let keys = Keys::new(prefix)?;
        let session = zenoh::open(config).await.map_err(system)?;
        let id = session.zid().to_string();
        let _token = token(&session, keys.client(&id)).await.map_err(system)?;
        Ok(Self { session, keys, id, watches: AtomicU64::new(0), _token })
    }

    /// Calls an rpc that answers with one message, by `SERVICE/METHOD`; `message` has the bytes of its request message, the answer
    /// those of its response message.
    ///
    /// # Errors
    /// [`ClientError`].
    pub async fn call(
        &self,
        rpc: &str,
        message: impl Into<Vec<u8>> + Send,
        timeout: Duration,
    ) -> Result<Bytes, ClientError> {
        let parameters = format!("client={}", self.id);
        let query = self.query(rpc, message.into(), timeout, &parameters);
        // Two daemons of one prefix are more than there should be.
        let replies = query.with(FifoChannel::new(2)).await.map_err(system)?;
        match replies.recv_async().await {
            Ok(reply) => told(reply, timeout),
            Err(_) => Err(ClientError::NoDaemon { prefix: self.keys.prefix().to_owned() }),
        }
    }

    /// Begins a watch, by the rpc's `SERVICE/METHOD`. It ends with `timeout`, after as many `steps` as are said, or when it is dropped.
    ///
    /// # Errors
    /// [`ClientError::System`].
    pub async fn watch(
        &self,
        rpc: &str,
        message: impl Into<Vec<u8>> + Send,
        timeout: Duration,
        steps: Option<u64>,
    ) -> Result<Watch, ClientError> {
        let id = format!("{}/{}", self.id, self.watches.fetch_add(1, Ordering::Relaxed));
        let _token = token(&self.session, self.keys.client(&id)).await.map_err(system)?;
        let steps = steps.map(|steps| format!(";steps={steps}")).unwrap_or_default();
        let (sender, replies) = mpsc::unbounded_channel();
        let waiting = Arc::new(AtomicUsize::new(0));
        let query = self.query(rpc, message.into(), timeout, &format!("client={id}{steps}"));
        let counted = Arc::clone(&waiting);
        let taken = move |reply: Reply| {
            let bytes = reply.result().map_or(0, |sample| sample.payload().len());
            // What is beyond the bound is let go of, and the reader is told.
            if counted.load(Ordering::Acquire) <= WAITING {
                counted.fetch_add(bytes, Ordering::AcqRel);
                // A watch that was dropped has no reader.
                _ = sender.send(reply);
            }
        };
        query.callback(taken).await.map_err(system)?;
        Ok(Watch { replies, waiting, timeout, _token })
    }

    fn query(
        &self,
        rpc: &str,
        message: Vec<u8>,
        timeout: Duration,
        parameters: &str,
    ) -> SessionGetBuilder<'_, 'static, DefaultHandler> {
        let selector = format!("{}?timeout={};{parameters}", self.keys.call(rpc), timeout.as_secs_f64());
        self.session
            .get(selector)
            .payload(message)
            .encoding(Encoding::APPLICATION_PROTOBUF)
            .timeout(timeout + LONGER)
            .consolidation(ConsolidationMode::None)
            .congestion_control(CongestionControl::Block)
            .express(true)
    }

    /// Moves one body or robot of a scene. Nobody says what becomes of it.
    ///
    /// # Errors
    /// [`ClientError::System`].
    pub async fn put_pose(&self, scene: &str, of: &Of, pose: &Pose) -> Result<(), ClientError> {
        self.put(&self.keys.pose(scene, of), to_proto::pose(pose).encode_to_vec()).await
    }

    /// Moves bodies and robots of a scene together: `message` has `bodies` and `robots` alone.
    ///
    /// # Errors
    /// [`ClientError::System`].
    pub async fn put_poses(&self, scene: &str, message: &v1::PoseStreamRequest) -> Result<(), ClientError> {
        self.put(&self.keys.poses(scene), message.encode_to_vec()).await
    }

    async fn put(&self, key: &str, message: Vec<u8>) -> Result<(), ClientError> {
        let put = self.session.put(key, message).encoding(Encoding::APPLICATION_PROTOBUF);
        put.congestion_control(CongestionControl::Block).express(true).await.map_err(system)
    }

    /// The session, for what is beyond calls: subscriptions, tokens.
    #[must_use]
    pub fn session(&self) -> &Session {
        &self.session
    }

    /// The daemon's keys.
    #[must_use]
    pub fn keys(&self) -> &Keys {
        &self.keys
    }
}

/// What zenoh is told of a client of one endpoint that looks for nobody else.
pub(super) fn client_of(endpoint: &str) -> zenoh::Result<zenoh::Config> {
    let mut config = zenoh::Config::default();
    let told = [
        ("mode", json!("client")),
        ("connect/endpoints", json!([endpoint])),
        ("connect/retry", json!({"period_init_ms": 100, "period_max_ms": 1000, "period_increase_factor": 2})),
        ("listen/endpoints", json!([])),
        ("scouting/multicast/enabled", json!(false)),
        ("scouting/gossip/enabled", json!(false)),
    ];
    for (key, value) in told {
        config.insert_json5(key, &value.to_string())?;
    }
    Ok(config)
}

/// Messages of a watch. Dropping it ends it.
#[derive(Debug)]
pub struct Watch {
    replies: mpsc::UnboundedReceiver<Reply>,
    /// Bytes of replies that are not read yet.
    waiting: Arc<AtomicUsize>,
    timeout: Duration,
    _token: LivelinessToken,
}

impl Watch {
    /// The next message, once there is one; none after the last of the steps that were asked for, or when the daemon is gone.
    ///
    /// # Errors
    /// [`ClientError`]. Then the watch has ended.
    pub async fn next(&mut self) -> Result<Option<Bytes>, ClientError> {
        if self.waiting.load(Ordering::Acquire) > WAITING {
            return Err(ClientError::TooSlow);
        }
        let Some(reply) = self.replies.recv().await else { return Ok(None) };
        let message = told(reply, self.timeout)?;
        self.waiting.fetch_sub(message.len(), Ordering::AcqRel);
        Ok(Some(message))
    }
}

fn told(reply: Reply, timeout: Duration) -> Result<Bytes, ClientError> {
    match reply.into_result() {
        Ok(sample) => Ok(sample.payload().to_bytes().into_owned().into()),
        // zenoh's own errors are texts; the daemon's say what they are.
        Err(error) if error.encoding() != &Encoding::APPLICATION_PROTOBUF => Err(ClientError::Timeout(timeout)),
        Err(error) => Err(ClientError::Refused(Box::new(Refusal::read(&error.payload().to_bytes())?))),
    }
}
