//! Asks a daemon through shared memory. It blocks; one request at a time. Every wait ends at the caller's own timeout,
//! because a daemon that was killed does not say so.

use std::path::Path;
use std::time::{Duration, Instant};

use iceoryx2::node::Node;
use iceoryx2::port::client::Client as Port;
use iceoryx2::port::listener::Listener;
use iceoryx2::port::notifier::Notifier;
use iceoryx2::prelude::{AllocationStrategy, BackpressureStrategy, PortName};
use iceoryx2::service::attribute::AttributeKey;
use iceoryx2::service::builder::request_response::RequestResponseOpenError;
use iceoryx2::service::port_factory::PortFactory as _;
use iceoryx2::service::port_factory::client::ClientCreateError;

use super::endpoint::{
    BadEndpoint, Endpoint, Events, Ipc, Line, Questions, attribute, lines, listener_name, sleep, told,
};
use super::layout::{ABI_HASH, ALIGNMENT, kind};
use super::message::{Ask, Envelope, call_message, request_message_in};
use super::reply::{Came, Refusal, Reply, decode};
use super::request::{ClientId, Nonce};
use super::sections::Malformed;
use super::space::{self, NoSpace};
use crate::limits::LimitExceeded;
use crate::service::Target;

/// What is said of a request beside the question.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// How long the answer is waited for; the daemon keeps to it, too.
    pub timeout: Duration,
    /// After this the caller wants what is there.
    pub time_budget: Option<Duration>,
    /// The sides of the nearest pair are wanted.
    pub wants_sides: bool,
    /// How long the answer is looked for before the thread sleeps.
    pub spin: Duration,
}

impl Default for Options {
    fn default() -> Self {
        let (timeout, spin) = (Duration::from_secs(10), Duration::ZERO);
        Self { timeout, time_budget: None, wants_sides: false, spin }
    }
}

