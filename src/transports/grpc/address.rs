//! Where does the door listen? At a TCP address, or at a Unix socket that only the daemon's own user may connect to.

use std::fmt;
use std::fs::{self, DirBuilder, Permissions};
use std::io::{self, ErrorKind};
use std::net::SocketAddr;
use std::os::unix::fs::{DirBuilderExt, FileTypeExt, MetadataExt, PermissionsExt};
use std::os::unix::net::UnixStream as BlockingUnixStream;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use tokio::net::{TcpListener, UnixListener, lookup_host};

/// As configured.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Address {
    /// HOST:PORT.
    Tcp(String),
    /// The path of a socket.
    Unix(PathBuf),
}

impl FromStr for Address {
    type Err = std::convert::Infallible;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Ok(match text.strip_prefix("unix:") {
            Some(path) => Self::Unix(path.strip_prefix("//").unwrap_or(path).into()),
            None => Self::Tcp(text.to_owned()),
        })
    }
}

/// An open socket.
#[derive(Debug)]
pub(super) enum Listener {
    /// And where it is.
    Tcp(TcpListener, SocketAddr),
    /// And its file.
    Unix(UnixListener, SocketFile),
}

impl fmt::Display for Listener {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Tcp(_, address) => address.fmt(f),
            Self::Unix(_, file) => write!(f, "unix:{}", file.path.display()),
        }
    }
}

/// The addresses that HOST:PORT means.
///
/// # Errors
/// It means none.
pub(super) async fn resolve(host_and_port: &str) -> io::Result<Vec<SocketAddr>> {
    Ok(lookup_host(host_and_port).await?.collect())
}

/// Listens at the first of `addresses` that is free.
///
/// # Errors
/// None is.
pub(super) async fn listen(addresses: &[SocketAddr]) -> io::Result<Listener> {
    let listener = TcpListener::bind(addresses).await?;
    let address = listener.local_addr()?;
    Ok(Listener::Tcp(listener, address))
}

/// Listens at a socket at `path`. One that a daemon left behind which is not there any more is replaced.
///
/// # Errors
/// Another daemon listens there, something else than a socket is there, or the folder cannot be written.
pub(super) fn listen_at(path: &Path) -> io::Result<Listener> {
    refuse_taken(path)?;
    // The socket is made in a folder that nobody else can enter, and moved when its permissions are right: at no time can
    // another user connect.
    let mut private = path.as_os_str().to_owned();
    private.push(".new");
    let private = PathBuf::from(private);
    DirBuilder::new().mode(0o700).create(&private).or_else(|error| {
        // What another daemon left that was killed just here.
        if error.kind() != ErrorKind::AlreadyExists {
            return Err(error);
        }
        fs::remove_dir_all(&private)?;
        DirBuilder::new().mode(0o700).create(&private)
    })?;
    let made = private.join("s");
    let listener = UnixListener::bind(&made).and_then(|listener| {
        fs::set_permissions(&made, Permissions::from_mode(0o600))?;
        fs::rename(&made, path)?;
        Ok(listener)
    });
    fs::remove_dir_all(&private)?;
    let file = SocketFile::at(path)?;
    Ok(Listener::Unix(listener?, file))
}

fn refuse_taken(path: &Path) -> io::Result<()> {
    let there = match fs::symlink_metadata(path) {
        Ok(there) => there,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(()),
        Err(error) => return Err(error),
    };
    if !there.file_type().is_socket() {
        return Err(io::Error::new(ErrorKind::AlreadyExists, "something that is not a socket is there"));
    }
    match BlockingUnixStream::connect(path) {
        Ok(_) => Err(io::Error::new(ErrorKind::AddrInUse, "another process listens there")),
        Err(error) if error.kind() == ErrorKind::ConnectionRefused => Ok(()),
        Err(error) => Err(error),
    }
}

/// The file of a socket, removed when it is dropped, unless another has taken its place.
#[derive(Debug)]
pub(super) struct SocketFile {
    path: PathBuf,
    device: u64,
    inode: u64,
}

impl SocketFile {
    fn at(path: &Path) -> io::Result<Self> {
        let there = fs::symlink_metadata(path)?;
        Ok(Self { path: path.to_owned(), device: there.dev(), inode: there.ino() })
    }
}

impl Drop for SocketFile {
    fn drop(&mut self) {
        let is_ours = |there: fs::Metadata| (there.dev(), there.ino()) == (self.device, self.inode);
        if fs::symlink_metadata(&self.path).is_ok_and(is_ours)
            && let Err(error) = fs::remove_file(&self.path)
        {
            tracing::warn!(path = %self.path.display(), %error, "the socket cannot be removed");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test]
    async fn a_socket_is_its_owners_alone_and_goes_with_its_listener() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("clearance.sock");
        let listener = listen_at(&path).unwrap();
        assert_eq!(fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o600);
        assert_eq!(listener.to_string(), format!("unix:{}", path.display()));
        assert!(BlockingUnixStream::connect(&path).is_ok());
        drop(listener);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[tokio::test]
    async fn a_socket_left_behind_is_replaced_and_a_live_one_or_another_file_is_not() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("clearance.sock");
        drop(std::os::unix::net::UnixListener::bind(&path).unwrap());
        fs::create_dir(folder.path().join("clearance.sock.new")).unwrap();
        let first = listen_at(&path).unwrap();
        assert_eq!(listen_at(&path).unwrap_err().kind(), ErrorKind::AddrInUse);
        // One whose file was replaced leaves the other's alone.
        fs::remove_file(&path).unwrap();
        let second = listen_at(&path).unwrap();
        drop(first);
        assert!(BlockingUnixStream::connect(&path).is_ok());
        drop(second);
        fs::write(&path, "notes").unwrap();
        assert_eq!(listen_at(&path).unwrap_err().kind(), ErrorKind::AlreadyExists);
        assert_eq!(fs::read_to_string(&path).unwrap(), "notes");
    }

    #[test]
    fn both_forms_of_a_sockets_address_are_known() {
        let unix = |path: &str| Address::Unix(path.into());
        assert_eq!("unix:/run/c.sock".parse(), Ok(unix("/run/c.sock")));
        assert_eq!("unix:///run/c.sock".parse(), Ok(unix("/run/c.sock")));
        assert_eq!("unix:here.sock".parse(), Ok(unix("here.sock")));
        assert_eq!("localhost:1".parse(), Ok(Address::Tcp("localhost:1".to_owned())));
    }
}
