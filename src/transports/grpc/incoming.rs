//! Who is let in? As many connections as there may be, and of these, where the door has TLS, the ones that shake hands in
//! time.

use std::io;
use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;

use tokio::net::{TcpStream, UnixStream};
use tokio::sync::{OwnedSemaphorePermit, Semaphore, mpsc, watch};
use tokio::task::JoinSet;
use tokio::time::{sleep, timeout};
use tokio_rustls::TlsAcceptor;

use super::address::Listener;
use super::certificate::client_name;
use super::clients::{Client, Clients};
use super::connection::{Connection, Place, Socket};
use super::door::DOOR;
use crate::limits::Limits;
use crate::service::{Seldom, Service, Traffic};

/// When the system has no more file descriptors, closing of others is waited for.
const OUT_OF_FILES: Duration = Duration::from_millis(50);

/// What a socket becomes before it is served.
pub(super) struct Reception {
    listener: Listener,
    tls: Option<TlsAcceptor>,
    clients: Arc<Clients>,
    places: Arc<Semaphore>,
    max_connections: usize,
    patience: Duration,
    draining: watch::Receiver<bool>,
    let_in: mpsc::Sender<io::Result<Connection>>,
    turned_away: Seldom,
    traffic: Arc<Traffic>,
}

impl Reception {
    /// Whoever is let in comes out of the receiver.
    pub fn new(
        listener: Listener,
        tls: Option<TlsAcceptor>,
        clients: Arc<Clients>,
        service: &Service,
        draining: watch::Receiver<bool>,
    ) -> (Self, mpsc::Receiver<io::Result<Connection>>) {
        let (let_in, connections) = mpsc::channel(16);
        let limits: &Limits = service.limits();
        let max_connections = limits.max_connections.min(Semaphore::MAX_PERMITS);
        let reception = Self {
            listener,
            tls,
            clients,
            places: Arc::new(Semaphore::new(max_connections)),
            max_connections,
            patience: Duration::from_secs(limits.max_handshake_seconds as u64),
            draining,
            let_in,
            turned_away: Seldom::new(),
            traffic: service.traffic(DOOR),
        };
        (reception, connections)
    }

    /// Lets connections in until the door drains; then the socket is closed, and so is whoever still shakes hands.
    pub async fn run(self) {
        let mut draining = self.draining.clone();
        tokio::select! {
            () = self.accept() => {}
            // A door that is gone drains, too.
            _ = draining.wait_for(|draining| *draining) => {}
        }
    }

    async fn accept(&self) {
        let mut handshakes = JoinSet::new();
        loop {
            let accepted = match &self.listener {
                Listener::Tcp(listener, _) => listener.accept().await.map(|(socket, from)| Accepted::Tcp(socket, from)),
                Listener::Unix(listener, _) => listener.accept().await.map(|(socket, _)| Accepted::Unix(socket)),
            };
            while handshakes.try_join_next().is_some() {}
            let accepted = match accepted {
                Ok(accepted) => accepted,
                Err(error) => {
                    if let Some(times) = self.turned_away.due() {
                        tracing::warn!(%error, times, "connections cannot be accepted");
                    }
                    sleep(OUT_OF_FILES).await;
                    continue;
                }
            };
            let Ok(place) = Arc::clone(&self.places).try_acquire_owned() else {
                self.traffic.connections_refused.add(1);
                if let Some(times) = self.turned_away.due() {
                    let max_connections = self.max_connections;
                    tracing::warn!(max_connections, times, "connections were closed: there are too many");
                }
                continue;
            };
            match accepted {
                Accepted::Unix(socket) => {
                    let user = socket.peer_cred().map_or_else(|_| "unknown".to_owned(), |user| user.uid().to_string());
                    let client = self.clients.named(&format!("user:{user}"));
                    self.let_in(Socket::Unix(socket), client, place).await;
                }
                Accepted::Tcp(socket, from) => {
                    if let Err(error) = socket.set_nodelay(true) {
                        tracing::debug!(%from, %error, "TCP_NODELAY");
                    }
                    let client = self.clients.at(from.ip());
                    match &self.tls {
                        None => self.let_in(Socket::Tcp(socket), client, place).await,
                        Some(tls) => {
                            let shaken = shake_hands(tls.clone(), socket, self.patience);
                            let (clients, let_in) = (Arc::clone(&self.clients), self.let_in.clone());
                            let traffic = Arc::clone(&self.traffic);
                            let (patience, draining) = (self.patience, self.draining.clone());
                            handshakes.spawn(async move {
                                match shaken.await {
                                    Ok((socket, name)) => {
                                        let client = name.map_or(client, |name| clients.named(&name));
                                        let place = Place::new(place, traffic);
                                        let connection = Connection::new(socket, client, place, patience, draining);
                                        // A door that is gone serves nobody.
                                        let_in.send(Ok(connection)).await.unwrap_or_default();
                                    }
                                    Err(error) => {
                                        traffic.handshakes_failed.add(1);
                                        tracing::debug!(%from, %error, "TLS handshake");
                                    }
                                }
                            });
                        }
                    }
                }
            }
        }
    }

    async fn let_in(&self, socket: Socket, client: Arc<Client>, place: OwnedSemaphorePermit) {
        let place = Place::new(place, Arc::clone(&self.traffic));
        let connection = Connection::new(socket, client, place, self.patience, self.draining.clone());
        // A door that is gone serves nobody.
        self.let_in.send(Ok(connection)).await.unwrap_or_default();
    }
}

enum Accepted {
    Tcp(TcpStream, SocketAddr),
    Unix(UnixStream),
}

/// The connection with TLS, and the name of the client's certificate if it showed one.
async fn shake_hands(tls: TlsAcceptor, socket: TcpStream, patience: Duration) -> io::Result<(Socket, Option<String>)> {
    let socket =
        timeout(patience, tls.accept(socket)).await.map_err(|_| io::Error::from(io::ErrorKind::TimedOut))??;
    let (_, session) = socket.get_ref();
    let name = session.peer_certificates().and_then(|chain| chain.first()).map(|certificate| client_name(certificate));
    Ok((Socket::Tls(Box::new(socket)), name))
}
