//! How is the daemon to be? From a TOML file, the environment and flags: a flag wins over the environment, the
//! environment over the file, the file over the defaults, which stand here and nowhere else.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use serde::Deserialize;

#[cfg(any(feature = "shared-memory", feature = "zenoh"))]
use super::DoorChoice;
use super::{GrpcSettings, LogFormat, MetricsSettings, SharedMemorySettings, TracesSettings, ZenohSettings};
use crate::limits::Limits;
use crate::service;

/// Everything that can be chosen.
#[derive(Clone, Debug, PartialEq)]
pub struct Config {
    /// Threads and caps.
    pub service: service::Config,
    /// The gRPC door.
    #[cfg(feature = "grpc")]
    pub grpc: crate::transports::grpc::Config,
    /// The shared-memory door.
    #[cfg(feature = "shared-memory")]
    pub shared_memory: DoorChoice<crate::transports::shared_memory::Config>,
    /// The zenoh door.
    #[cfg(feature = "zenoh")]
    pub zenoh: DoorChoice<crate::transports::zenoh::Config>,
    /// How long requests under way may take to finish once the daemon is told to end.
    pub drain: Duration,
    /// Which log lines are written, as a filter of `tracing`.
    pub log: String,
    /// How log lines look.
    pub log_format: LogFormat,
    /// Calls that take at least so long are logged; zero: none.
    pub slow_query: Duration,
    /// The metrics endpoint, if there is to be one.
    #[cfg(feature = "metrics")]
    pub metrics: Option<crate::observability::MetricsConfig>,
    /// Where traces go, if there are to be any.
    #[cfg(feature = "traces")]
    pub traces: Option<crate::observability::TracesConfig>,
}

/// What holds if nobody says.
pub mod defaults {
    /// Where the gRPC door is.
    pub const GRPC_ADDRESS: &str = "127.0.0.1:50551";
    /// What the keys of the zenoh door begin with.
    pub const ZENOH_PREFIX: &str = "clearance";
    /// Where the zenoh door listens.
    pub const ZENOH_LISTEN: &str = "tcp/127.0.0.1:50552";
    /// What the shared-memory door is called.
    pub const SHARED_MEMORY_NAME: &str = "clearance";
    /// The folder of the shared-memory door.
    pub const SHARED_MEMORY_ROOT: &str = "/tmp/clearance";
    /// Microseconds that the shared-memory door looks for the next request before it sleeps.
    pub const SHARED_MEMORY_SPIN: u64 = 20;
    /// Seconds that requests under way may take to finish.
    pub const DRAIN_SECONDS: u64 = 10;
    /// Which log lines are written. zenoh tells of every session, and warns of what is meant to be: that nobody is looked for.
    pub const LOG: &str = "info,zenoh=warn,zenoh::net::routing=error";
    /// How log lines look.
    pub const LOG_FORMAT: super::LogFormat = super::LogFormat::Text;
    /// Scenes that have figures of their own among the metrics, at most.
    pub const METRICS_SCENES: usize = 50;
    /// Of calls that come without a trace, this share begins one.
    pub const TRACES_SAMPLE_RATIO: f64 = 0.01;
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
    /// How log lines look: `text` or `json`.
    pub log_format: Option<LogFormat>,
    /// Calls that take at least so many seconds are logged; 0, the default: none.
    pub slow_query_seconds: Option<f64>,
    /// The gRPC door.
    pub grpc: GrpcSettings,
    /// The shared-memory door.
    pub shared_memory: SharedMemorySettings,
    /// The zenoh door.
    pub zenoh: ZenohSettings,
    /// The metrics endpoint.
    pub metrics: MetricsSettings,
    /// Traces.
    pub traces: TracesSettings,
    /// Caps by their names in [`Limits`].
    pub limits: toml::Table,
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
    /// This program lacks what is asked for.
    #[error("{key}: this program was built without {key}")]
    NotBuiltIn {
        /// Which part of the configuration.
        key: &'static str,
    },
    /// A value that cannot be.
    #[error("{key}: {problem}")]
    BadValue {
        /// Which key.
        key: &'static str,
        /// Why.
        problem: String,
    },
    /// What is said of the gRPC door does not fit together.
    #[error("grpc.{key}: {problem}")]
    BadDoor {
        /// Which key.
        key: &'static str,
        /// Why.
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
            log_format: self.log_format.or(weaker.log_format),
            slow_query_seconds: self.slow_query_seconds.or(weaker.slow_query_seconds),
            grpc: self.grpc.over(weaker.grpc),
            shared_memory: self.shared_memory.over(weaker.shared_memory),
            zenoh: self.zenoh.over(weaker.zenoh),
            metrics: self.metrics.over(weaker.metrics),
            traces: self.traces.over(weaker.traces),
            limits,
        }
    }

    /// The configuration, with defaults for what nobody said.
    ///
    /// # Errors
    /// [`ConfigError::BadLimit`] or [`ConfigError::BadDoor`].
    pub fn resolve(self) -> Result<Config, ConfigError> {
        let bad = |problem: toml::de::Error| ConfigError::BadLimit { problem: problem.message().to_owned() };
        let limits = self.limits.try_into().map_err(bad)?;
        #[cfg_attr(not(feature = "traces"), expect(unused_variables, reason = "only the check counts"))]
        let traces = self.traces.checked()?;
        let slow_query = slow_query(self.slow_query_seconds.unwrap_or(0.0))?;
        #[cfg(not(feature = "metrics"))]
        if self.metrics.is_asked_for() {
            return Err(ConfigError::NotBuiltIn { key: "metrics" });
        }
        Ok(Config {
            service: service::Config { threads: self.threads.unwrap_or(0), limits },
            #[cfg(feature = "grpc")]
            grpc: self.grpc.resolve()?,
            #[cfg(feature = "shared-memory")]
            shared_memory: self.shared_memory.resolve(),
            #[cfg(feature = "zenoh")]
            zenoh: self.zenoh.resolve(),
            drain: Duration::from_secs(self.drain_seconds.unwrap_or(defaults::DRAIN_SECONDS)),
            log: self.log.unwrap_or_else(|| defaults::LOG.to_owned()),
            log_format: self.log_format.unwrap_or(defaults::LOG_FORMAT),
            slow_query,
            #[cfg(feature = "metrics")]
            metrics: self.metrics.resolve(),
            #[cfg(feature = "traces")]
            traces: traces
                .map(|(endpoint, sample_ratio)| crate::observability::TracesConfig { endpoint, sample_ratio }),
        })
    }
}

