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

    /// The door's configuration, with defaults for what nobody said.
    #[cfg(feature = "shared-memory")]
    pub(super) fn resolve(self) -> super::DoorChoice<crate::transports::shared_memory::Config> {
        use super::{DoorChoice, defaults};
        let (is_named, spin) = (self.name.is_some(), self.spin_microseconds.unwrap_or(defaults::SHARED_MEMORY_SPIN));
        let config = crate::transports::shared_memory::Config {
            name: self.name.unwrap_or_else(|| defaults::SHARED_MEMORY_NAME.to_owned()),
            root: self.root.unwrap_or_else(|| PathBuf::from(defaults::SHARED_MEMORY_ROOT)),
            spin: std::time::Duration::from_micros(spin),
        };
        DoorChoice::new(self.enabled, is_named, config)
    }
}

#[cfg(all(test, feature = "shared-memory"))]
mod tests {
    use super::super::DoorChoice;
    use super::*;

    #[test]
    fn shared_memory_that_was_asked_for_is_told_from_what_is_there_by_default() {
        let of = |text| toml::from_str::<SharedMemorySettings>(text).unwrap().resolve();
        assert!(matches!(of(""), DoorChoice::IfPossible(_)));
        assert!(matches!(of("root = \"/tmp/x\""), DoorChoice::IfPossible(_)));
        assert!(matches!(of("enabled = true"), DoorChoice::On(_)));
        assert!(matches!(of("name = \"mine\""), DoorChoice::On(config) if config.name == "mine"));
        assert_eq!(of("enabled = false\nname = \"mine\""), DoorChoice::Off);
    }
}