/// Why there is no answer.
#[derive(Debug, thiserror::Error)]
pub enum ClientError {
    /// A name or folder that cannot be.
    #[error(transparent)]
    Endpoint(#[from] BadEndpoint),
    /// Nobody serves the name.
    #[error("no daemon serves shared memory under the name {name:?}: {problem}")]
    NoDaemon {
        /// The name.
        name: String,
        /// What the system says.
        problem: String,
    },
    /// All places for clients are taken.
    #[error("the daemon has as many shared-memory clients as it takes (limit max_shared_memory_clients)")]
    TooManyClients,
    /// The daemon was built for another layout.
    #[error("the daemon's messages have the layout {theirs}, this client's {ABI_HASH:016x}")]
    OtherLayout {
        /// The daemon's hash.
        theirs: String,
    },
    /// No room in /dev/shm.
    #[error("shared memory: {0}")]
    NoSpace(#[from] NoSpace),
    /// The request is larger than the daemon takes.
    #[error(transparent)]
    TooLarge(#[from] LimitExceeded),
    /// No answer came in time.
    #[error("no answer came in {0:?}")]
    Timeout(Duration),
    /// The daemon went away before it answered.
    #[error("the daemon went away before it answered")]
    Gone,
    /// The daemon refuses.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// What came is no answer.
    #[error("not an answer: {0}")]
    Malformed(#[from] Malformed),
    /// iceoryx2 refuses.
    #[error("shared memory: {0}")]
    System(String),
}

/// While it waits, a client looks this often whether the daemon is still alive.
const ALIVE: Duration = Duration::from_millis(250);

/// Whether the daemon has fetched the request before is looked at this often.
const FETCHED: Duration = Duration::from_millis(1);

/// A connection to a daemon on the same machine.
#[derive(Debug)]
pub struct Client {
    port: Port<Ipc, [Line], (), [Line], ()>,
    asked: Notifier<Ipc>,
    answered: Listener<Ipc>,
    id: ClientId,
    most_bytes: usize,
    questions: Questions,
    node: Node<Ipc>,
    nonces: Nonces,
    /// The last request: its memory serves the next.
    message: Vec<u8>,
}

/// Random bytes, fetched for many requests at a time.
#[derive(Debug)]
struct Nonces {
    bytes: [u8; 1024],
    used: usize,
}

impl Nonces {
    fn new() -> Self {
        Self { bytes: [0; 1024], used: 1024 }
    }

    fn next(&mut self) -> Result<Nonce, ClientError> {
        if self.used == self.bytes.len() {
            let mut filled = 0;
            while filled < self.bytes.len() {
                let more = rustix::rand::getrandom(&mut self.bytes[filled..], rustix::rand::GetRandomFlags::empty());
                filled += more.map_err(|error| ClientError::System(error.to_string()))?;
            }
            self.used = 0;
        }
        let mut nonce = Nonce::default();
        let end = self.used + nonce.len();
        nonce.copy_from_slice(&self.bytes[self.used..end]);
        self.used = end;
        Ok(nonce)
    }
}

impl Client {
    /// Connects to the daemon that serves `name`; `root` is its folder.
    ///
    /// # Errors
    /// [`ClientError`].
    pub fn connect(name: &str, root: &Path) -> Result<Self, ClientError> {
        let endpoint = Endpoint::new(name, root)?;
        let nobody = |problem: String| ClientError::NoDaemon { name: name.to_owned(), problem };
        if !root.is_dir() {
            return Err(nobody(format!("there is no folder {}", root.display())));
        }
        let node = endpoint.node().map_err(nobody)?;
        let service = node.service_builder(&endpoint.service("questions").map_err(ClientError::System)?);
        let questions = service.request_response::<[Line], [Line]>().open().map_err(|error| {
            let full = error == RequestResponseOpenError::ExceedsMaxNumberOfNodes;
            if full { ClientError::TooManyClients } else { nobody(told(error)) }
        })?;
        let theirs = attribute_of(&questions, attribute::ABI_HASH)?;
        if theirs != format!("{ABI_HASH:016x}") {
            return Err(ClientError::OtherLayout { theirs });
        }
        let most_bytes = attribute_of(&questions, attribute::REQUEST_BYTES)?;
        let most_bytes = most_bytes.parse().map_err(|_| ClientError::System(format!("{most_bytes:?} is no size")))?;
        // One request under way, one that the daemon has not let go of, one being written.
        space::check(3_usize.saturating_mul(most_bytes))?;
        let port = questions.client_builder();
        let port = port
            .initial_max_slice_len(most_bytes.div_ceil(ALIGNMENT))
            .allocation_strategy(AllocationStrategy::Static)
            // Delivering is tried again here, where the timeout is known.
            .backpressure_strategy(BackpressureStrategy::DiscardData)
            .create();
        let full = |error: &ClientCreateError| *error == ClientCreateError::ExceedsMaxSupportedClients;
        let port =
            port.map_err(
                |error| if full(&error) { ClientError::TooManyClients } else { ClientError::System(told(error)) },
            )?;
        space::take(&endpoint.prefix())?;
        let mut nonces = Nonces::new();
        let id = nonces.next()?;
        let events = |part| -> Result<Events, ClientError> {
            let service = node.service_builder(&endpoint.service(part).map_err(ClientError::System)?);
            service.event().open().map_err(|error| nobody(told(error)))
        };
        let listener = PortName::new(&listener_name(id)).map_err(|error| ClientError::System(told(error)))?;
        let asked = events("asked")?.notifier_builder().create();
        let answered = events("answered")?.listener_builder().name(&listener).create();
        let asked = asked.map_err(|error| ClientError::System(told(error)))?;
        let answered = answered.map_err(|error| ClientError::System(told(error)))?;
        Ok(Self { port, asked, answered, id, most_bytes, questions, node, nonces, message: Vec::new() })
    }

    /// The longest request that the daemon takes, bytes.
    #[must_use]
    pub fn most_bytes(&self) -> usize {
        self.most_bytes
    }

    /// Asks, and waits for the answer.
    ///
    /// # Errors
    /// [`ClientError`].
    pub fn ask(&mut self, target: &Target, ask: Ask<'_>, options: &Options) -> Result<Reply, ClientError> {
        let nonce = self.nonces.next()?;
        let Options { timeout, time_budget, wants_sides, .. } = *options;
        let client = self.id;
        let envelope = Envelope { target, timeout: Some(timeout), time_budget, wants_sides, nonce, client };
        let message = request_message_in(std::mem::take(&mut self.message), &envelope, ask);
        let reply = self.exchange(&message, nonce, options);
        self.message = message;
        reply
    }

    /// Calls an rpc by its name, for example `Scenes/Apply`, with the bytes of its request message, and waits for the bytes
    /// of its response message. Rpcs that stream answers are gRPC's alone.
    ///
    /// # Errors
    /// [`ClientError`].
    pub fn call(&mut self, rpc: &str, message: &[u8], timeout: Duration) -> Result<Vec<u8>, ClientError> {
        let nonce = self.nonces.next()?;
        let target = Target::default();
        let envelope = Envelope {
            target: &target,
            timeout: Some(timeout),
            time_budget: None,
            wants_sides: false,
            nonce,
            client: self.id,
        };
        let options = Options { timeout, ..Options::default() };
        let reply = self.exchange(&call_message(&envelope, rpc, message), nonce, &options)?;
        Ok(reply.bytes(kind::RESPONSE).unwrap_or_default().to_vec())
    }

    /// Sends bytes as they are and waits for the answer to `nonce`: for those who write messages themselves. An answer
    /// wakes the client only if the message has its [`Client::id`].
    ///
    /// # Errors
    /// [`ClientError`].
    pub fn exchange(&mut self, message: &[u8], nonce: Nonce, options: &Options) -> Result<Reply, ClientError> {
        LimitExceeded::check("max_shared_memory_request_bytes", message.len(), self.most_bytes)?;
        let system = |problem: String| ClientError::System(problem);
        let padded: Vec<u8>;
        let message = if message.len().is_multiple_of(ALIGNMENT) {
            message
        } else {
            padded = [message, &vec![0; message.len().next_multiple_of(ALIGNMENT) - message.len()]].concat();
            &padded
        };
        let (begun, mut looked) = (Instant::now(), Instant::now());
        let lines = lines(message);
        let pending = loop {
            let room = self.port.loan_slice_uninit(lines.len()).map_err(|error| system(told(error)))?;
            match room.write_from_slice(lines).send() {
                Ok(pending) if pending.number_of_server_connections() > 0 => break pending,
                Ok(_) if self.questions.dynamic_config().number_of_servers() == 0 => return Err(ClientError::Gone),
                // The daemon does not fetch: it still has the request that was given up before.
                Ok(_) if begun.elapsed() < options.timeout => std::thread::sleep(FETCHED),
                Ok(_) => return Err(ClientError::Timeout(options.timeout)),
                Err(error) => return Err(system(told(error))),
            }
        };
        self.asked.notify().map_err(|error| system(told(error)))?;
        loop {
            // Asked before the look for an answer, so that an answer sent before the end is not missed.
            let connected = pending.is_connected();
            if let Some(response) = pending.receive().map_err(|error| system(told(error)))? {
                match decode(response.payload().as_flattened().to_vec(), nonce)? {
                    Came::Reply(reply) => return Ok(reply),
                    Came::Refusal(refusal) => return Err(refusal.into()),
                    Came::Foreign => continue,
                }
            }
            if !connected {
                return Err(ClientError::Gone);
            }
            let waited = begun.elapsed();
            let Some(left) = options.timeout.checked_sub(waited) else {
                return Err(ClientError::Timeout(options.timeout));
            };
            if waited < options.spin {
                std::hint::spin_loop();
                continue;
            }
            sleep(&self.answered, left.min(ALIVE)).map_err(system)?;
            if looked.elapsed() >= ALIVE {
                // Only this makes the connection to a dead daemon end.
                self.node.try_cleanup_dead_nodes();
                looked = Instant::now();
            }
        }
    }

    /// What answers to this client are addressed with.
    #[must_use]
    pub fn id(&self) -> ClientId {
        self.id
    }
}

fn attribute_of(questions: &Questions, key: &str) -> Result<String, ClientError> {
    let key: AttributeKey = key.try_into().map_err(|error| ClientError::System(told(error)))?;
    let value = questions.attributes().key_value(&key, 0);
    Ok(value.map(|value| value.to_string()).unwrap_or_default())
}
