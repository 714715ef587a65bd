//! Where does the door listen, and how long? Binding is apart from serving, so that a caller can use port 0 and tell the
//! address before anything is served.

use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;

use tokio::sync::watch;
use tokio_rustls::TlsAcceptor;
use tokio_stream::wrappers::ReceiverStream;
use tonic::server::NamedService;
use tonic::transport::Server;
use tonic_health::ServingStatus;
use tonic_reflection::server::Builder;
use tonic_web::GrpcWebLayer;
use tower::util::option_layer;
use tower_http::cors::CorsLayer;

use super::address::{Address, Listener, listen, listen_at, resolve};
use super::clients::Clients;
use super::gate::GateLayer;
use super::handlers::Handlers;
use super::incoming::Reception;
use super::tls::{TlsError, TlsFiles};
use super::tokens::{KnownToken, TokenError, TokenSource, Tokens};
use super::web::{BadOrigin, cors};
use crate::service::{Door, Service};
use crate::transports::wire::v1;
use crate::transports::wire::v1::assets_server::AssetsServer;
use crate::transports::wire::v1::queries_server::QueriesServer;
use crate::transports::wire::v1::robots_server::RobotsServer;
use crate::transports::wire::v1::scenes_server::ScenesServer;
use crate::transports::wire::v1::server_server::ServerServer;

/// What the door is called.
pub(super) const DOOR: &str = "grpc";
/// How much one connection may send before it has to wait, bytes: the default of 64 KiB caps long links.
pub(super) const WINDOW: u32 = 8 << 20;
/// Calls of one connection at a time.
const CALLS_PER_CONNECTION: u32 = 256;
/// A connection without traffic is asked for a sign of life this often, and closed when none comes.
const KEEPALIVE: Duration = Duration::from_secs(20);
const KEEPALIVE_TIMEOUT: Duration = Duration::from_secs(20);

/// What health is told of: the daemon as a whole, and each service.
const SERVICES: [&str; 6] = [
    "",
    ScenesServer::<Handlers>::NAME,
    AssetsServer::<Handlers>::NAME,
    RobotsServer::<Handlers>::NAME,
    QueriesServer::<Handlers>::NAME,
    ServerServer::<Handlers>::NAME,
];

/// Where the door is to be, and for whom.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Config {
    /// HOST:PORT, where port 0 means any free one; or `unix:PATH`.
    pub address: String,
    /// Listen beyond loopback although it is not both encrypted and closed to strangers.
    pub insecure: bool,
    /// The files of TLS; none: bytes go as they are.
    pub tls: Option<TlsFiles>,
    /// Who may do what; empty: everybody who can connect may do everything.
    pub tokens: Vec<TokenSource>,
    /// Origins of web pages that may ask by gRPC-Web; empty: the door does not speak it.
    pub allowed_origins: Vec<String>,
}

