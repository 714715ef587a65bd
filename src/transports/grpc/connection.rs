//! How long may a connection stay? Until it has been silent too long at its beginning, and, once the daemon drains, until
//! nothing is under way on it any more.
//!
//! HTTP/2 itself waits for ever for the first bytes of a client, and after a GOAWAY for a client's sign of life. Each
//! connection therefore has a minder, which can cut it: reads and writes then end with an error.

use std::io;
use std::pin::Pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::task::{Context, Poll};
use std::time::{Duration, Instant};

use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::{TcpStream, UnixStream};
use tokio::sync::{OwnedSemaphorePermit, oneshot, watch};
use tokio::time::sleep;
use tokio_rustls::server::TlsStream;
use tonic::transport::server::Connected;

use super::clients::Client;
use crate::service::Traffic;

/// Bytes after which a connection has begun: the preface of HTTP/2 and the head of its first frame. No call of
/// gRPC-Web is shorter.
const BEGUN: u64 = 24 + 9;
/// A connection of a draining daemon ends when no call is under way on it and nothing has moved for this long. A client
/// that reads what it is sent closes it much sooner.
const LULL: Duration = Duration::from_millis(500);

/// What bytes go through.
#[derive(Debug)]
pub(super) enum Socket {
    Tcp(TcpStream),
    Unix(UnixStream),
    Tls(Box<TlsStream<TcpStream>>),
}

/// A connection that was let in.
#[derive(Debug)]
pub(super) struct Connection {
    socket: Socket,
    peer: Peer,
    /// Comes, or loses its sender, when the connection is to end.
    cut: oneshot::Receiver<()>,
    is_cut: bool,
    _place: Place,
}

/// The place of a connection among all of a door.
#[derive(Debug)]
pub(super) struct Place {
    traffic: Arc<Traffic>,
    _permit: OwnedSemaphorePermit,
}

impl Place {
    /// A connection is there, until what is returned is dropped.
    pub fn new(permit: OwnedSemaphorePermit, traffic: Arc<Traffic>) -> Self {
        traffic.connections_opened.add(1);
        Self { traffic, _permit: permit }
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        self.traffic.connections_closed.add(1);
    }
}

/// What every call of a connection knows of it.
#[derive(Clone, Debug)]
pub(super) struct Peer {
    /// Who asks, as far as the connection tells.
    pub client: Arc<Client>,
    /// Where the connection is in its life.
    pub progress: Arc<Progress>,
}

/// Where a connection is in its life.
#[derive(Debug)]
pub(super) struct Progress {
    since: Instant,
    /// Bytes that came.
    read: AtomicU64,
    /// When bytes moved last, milliseconds after `since`.
    moved: AtomicU64,
    /// Calls under way.
    calls: AtomicUsize,
}

/// A call that is under way on a connection, until it is dropped.
#[derive(Debug)]
pub(super) struct OnConnection(Arc<Progress>);

impl Progress {
    fn new() -> Self {
        Self { since: Instant::now(), read: AtomicU64::new(0), moved: AtomicU64::new(0), calls: AtomicUsize::new(0) }
    }

    /// A call begins.
    pub fn enter(self: &Arc<Self>) -> OnConnection {
        self.calls.fetch_add(1, Ordering::AcqRel);
        OnConnection(Arc::clone(self))
    }

    fn moved(&self) {
        let now = self.since.elapsed().as_millis();
        self.moved.store(u64::try_from(now).unwrap_or(u64::MAX), Ordering::Release);
    }

    fn has_begun(&self) -> bool {
        self.read.load(Ordering::Acquire) >= BEGUN
    }

    fn is_idle(&self) -> bool {
        let last = Duration::from_millis(self.moved.load(Ordering::Acquire));
        self.calls.load(Ordering::Acquire) == 0 && self.since.elapsed().saturating_sub(last) >= LULL
    }
}

impl Drop for OnConnection {
    fn drop(&mut self) {
        self.0.moved();
        self.0.calls.fetch_sub(1, Ordering::AcqRel);
    }
}

