//! Bare iceoryx2, set up as the door is: request-response in fixed memory, each side woken by an event.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use iceoryx2::node::Node;
use iceoryx2::port::client::Client as Port;
use iceoryx2::port::listener::Listener;
use iceoryx2::port::notifier::Notifier;
use iceoryx2::prelude::AllocationStrategy;

use super::door::{events, questions};
use super::endpoint::{Endpoint, Ipc, Line, lines, sleep, told};
use super::layout::ALIGNMENT;
use crate::limits::Limits;
use crate::transports::echo::{Echo, EchoError, Parcel, wanted};

/// A client of bare iceoryx2, with a thread at the other end.
#[derive(Debug)]
pub struct SharedMemoryEcho {
    // The order of the fields is the order in which they are closed.
    port: Port<Ipc, [Line], (), [Line], ()>,
    asked: Notifier<Ipc>,
    answered: Listener<Ipc>,
    _node: Node<Ipc>,
    came: Vec<u8>,
    over: Arc<AtomicBool>,
    server: Option<JoinHandle<Result<(), String>>>,
}

/// Both sides look around this often without being woken.
const LOOK: Duration = Duration::from_millis(100);

impl SharedMemoryEcho {
    /// With a name that no door has, and memory as the door takes it with these limits.
    ///
    /// # Errors
    /// What iceoryx2 says.
    pub fn new(name: &str, root: &Path, limits: &Limits) -> Result<Self, EchoError> {
        Self::open(name, root, limits).map_err(EchoError::of("iceoryx2"))
    }

    fn open(name: &str, root: &Path, limits: &Limits) -> Result<Self, String> {
        let endpoint = Endpoint::new(name, root).map_err(|error| error.to_string())?;
        let over = Arc::new(AtomicBool::new(false));
        let server = serve(&endpoint, limits, Arc::clone(&over))?;
        let node = endpoint.node()?;
        let port = questions(&endpoint, &node, limits)?
            .client_builder()
            .initial_max_slice_len(limits.max_shared_memory_request_bytes.div_ceil(ALIGNMENT))
            .allocation_strategy(AllocationStrategy::Static)
            .create()
            .map_err(told)?;
        let asked = events(&endpoint, &node, "asked", 1, 4)?.notifier_builder().create().map_err(told)?;
        let answered = events(&endpoint, &node, "answered", 4, 1)?.listener_builder().create().map_err(told)?;
        Ok(Self { port, asked, answered, _node: node, came: Vec::new(), over, server: Some(server) })
    }

    fn there_and_back(&mut self, parcel: &Parcel) -> Result<(), String> {
        let padded = parcel.bytes().len().next_multiple_of(ALIGNMENT);
        let room = self.port.loan_slice_uninit(padded / ALIGNMENT).map_err(told)?;
        // Whole lines first; the rest of the last one is filled with zeros.
        let whole = lines(parcel.bytes());
        let last = &parcel.bytes()[whole.len() * ALIGNMENT..];
        let line = |index: usize| {
            whole.get(index).copied().unwrap_or_else(|| {
                let mut line = [0; ALIGNMENT];
                line[..last.len()].copy_from_slice(last);
                line
            })
        };
        let pending = room.write_from_fn(line).send().map_err(told)?;
        self.asked.notify().map_err(told)?;
        loop {
            if let Some(response) = pending.receive().map_err(told)? {
                self.came.clear();
                self.came.extend_from_slice(response.payload().as_flattened());
                return Ok(());
            }
            sleep(&self.answered, LOOK)?;
        }
    }
}

impl Echo for SharedMemoryEcho {
    fn exchange(&mut self, parcel: &Parcel) -> Result<(), EchoError> {
        self.there_and_back(parcel).map_err(EchoError::of("iceoryx2"))
    }
}

impl Drop for SharedMemoryEcho {
    fn drop(&mut self) {
        self.over.store(true, Ordering::Release);
        // The thread looks around by itself if it is not woken.
        _ = self.asked.notify();
        _ = self.server.take().map(JoinHandle::join);
    }
}

/// Opens the server's side, and answers on a thread of its own until it is over.
fn serve(
    endpoint: &Endpoint,
    limits: &Limits,
    over: Arc<AtomicBool>,
) -> Result<JoinHandle<Result<(), String>>, String> {
    let node = endpoint.node()?;
    let server = questions(endpoint, &node, limits)?
        .server_builder()
        .initial_max_slice_len(limits.max_shared_memory_response_bytes.div_ceil(ALIGNMENT))
        .allocation_strategy(AllocationStrategy::Static)
        .max_loaned_responses_per_request(1)
        .create()
        .map_err(told)?;
    let asked = events(endpoint, &node, "asked", 1, 4)?.listener_builder().create().map_err(told)?;
    let answered = events(endpoint, &node, "answered", 4, 1)?.notifier_builder().create().map_err(told)?;
    let zeros = vec![[0; ALIGNMENT]; limits.max_shared_memory_response_bytes.div_ceil(ALIGNMENT)];
    Ok(thread::spawn(move || {
        let (_node, mut came) = (node, Vec::new());
        while !over.load(Ordering::Acquire) {
            while let Some(request) = server.receive().map_err(told)? {
                // A server looks at what it gets, and at a copy, because the client may go on writing.
                came.clear();
                came.extend_from_slice(request.payload());
                let length = wanted(came.as_flattened()).div_ceil(ALIGNMENT).clamp(1, zeros.len());
                let room = request.loan_slice_uninit(length).map_err(told)?;
                room.write_from_slice(&zeros[..length]).send().map_err(told)?;
                answered.notify().map_err(told)?;
            }
            sleep(&asked, LOOK)?;
        }
        Ok(())
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bare_shared_memory_brings_back_whole_lines() {
        let folder = tempfile::tempdir().unwrap();
        let limits = Limits {
            max_shared_memory_clients: 1,
            max_shared_memory_request_bytes: 1 << 16,
            max_shared_memory_response_bytes: 1 << 16,
            ..Limits::default()
        };
        let name = format!("echo-{}", std::process::id());
        let mut echo = SharedMemoryEcho::new(&name, folder.path(), &limits).unwrap();
        for (size, wanted, lines) in [(8, 8, 1), (100, 65, 2), (1 << 16, 1 << 16, 1 << 10)] {
            echo.exchange(&Parcel::new(size, wanted)).unwrap();
            assert_eq!(echo.came.len(), lines * ALIGNMENT);
        }
    }
}
