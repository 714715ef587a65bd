//! Where is the daemon looked at? `/metrics`, `/livez` and `/readyz` over HTTP/1.1, at an address of their own.
//!
//! Nobody who comes here holds up anything else: a connection answers one request and has a few seconds for it, the oldest makes
//! room where there are too many, and the daemon's end waits for none.

use std::collections::VecDeque;
use std::convert::Infallible;
use std::io;
use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;

use http_body_util::Full;
use hyper::body::{Bytes, Incoming};
use hyper::header::{ACCEPT, ALLOW, CACHE_CONTROL, CONTENT_TYPE, HeaderMap};
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper::{Method, Request, Response, StatusCode};
use hyper_util::rt::{TokioIo, TokioTimer};
use prometheus_client::encoding::{prometheus_text, text};
use prometheus_client::registry::Registry;
use tokio::net::{TcpListener, TcpStream, lookup_host};
use tokio::sync::Semaphore;
use tokio::task::{AbortHandle, JoinSet, spawn_blocking};
use tokio::time::{sleep, timeout};

use super::daemon_metrics::DaemonMetrics;
use super::process_metrics::ProcessMetrics;
use super::scene_checks::SceneChecks;
use super::scene_metrics::SceneMetrics;
use crate::service::Service;

/// Connections at a time. One more, and the oldest is closed: whoever holds on to connections cannot keep a probe out.
const CONNECTIONS: usize = 32;
/// A connection that has not sent the head of its request by then is closed.
const HEAD: Duration = Duration::from_secs(3);
/// A connection has this long in all.
const CONNECTION: Duration = Duration::from_secs(10);
/// The head of a request may have so many bytes.
const HEAD_BYTES: usize = 8 << 10;
/// When the system has no more file descriptors, closing of others is waited for.
const OUT_OF_FILES: Duration = Duration::from_millis(50);

const OPEN_METRICS: &str = "application/openmetrics-text; version=1.0.0; charset=utf-8";
const PLAIN: &str = "text/plain; charset=utf-8";

/// Where the endpoint is to be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MetricsConfig {
    /// HOST:PORT, where port 0 means any free one.
    pub address: String,
    /// Listen beyond loopback: whoever reaches the address reads the names of scenes and how busy the daemon is.
    pub exposed: bool,
    /// Scenes that have figures of their own, at most.
    pub scenes: usize,
}

/// Why the endpoint cannot be opened.
#[derive(Debug, thiserror::Error)]
pub enum EndpointError {
    /// Nothing that means an address of this machine, or one that is taken.
    #[error("metrics.address {address:?}: {source}")]
    Address {
        /// As configured.
        address: String,
        /// What the system says.
        source: io::Error,
    },
    /// Nobody said that the whole network may read it.
    #[error("metrics.address {address} is not a loopback address; it is only used with --metrics-exposed")]
    NotLoopback {
        /// The address.
        address: SocketAddr,
    },
}

impl MetricsConfig {
    /// Opens the endpoint; callers wait in front of it until it is served.
    ///
    /// # Errors
    /// [`EndpointError`].
    pub async fn bind(&self) -> Result<Endpoint, EndpointError> {
        let failed = |source| EndpointError::Address { address: self.address.clone(), source };
        let addresses: Vec<SocketAddr> = lookup_host(&self.address).await.map_err(failed)?.collect();
        if let Some(&address) = addresses.iter().find(|address| !address.ip().is_loopback())
            && !self.exposed
        {
            return Err(EndpointError::NotLoopback { address });
        }
        let listener = TcpListener::bind(addresses.as_slice()).await.map_err(failed)?;
        let address = listener.local_addr().map_err(failed)?;
        Ok(Endpoint { listener, address, scenes: self.scenes })
    }
}

/// An endpoint that nobody serves yet.
#[derive(Debug)]
pub struct Endpoint {
    listener: TcpListener,
    address: SocketAddr,
    scenes: usize,
}

