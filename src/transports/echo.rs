//! The floors under the doors: the stacks that the doors are made of, carrying bytes there and back and doing nothing else.
//! `clearance bench transports` holds each door against its floor. Those of a door's own stack stand beside the door.

use std::io::{self, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::Path;
use std::thread;

/// Carries bytes to a server that answers with as many bytes as were asked for.
pub trait Echo {
    /// Sends a parcel, and waits for the bytes that it asks for.
    ///
    /// # Errors
    /// What the stack says.
    fn exchange(&mut self, parcel: &Parcel) -> Result<(), EchoError>;
}

/// A stack that does not carry bytes.
#[derive(Debug, thiserror::Error)]
#[error("{stack}: {problem}")]
pub struct EchoError {
    /// Which.
    pub stack: &'static str,
    /// What it says.
    pub problem: String,
}

impl EchoError {
    /// Of a stack, whatever it says.
    pub fn of<E: std::fmt::Display>(stack: &'static str) -> impl Fn(E) -> Self {
        move |problem| Self { stack, problem: problem.to_string() }
    }
}

/// Bytes that say in their first eight how many are to come back.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Parcel {
    bytes: Vec<u8>,
    wanted: usize,
}

/// A parcel has room for its number.
const LEAST: usize = size_of::<u64>();

impl Parcel {
    /// A parcel of this size, at least eight bytes, that asks for `wanted`.
    #[must_use]
    pub fn new(size: usize, wanted: usize) -> Self {
        let mut bytes = vec![0x5a; size.max(LEAST)];
        bytes[..LEAST].copy_from_slice(&(wanted as u64).to_le_bytes());
        Self { bytes, wanted }
    }

    /// All of it.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// How many bytes are to come back.
    #[must_use]
    pub fn wanted(&self) -> usize {
        self.wanted
    }
}

/// How many bytes a parcel asks for; none if it is none.
#[must_use]
pub fn wanted(parcel: &[u8]) -> usize {
    parcel.first_chunk().map_or(0, |number| usize::try_from(u64::from_le_bytes(*number)).unwrap_or(0))
}

/// A stream of bytes, with a thread at its other end.
#[derive(Debug)]
pub struct SocketEcho<S> {
    stack: &'static str,
    stream: S,
    came: Vec<u8>,
}

impl SocketEcho<TcpStream> {
    /// Over TCP, on the loopback interface.
    ///
    /// # Errors
    /// No port is free.
    pub fn tcp() -> Result<Self, EchoError> {
        let open = || {
            let listener = TcpListener::bind("127.0.0.1:0")?;
            let stream = TcpStream::connect(listener.local_addr()?)?;
            let (other, _) = listener.accept()?;
            stream.set_nodelay(true)?;
            other.set_nodelay(true)?;
            thread::spawn(move || answer_all(other));
            Ok(Self { stack: "TCP", stream, came: Vec::new() })
        };
        open().map_err(EchoError::of::<io::Error>("TCP"))
    }
}

impl SocketEcho<UnixStream> {
    /// Over a Unix socket at `path`.
    ///
    /// # Errors
    /// There can be none.
    pub fn unix(path: &Path) -> Result<Self, EchoError> {
        let open = || {
            let listener = UnixListener::bind(path)?;
            let stream = UnixStream::connect(path)?;
            let (other, _) = listener.accept()?;
            thread::spawn(move || answer_all(other));
            Ok(Self { stack: "Unix socket", stream, came: Vec::new() })
        };
        open().map_err(EchoError::of::<io::Error>("Unix socket"))
    }
}

/// Answers until the other side hangs up. Lengths go first, eight bytes each.
fn answer_all(mut stream: impl Read + Write) -> io::Result<()> {
    let (mut parcel, mut answer) = (Vec::new(), Vec::new());
    loop {
        let mut length = [0; LEAST];
        stream.read_exact(&mut length)?;
        parcel.resize(u64::from_le_bytes(length) as usize, 0);
        stream.read_exact(&mut parcel)?;
        answer.resize(wanted(&parcel), 0);
        stream.write_all(&answer)?;
    }
}

impl<S: Read + Write> Echo for SocketEcho<S> {
    fn exchange(&mut self, parcel: &Parcel) -> Result<(), EchoError> {
        self.came.resize(parcel.wanted(), 0);
        let mut exchange = || {
            self.stream.write_all(&(parcel.bytes().len() as u64).to_le_bytes())?;
            self.stream.write_all(parcel.bytes())?;
            self.stream.read_exact(&mut self.came)
        };
        exchange().map_err(EchoError::of::<io::Error>(self.stack))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sockets_bring_back_as_many_bytes_as_were_asked_for() {
        let folder = tempfile::tempdir().unwrap();
        let mut tcp = SocketEcho::tcp().unwrap();
        let mut unix = SocketEcho::unix(&folder.path().join("echo.sock")).unwrap();
        for (size, wanted) in [(0, 0), (100, 3), (8, 1 << 20), (3 << 20, 8)] {
            let parcel = Parcel::new(size, wanted);
            tcp.exchange(&parcel).unwrap();
            unix.exchange(&parcel).unwrap();
            assert_eq!((tcp.came.len(), unix.came.len()), (wanted, wanted));
        }
    }
}
