//! Where does the door listen, and how long? Binding is apart from serving, so that a caller can use port 0 and tell the
//! address before anything is served.

use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;

use tokio::net::{TcpListener, lookup_host};
use tonic::server::NamedService;
use tonic::transport::Server;
use tonic::transport::server::TcpIncoming;
use tonic_health::ServingStatus;
use tonic_reflection::server::Builder;

use super::handlers::Handlers;
use crate::service::{Door, Service};
use crate::transports::wire::v1;
use crate::transports::wire::v1::assets_server::AssetsServer;
use crate::transports::wire::v1::queries_server::QueriesServer;
use crate::transports::wire::v1::robots_server::RobotsServer;
use crate::transports::wire::v1::scenes_server::ScenesServer;
use crate::transports::wire::v1::server_server::ServerServer;

/// How much one connection may send before it has to wait, bytes: the default of 64 KiB caps long links.
const WINDOW: u32 = 8 << 20;
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

/// Where the door is to be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Config {
    /// HOST:PORT; port 0 means any free one.
    pub address: String,
    /// Listen beyond loopback although there is neither TLS nor a token.
    pub insecure: bool,
}

/// Why the door cannot be opened.
#[derive(Debug, thiserror::Error)]
pub enum BindError {
    /// Not a HOST:PORT that means an address of this machine.
    #[error("grpc.address {address:?}: {source}")]
    Address {
        /// As configured.
        address: String,
        /// What the system says.
        source: std::io::Error,
    },
    /// Anybody in the network could ask and change everything.
    #[error("grpc.address {address} is not a loopback address; without TLS it is only used with --insecure")]
    NotLoopback {
        /// The address.
        address: SocketAddr,
    },
}

impl Config {
    /// Opens the door; callers wait in front of it until it is served.
    ///
    /// # Errors
    /// [`BindError`].
    pub async fn bind(&self) -> Result<Listening, BindError> {
        let failed = |source| BindError::Address { address: self.address.clone(), source };
        let addresses: Vec<SocketAddr> = lookup_host(&self.address).await.map_err(failed)?.collect();
        if let Some(&address) = addresses.iter().find(|address| !address.ip().is_loopback())
            && !self.insecure
        {
            return Err(BindError::NotLoopback { address });
        }
        let listener = TcpListener::bind(addresses.as_slice()).await.map_err(failed)?;
        let address = listener.local_addr().map_err(failed)?;
        Ok(Listening { listener, address })
    }
}

/// An open door that nobody serves yet.
#[derive(Debug)]
pub struct Listening {
    listener: TcpListener,
    address: SocketAddr,
}

impl Listening {
    /// Where it is.
    #[must_use]
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// The door as the service lists it.
    #[must_use]
    pub fn door(&self) -> Door {
        Door { kind: "grpc", address: self.address.to_string() }
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
            .add_service(health_server)
            .add_service(reflection_v1)
            .add_service(reflection_v1alpha)
            .add_service(scenes.max_decoding_message_size(bytes).max_encoding_message_size(bytes))
            .add_service(assets.max_decoding_message_size(bytes).max_encoding_message_size(bytes))
            .add_service(robots.max_decoding_message_size(bytes).max_encoding_message_size(bytes))
            .add_service(queries.max_decoding_message_size(bytes).max_encoding_message_size(bytes))
            .add_service(server.max_decoding_message_size(bytes).max_encoding_message_size(bytes))
            .serve_with_incoming_shutdown(TcpIncoming::from(self.listener).with_nodelay(Some(true)), async {
                drain.await;
                for name in SERVICES {
                    health.set_service_status(name, ServingStatus::NotServing).await;
                }
            })
            .await
    }
}
