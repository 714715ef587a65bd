//! What does a caller see when a request fails? One status for each error, with the reason for programs in its metadata
//! (`proto/clearance/v1/service.proto` lists the keys).

use tonic::metadata::MetadataMap;
use tonic::{Code, Status};

use crate::service::ServiceError;
use crate::transports::wire::to_proto::{ErrorCard, reason_name};
use crate::transports::wire::v1::ErrorReason;

/// The status of an error.
#[must_use]
pub fn status_of(error: &ServiceError) -> Status {
    let ErrorCard { code, reason, details } = ErrorCard::of(error);
    with_reason(Code::from_i32(code.into()), reason, &error.to_string(), details)
}

/// A status with what programs read of it.
pub(super) fn with_reason(
    code: Code,
    reason: ErrorReason,
    message: &str,
    details: Vec<(&'static str, String)>,
) -> Status {
    let mut metadata = MetadataMap::new();
    let mut put = |key: &'static str, value: String| {
        // A name that is not ASCII has no place in metadata; the message has it.
        if let Ok(value) = value.parse() {
            metadata.insert(key, value);
        }
    };
    put("clearance-reason", reason_name(reason).to_owned());
    for (key, value) in details {
        put(key, value);
    }
    Status::with_metadata(code, message, metadata)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limits::LimitExceeded;

    #[test]
    fn a_cap_is_told_with_both_numbers() {
        let exceeded = LimitExceeded { limit: "max_items", asked: 7, allowed: 5 };
        let status = status_of(&ServiceError::Limit(exceeded));
        assert_eq!(status.code(), Code::ResourceExhausted);
        let of = |key| status.metadata().get(key).unwrap().to_str().unwrap();
        assert_eq!(of("clearance-reason"), "LIMIT_EXCEEDED");
        assert_eq!((of("clearance-limit"), of("clearance-asked"), of("clearance-allowed")), ("max_items", "7", "5"));
    }

    #[test]
    fn a_field_with_characters_that_metadata_cannot_hold_is_in_the_message_alone() {
        let status = status_of(&ServiceError::invalid("päth\n", "is odd"));
        assert_eq!(status.message(), "päth\n: is odd");
        assert!(status.metadata().get("clearance-field").is_none());
        assert!(status.metadata().get("clearance-reason").is_some());
    }

    /// What the table says of codes, tonic says, too.
    #[test]
    fn codes_are_those_of_grpc() {
        let of = |error: ServiceError| status_of(&error).code();
        assert_eq!(of(ServiceError::invalid("x", "y")), Code::InvalidArgument);
        assert_eq!(of(ServiceError::DeadlineExceeded), Code::DeadlineExceeded);
        assert_eq!(of(ServiceError::NotFound { what: "scene", name: String::new() }), Code::NotFound);
        assert_eq!(of(ServiceError::AlreadyExists { what: "scene", name: String::new() }), Code::AlreadyExists);
        let refused = ServiceError::EditRefused { field: String::new(), problem: String::new() };
        assert_eq!(of(refused), Code::FailedPrecondition);
        let (expected, current) = (crate::scene::Revision(1), crate::scene::Revision(2));
        assert_eq!(of(ServiceError::RevisionMovedOn { expected, current }), Code::Aborted);
        assert_eq!(of(ServiceError::RevisionGone { asked: expected, oldest: current }), Code::OutOfRange);
        assert_eq!(of(ServiceError::HashMismatch { problem: String::new() }), Code::DataLoss);
        assert_eq!(of(ServiceError::ShuttingDown), Code::Unavailable);
        assert_eq!(of(ServiceError::Internal { incident: 1 }), Code::Internal);
    }
}
