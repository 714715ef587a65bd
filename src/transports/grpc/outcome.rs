//! What became of a call, as its status tells? The reason among the status's metadata is the word; where there is none, the door
//! itself said no.

use std::sync::LazyLock;

use http::HeaderMap;
use tonic::{Code, Status};

use crate::limits::Limits;
use crate::service::Outcome;

/// The outcome that headers or trailers tell. Without a status all is well.
pub(super) fn outcome_of(headers: &HeaderMap) -> Outcome {
    let Some(status) = headers.get(Status::GRPC_STATUS) else { return Outcome::OK };
    let text = |name| headers.get(name).and_then(|value| value.to_str().ok());
    if let Some(limit) = text("clearance-limit").and_then(limit_named) {
        return Outcome::limit(limit);
    }
    let reason = text("clearance-reason").and_then(Outcome::named);
    reason.unwrap_or_else(|| {
        let code = Code::from_bytes(status.as_bytes());
        if code == Code::Ok {
            Outcome::OK
        } else if code == Code::Cancelled {
            Outcome::ABANDONED
        } else {
            Outcome::OTHER
        }
    })
}

/// A limit's own name: what comes with a call cannot become another.
fn limit_named(name: &str) -> Option<&'static str> {
    static NAMES: LazyLock<Vec<&'static str>> =
        LazyLock::new(|| Limits::default().table().iter().map(|limit| limit.name).collect());
    NAMES.iter().copied().find(|known| *known == name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limits::LimitExceeded;
    use crate::service::ServiceError;
    use crate::transports::grpc::status_of;
    use crate::transports::wire::v1::ErrorReason;

    fn told(status: Status) -> Outcome {
        outcome_of(status.into_http::<()>().headers())
    }

    #[test]
    fn what_the_service_says_is_found_again_in_the_status() {
        let limit = LimitExceeded { limit: "max_items", asked: 2, allowed: 1 };
        for error in [ServiceError::DeadlineExceeded, ServiceError::Limit(limit), ServiceError::ShuttingDown] {
            assert_eq!(told(status_of(&error)), Outcome::of(&error));
        }
    }

    #[test]
    fn every_reason_that_callers_are_told_is_an_outcome() {
        let unspecified = ErrorReason::Unspecified as i32;
        let reasons: Vec<_> = (unspecified + 1..).map_while(|number| ErrorReason::try_from(number).ok()).collect();
        for reason in &reasons {
            let name = reason.as_str_name().strip_prefix("ERROR_REASON_").unwrap();
            assert!(Outcome::named(name).is_some(), "{name}");
        }
        assert_eq!(reasons.len(), Outcome::WORDS.len() - 3, "an outcome that no caller is told");
    }

    #[test]
    fn a_status_without_a_reason_is_the_doors_own() {
        assert_eq!(outcome_of(&HeaderMap::new()), Outcome::OK);
        assert_eq!(told(Status::cancelled("")), Outcome::ABANDONED);
        assert_eq!(told(Status::unimplemented("")), Outcome::OTHER);
    }
}
