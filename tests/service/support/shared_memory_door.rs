//! The door of shared memory: the messages that gRPC would carry, in segments that both sides see.

use std::ops::Deref;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use clearance::app::DoorChoice;
use clearance::limits::Limits;
use clearance::transports::shared_memory::{Client, ClientError, Config};
use tempfile::TempDir;
use tonic::Code;

use super::by_name::ByName;
use super::daemon::{RunningDaemon, config};
use super::door::{Refusal, Told};

/// A name that no other test has, on this machine.
pub fn unused_name() -> Name {
    static NEXT: AtomicUsize = AtomicUsize::new(0);
    Name(format!("test-{}-{}", std::process::id(), NEXT.fetch_add(1, Ordering::Relaxed)))
}

/// A door's name. Whatever is left of the door in /dev/shm goes with it: nobody opens the name again who would clean up.
pub struct Name(String);

impl Deref for Name {
    type Target = str;

    fn deref(&self) -> &str {
        &self.0
    }
}

impl Drop for Name {
    fn drop(&mut self) {
        let prefix = format!("{}.", self.0);
        let files = std::fs::read_dir("/dev/shm").into_iter().flatten().flatten();
        for file in files.filter(|file| file.file_name().to_string_lossy().starts_with(&prefix)) {
            std::fs::remove_file(file.path()).unwrap_or_default();
        }
    }
}

/// What calls rpcs by their names. A client has one call under way: calls at the same time have one each.
pub struct SharedMemory {
    _daemon: RunningDaemon,
    idle: Arc<Mutex<Vec<Client>>>,
    name: Name,
    root: TempDir,
}

/// Calls at the same time, at most.
const CLIENTS: usize = 4;
const PATIENCE: Duration = Duration::from_secs(100);

impl From<ClientError> for Refusal {
    fn from(error: ClientError) -> Self {
        let ClientError::Refused(refusal) = error else { panic!("{error}") };
        Self {
            code: Code::from(refusal.code as i32),
            reason: refusal.reason,
            field: refusal.field,
            message: refusal.message,
        }
    }
}

impl ByName for SharedMemory {
    async fn open_with(limits: Limits) -> Self {
        let (name, root) = (unused_name(), tempfile::tempdir().unwrap());
        let limits = Limits {
            max_shared_memory_clients: CLIENTS,
            max_shared_memory_request_bytes: 1 << 20,
            max_shared_memory_response_bytes: 1 << 20,
            ..limits
        };
        let mut config = config(limits);
        let door = Config { name: name.to_string(), root: root.path().to_owned(), spin: Duration::ZERO };
        config.shared_memory = DoorChoice::On(door);
        let daemon = RunningDaemon::start(&config).await;
        Self { _daemon: daemon, idle: Arc::default(), name, root }
    }

    async fn call_bytes(&self, rpc: &'static str, message: Vec<u8>) -> Told<Vec<u8>> {
        let (idle, name, root) = (Arc::clone(&self.idle), self.name.to_owned(), self.root.path().to_owned());
        let calling = tokio::task::spawn_blocking(move || {
            let one = idle.lock().unwrap().pop();
            let mut client = one.unwrap_or_else(|| Client::connect(&name, Path::new(&root)).unwrap());
            let outcome = client.call(rpc, &message, PATIENCE);
            idle.lock().unwrap().push(client);
            outcome
        });
        Ok(calling.await.unwrap()?)
    }
}