fn slow_query(seconds: f64) -> Result<Duration, ConfigError> {
    let bad = |problem: String| ConfigError::BadValue { key: "slow_query_seconds", problem };
    Duration::try_from_secs_f64(seconds).map_err(|error| bad(format!("{seconds}: {error}")))
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

    #[test]
    fn a_threshold_that_is_no_time_is_refused() {
        for seconds in ["-1.0", "nan", "inf"] {
            let error = settings(&format!("slow_query_seconds = {seconds}")).resolve().unwrap_err().to_string();
            assert!(error.starts_with("slow_query_seconds: "), "{error}");
        }
        let config = settings("slow_query_seconds = 0.25").resolve().unwrap();
        assert_eq!(config.slow_query, Duration::from_millis(250));
    }

    #[cfg(feature = "metrics")]
    #[test]
    fn an_empty_address_takes_back_an_endpoint() {
        let file = settings("[metrics]\naddress = \"127.0.0.1:9464\"");
        assert!(file.clone().resolve().unwrap().metrics.is_some());
        assert_eq!(settings("[metrics]\naddress = \"\"").over(file).resolve().unwrap().metrics, None);
    }

    const SAMPLE: &str = include_str!("../../deploy/clearance.toml");

    #[test]
    fn the_sample_configuration_is_what_holds_if_nobody_says_anything() {
        let sample = settings(SAMPLE);
        let caps = Limits::default().table();
        let missing: Vec<_> = caps.iter().filter(|cap| !sample.limits.contains_key(cap.name)).collect();
        assert!(missing.is_empty(), "deploy/clearance.toml lacks {missing:?}");
        assert_eq!(sample.resolve().unwrap(), Settings::default().resolve().unwrap());
    }

    #[test]
    fn the_sample_configuration_has_every_key() {
        let is_key = |line: &str| {
            let word = line.split(' ').next().unwrap_or_default();
            line.starts_with("[[")
                || line.contains(" = ")
                    && word.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_')
        };
        let uncommented: Vec<&str> =
            SAMPLE.lines().map(|line| line.strip_prefix("# ").filter(|line| is_key(line)).unwrap_or(line)).collect();
        let shown = format!("{:?}", settings(&uncommented.join("\n")));
        // What nobody says is `None`.
        assert!(!shown.contains("None"), "deploy/clearance.toml says nothing of a key: {shown}");
        assert!(shown.contains("name: \"planner\""), "{shown}");
    }
}
