//! Which daemon is to be asked, and what is it shown? Flags of every command that can ask one.

use std::path::PathBuf;

/// Flags that name a daemon.
#[derive(clap::Args, Clone, Debug)]
pub struct DaemonFlags {
    /// Ask this daemon instead of the library, for example `http://127.0.0.1:50551` or `unix:/run/clearance.sock`.
    #[arg(long, value_name = "ADDR")]
    pub server: Option<String>,
    /// File with the token for that daemon.
    #[arg(long, value_name = "FILE", requires = "server")]
    pub server_token: Option<PathBuf>,
    /// Certificates (PEM) of which one must have signed the daemon's [default: those the system trusts]
    #[arg(long, value_name = "FILE", requires = "server")]
    pub server_ca: Option<PathBuf>,
    /// Certificate (PEM) that the daemon is shown.
    #[arg(long, value_name = "FILE", requires_all = ["server", "client_key"])]
    pub client_certificate: Option<PathBuf>,
    /// Private key (PEM) of that certificate.
    #[arg(long, value_name = "FILE", requires_all = ["server", "client_certificate"])]
    pub client_key: Option<PathBuf>,
}

#[cfg(feature = "grpc")]
mod credentials {
    use std::fs;
    use std::path::Path;

    use super::DaemonFlags;
    use crate::cli::exit_code::Failed;
    use crate::transports::grpc::{Credentials, Identity};

    impl DaemonFlags {
        /// What the files hold.
        ///
        /// # Errors
        /// One cannot be read.
        pub fn credentials(&self) -> Result<Credentials, Failed> {
            let token = self.server_token.as_deref().map(read).transpose()?;
            let token = token.map(|bytes| String::from_utf8_lossy(&bytes).trim().to_owned());
            let ca = self.server_ca.as_deref().map(read).transpose()?;
            let identity = match (&self.client_certificate, &self.client_key) {
                (Some(certificate), Some(key)) => Some(Identity { certificate: read(certificate)?, key: read(key)? }),
                _ => None,
            };
            Ok(Credentials { token, ca, identity })
        }
    }

    fn read(path: &Path) -> Result<Vec<u8>, Failed> {
        fs::read(path).map_err(|error| Failed::input(format!("{}: {error}", path.display())))
    }
}
