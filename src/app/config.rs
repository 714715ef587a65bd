//! How is the daemon to be? From a TOML file, the environment and flags: a flag wins over the environment, the
//! environment over the file, the file over the defaults, which stand here and nowhere else.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use serde::Deserialize;

use crate::limits::Limits;
use crate::service;

/// Everything that can be chosen.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Config {
    /// Threads and caps.
    pub service: service::Config,
    /// The gRPC door.
    #[cfg(feature = "grpc")]
    pub grpc: crate::transports::grpc::Config,
    /// The shared-memory door.
    #[cfg(feature = "shared-memory")]
    pub shared_memory: SharedMemory,
    /// How long requests under way may take to finish once the daemon is told to end.
    pub drain: Duration,
    /// Which log lines are written, as a filter of `tracing`.
    pub log: String,
}

/// Whether there is a shared-memory door.
#[cfg(feature = "shared-memory")]
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SharedMemory {
    /// There is none.
    Off,
    /// Nobody asked for it: where it cannot be opened, the daemon says so in its log and serves the other doors.
    IfPossible(crate::transports::shared_memory::Config),
    /// It was asked for: a daemon that cannot open it does not start.
    On(crate::transports::shared_memory::Config),
}

/// What holds if nobody says.
pub mod defaults {
    /// Where the gRPC door is.
    pub const GRPC_ADDRESS: &str = "127.0.0.1:50551";
    /// What the shared-memory door is called.
    pub const SHARED_MEMORY_NAME: &str = "clearance";
    /// The folder of the shared-memory door.
    pub const SHARED_MEMORY_ROOT: &str = "/tmp/clearance";
    /// Microseconds that the shared-memory door looks for the next request before it sleeps.
    pub const SHARED_MEMORY_SPIN: u64 = 20;
    /// Seconds that requests under way may take to finish.
    pub const DRAIN_SECONDS: u64 = 10;
    /// Which log lines are written.
    pub const LOG: &str = "info";
}

/// Choices of one source, as far as it says something. The same names are keys of the file.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Settings {
    /// Threads that answer questions; 0, the default: one for each core.
    pub threads: Option<usize>,
    /// Seconds that requests under way may take to finish once the daemon is told to end.
    pub drain_seconds: Option<u64>,
    /// Which log lines are written, as a filter of `tracing`.
    pub log: Option<String>,
    /// The gRPC door.
    pub grpc: GrpcSettings,
    /// The shared-memory door.
    pub shared_memory: SharedMemorySettings,
    /// Caps by their names in [`Limits`].
    pub limits: toml::Table,
}

/// Choices for the gRPC door.
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct GrpcSettings {
    /// HOST:PORT; port 0 means any free one.
    pub address: Option<String>,
    /// Listen beyond loopback although there is neither TLS nor a token.
    pub insecure: Option<bool>,
}

/// Choices for the shared-memory door.
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SharedMemorySettings {
    /// Whether there is one; unsaid: if it can be opened.
    pub enabled: Option<bool>,
    /// What it is called: 1 to 32 of a-z, 0-9, _ and -. No other door of the machine may have the name.
    pub name: Option<String>,
    /// Absolute path of its folder.
    pub root: Option<PathBuf>,
    /// Microseconds that it looks for the next request before it sleeps.
    pub spin_microseconds: Option<u64>,
}

impl SharedMemorySettings {
    fn over(self, weaker: Self) -> Self {
        Self {
            enabled: self.enabled.or(weaker.enabled),
            name: self.name.or(weaker.name),
            root: self.root.or(weaker.root),
            spin_microseconds: self.spin_microseconds.or(weaker.spin_microseconds),
        }
    }

    #[cfg(feature = "shared-memory")]
    fn resolve(self) -> SharedMemory {
        // Whoever gives it a name wants it.
        let asked_for = self.enabled.unwrap_or(self.name.is_some());
        let spin = self.spin_microseconds.unwrap_or(defaults::SHARED_MEMORY_SPIN);
        let config = crate::transports::shared_memory::Config {
            name: self.name.unwrap_or_else(|| defaults::SHARED_MEMORY_NAME.to_owned()),
            root: self.root.unwrap_or_else(|| PathBuf::from(defaults::SHARED_MEMORY_ROOT)),
            spin: Duration::from_micros(spin),
        };
        match self.enabled {
            Some(false) => SharedMemory::Off,
            Some(true) | None if asked_for => SharedMemory::On(config),
            Some(true) | None => SharedMemory::IfPossible(config),
        }
    }
}