/// Why the door cannot be opened.
#[derive(Debug, thiserror::Error)]
pub enum BindError {
    /// Nothing that means an address of this machine, or one that is taken.
    #[error("grpc.address {address:?}: {source}")]
    Address {
        /// As configured.
        address: String,
        /// What the system says.
        source: std::io::Error,
    },
    /// Anybody in the network could ask and change everything, or read what others ask.
    #[error(
        "grpc.address {address} is not a loopback address; it is only used with TLS and a token or a client CA, or with --insecure"
    )]
    NotLoopback {
        /// The address.
        address: SocketAddr,
    },
    /// Nobody else sees what goes through a Unix socket.
    #[error("grpc.address {address:?} is a Unix socket, where grpc.tls has no meaning")]
    TlsOnUnix {
        /// As configured.
        address: String,
    },
    /// A file of TLS.
    #[error("grpc.tls: {0}")]
    Tls(#[from] TlsError),
    /// A token.
    #[error(transparent)]
    Token(#[from] TokenError),
    /// An origin.
    #[error(transparent)]
    Origin(#[from] BadOrigin),
}

impl Config {
    /// Opens the door; callers wait in front of it until it is served.
    ///
    /// # Errors
    /// [`BindError`].
    pub async fn bind(&self) -> Result<Listening, BindError> {
        let cors = cors(&self.allowed_origins)?;
        let tokens = self.tokens.iter().map(TokenSource::read).collect::<Result<Vec<_>, _>>()?;
        let tls = self.tls.as_ref().map(|files| files.acceptor(cors.is_some())).transpose()?;
        let failed = |source| BindError::Address { address: self.address.clone(), source };
        let Ok(address) = self.address.parse::<Address>();
        let listener = match address {
            Address::Unix(_) if tls.is_some() => {
                return Err(BindError::TlsOnUnix { address: self.address.clone() });
            }
            Address::Unix(path) => listen_at(&path).map_err(failed)?,
            Address::Tcp(host_and_port) => {
                let addresses = resolve(&host_and_port).await.map_err(failed)?;
                if let Some(&address) = addresses.iter().find(|address| !address.ip().is_loopback())
                    && !self.insecure
                    && !self.is_closed_to_strangers()
                {
                    return Err(BindError::NotLoopback { address });
                }
                listen(&addresses).await.map_err(failed)?
            }
        };
        Ok(Listening { listener, tls, tokens, cors })
    }

    /// Whether all that goes through the door is encrypted, and nobody comes in whom the daemon does not know.
    fn is_closed_to_strangers(&self) -> bool {
        self.tls.as_ref().is_some_and(|tls| tls.client_ca.is_some() || !self.tokens.is_empty())
    }
}

/// An open door that nobody serves yet.
pub struct Listening {
    listener: Listener,
    tls: Option<TlsAcceptor>,
    tokens: Vec<KnownToken>,
    cors: Option<CorsLayer>,
}

impl std::fmt::Debug for Listening {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Listening").field("listener", &self.listener).finish_non_exhaustive()
    }
}

impl Listening {
    /// The door as the service lists it.
    #[must_use]
    pub fn door(&self) -> Door {
        Door { kind: DOOR, address: self.listener.to_string() }
    }

    /// Serves until `drain` comes, then answers what is under way and closes.
    ///
    /// # Errors
    /// The system takes the socket away.
    pub async fn serve(
        self,
        service: Arc<Service>,
        drain: impl Future<Output = ()> + Send,
    ) -> Result<(), tonic::transport::Error> {
        let (health, health_server) = tonic_health::server::health_reporter();
        for name in SERVICES {
            health.set_service_status(name, ServingStatus::Serving).await;
        }
        let reflection = |builder: Builder<'static>| {
            builder
                .register_encoded_file_descriptor_set(v1::DESCRIPTORS)
                .register_encoded_file_descriptor_set(tonic_health::pb::FILE_DESCRIPTOR_SET)
        };
        let descriptors = "the descriptors were made by the same build";
        let reflection_v1 = reflection(Builder::configure()).build_v1().expect(descriptors);
        let reflection_v1alpha = reflection(Builder::configure()).build_v1alpha().expect(descriptors);

        let bytes = service.limits().max_message_bytes;
        let clients = Arc::new(Clients::new(service.limits()));
        let gate = GateLayer::new(Tokens::new(&self.tokens, &clients), Arc::clone(&service));
        let (draining, told_to_drain) = watch::channel(false);
        let (reception, connections) = Reception::new(self.listener, self.tls, clients, &service, told_to_drain);
        tokio::spawn(reception.run());
        let handlers = Handlers { service };
        let scenes = ScenesServer::new(handlers.clone());
        let assets = AssetsServer::new(handlers.clone());
        let robots = RobotsServer::new(handlers.clone());
        let queries = QueriesServer::new(handlers.clone());
        let server = ServerServer::new(handlers);
        Server::builder()
            .initial_stream_window_size(WINDOW)
            .initial_connection_window_size(WINDOW)
            .max_concurrent_streams(CALLS_PER_CONNECTION)
            .http2_keepalive_interval(Some(KEEPALIVE))
            .http2_keepalive_timeout(Some(KEEPALIVE_TIMEOUT))
            .accept_http1(self.cors.is_some())
            .layer(option_layer(self.cors.clone()))
            .layer(option_layer(self.cors.map(|_| GrpcWebLayer::new())))
            .layer(gate)
            .add_service(health_server)
            .add_service(reflection_v1)
            .add_service(reflection_v1alpha)
            .add_service(scenes.max_decoding_message_size(bytes).max_encoding_message_size(bytes))
            .add_service(assets.max_decoding_message_size(bytes).max_encoding_message_size(bytes))
            .add_service(robots.max_decoding_message_size(bytes).max_encoding_message_size(bytes))
            .add_service(queries.max_decoding_message_size(bytes).max_encoding_message_size(bytes))
            .add_service(server.max_decoding_message_size(bytes).max_encoding_message_size(bytes))
            .serve_with_incoming_shutdown(ReceiverStream::new(connections), async {
                drain.await;
                draining.send_replace(true);
                for name in SERVICES {
                    health.set_service_status(name, ServingStatus::NotServing).await;
                }
            })
            .await
    }
}
