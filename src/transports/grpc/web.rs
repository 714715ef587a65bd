//! May a page of the web ask? Pages of the origins that are configured may, by gRPC-Web; without any, the door does not
//! speak it.

use std::time::Duration;

use http::{HeaderName, HeaderValue, Method, header};
use tower_http::cors::{AllowOrigin, CorsLayer};

/// An entry of `grpc.web.allowed_origins` that is no origin.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("grpc.web.allowed_origins: {0:?} is not an origin like `https://planner.example`, nor `*`")]
pub struct BadOrigin(String);

/// How long a browser may remember what it was told of an origin.
const MAX_AGE: Duration = Duration::from_secs(3600);

/// What a page may send beside what every page may.
const SENT: [&str; 5] = ["authorization", "content-type", "grpc-timeout", "x-grpc-web", "x-user-agent"];

/// What a page may see beside what every page may. Of a refusal without a body all of it is in the headers.
const SEEN: [&str; 14] = [
    "grpc-status",
    "grpc-message",
    "grpc-status-details-bin",
    "grpc-retry-pushback-ms",
    "clearance-allowed",
    "clearance-asked",
    "clearance-epoch",
    "clearance-field",
    "clearance-limit",
    "clearance-oldest-revision",
    "clearance-reason",
    "clearance-retry-after-ms",
    "clearance-revision",
    "clearance-scope",
];

/// The answers to browsers that ask whether a page may ask. None: no page may.
///
/// # Errors
/// [`BadOrigin`].
pub(super) fn cors(allowed_origins: &[String]) -> Result<Option<CorsLayer>, BadOrigin> {
    if allowed_origins.is_empty() {
        return Ok(None);
    }
    let origins: Vec<HeaderValue> = allowed_origins.iter().map(|text| origin(text)).collect::<Result<_, _>>()?;
    let origins =
        if allowed_origins.iter().any(|text| text == "*") { AllowOrigin::any() } else { AllowOrigin::list(origins) };
    let cors = CorsLayer::new()
        .allow_origin(origins)
        .allow_methods([Method::POST])
        .allow_headers(SENT.map(HeaderName::from_static))
        .expose_headers(SEEN.map(HeaderName::from_static))
        .vary([header::ORIGIN])
        .max_age(MAX_AGE);
    Ok(Some(cors))
}

/// Browsers compare origins as text: scheme, host in small letters, port if it is not the scheme's own, and nothing else.
fn origin(text: &str) -> Result<HeaderValue, BadOrigin> {
    let bad = || BadOrigin(text.to_owned());
    if text != "*" {
        let (scheme, host) = text.split_once("://").ok_or_else(bad)?;
        let odd = |c: char| c.is_ascii_uppercase() || !c.is_ascii_graphic() || "/?#@".contains(c);
        if scheme.is_empty()
            || host.is_empty()
            || text.contains(['*', ','])
            || scheme.contains(odd)
            || host.contains(odd)
        {
            return Err(bad());
        }
    }
    HeaderValue::from_str(text).map_err(|_| bad())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_no_browser_would_send_as_origin_is_refused() {
        let told = |text: &str| cors(&[text.to_owned()]).map(|cors| cors.is_some());
        for fine in ["https://planner.example", "http://localhost:3000", "http://[::1]:3000", "*"] {
            assert_eq!(told(fine), Ok(true), "{fine}");
        }
        let bad =
            ["planner.example", "https://planner.example/", "https://Planner.example", "https://*.example", "", "://"];
        for bad in bad {
            assert_eq!(told(bad), Err(BadOrigin(bad.to_owned())));
        }
        assert!(matches!(cors(&[]), Ok(None)));
    }
}
