//! What can be chosen for traces? The keys of `[traces]` in the file, and what they mean together.

use serde::Deserialize;

use super::ConfigError;

/// Choices of one source, as far as it says something.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TracesSettings {
    /// A collector of OpenTelemetry, `http://HOST:PORT`; unsaid: nothing is traced.
    pub endpoint: Option<String>,
    /// Of calls that come without a trace, this share begins one.
    pub sample_ratio: Option<f64>,
}

impl TracesSettings {
    /// What this source says, and for the rest what `weaker` says.
    pub(super) fn over(self, weaker: Self) -> Self {
        Self { endpoint: self.endpoint.or(weaker.endpoint), sample_ratio: self.sample_ratio.or(weaker.sample_ratio) }
    }

    /// Where to send spans, and the share of calls that begin a trace. An empty endpoint means none, so that a flag can take
    /// back what a file says.
    ///
    /// # Errors
    /// A share that is none, an endpoint that is not spoken to, or a program that traces nothing.
    pub(super) fn checked(self) -> Result<Option<(String, f64)>, ConfigError> {
        let bad = |key, problem: String| ConfigError::BadValue { key, problem };
        let ratio = self.sample_ratio.unwrap_or(super::defaults::TRACES_SAMPLE_RATIO);
        if !(0.0..=1.0).contains(&ratio) {
            return Err(bad("traces.sample_ratio", format!("{ratio} is not within 0 and 1")));
        }
        let Some(endpoint) = self.endpoint.filter(|endpoint| !endpoint.is_empty()) else { return Ok(None) };
        if !endpoint.starts_with("http://") {
            let problem =
                format!("{endpoint:?} does not begin with http://; a collector beside the daemon speaks TLS for it");
            return Err(bad("traces.endpoint", problem));
        }
        if cfg!(not(feature = "traces")) {
            return Err(ConfigError::NotBuiltIn { key: "traces" });
        }
        Ok(Some((endpoint, ratio)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(text: &str) -> String {
        toml::from_str::<TracesSettings>(text).unwrap().checked().unwrap_err().to_string()
    }

    #[test]
    fn what_cannot_be_is_told_by_its_key() {
        assert!(told("sample_ratio = 1.5").starts_with("traces.sample_ratio: 1.5 is not within"));
        assert!(told("sample_ratio = nan").starts_with("traces.sample_ratio: NaN"));
        assert!(told("endpoint = \"https://collector:4317\"").starts_with("traces.endpoint: "));
    }

    #[cfg(feature = "traces")]
    #[test]
    fn nothing_is_traced_unless_there_is_a_collector() {
        assert_eq!(TracesSettings::default().checked().unwrap(), None);
        let file: TracesSettings = toml::from_str("endpoint = \"http://127.0.0.1:4317\"\nsample_ratio = 1.0").unwrap();
        assert_eq!(file.clone().checked().unwrap(), Some(("http://127.0.0.1:4317".to_owned(), 1.0)));
        let flag = TracesSettings { endpoint: Some(String::new()), sample_ratio: None };
        assert_eq!(flag.over(file).checked().unwrap(), None);
    }
}
