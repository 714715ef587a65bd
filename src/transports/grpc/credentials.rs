//! What does a client show, and whom does it trust?

use std::fmt;

use tonic::metadata::{Ascii, MetadataValue};
use tonic::service::Interceptor;
use tonic::transport::{Certificate, ClientTlsConfig, Identity as TonicIdentity};
use tonic::{Request, Status};

/// What a client shows a daemon, and how it knows the daemon. By default it shows nothing, and trusts whom the system
/// trusts.
#[derive(Clone, Default)]
pub struct Credentials {
    /// Goes with every call.
    pub token: Option<String>,
    /// Certificates (PEM) of which one must have signed the daemon's; none: those the system trusts.
    pub ca: Option<Vec<u8>>,
    /// The client's own certificate.
    pub identity: Option<Identity>,
}

/// A certificate and its key.
#[derive(Clone)]
pub struct Identity {
    /// The certificate, and those between it and a root (PEM).
    pub certificate: Vec<u8>,
    /// Its private key (PEM).
    pub key: Vec<u8>,
}

impl fmt::Debug for Credentials {
    /// Says what there is, not what it is.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Credentials")
            .field("token", &self.token.is_some())
            .field("ca", &self.ca.is_some())
            .field("identity", &self.identity.is_some())
            .finish()
    }
}

impl fmt::Debug for Identity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Identity").finish_non_exhaustive()
    }
}

impl Credentials {
    /// Whether there is anything that only TLS can use.
    pub(super) fn has_tls(&self) -> bool {
        self.ca.is_some() || self.identity.is_some()
    }

    pub(super) fn tls(&self) -> ClientTlsConfig {
        let mut tls = ClientTlsConfig::new();
        tls = match &self.ca {
            Some(ca) => tls.ca_certificate(Certificate::from_pem(ca)),
            None => tls.with_native_roots(),
        };
        match &self.identity {
            Some(Identity { certificate, key }) => tls.identity(TonicIdentity::from_pem(certificate, key)),
            None => tls,
        }
    }

    /// What puts the token on every call; none if it cannot stand in a header.
    pub(super) fn bearer(&self) -> Option<Bearer> {
        let Some(token) = &self.token else { return Some(Bearer(None)) };
        let mut value: MetadataValue<Ascii> = format!("Bearer {token}").parse().ok()?;
        value.set_sensitive(true);
        Some(Bearer(Some(value)))
    }
}

/// Puts the token on a call.
#[derive(Clone, Debug)]
pub struct Bearer(Option<MetadataValue<Ascii>>);

impl Interceptor for Bearer {
    fn call(&mut self, mut request: Request<()>) -> Result<Request<()>, Status> {
        if let Some(value) = &self.0 {
            request.metadata_mut().insert("authorization", value.clone());
        }
        Ok(request)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn secrets_are_not_shown() {
        let identity = Identity { certificate: b"secret".to_vec(), key: b"secret".to_vec() };
        let credentials =
            Credentials { token: Some("secret".to_owned()), ca: Some(b"secret".to_vec()), identity: Some(identity) };
        let shown = format!("{credentials:?} {:?} {:?}", credentials.identity, credentials.bearer());
        assert!(!shown.contains("secret"), "{shown}");
        assert!(Credentials { token: Some("a\nb".to_owned()), ..Credentials::default() }.bearer().is_none());
    }
}