impl Endpoint {
    /// Where it listens.
    #[must_use]
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// Serves what `registry` and the service tell, until it is dropped.
    pub async fn serve(self, service: Arc<Service>, mut registry: Registry) -> Infallible {
        let checks = Arc::new(SceneChecks::default());
        registry.register_collector(Box::new(DaemonMetrics::new(Arc::clone(&service))));
        registry.register_collector(Box::new(SceneMetrics::new(
            Arc::clone(&service),
            Arc::clone(&checks),
            self.scenes,
        )));
        registry.register_collector(Box::new(ProcessMetrics::new()));
        let board = Arc::new(Board { service: Arc::clone(&service), registry, one_at_a_time: Semaphore::new(1) });
        // Dropping the set ends all of its tasks.
        let mut tasks = JoinSet::new();
        tasks.spawn(checks.look(service, self.scenes));
        let mut connections: VecDeque<AbortHandle> = VecDeque::new();
        loop {
            match self.listener.accept().await {
                Ok((socket, _)) => {
                    while tasks.try_join_next().is_some() {}
                    connections.retain(|connection| !connection.is_finished());
                    if connections.len() >= CONNECTIONS
                        && let Some(oldest) = connections.pop_front()
                    {
                        oldest.abort();
                    }
                    connections.push_back(tasks.spawn(attend(socket, Arc::clone(&board))));
                }
                Err(error) => {
                    tracing::debug!(%error, "the metrics endpoint cannot accept a connection");
                    sleep(OUT_OF_FILES).await;
                }
            }
        }
    }
}

/// What is told.
#[derive(Debug)]
struct Board {
    service: Arc<Service>,
    registry: Registry,
    /// Scrapes are written one after the other.
    one_at_a_time: Semaphore,
}

async fn attend(socket: TcpStream, board: Arc<Board>) {
    let answer = service_fn(move |request| {
        let board = Arc::clone(&board);
        async move { Ok::<_, Infallible>(board.answer(request).await) }
    });
    let connection = http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(HEAD)
        .max_buf_size(HEAD_BYTES)
        .keep_alive(false)
        .serve_connection(TokioIo::new(socket), answer);
    match timeout(CONNECTION, connection).await {
        Ok(Ok(())) => {}
        Ok(Err(error)) => tracing::debug!(%error, "a connection of the metrics endpoint"),
        Err(_) => tracing::debug!("a connection of the metrics endpoint took too long"),
    }
}

type Page = Response<Full<Bytes>>;

impl Board {
    async fn answer(self: &Arc<Self>, request: Request<Incoming>) -> Page {
        if request.method() != Method::GET && request.method() != Method::HEAD {
            let mut refused = page(StatusCode::METHOD_NOT_ALLOWED, PLAIN, "only GET is answered here\n");
            refused.headers_mut().insert(ALLOW, hyper::header::HeaderValue::from_static("GET, HEAD"));
            return refused;
        }
        match request.uri().path() {
            "/metrics" => self.metrics(wants_open_metrics(request.headers())).await,
            "/livez" => page(StatusCode::OK, PLAIN, "live\n"),
            "/readyz" if self.service.is_draining() => page(StatusCode::SERVICE_UNAVAILABLE, PLAIN, "draining\n"),
            "/readyz" => page(StatusCode::OK, PLAIN, "ready\n"),
            _ => page(StatusCode::NOT_FOUND, PLAIN, "there are /metrics, /livez and /readyz\n"),
        }
    }

    async fn metrics(self: &Arc<Self>, open_metrics: bool) -> Page {
        let failed = |problem: &str| page(StatusCode::INTERNAL_SERVER_ERROR, PLAIN, format!("{problem}\n"));
        // It is never closed.
        let Ok(_turn) = self.one_at_a_time.acquire().await else { return failed("the daemon ends") };
        let board = Arc::clone(self);
        let written = spawn_blocking(move || {
            let mut out = String::new();
            let outcome = if open_metrics {
                text::encode(&mut out, &board.registry)
            } else {
                prometheus_text::encode(&mut out, &board.registry)
            };
            outcome.map(|()| out)
        });
        match written.await {
            Ok(Ok(out)) => {
                page(StatusCode::OK, if open_metrics { OPEN_METRICS } else { prometheus_text::CONTENT_TYPE }, out)
            }
            Ok(Err(_)) | Err(_) => failed("the metrics cannot be written"),
        }
    }
}

/// Prometheus says in its requests that it can read OpenMetrics; a person with curl does not.
fn wants_open_metrics(headers: &HeaderMap) -> bool {
    headers
        .get_all(ACCEPT)
        .iter()
        .any(|accept| accept.to_str().is_ok_and(|accept| accept.contains("application/openmetrics-text")))
}

fn page(status: StatusCode, content_type: &'static str, text: impl Into<Bytes>) -> Page {
    let mut page = Response::new(Full::new(text.into()));
    *page.status_mut() = status;
    page.headers_mut().insert(CONTENT_TYPE, hyper::header::HeaderValue::from_static(content_type));
    page.headers_mut().insert(CACHE_CONTROL, hyper::header::HeaderValue::from_static("no-store"));
    page
}
