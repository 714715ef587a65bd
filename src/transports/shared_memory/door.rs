//! Where is the door, and how long is it open? Opening takes all the memory that will ever be needed, so that nothing
//! can run out later.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use iceoryx2::node::Node;
use iceoryx2::port::listener::Listener;
use iceoryx2::port::notifier::Notifier;
use iceoryx2::port::server::Server;
use iceoryx2::prelude::{AllocationStrategy, BackpressureStrategy};
use iceoryx2::service::attribute::AttributeVerifier;
use iceoryx2::service::port_factory::server::ServerCreateError;
use tokio::runtime::Handle;
use tokio::sync::oneshot;

use super::attendant::Attendant;
use super::endpoint::{BadEndpoint, Endpoint, Events, Ipc, Line, Questions, UNDER_WAY, alignment, attribute, told};
use super::layout::{ABI_HASH, ALIGNMENT};
use super::space::{self, NoSpace};
use crate::limits::Limits;
use crate::service::{Door, Service};

/// Where the door is to be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Config {
    /// 1 to 32 of a-z, 0-9, _ and -; no other door of the machine may have it.
    pub name: String,
    /// Absolute path of the folder for what both sides know of each other.
    pub root: PathBuf,
    /// How long the door looks for the next request before it sleeps.
    pub spin: Duration,
}

