//! A network between a caller and the daemon that can be cut.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Duration;

use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::tcp::{OwnedReadHalf, OwnedWriteHalf};
use tokio::net::{TcpListener, TcpStream};
use tonic::transport::{Channel, Endpoint};

use super::watchdog::watched;

/// Between a caller and the daemon: passes bytes on until it is told not to.
pub struct Network {
    pub address: String,
    pub state: Arc<State>,
}

#[derive(Default)]
pub struct State {
    /// Nothing comes through, and nobody is told.
    pub held: AtomicBool,
    /// Bytes to the daemon before the connection breaks; 0: it does not.
    pub breaks_after: AtomicUsize,
    /// Nothing comes back from the daemon: a caller that does not read.
    pub unread: AtomicBool,
    /// Nothing comes through, connections are broken and none is let through: a cable that is out.
    pub cut: AtomicBool,
    /// Bytes that went to the daemon.
    pub passed: AtomicUsize,
}

impl Network {
    pub async fn to(daemon: &str) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
        let address = listener.local_addr().unwrap().to_string();
        let (state, daemon) = (Arc::new(State::default()), daemon.to_owned());
        let shared = Arc::clone(&state);
        tokio::spawn(async move {
            while let Ok((caller, _)) = listener.accept().await {
                if shared.cut.load(Ordering::Acquire) {
                    continue;
                }
                let Ok(there) = TcpStream::connect(&daemon).await else { continue };
                let ((from_caller, to_caller), (from_there, to_there)) = (caller.into_split(), there.into_split());
                let there = tokio::spawn(pass(from_caller, to_there, Arc::clone(&shared), true));
                let back = tokio::spawn(pass(from_there, to_caller, Arc::clone(&shared), false));
                // One direction that ends takes the other with it.
                tokio::spawn(async move {
                    let (there_ends, back_ends) = (there.abort_handle(), back.abort_handle());
                    tokio::select! { _ = there => back_ends.abort(), _ = back => there_ends.abort() }
                });
            }
        });
        Self { address, state }
    }

    pub async fn channel(&self) -> Channel {
        let endpoint = Endpoint::from_shared(format!("http://{}", self.address)).unwrap();
        let endpoint = endpoint.http2_keep_alive_interval(Duration::from_millis(200)).keep_alive_while_idle(true);
        let endpoint = endpoint.keep_alive_timeout(Duration::from_millis(500));
        watched("connecting", endpoint.connect()).await.unwrap()
    }
}

async fn pass(mut from: OwnedReadHalf, mut to: OwnedWriteHalf, state: Arc<State>, to_daemon: bool) {
    let mut bytes = vec![0; 4096];
    loop {
        let read = tokio::select! {
            read = from.read(&mut bytes) => read,
            () = cut(&state) => return,
        };
        let Ok(count @ 1..) = read else { return };
        while state.held.load(Ordering::Acquire) || !to_daemon && state.unread.load(Ordering::Acquire) {
            if state.cut.load(Ordering::Acquire) {
                return;
            }
            tokio::time::sleep(Duration::from_millis(5)).await;
        }
        if to_daemon {
            let passed = state.passed.fetch_add(count, Ordering::AcqRel) + count;
            let breaks_after = state.breaks_after.load(Ordering::Acquire);
            if breaks_after > 0 && passed > breaks_after {
                return;
            }
        }
        if to.write_all(&bytes[..count]).await.is_err() {
            return;
        }
    }
}

async fn cut(state: &State) {
    while !state.cut.load(Ordering::Acquire) {
        tokio::time::sleep(Duration::from_millis(5)).await;
    }
}