/// Why there is no configuration.
#[derive(Debug, thiserror::Error)]
pub enum ConfigError {
    /// The file cannot be read.
    #[error("{path}: {source}", path = path.display())]
    Unreadable {
        /// Which file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The file does not hold what it should.
    #[error("{path}: {problem}", path = path.display())]
    BadFile {
        /// Which file.
        path: PathBuf,
        /// Which line and key.
        problem: String,
    },
    /// A cap that is not known, or no number.
    #[error("limits: {problem}")]
    BadLimit {
        /// Which, and why.
        problem: String,
    },
}

impl Settings {
    /// What a TOML file says.
    ///
    /// # Errors
    /// [`ConfigError::Unreadable`] or [`ConfigError::BadFile`]; a key that is not known is an error.
    pub fn read(path: &Path) -> Result<Self, ConfigError> {
        let text =
            fs::read_to_string(path).map_err(|source| ConfigError::Unreadable { path: path.to_owned(), source })?;
        let bad = |problem: toml::de::Error| ConfigError::BadFile {
            path: path.to_owned(),
            problem: problem.to_string().trim_end().to_owned(),
        };
        let settings: Self = toml::from_str(&text).map_err(bad)?;
        // Caps are known by name only when the sources are put together; a file is held to its own mistakes at once.
        settings.limits.clone().try_into::<Limits>().map_err(bad)?;
        Ok(settings)
    }

    /// What this source says, and for the rest what `weaker` says.
    #[must_use]
    pub fn over(self, weaker: Self) -> Self {
        let mut limits = weaker.limits;
        limits.extend(self.limits);
        Self {
            threads: self.threads.or(weaker.threads),
            drain_seconds: self.drain_seconds.or(weaker.drain_seconds),
            log: self.log.or(weaker.log),
            grpc: GrpcSettings {
                address: self.grpc.address.or(weaker.grpc.address),
                insecure: self.grpc.insecure.or(weaker.grpc.insecure),
            },
            shared_memory: self.shared_memory.over(weaker.shared_memory),
            limits,
        }
    }

    /// The configuration, with defaults for what nobody said.
    ///
    /// # Errors
    /// [`ConfigError::BadLimit`].
    pub fn resolve(self) -> Result<Config, ConfigError> {
        let bad = |problem: toml::de::Error| ConfigError::BadLimit { problem: problem.message().to_owned() };
        let limits = self.limits.try_into().map_err(bad)?;
        Ok(Config {
            service: service::Config { threads: self.threads.unwrap_or(0), limits },
            #[cfg(feature = "grpc")]
            grpc: crate::transports::grpc::Config {
                address: self.grpc.address.unwrap_or_else(|| defaults::GRPC_ADDRESS.to_owned()),
                insecure: self.grpc.insecure.unwrap_or(false),
            },
            #[cfg(feature = "shared-memory")]
            shared_memory: self.shared_memory.resolve(),
            drain: Duration::from_secs(self.drain_seconds.unwrap_or(defaults::DRAIN_SECONDS)),
            log: self.log.unwrap_or_else(|| defaults::LOG.to_owned()),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settings(text: &str) -> Settings {
        toml::from_str(text).unwrap()
    }

    #[test]
    fn the_stronger_source_wins_key_by_key() {
        let file = settings("threads = 3\nlog = \"warn\"\n[limits]\nmax_items = 7\nmax_pairs = 8");
        let flags = settings("threads = 2\n[limits]\nmax_items = 9");
        let config = flags.over(file).resolve().unwrap();
        assert_eq!((config.service.threads, config.log.as_str()), (2, "warn"));
        assert_eq!((config.service.limits.max_items, config.service.limits.max_pairs), (9, 8));
        assert_eq!(config.service.limits.max_scenes, Limits::default().max_scenes);
        assert_eq!(config.drain, Duration::from_secs(defaults::DRAIN_SECONDS));
    }

    #[cfg(feature = "shared-memory")]
    #[test]
    fn shared_memory_that_was_asked_for_is_told_from_what_is_there_by_default() {
        let of = |text| settings(text).resolve().unwrap().shared_memory;
        assert!(matches!(of(""), SharedMemory::IfPossible(_)));
        assert!(matches!(of("[shared_memory]\nroot = \"/tmp/x\""), SharedMemory::IfPossible(_)));
        assert!(matches!(of("[shared_memory]\nenabled = true"), SharedMemory::On(_)));
        assert!(matches!(of("[shared_memory]\nname = \"mine\""), SharedMemory::On(config) if config.name == "mine"));
        assert_eq!(of("[shared_memory]\nenabled = false\nname = \"mine\""), SharedMemory::Off);
    }

    #[test]
    fn unknown_keys_are_errors_that_name_them() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("clearance.toml");
        for (text, named) in [("thread = 3", "thread"), ("[grpc]\nport = 1", "port"), ("[limits]\nmax = 1", "max")] {
            fs::write(&path, text).unwrap();
            let error = Settings::read(&path).unwrap_err().to_string();
            assert!(error.contains(&format!("`{named}`")), "{error}");
        }
        let error = settings("[limits]\nmax_items = -1").resolve().unwrap_err().to_string();
        assert!(error.starts_with("limits: "), "{error}");
    }
}