/// Why the door cannot be opened.
#[derive(Debug, thiserror::Error)]
pub enum BindError {
    /// A name or folder that cannot be.
    #[error(transparent)]
    Endpoint(#[from] BadEndpoint),
    /// Sizes that leave no room for an error, or none for any client.
    #[error("limits.{limit} {value} is less than {least}")]
    TooSmall {
        /// Which limit.
        limit: &'static str,
        /// As it is.
        value: usize,
        /// What it has to be.
        least: usize,
    },
    /// No room in /dev/shm.
    #[error("shared memory: {0}")]
    NoSpace(#[from] NoSpace),
    /// Another daemon has the name.
    #[error("another daemon serves shared memory under the name {name:?}; choose another shared_memory.name")]
    Taken {
        /// The name.
        name: String,
    },
    /// iceoryx2 or the system refuses.
    #[error("shared memory {name:?} in {root}: {problem}", root = root.display())]
    System {
        /// The name.
        name: String,
        /// The folder.
        root: PathBuf,
        /// What it says.
        problem: String,
    },
}

/// What the door is called.
pub(super) const DOOR: &str = "shared-memory";
/// An error has to fit into an answer, and a header into a request.
const LEAST_BYTES: usize = 64 << 10;

/// The server's port.
pub(super) type Port = Server<Ipc, [Line], (), [Line], ()>;

/// What the door keeps open. The order of the fields is the order in which they are closed.
#[derive(Debug)]
pub(super) struct Ports {
    pub server: Port,
    pub asked: Listener<Ipc>,
    pub answered: Arc<Notifier<Ipc>>,
    /// Wakes who sleeps at `asked`.
    pub wake: Arc<Notifier<Ipc>>,
    pub node: Node<Ipc>,
}

/// An open door that nobody serves yet.
#[derive(Debug)]
pub struct Listening {
    endpoint: Endpoint,
    spin: Duration,
    ports: Ports,
}

impl Config {
    /// Opens the door; callers wait in front of it until it is served.
    ///
    /// # Errors
    /// [`BindError`].
    pub fn bind(&self, limits: &Limits) -> Result<Listening, BindError> {
        let endpoint = Endpoint::new(&self.name, &self.root)?;
        let (clients, answer) = (limits.max_shared_memory_clients, limits.max_shared_memory_response_bytes);
        at_least("max_shared_memory_clients", clients, 1)?;
        at_least("max_shared_memory_request_bytes", limits.max_shared_memory_request_bytes, LEAST_BYTES)?;
        at_least("max_shared_memory_response_bytes", answer, LEAST_BYTES)?;
        let answers = 2 * clients + 1;
        space::check(answers.saturating_mul(answer))?;
        let failed = |problem| BindError::System { name: self.name.clone(), root: self.root.clone(), problem };
        self.make_root().map_err(|error| failed(error.to_string()))?;
        let node = endpoint.node().map_err(failed)?;
        let questions = questions(&endpoint, &node, limits).map_err(failed)?;
        let server = questions
            .server_builder()
            .initial_max_slice_len(answer.div_ceil(ALIGNMENT))
            .allocation_strategy(AllocationStrategy::Static)
            .backpressure_strategy(BackpressureStrategy::DiscardData)
            .max_loaned_responses_per_request(1)
            .override_response_preallocation(move |_| answers)
            .create();
        let taken = |error: &ServerCreateError| *error == ServerCreateError::ExceedsMaxSupportedServers;
        let server = server.map_err(|error| {
            if taken(&error) { BindError::Taken { name: self.name.clone() } } else { failed(told(error)) }
        })?;
        let asked = events(&endpoint, &node, "asked", 1, clients + 2).map_err(failed)?;
        let answered = events(&endpoint, &node, "answered", clients + 1, 1).map_err(failed)?;
        let wake = asked.notifier_builder().create().map_err(told).map_err(failed)?;
        let ports = Ports {
            server,
            asked: asked.listener_builder().create().map_err(told).map_err(failed)?,
            answered: Arc::new(answered.notifier_builder().create().map_err(told).map_err(failed)?),
            wake: Arc::new(wake),
            node,
        };
        space::take(&endpoint.prefix())?;
        Ok(Listening { endpoint, spin: self.spin, ports })
    }

    /// Only the same user gets in: the folder says where the segments are.
    fn make_root(&self) -> std::io::Result<()> {
        if self.root.is_dir() {
            return Ok(());
        }
        fs::create_dir_all(&self.root)?;
        fs::set_permissions(&self.root, fs::Permissions::from_mode(0o700))
    }
}

fn at_least(limit: &'static str, value: usize, least: usize) -> Result<(), BindError> {
    if value < least { Err(BindError::TooSmall { limit, value, least }) } else { Ok(()) }
}

pub(super) fn questions(endpoint: &Endpoint, node: &Node<Ipc>, limits: &Limits) -> Result<Questions, String> {
    let clients = limits.max_shared_memory_clients;
    let told_to_clients = [
        (attribute::ABI_HASH, format!("{ABI_HASH:016x}")),
        (attribute::REQUEST_BYTES, limits.max_shared_memory_request_bytes.to_string()),
    ];
    let mut attributes = AttributeVerifier::new();
    for (key, value) in told_to_clients {
        let (key, value) = (key.try_into().map_err(told)?, value.as_str().try_into().map_err(told)?);
        attributes = attributes.require(&key, &value).map_err(told)?;
    }
    node.service_builder(&endpoint.service("questions")?)
        .request_response::<[Line], [Line]>()
        .request_payload_alignment(alignment())
        .response_payload_alignment(alignment())
        .enable_safe_overflow_for_requests(false)
        .enable_safe_overflow_for_responses(false)
        .enable_fire_and_forget_requests(false)
        .max_active_requests_per_client(UNDER_WAY)
        .max_loaned_requests(1)
        .max_response_buffer_size(1)
        .max_borrowed_responses_per_pending_response(1)
        .max_servers(1)
        .max_clients(clients)
        // One more, so that a client too many is told that there are too many clients.
        .max_nodes(clients + 2)
        .open_or_create_with_attributes(&attributes)
        .map_err(|error| format!("{error:?}; clients of a daemon with other limits may still be there"))
}

pub(super) fn events(
    endpoint: &Endpoint,
    node: &Node<Ipc>,
    part: &str,
    listeners: usize,
    notifiers: usize,
) -> Result<Events, String> {
    let service = node.service_builder(&endpoint.service(part)?).event();
    let nodes = listeners.max(notifiers) + 2;
    let service = service.max_listeners(listeners).max_notifiers(notifiers).max_nodes(nodes).event_id_max_value(1);
    service.open_or_create().map_err(told)
}

impl Listening {
    /// The door as the service lists it.
    #[must_use]
    pub fn door(&self) -> Door {
        Door { kind: DOOR, address: self.endpoint.name().to_owned() }
    }

    /// Serves until `drain` comes, then answers what is under way and closes.
    ///
    /// # Errors
    /// The memory is taken away, or there is no thread.
    pub async fn serve(self, service: Arc<Service>, drain: impl Future<Output = ()> + Send) -> Result<(), String> {
        let Self { spin, ports, .. } = self;
        let wake = Arc::clone(&ports.wake);
        let draining = Arc::new(AtomicBool::new(false));
        let attendant = Attendant::new(ports, service, Handle::current(), spin, Arc::clone(&draining));
        let (ended, mut end) = oneshot::channel();
        thread::Builder::new()
            .name("shared-memory".to_owned())
            // Nobody waits any more only when the daemon has given up on draining.
            .spawn(move || drop(ended.send(attendant.attend())))
            .map_err(|error| error.to_string())?;
        let gone = "the thread that serves shared memory panicked";
        tokio::select! {
            ended = &mut end => return ended.unwrap_or_else(|_| Err(gone.to_owned())),
            () = drain => {}
        }
        draining.store(true, Ordering::Release);
        // Without a wake-up the thread sees it at its next look.
        _ = wake.notify();
        end.await.unwrap_or_else(|_| Err(gone.to_owned()))
    }
}
