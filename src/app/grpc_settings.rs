//! What can be chosen for the gRPC door? The keys of `[grpc]` in the file, and what they mean together.

use std::path::PathBuf;

use serde::Deserialize;

/// Choices of one source, as far as it says something.
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct GrpcSettings {
    /// HOST:PORT, where port 0 means any free one; or `unix:PATH`.
    pub address: Option<String>,
    /// Listen beyond loopback although it is not both encrypted and closed to strangers.
    pub insecure: Option<bool>,
    /// The files of TLS.
    pub tls: TlsSettings,
    /// Who may do what.
    pub tokens: Vec<TokenSettings>,
    /// Pages of the web.
    pub web: WebSettings,
}

/// The files of TLS, in PEM. The first two go together.
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TlsSettings {
    /// The daemon's certificate, followed by those between it and a root.
    pub certificate: Option<PathBuf>,
    /// Its private key.
    pub key: Option<PathBuf>,
    /// Certificates of which one must have signed every client's.
    pub client_ca: Option<PathBuf>,
}

/// One token. Either `sha256` or `file` says which.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TokenSettings {
    /// The client's name, in log lines and for its quotas.
    pub name: String,
    /// The SHA-256 of the token's bytes, 64 hexadecimal digits.
    pub sha256: Option<String>,
    /// A file that holds the token.
    pub file: Option<PathBuf>,
    /// What it allows: `read`, `write` or both.
    pub scopes: Vec<String>,
}

/// Choices for pages of the web.
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct WebSettings {
    /// Origins of pages that may ask, by gRPC-Web; `*` means any.
    pub allowed_origins: Vec<String>,
}

impl GrpcSettings {
    /// What this source says, and for the rest what `weaker` says. Lists are not joined.
    pub(super) fn over(self, weaker: Self) -> Self {
        Self {
            address: self.address.or(weaker.address),
            insecure: self.insecure.or(weaker.insecure),
            tls: TlsSettings {
                certificate: self.tls.certificate.or(weaker.tls.certificate),
                key: self.tls.key.or(weaker.tls.key),
                client_ca: self.tls.client_ca.or(weaker.tls.client_ca),
            },
            tokens: if self.tokens.is_empty() { weaker.tokens } else { self.tokens },
            web: if self.web.allowed_origins.is_empty() { weaker.web } else { self.web },
        }
    }
}

#[cfg(feature = "grpc")]
mod resolved {
    use super::{GrpcSettings, TlsSettings, TokenSettings};
    use crate::app::{ConfigError, defaults};
    use crate::transports::grpc::{Config, Scope, Secret, TlsFiles, TokenSource};

    impl GrpcSettings {
        /// The door's configuration, with defaults for what nobody said.
        ///
        /// # Errors
        /// [`ConfigError::BadDoor`].
        pub(in crate::app) fn resolve(self) -> Result<Config, ConfigError> {
            Ok(Config {
                address: self.address.unwrap_or_else(|| defaults::GRPC_ADDRESS.to_owned()),
                insecure: self.insecure.unwrap_or(false),
                tls: self.tls.resolve()?,
                tokens: self.tokens.into_iter().map(TokenSettings::resolve).collect::<Result<_, _>>()?,
                allowed_origins: self.web.allowed_origins,
            })
        }
    }

    impl TlsSettings {
        fn resolve(self) -> Result<Option<TlsFiles>, ConfigError> {
            let bad = |problem: &str| ConfigError::BadDoor { key: "tls", problem: problem.to_owned() };
            match (self.certificate, self.key, self.client_ca) {
                (Some(certificate), Some(key), client_ca) => Ok(Some(TlsFiles { certificate, key, client_ca })),
                (Some(_), None, _) => Err(bad("there is a certificate, but no key")),
                (None, Some(_), _) => Err(bad("there is a key, but no certificate")),
                (None, None, Some(_)) => Err(bad("there is a client_ca, but neither certificate nor key")),
                (None, None, None) => Ok(None),
            }
        }
    }

    impl TokenSettings {
        fn resolve(self) -> Result<TokenSource, ConfigError> {
            let name = self.name;
            let bad = |problem: String| ConfigError::BadDoor { key: "tokens", problem: format!("{name:?}: {problem}") };
            let secret = match (self.sha256, self.file) {
                (Some(sha256), None) => Secret::Sha256(sha256),
                (None, Some(file)) => Secret::File(file),
                (Some(_), Some(_)) => return Err(bad("sha256 and file exclude each other".to_owned())),
                (None, None) => return Err(bad("there is neither sha256 nor file".to_owned())),
            };
            let scope = |text: &String| match text.as_str() {
                "read" => Ok(Scope::Read),
                "write" => Ok(Scope::Write),
                _ => Err(bad(format!("{text:?} is no scope: `read` and `write` are"))),
            };
            let scopes = self.scopes.iter().map(scope).collect::<Result<_, _>>()?;
            Ok(TokenSource { name, secret, scopes })
        }
    }
}

#[cfg(all(test, feature = "grpc"))]
mod tests {
    use super::*;

    fn told(text: &str) -> String {
        toml::from_str::<GrpcSettings>(text).unwrap().resolve().unwrap_err().to_string()
    }

    #[test]
    fn what_does_not_fit_together_is_told_by_its_key() {
        assert_eq!(told("[tls]\nkey = \"k\""), "grpc.tls: there is a key, but no certificate");
        assert_eq!(told("[tls]\ncertificate = \"k\""), "grpc.tls: there is a certificate, but no key");
        let token = |rest: &str| told(&format!("[[tokens]]\nname = \"planner\"\n{rest}"));
        assert_eq!(token("scopes = [\"read\"]"), "grpc.tokens: \"planner\": there is neither sha256 nor file");
        let both = token("scopes = [\"read\"]\nsha256 = \"\"\nfile = \"\"");
        assert_eq!(both, "grpc.tokens: \"planner\": sha256 and file exclude each other");
        let scope = token("scopes = [\"admin\"]\nfile = \"f\"");
        assert_eq!(scope, "grpc.tokens: \"planner\": \"admin\" is no scope: `read` and `write` are");
    }

    #[test]
    fn a_flag_replaces_one_file_and_leaves_the_others() {
        let file: GrpcSettings = toml::from_str(
            "address = \"unix:/run/c\"\n[tls]\ncertificate = \"a\"\nkey = \"b\"\n[[tokens]]\nname = \"n\"\nfile = \"t\"\nscopes = [\"read\", \"write\"]",
        )
        .unwrap();
        let tls = TlsSettings { key: Some("c".into()), ..TlsSettings::default() };
        let config = GrpcSettings { tls, ..GrpcSettings::default() }.over(file).resolve().unwrap();
        let tls = config.tls.unwrap();
        assert_eq!((tls.certificate, tls.key, tls.client_ca), ("a".into(), "c".into(), None));
        assert_eq!((config.address.as_str(), config.tokens.len()), ("unix:/run/c", 1));
        assert_eq!(config.tokens[0].scopes.len(), 2);
    }
}
