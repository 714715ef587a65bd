//! Who is it that shows this token, and what may they do? Only hashes of tokens are kept, and no text of one is ever part
//! of an error or a log line.

use std::path::PathBuf;
use std::sync::Arc;
use std::{fs, io};

use sha2::{Digest, Sha256};
use subtle::{Choice, ConstantTimeEq};

use super::access::Scope;
use super::clients::{Client, Clients};

/// A token as it is configured.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TokenSource {
    /// The client's name, in log lines and for its quotas. Several tokens may have the same.
    pub name: String,
    /// Where the token is known from.
    pub secret: Secret,
    /// What it allows.
    pub scopes: Vec<Scope>,
}

/// Where a token is known from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Secret {
    /// The SHA-256 of its bytes, 64 hexadecimal digits.
    Sha256(String),
    /// A file that holds it; space around it does not count.
    File(PathBuf),
}

/// What is wrong with a configured token.
#[derive(Debug, thiserror::Error)]
pub enum TokenError {
    /// The system does not give its file.
    #[error("grpc.tokens, {name:?}: {path}: {source}", path = path.display())]
    Unreadable {
        /// The client's name.
        name: String,
        /// The token's file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// It cannot be as it is.
    #[error("grpc.tokens, {name:?}: {problem}")]
    Bad {
        /// The client's name.
        name: String,
        /// Why.
        problem: String,
    },
}

/// A file with less is a mistake, or a token that can be guessed.
const SHORTEST: usize = 16;

/// The tokens that open the door.
#[derive(Debug, Default)]
pub(super) struct Tokens {
    tokens: Vec<Token>,
}

/// One of them.
#[derive(Debug)]
pub(super) struct Token {
    sha256: [u8; 32],
    scopes: Vec<Scope>,
    pub client: Arc<Client>,
}

/// A token that was read, and whose it is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct KnownToken {
    name: String,
    sha256: [u8; 32],
    scopes: Vec<Scope>,
}

impl TokenSource {
    /// Reads what is to be known of the token.
    ///
    /// # Errors
    /// [`TokenError`].
    pub(super) fn read(&self) -> Result<KnownToken, TokenError> {
        let bad = |problem: &str| TokenError::Bad { name: self.name.clone(), problem: problem.to_owned() };
        if self.name.is_empty() {
            return Err(bad("the name is empty"));
        }
        if self.scopes.is_empty() {
            return Err(bad("there are no scopes: it allows nothing"));
        }
        let sha256 = match &self.secret {
            Secret::Sha256(hex) => digits(hex).ok_or_else(|| bad("sha256 is not 64 hexadecimal digits"))?,
            Secret::File(path) => {
                let text = fs::read_to_string(path).map_err(|source| TokenError::Unreadable {
                    name: self.name.clone(),
                    path: path.clone(),
                    source,
                })?;
                let token = text.trim();
                if token.len() < SHORTEST || token.contains(|c: char| !c.is_ascii_graphic()) {
                    let problem = format!(
                        "{}: not a token: {SHORTEST} or more printable ASCII characters without space",
                        path.display()
                    );
                    return Err(bad(&problem));
                }
                Sha256::digest(token).into()
            }
        };
        Ok(KnownToken { name: self.name.clone(), sha256, scopes: self.scopes.clone() })
    }
}

fn digits(hex: &str) -> Option<[u8; 32]> {
    let mut bytes = [0; 32];
    if hex.len() != 64 || !hex.bytes().all(|digit| digit.is_ascii_hexdigit()) {
        return None;
    }
    for (byte, digits) in bytes.iter_mut().zip(hex.as_bytes().chunks(2)) {
        *byte = u8::from_str_radix(str::from_utf8(digits).ok()?, 16).ok()?;
    }
    Some(bytes)
}

impl Tokens {
    pub fn new(known: &[KnownToken], clients: &Clients) -> Self {
        let token = |known: &KnownToken| Token {
            sha256: known.sha256,
            scopes: known.scopes.clone(),
            client: clients.named(&format!("token:{}", known.name)),
        };
        Self { tokens: known.iter().map(token).collect() }
    }

    /// Whether nobody needs one.
    pub fn is_empty(&self) -> bool {
        self.tokens.is_empty()
    }

    /// The token that was shown. Takes the same time for every one that is not known.
    pub fn find(&self, shown: &[u8]) -> Option<&Token> {
        let sha256: [u8; 32] = Sha256::digest(shown).into();
        let mut found = None;
        for token in &self.tokens {
            let same: Choice = token.sha256.ct_eq(&sha256);
            if bool::from(same) {
                found = Some(token);
            }
        }
        found
    }
}

impl Token {
    pub fn allows(&self, scope: Scope) -> bool {
        self.scopes.contains(&scope)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limits::Limits;

    fn source(secret: Secret, scopes: &[Scope]) -> TokenSource {
        TokenSource { name: "planner".to_owned(), secret, scopes: scopes.to_vec() }
    }

    #[test]
    fn a_token_is_found_by_its_hash_or_its_file_and_no_other_is() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("token");
        fs::write(&path, "correct-horse-battery\n").unwrap();
        // sha256sum of "another-long-token-17".
        let hash = Sha256::digest("another-long-token-17").iter().map(|byte| format!("{byte:02X}")).collect();
        let sources = [source(Secret::File(path), &[Scope::Read]), source(Secret::Sha256(hash), &[Scope::Write])];
        let known: Vec<_> = sources.iter().map(|source| source.read().unwrap()).collect();
        let tokens = Tokens::new(&known, &Clients::new(&Limits::default()));
        let allows =
            |shown: &str| tokens.find(shown.as_bytes()).map(|t| [Scope::Read, Scope::Write].map(|s| t.allows(s)));
        assert_eq!(allows("correct-horse-battery"), Some([true, false]));
        assert_eq!(allows("another-long-token-17"), Some([false, true]));
        for wrong in ["", "correct-horse-batter", "correct-horse-battery\n", "Correct-horse-battery"] {
            assert_eq!(allows(wrong), None);
        }
        let [first, second] =
            ["correct-horse-battery", "another-long-token-17"].map(|t| tokens.find(t.as_bytes()).unwrap());
        assert!(Arc::ptr_eq(&first.client, &second.client), "one name is one client");
    }

    #[test]
    fn a_bad_token_is_told_by_its_clients_name_and_never_by_its_text() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("token");
        fs::write(&path, "hunter2").unwrap();
        for (bad, problem) in [
            (source(Secret::File(path.clone()), &[Scope::Read]), "not a token"),
            (source(Secret::File(folder.path().join("missing")), &[Scope::Read]), "missing: No such file"),
            (source(Secret::Sha256("hunter2".to_owned()), &[Scope::Read]), "64 hexadecimal digits"),
            (source(Secret::Sha256("+1".repeat(32)), &[Scope::Read]), "64 hexadecimal digits"),
            (source(Secret::Sha256("0".repeat(64)), &[]), "no scopes"),
        ] {
            let told = bad.read().unwrap_err().to_string();
            assert!(told.contains("planner") && told.contains(problem), "{told}");
            assert!(!told.contains("hunter2"), "{told}");
        }
    }
}
