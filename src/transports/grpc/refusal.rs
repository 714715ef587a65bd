//! What does a caller see whom the door itself refuses? Like every refusal: a status, and the reason for programs in its
//! metadata.

use std::time::Duration;

use http::HeaderMap;
use tonic::{Code, Status};

use super::access::Scope;
use super::clients::OverQuota;
use super::status::with_reason;
use crate::limits::LimitExceeded;
use crate::transports::wire::v1::ErrorReason;

/// Why the door does not let a call in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Refusal {
    /// It brings no token.
    NoToken,
    /// It brings one that is not known.
    UnknownToken,
    /// Its token does not allow it.
    MissingScope(Scope),
    /// Its client has to wait.
    OverQuota(OverQuota),
}

impl From<Refusal> for Status {
    fn from(refusal: Refusal) -> Self {
        match refusal {
            Refusal::NoToken => {
                let message = "a token is needed: `authorization: Bearer TOKEN`";
                with_reason(Code::Unauthenticated, ErrorReason::NoToken, message, Vec::new())
            }
            Refusal::UnknownToken => {
                with_reason(Code::Unauthenticated, ErrorReason::UnknownToken, "the token is not known", Vec::new())
            }
            Refusal::MissingScope(scope) => {
                let message = format!("the token does not have the scope `{scope}`");
                let details = vec![("clearance-scope", scope.to_string())];
                with_reason(Code::PermissionDenied, ErrorReason::MissingScope, &message, details)
            }
            Refusal::OverQuota(OverQuota { exceeded, wait }) => beyond(exceeded, wait),
        }
    }
}

/// A limit is exceeded; `wait` says when to ask again.
fn beyond(exceeded: LimitExceeded, wait: Option<Duration>) -> Status {
    let mut details = vec![
        ("clearance-limit", exceeded.limit.to_owned()),
        ("clearance-asked", exceeded.asked.to_string()),
        ("clearance-allowed", exceeded.allowed.to_string()),
    ];
    let mut message = exceeded.to_string();
    if let Some(wait) = wait {
        // Milliseconds, the next whole one. gRPC's clients with a retry policy know the second of the two.
        let milliseconds = wait.as_nanos().div_ceil(1_000_000);
        details.push(("clearance-retry-after-ms", milliseconds.to_string()));
        details.push(("grpc-retry-pushback-ms", milliseconds.to_string()));
        message.push_str(&format!("; ask again in {milliseconds} ms"));
    }
    with_reason(Code::ResourceExhausted, ErrorReason::LimitExceeded, &message, details)
}

/// tonic tells a message that is too large, in whichever direction, by OUT_OF_RANGE and a text. Puts in its place what every
/// other limit says. Our own OUT_OF_RANGE has a reason with it.
pub(super) fn name_message_limit(headers: &mut HeaderMap) {
    if headers.get(Status::GRPC_STATUS).is_none_or(|code| code != "11") || headers.contains_key("clearance-reason") {
        return;
    }
    let Some(status) = Status::from_header_map(headers) else { return };
    let Some((asked, allowed)) = two_numbers(status.message()) else { return };
    let exceeded = LimitExceeded { limit: "max_message_bytes", asked, allowed };
    headers.remove(Status::GRPC_MESSAGE);
    let told = beyond(exceeded, None).add_header(headers);
    // Nothing in it comes from outside.
    debug_assert!(told.is_ok(), "numbers and names fit in headers");
}

/// The two numbers of "message length too large: found N bytes, the limit is: N bytes".
fn two_numbers(text: &str) -> Option<(u64, u64)> {
    let (_, numbers) = text.split_once("message length too large")?;
    let mut numbers = numbers.split(|c: char| !c.is_ascii_digit()).filter_map(|digits| digits.parse().ok());
    Some((numbers.next()?, numbers.next()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_client_that_has_to_wait_is_told_how_long() {
        let exceeded = LimitExceeded { limit: "max_client_bytes_per_second", asked: 7, allowed: 5 };
        let status = Status::from(Refusal::OverQuota(OverQuota { exceeded, wait: Some(Duration::from_micros(1_500)) }));
        assert_eq!(status.code(), Code::ResourceExhausted);
        let of = |key| status.metadata().get(key).unwrap().to_str().unwrap();
        assert_eq!((of("clearance-limit"), of("clearance-asked")), ("max_client_bytes_per_second", "7"));
        assert_eq!((of("clearance-retry-after-ms"), of("grpc-retry-pushback-ms")), ("2", "2"));
    }

    #[test]
    fn only_tonics_own_out_of_range_is_renamed() {
        let renamed = |status: Status| {
            let mut headers = HeaderMap::new();
            status.add_header(&mut headers).unwrap();
            name_message_limit(&mut headers);
            Status::from_header_map(&headers).unwrap()
        };
        let text = "Error, decoded message length too large: found 16008 bytes, the limit is: 10000 bytes";
        let status = renamed(Status::out_of_range(text));
        assert_eq!(status.code(), Code::ResourceExhausted);
        assert_eq!(status.message(), "max_message_bytes exceeded: asked for 16008, allowed is 10000");
        assert_eq!(status.metadata().get("clearance-reason").unwrap(), "LIMIT_EXCEEDED");
        let gone = with_reason(Code::OutOfRange, ErrorReason::RevisionGone, text, Vec::new());
        assert_eq!(renamed(gone).code(), Code::OutOfRange);
        assert_eq!(renamed(Status::out_of_range("another")).code(), Code::OutOfRange);
        assert_eq!(renamed(Status::internal(text)).code(), Code::Internal);
    }
}
