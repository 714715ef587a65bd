//! What can be chosen for the shared-memory door? The keys of `[shared_memory]` in the file, and what they mean together.

use std::path::PathBuf;

use serde::Deserialize;

/// Choices of one source, as far as it says something.
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
    /// What this source says, and for the rest what `weaker` says.
    pub(super) fn over(self, weaker: Self) -> Self {
        Self {
            enabled: self.enabled.or(weaker.enabled),
            name: self.name.or(weaker.name),
            root: self.root.or(weaker.root),
            spin_microseconds: self.spin_microseconds.or(weaker.spin_microseconds),
        }
    }
}

#[cfg(feature = "shared-memory")]
mod resolved {
    use std::path::PathBuf;
    use std::time::Duration;

    use super::SharedMemorySettings;
    use crate::app::defaults;
    use crate::transports::shared_memory::Config;

    /// Whether there is a shared-memory door.
    #[derive(Clone, Debug, PartialEq, Eq)]
    pub enum SharedMemory {
        /// There is none.
        Off,
        /// Nobody asked for it: where it cannot be opened, the daemon says so in its log and serves the other doors.
        IfPossible(Config),
        /// It was asked for: a daemon that cannot open it does not start.
        On(Config),
    }

    impl SharedMemorySettings {
        /// The door's configuration, with defaults for what nobody said.
        pub(in crate::app) fn resolve(self) -> SharedMemory {
            // Whoever gives it a name wants it.
            let asked_for = self.enabled.unwrap_or(self.name.is_some());
            let spin = self.spin_microseconds.unwrap_or(defaults::SHARED_MEMORY_SPIN);
            let config = Config {
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
}

#[cfg(feature = "shared-memory")]
pub use resolved::SharedMemory;

#[cfg(all(test, feature = "shared-memory"))]
mod tests {
    use super::*;

    #[test]
    fn shared_memory_that_was_asked_for_is_told_from_what_is_there_by_default() {
        let of = |text| toml::from_str::<SharedMemorySettings>(text).unwrap().resolve();
        assert!(matches!(of(""), SharedMemory::IfPossible(_)));
        assert!(matches!(of("root = \"/tmp/x\""), SharedMemory::IfPossible(_)));
        assert!(matches!(of("enabled = true"), SharedMemory::On(_)));
        assert!(matches!(of("name = \"mine\""), SharedMemory::On(config) if config.name == "mine"));
        assert_eq!(of("enabled = false\nname = \"mine\""), SharedMemory::Off);
    }
}