impl Connection {
    /// A connection that has `patience` to begin, and ends in time once `draining` comes.
    pub fn new(
        socket: Socket,
        client: Arc<Client>,
        place: Place,
        patience: Duration,
        draining: watch::Receiver<bool>,
    ) -> Self {
        let progress = Arc::new(Progress::new());
        let (minder, cut) = oneshot::channel();
        tokio::spawn(mind(Arc::clone(&progress), minder, patience, draining));
        Self { socket, peer: Peer { client, progress }, cut, is_cut: false, _place: place }
    }

    /// # Errors
    /// The connection was cut.
    fn check(&mut self, context: &mut Context<'_>) -> io::Result<()> {
        self.is_cut = self.is_cut || Pin::new(&mut self.cut).poll(context).is_ready();
        if self.is_cut { Err(io::ErrorKind::ConnectionAborted.into()) } else { Ok(()) }
    }

    fn wrote(&self, outcome: Poll<io::Result<usize>>) -> Poll<io::Result<usize>> {
        if let Poll::Ready(Ok(1..)) = outcome {
            self.peer.progress.moved();
        }
        outcome
    }
}

/// Cuts the connection, by dropping its end of `cut`, when it may not stay.
async fn mind(
    progress: Arc<Progress>,
    mut cut: oneshot::Sender<()>,
    patience: Duration,
    mut draining: watch::Receiver<bool>,
) {
    let stay = async {
        tokio::select! {
            () = sleep(patience) => {}
            _ = draining.wait_for(|draining| *draining) => {}
        }
        if !progress.has_begun() {
            return;
        }
        // A door that is gone drains, too.
        drop(draining.wait_for(|draining| *draining).await);
        while !progress.is_idle() {
            sleep(LULL / 5).await;
        }
    };
    tokio::select! {
        () = stay => {}
        () = cut.closed() => {}
    }
}

impl Connected for Connection {
    type ConnectInfo = Peer;

    fn connect_info(&self) -> Peer {
        self.peer.clone()
    }
}

/// The same call for whatever socket it is.
macro_rules! on_socket {
    ($connection:expr, $socket:ident => $call:expr) => {
        match &mut $connection.socket {
            Socket::Tcp(socket) => {
                let $socket = Pin::new(socket);
                $call
            }
            Socket::Unix(socket) => {
                let $socket = Pin::new(socket);
                $call
            }
            Socket::Tls(socket) => {
                let $socket = Pin::new(socket.as_mut());
                $call
            }
        }
    };
}

impl AsyncRead for Connection {
    fn poll_read(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        self.check(context)?;
        let before = buffer.filled().len();
        let outcome = on_socket!(self, socket => socket.poll_read(context, buffer));
        let read = buffer.filled().len() - before;
        if read > 0 {
            self.peer.progress.read.fetch_add(read as u64, Ordering::AcqRel);
            self.peer.progress.moved();
        }
        outcome
    }
}

impl AsyncWrite for Connection {
    fn poll_write(mut self: Pin<&mut Self>, context: &mut Context<'_>, bytes: &[u8]) -> Poll<io::Result<usize>> {
        self.check(context)?;
        let outcome = on_socket!(self, socket => socket.poll_write(context, bytes));
        self.wrote(outcome)
    }

    fn poll_write_vectored(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        slices: &[io::IoSlice<'_>],
    ) -> Poll<io::Result<usize>> {
        self.check(context)?;
        let outcome = on_socket!(self, socket => socket.poll_write_vectored(context, slices));
        self.wrote(outcome)
    }

    fn is_write_vectored(&self) -> bool {
        match &self.socket {
            Socket::Tcp(socket) => socket.is_write_vectored(),
            Socket::Unix(socket) => socket.is_write_vectored(),
            Socket::Tls(socket) => socket.is_write_vectored(),
        }
    }

    fn poll_flush(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        self.check(context)?;
        on_socket!(self, socket => socket.poll_flush(context))
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        self.check(context)?;
        on_socket!(self, socket => socket.poll_shutdown(context))
    }
}
