//! What does a query ask? Its key names the rpc, its parameters say what no message says.

use std::time::Duration;

use zenoh::query::Parameters;

use super::keys::{Keys, is_client_id};
use crate::service::ServiceError;

/// A query, but for its payload.
#[derive(Clone, Debug, PartialEq)]
pub struct Selected {
    /// `SERVICE/METHOD`.
    pub rpc: String,
    /// How long the caller listens.
    pub timeout: Option<Duration>,
    /// The caller's token, without what all such tokens begin with.
    pub client: Option<String>,
    /// Of what is answered step by step: how many steps.
    pub steps: Option<u64>,
    /// The caller's trace.
    pub traceparent: Option<String>,
}

/// What the longest trace header has: version, trace, parent and flags.
const TRACEPARENT_BYTES: usize = 55;
/// The rpc of keys without a service and a method is as long as it was sent.
const LONGEST_RPC: usize = 64;

impl Selected {
    /// Reads the selector of a query.
    ///
    /// # Errors
    /// A key that names no rpc, a parameter that is not known or cannot be.
    pub fn read(keys: &Keys, key: &str, parameters: &str) -> Result<Self, ServiceError> {
        let rpc = keys.rpc_of(key).filter(|rpc| rpc.len() <= LONGEST_RPC && !rpc.contains('*'));
        let no_rpc = || ServiceError::invalid("key", "names no rpc: one is asked by PREFIX/v1/call/SERVICE/METHOD");
        let mut selected = Self {
            rpc: rpc.ok_or_else(no_rpc)?.to_owned(),
            timeout: None,
            client: None,
            steps: None,
            traceparent: None,
        };
        for (name, value) in Parameters::from(parameters).iter() {
            match name {
                "timeout" => selected.timeout = Some(seconds(value)?),
                "client" if is_client_id(value) => selected.client = Some(value.to_owned()),
                "client" => return Err(bad("client", "is no key without wildcards of up to 128 bytes")),
                "steps" => selected.steps = Some(steps(value)?),
                "traceparent" if value.len() <= TRACEPARENT_BYTES => selected.traceparent = Some(value.to_owned()),
                "traceparent" => return Err(bad("traceparent", "is too long")),
                // What zenoh itself says to queryables.
                "" => {}
                reserved if reserved.starts_with('_') => {}
                unknown => return Err(ServiceError::invalid("parameters", format!("there is no {unknown:?}"))),
            }
        }
        Ok(selected)
    }
}

fn bad(parameter: &str, problem: &str) -> ServiceError {
    ServiceError::invalid(format!("parameters.{parameter}"), problem)
}

fn seconds(text: &str) -> Result<Duration, ServiceError> {
    let seconds = text.parse().ok().and_then(|seconds: f64| Duration::try_from_secs_f64(seconds).ok());
    seconds.filter(|time| !time.is_zero()).ok_or_else(|| bad("timeout", "is no number of seconds greater than 0"))
}

fn steps(text: &str) -> Result<u64, ServiceError> {
    text.parse().ok().filter(|steps| *steps > 0).ok_or_else(|| bad("steps", "is no whole number greater than 0"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(key: &str, parameters: &str) -> Result<Selected, String> {
        let keys = Keys::new("clearance").unwrap();
        Selected::read(&keys, key, parameters).map_err(|error| error.to_string())
    }

    #[test]
    fn parameters_say_what_the_message_does_not() {
        let told = "timeout=2.5;client=ab/1;steps=3;traceparent=00-1-2-01;_anyke";
        let selected = read("clearance/v1/call/Scenes/Watch", told).unwrap();
        assert_eq!((selected.rpc.as_str(), selected.timeout), ("Scenes/Watch", Some(Duration::from_millis(2500))));
        assert_eq!((selected.client.as_deref(), selected.steps), (Some("ab/1"), Some(3)));
        assert_eq!(selected.traceparent.as_deref(), Some("00-1-2-01"));
        let bare = read("clearance/v1/call/Queries/Collide", "").unwrap();
        assert_eq!((bare.timeout, bare.client, bare.steps), (None, None, None));
    }

    #[test]
    fn what_cannot_be_is_refused_by_its_name() {
        let of = |parameters: &str| read("clearance/v1/call/Queries/Collide", parameters).unwrap_err();
        for bad in ["timeout=", "timeout=nan", "timeout=-1", "timeout=0", "timeout=1e300", "timeout=x"] {
            assert_eq!(of(bad), "parameters.timeout: is no number of seconds greater than 0", "{bad}");
        }
        assert!(of("client=a/**").starts_with("parameters.client: "));
        assert!(of("client=").starts_with("parameters.client: "));
        assert!(of("steps=0").starts_with("parameters.steps: "));
        assert!(of(&format!("traceparent={}", "x".repeat(56))).starts_with("parameters.traceparent: "));
        assert_eq!(of("speed=1"), "parameters: there is no \"speed\"");
        for key in ["clearance/v1/call", "clearance/v1/call/**", "clearance/v1/call/Queries/*", "other/v1/call/a/b"] {
            assert!(read(key, "").unwrap_err().starts_with("key: names no rpc"), "{key}");
        }
    }
}
