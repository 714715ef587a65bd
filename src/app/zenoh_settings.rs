//! What can be chosen for the zenoh door? The keys of `[zenoh]` in the file, and what they mean together.

use std::path::PathBuf;

use serde::Deserialize;

/// Choices of one source, as far as it says something.
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ZenohSettings {
    /// Whether there is one; unsaid: if it can be opened.
    pub enabled: Option<bool>,
    /// What its keys begin with.
    pub prefix: Option<String>,
    /// Endpoints where others connect; an empty list: nowhere.
    pub listen: Option<Vec<String>>,
    /// Endpoints of routers that it connects to.
    pub connect: Option<Vec<String>>,
    /// Look for others by multicast and gossip.
    pub scouting: Option<bool>,
    /// zenoh's own configuration, for everything else.
    pub file: Option<PathBuf>,
    /// Let strangers in.
    pub insecure: Option<bool>,
}

impl ZenohSettings {
    /// What this source says, and for the rest what `weaker` says.
    pub(super) fn over(self, weaker: Self) -> Self {
        Self {
            enabled: self.enabled.or(weaker.enabled),
            prefix: self.prefix.or(weaker.prefix),
            listen: self.listen.or(weaker.listen),
            connect: self.connect.or(weaker.connect),
            scouting: self.scouting.or(weaker.scouting),
            file: self.file.or(weaker.file),
            insecure: self.insecure.or(weaker.insecure),
        }
    }

    /// The door's configuration, with defaults for what nobody said.
    #[cfg(feature = "zenoh")]
    pub(super) fn resolve(self) -> super::DoorChoice<crate::transports::zenoh::Config> {
        use super::{DoorChoice, defaults};
        let is_named = self.listen.is_some() || self.connect.is_some() || self.file.is_some();
        let config = crate::transports::zenoh::Config {
            prefix: self.prefix.unwrap_or_else(|| defaults::ZENOH_PREFIX.to_owned()),
            listen: self.listen,
            listens_at: defaults::ZENOH_LISTEN.to_owned(),
            connect: self.connect,
            scouting: self.scouting.unwrap_or(false),
            file: self.file,
            insecure: self.insecure.unwrap_or(false),
        };
        DoorChoice::new(self.enabled, is_named, config)
    }
}

#[cfg(all(test, feature = "zenoh"))]
mod tests {
    use super::super::DoorChoice;
    use super::*;

    #[test]
    fn zenoh_that_was_asked_for_is_told_from_what_is_there_by_default() {
        let of = |text| toml::from_str::<ZenohSettings>(text).unwrap().resolve();
        assert!(matches!(of(""), DoorChoice::IfPossible(_)));
        assert!(matches!(of("prefix = \"site\""), DoorChoice::IfPossible(config) if config.prefix == "site"));
        assert!(matches!(of("listen = [\"tcp/127.0.0.1:0\"]"), DoorChoice::On(_)));
        assert!(matches!(of("connect = [\"tls/router:7447\"]"), DoorChoice::On(_)));
        assert_eq!(of("enabled = false\nlisten = []"), DoorChoice::Off);
    }
}
