//! Which certificate does the door show, and whose does it want to see? Files are read once, at the start; what is wrong
//! with one is said with its name.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::SystemTime;
use std::{fs, io};

use tokio_rustls::TlsAcceptor;
use tokio_rustls::rustls::crypto::ring;
use tokio_rustls::rustls::pki_types::pem::PemObject;
use tokio_rustls::rustls::pki_types::{CertificateDer, PrivateKeyDer};
use tokio_rustls::rustls::server::WebPkiClientVerifier;
use tokio_rustls::rustls::{Error as RustlsError, RootCertStore, ServerConfig};

use super::certificate::{Validity, validity};

/// The files of TLS, in PEM.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TlsFiles {
    /// The daemon's certificate, followed by those between it and a root.
    pub certificate: PathBuf,
    /// Its private key.
    pub key: PathBuf,
    /// Certificates of which one must have signed the client's; none: clients need no certificate.
    pub client_ca: Option<PathBuf>,
}

/// What is wrong with a file.
#[derive(Debug, thiserror::Error)]
pub enum TlsError {
    /// The system does not give it.
    #[error("{path}: {source}", path = path.display())]
    Unreadable {
        /// Which.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// It is not what it should be.
    #[error("{path}: {problem}", path = path.display())]
    Bad {
        /// Which.
        path: PathBuf,
        /// Why.
        problem: String,
    },
    /// Each may be fine, but they do not belong together.
    #[error("{key} is not the key of the certificate in {certificate}", key = key.display(), certificate = certificate.display())]
    NotItsKey {
        /// The certificate's file.
        certificate: PathBuf,
        /// The key's.
        key: PathBuf,
    },
}

impl TlsFiles {
    /// Reads the files. `web` lets browsers in, which may want HTTP/1.1.
    ///
    /// # Errors
    /// [`TlsError`].
    pub(super) fn acceptor(&self, web: bool) -> Result<TlsAcceptor, TlsError> {
        let chain = certificates(&self.certificate)?;
        warn_of_dates(&self.certificate, &chain)?;
        let key = PrivateKeyDer::from_pem_slice(&read(&self.key)?).map_err(|error| bad(&self.key, &error))?;
        let provider = Arc::new(ring::default_provider());
        let builder = ServerConfig::builder_with_provider(Arc::clone(&provider))
            .with_safe_default_protocol_versions()
            .map_err(|error| bad(&self.certificate, &error))?;
        let builder = match &self.client_ca {
            None => builder.with_no_client_auth(),
            Some(path) => {
                let mut roots = RootCertStore::empty();
                let authorities = certificates(path)?;
                warn_of_dates(path, &authorities)?;
                for authority in authorities {
                    roots.add(authority).map_err(|error| bad(path, &error))?;
                }
                let verifier = WebPkiClientVerifier::builder_with_provider(Arc::new(roots), provider).build();
                builder.with_client_cert_verifier(verifier.map_err(|error| bad(path, &error))?)
            }
        };
        let mut config = builder.with_single_cert(chain, key).map_err(|error| {
            if let RustlsError::InconsistentKeys(_) = error {
                return TlsError::NotItsKey { certificate: self.certificate.clone(), key: self.key.clone() };
            }
            let of_certificate = matches!(error, RustlsError::InvalidCertificate(_));
            bad(if of_certificate { &self.certificate } else { &self.key }, &error)
        })?;
        config.alpn_protocols.push(b"h2".to_vec());
        if web {
            config.alpn_protocols.push(b"http/1.1".to_vec());
        }
        Ok(TlsAcceptor::from(Arc::new(config)))
    }
}

fn certificates(path: &Path) -> Result<Vec<CertificateDer<'static>>, TlsError> {
    let text = read(path)?;
    let certificates: Result<Vec<_>, _> = CertificateDer::pem_slice_iter(&text).collect();
    let certificates = certificates.map_err(|error| bad(path, &error))?;
    if certificates.is_empty() {
        return Err(bad(path, &"there is no certificate in it (PEM)"));
    }
    Ok(certificates)
}

/// A certificate outside its dates is told in the log and used all the same: clients see what is wrong with it, and a restart
/// does not take the daemon away from those that do not mind.
fn warn_of_dates(path: &Path, certificates: &[CertificateDer<'_>]) -> Result<(), TlsError> {
    for certificate in certificates {
        match validity(certificate, SystemTime::now()).map_err(|problem| bad(path, &problem))? {
            Validity::NotYet(from) => {
                tracing::error!(file = %path.display(), %from, "the certificate is not valid yet: clients will refuse it");
            }
            Validity::Expired(on) => {
                tracing::error!(file = %path.display(), %on, "the certificate has expired: clients will refuse it");
            }
            Validity::Valid(until) => tracing::info!(file = %path.display(), %until, "certificate"),
        }
    }
    Ok(())
}

fn read(path: &Path) -> Result<Vec<u8>, TlsError> {
    fs::read(path).map_err(|source| TlsError::Unreadable { path: path.to_owned(), source })
}

fn bad(path: &Path, problem: &dyn std::fmt::Display) -> TlsError {
    TlsError::Bad { path: path.to_owned(), problem: problem.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(files: &TlsFiles) -> String {
        files.acceptor(false).map(drop).unwrap_err().to_string()
    }

    #[test]
    fn what_is_wrong_with_a_file_is_told_with_its_name() {
        let folder = tempfile::tempdir().unwrap();
        let file = |name: &str, text: &str| {
            fs::write(folder.path().join(name), text).unwrap();
            folder.path().join(name)
        };
        let made = rcgen::generate_simple_self_signed(vec!["localhost".to_owned()]).unwrap();
        let other = rcgen::KeyPair::generate().unwrap();
        let certificate = file("certificate.pem", &made.cert.pem());
        let key = file("key.pem", &made.signing_key.serialize_pem());
        let good =
            TlsFiles { certificate: certificate.clone(), key: key.clone(), client_ca: Some(certificate.clone()) };
        assert!(good.acceptor(true).is_ok());

        let missing = told(&TlsFiles { key: folder.path().join("missing.pem"), ..good.clone() });
        assert!(missing.contains("missing.pem: No such file"), "{missing}");
        let empty = file("empty.pem", "");
        for files in [
            TlsFiles { certificate: empty.clone(), ..good.clone() },
            TlsFiles { client_ca: Some(empty.clone()), ..good.clone() },
        ] {
            assert!(told(&files).ends_with("empty.pem: there is no certificate in it (PEM)"), "{}", told(&files));
        }
        let no_key = told(&TlsFiles { key: certificate.clone(), ..good.clone() });
        assert!(no_key.contains("certificate.pem: "), "{no_key}");
        let broken = file("broken.pem", "-----BEGIN CERTIFICATE-----\nAAAA\n-----END CERTIFICATE-----\n");
        let broken = told(&TlsFiles { certificate: broken, ..good.clone() });
        assert!(broken.contains("broken.pem: "), "{broken}");
        let other = file("other.pem", &other.serialize_pem());
        let not_its = told(&TlsFiles { key: other, ..good });
        assert!(not_its.contains("other.pem is not the key of the certificate in "), "{not_its}");
    }
}
