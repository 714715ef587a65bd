//! Where do daemon and clients meet? Names, sizes and the settings of iceoryx2 that both sides have to agree on.

use std::path::{Path, PathBuf};
use std::time::Duration;

use iceoryx2::config::Config as IpcConfig;
use iceoryx2::node::Node;
use iceoryx2::port::listener::{Listener, ListenerWaitError};
use iceoryx2::prelude::{
    FileName, LogLevel, NodeBuilder, SemanticString, ServiceName, SignalHandlingMode, ipc_threadsafe, set_log_level,
};
use iceoryx2::service::port_factory::{event, request_response};

use super::layout::ALIGNMENT;

/// Between processes, with ports that several threads may use.
pub(super) type Ipc = ipc_threadsafe::Service;
/// What messages are made of. Slices of single bytes that are aligned to 64 would take 64 bytes for each.
pub(super) type Line = [u8; ALIGNMENT];
/// Questions and answers: runs of lines.
pub(super) type Questions = request_response::PortFactory<Ipc, [Line], (), [Line], ()>;
/// Wake-ups.
pub(super) type Events = event::PortFactory<Ipc>;

/// Requests that one client may have under way: the next is asked when the one before is answered.
pub(super) const UNDER_WAY: usize = 1;

/// The names of attributes by which the daemon tells clients what they have to know.
pub(super) mod attribute {
    pub const ABI_HASH: &str = "abi_hash";
    pub const REQUEST_BYTES: &str = "max_request_bytes";
}

/// Where a door is: its name, and the folder where both sides leave what they know of each other.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Endpoint {
    name: String,
    root: PathBuf,
}

/// A name or folder that cannot be one.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum BadEndpoint {
    /// It becomes part of file names.
    #[error("shared_memory.name {0:?} is not 1 to 32 of a-z, 0-9, _ and -")]
    Name(String),
    /// Other processes have to find it.
    #[error("shared_memory.root {0:?} is not an absolute path of at most 200 bytes")]
    Root(PathBuf),
}

const LONGEST_NAME: usize = 32;
const LONGEST_ROOT: usize = 200;

impl Endpoint {
    /// Checks name and folder. The name has to be the only one of its kind on the machine, whatever the folder.
    ///
    /// # Errors
    /// [`BadEndpoint`].
    pub fn new(name: &str, root: &Path) -> Result<Self, BadEndpoint> {
        let fits = |byte: u8| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'_' || byte == b'-';
        if name.is_empty() || name.len() > LONGEST_NAME || !name.bytes().all(fits) {
            return Err(BadEndpoint::Name(name.to_owned()));
        }
        let text = root.to_str().filter(|text| text.len() <= LONGEST_ROOT);
        if !root.is_absolute() || text.is_none() {
            return Err(BadEndpoint::Root(root.to_owned()));
        }
        Ok(Self { name: name.to_owned(), root: root.to_owned() })
    }

    /// What it is called.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What the names of its files in /dev/shm begin with. A name has no dot, so none is the beginning of another's.
    #[must_use]
    pub fn prefix(&self) -> String {
        format!("{}.", self.name)
    }

    /// A process's place at the door. What dead processes left behind is cleaned up first.
    pub(super) fn node(&self) -> Result<Node<Ipc>, String> {
        // What goes wrong comes back as an error, and we tell it in our own words.
        set_log_level(LogLevel::Fatal);
        let mut config = IpcConfig::default();
        config.global.prefix = FileName::new(self.prefix().as_bytes()).map_err(told)?;
        let root = self.root.to_str().unwrap_or_default();
        let root = iceoryx2::prelude::Path::new(root.as_bytes()).map_err(told)?;
        config.global.set_root_path(&root);
        // SIGTERM is the daemon's to handle, and the client's.
        let builder = NodeBuilder::new().config(&config).signal_handling_mode(SignalHandlingMode::Disabled);
        let node = builder.create::<Ipc>().map_err(told)?;
        node.try_cleanup_dead_nodes();
        Ok(node)
    }

    /// `questions`, `asked` or `answered`.
    pub(super) fn service(&self, part: &str) -> Result<ServiceName, String> {
        ServiceName::new(&format!("{}/{part}", self.name)).map_err(told)
    }
}

/// iceoryx2's errors say their name.
pub(super) fn told(error: impl std::fmt::Debug) -> String {
    format!("{error:?}")
}

/// The alignment of messages, as iceoryx2 takes it.
pub(super) fn alignment() -> iceoryx2::prelude::Alignment {
    iceoryx2::prelude::Alignment::new(ALIGNMENT).unwrap_or(iceoryx2::prelude::Alignment::ALIGN_8)
}

/// Sleeps until somebody notifies, or for a time; how many notifications came. A signal only wakes: SIGCONT, for one,
/// comes to every process that was stopped.
pub(super) fn sleep(listener: &Listener<Ipc>, time: Duration) -> Result<u64, String> {
    match listener.timed_wait(|_| {}, time) {
        Err(ListenerWaitError::InterruptSignal) => Ok(0),
        woken => woken.map_err(told),
    }
}

/// A message as lines; messages are padded to whole ones.
pub(super) fn lines(message: &[u8]) -> &[Line] {
    message.as_chunks().0
}

/// The name of a client's listener: its id in hexadecimal.
pub(super) fn listener_name(client: super::request::ClientId) -> String {
    client.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_file_names_and_roots_are_found_by_others() {
        let root = Path::new("/tmp/x");
        for name in ["", "a.b", "A", "a/b", "..", &"a".repeat(33)] {
            assert_eq!(Endpoint::new(name, root), Err(BadEndpoint::Name(name.to_owned())));
        }
        assert!(matches!(Endpoint::new("a", Path::new("x")), Err(BadEndpoint::Root(_))));
        assert_eq!(Endpoint::new("a-1_b", root).unwrap().prefix(), "a-1_b.");
    }
}
