//! Certificates made for one test: authorities, and what they sign.

use std::fs;
use std::path::PathBuf;

use clearance::transports::grpc::{Credentials, Identity, TlsFiles};
use rcgen::{BasicConstraints, CertificateParams, CertifiedIssuer, DnType, IsCa, KeyPair, date_time_ymd};
use tempfile::TempDir;

/// Who signs.
pub struct Authority(CertifiedIssuer<'static, KeyPair>);

/// A certificate and its key, as PEM.
pub struct Signed {
    pub certificate: String,
    pub key: String,
}

fn named(name: &str, hosts: &[&str]) -> CertificateParams {
    let hosts: Vec<String> = hosts.iter().map(|host| (*host).to_owned()).collect();
    let mut parameters = CertificateParams::new(hosts).unwrap();
    parameters.distinguished_name = rcgen::DistinguishedName::new();
    parameters.distinguished_name.push(DnType::CommonName, name);
    parameters
}

impl Authority {
    pub fn new(name: &str) -> Self {
        let mut parameters = named(name, &[]);
        parameters.is_ca = IsCa::Ca(BasicConstraints::Unconstrained);
        Self(CertifiedIssuer::self_signed(parameters, KeyPair::generate().unwrap()).unwrap())
    }

    pub fn pem(&self) -> String {
        self.0.pem()
    }

    fn signed(&self, parameters: &CertificateParams) -> Signed {
        let key = KeyPair::generate().unwrap();
        let certificate = parameters.signed_by(&key, &self.0).unwrap();
        Signed { certificate: certificate.pem(), key: key.serialize_pem() }
    }

    /// For a server that is asked as `localhost` or `127.0.0.1`.
    pub fn server(&self) -> Signed {
        self.signed(&named("daemon", &["localhost", "127.0.0.1"]))
    }

    /// Like [`Self::server`], but it was valid only in January 2020.
    pub fn expired_server(&self) -> Signed {
        let mut parameters = named("daemon", &["localhost", "127.0.0.1"]);
        (parameters.not_before, parameters.not_after) = (date_time_ymd(2020, 1, 1), date_time_ymd(2020, 2, 1));
        self.signed(&parameters)
    }

    pub fn client(&self, name: &str) -> Signed {
        self.signed(&named(name, &[]))
    }

    pub fn expired_client(&self, name: &str) -> Signed {
        let mut parameters = named(name, &[]);
        (parameters.not_before, parameters.not_after) = (date_time_ymd(2020, 1, 1), date_time_ymd(2020, 2, 1));
        self.signed(&parameters)
    }
}

impl Signed {
    pub fn identity(&self) -> Identity {
        Identity { certificate: self.certificate.clone().into_bytes(), key: self.key.clone().into_bytes() }
    }
}

/// Files as `[grpc.tls]` names them.
pub struct Files(TempDir);

impl Files {
    pub fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub fn put(&self, name: &str, text: &str) -> PathBuf {
        let path = self.0.path().join(name);
        fs::write(&path, text).unwrap();
        path
    }

    /// A server's certificate, and whose clients it lets in.
    pub fn tls(&self, server: &Signed, client_ca: Option<&Authority>) -> TlsFiles {
        TlsFiles {
            certificate: self.put("certificate.pem", &server.certificate),
            key: self.put("key.pem", &server.key),
            client_ca: client_ca.map(|ca| self.put("client_ca.pem", &ca.pem())),
        }
    }
}

/// A client that trusts `ca` alone.
pub fn trusting(ca: &Authority) -> Credentials {
    Credentials { ca: Some(ca.pem().into_bytes()), ..Credentials::default() }
}
