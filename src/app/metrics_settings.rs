//! What can be chosen for the metrics endpoint? The keys of `[metrics]` in the file, and what they mean together.

use serde::Deserialize;

/// Choices of one source, as far as it says something.
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MetricsSettings {
    /// HOST:PORT; unsaid: there is no endpoint, and nothing is counted.
    pub address: Option<String>,
    /// Listen beyond loopback.
    pub exposed: Option<bool>,
    /// Scenes that have figures of their own, at most.
    pub scenes: Option<usize>,
}

impl MetricsSettings {
    /// What this source says, and for the rest what `weaker` says.
    pub(super) fn over(self, weaker: Self) -> Self {
        Self {
            address: self.address.or(weaker.address),
            exposed: self.exposed.or(weaker.exposed),
            scenes: self.scenes.or(weaker.scenes),
        }
    }

    /// Whether there is to be an endpoint.
    #[cfg(not(feature = "metrics"))]
    pub(super) fn is_asked_for(&self) -> bool {
        self.address.as_ref().is_some_and(|address| !address.is_empty())
    }

    /// The endpoint's configuration, with defaults for what nobody said. An empty address means none, so that a flag can take
    /// back what a file says.
    #[cfg(feature = "metrics")]
    pub(super) fn resolve(self) -> Option<crate::observability::MetricsConfig> {
        Some(crate::observability::MetricsConfig {
            address: self.address.filter(|address| !address.is_empty())?,
            exposed: self.exposed.unwrap_or(false),
            scenes: self.scenes.unwrap_or(super::defaults::METRICS_SCENES),
        })
    }
}
