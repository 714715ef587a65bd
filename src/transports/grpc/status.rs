//! What does a caller see when a request fails? One status for each error, with the reason for programs in its metadata
//! (`proto/clearance/v1/service.proto` lists the keys).

use tonic::metadata::MetadataMap;
use tonic::{Code, Status};

use crate::service::ServiceError;
use crate::transports::wire::v1::ErrorReason;

/// The status of an error.
#[must_use]
pub fn status_of(error: &ServiceError) -> Status {
    let (code, reason) = code_of(error);
    let name = reason.as_str_name();
    let mut metadata = MetadataMap::new();
    let mut put = |key: &'static str, value: String| {
        // A name that is not ASCII has no place in metadata; the message has it.
        if let Ok(value) = value.parse() {
            metadata.insert(key, value);
        }
    };
    put("clearance-reason", name.strip_prefix("ERROR_REASON_").unwrap_or(name).to_owned());
    for (key, value) in details_of(error) {
        put(key, value);
    }
    Status::with_metadata(code, error.to_string(), metadata)
}

fn code_of(error: &ServiceError) -> (Code, ErrorReason) {
    match error {
        ServiceError::Invalid { .. } => (Code::InvalidArgument, ErrorReason::InvalidField),
        ServiceError::NotFound { .. } => (Code::NotFound, ErrorReason::NotFound),
        ServiceError::AlreadyExists { .. } => (Code::AlreadyExists, ErrorReason::AlreadyExists),
        ServiceError::EditRefused { .. } => (Code::FailedPrecondition, ErrorReason::EditRefused),
        ServiceError::KeyReused { .. } => (Code::InvalidArgument, ErrorReason::KeyReused),
        ServiceError::WrongEpoch { .. } => (Code::FailedPrecondition, ErrorReason::WrongEpoch),
        ServiceError::RevisionMovedOn { .. } => (Code::Aborted, ErrorReason::RevisionMovedOn),
        ServiceError::RevisionGone { .. } => (Code::OutOfRange, ErrorReason::RevisionGone),
        ServiceError::RevisionNotYet { .. } => (Code::Unavailable, ErrorReason::RevisionNotYet),
        ServiceError::Limit(_) => (Code::ResourceExhausted, ErrorReason::LimitExceeded),
        ServiceError::DeadlineExceeded => (Code::DeadlineExceeded, ErrorReason::DeadlineExceeded),
        ServiceError::HashMismatch { .. } => (Code::DataLoss, ErrorReason::HashMismatch),
        ServiceError::ShuttingDown => (Code::Unavailable, ErrorReason::ShuttingDown),
        ServiceError::Internal { .. } => (Code::Internal, ErrorReason::Internal),
    }
}

fn details_of(error: &ServiceError) -> Vec<(&'static str, String)> {
    match error {
        ServiceError::Invalid { field, .. } | ServiceError::EditRefused { field, .. } => {
            vec![("clearance-field", field.clone())]
        }
        ServiceError::WrongEpoch { current, .. } => vec![("clearance-epoch", current.to_string())],
        ServiceError::RevisionMovedOn { current, .. } | ServiceError::RevisionNotYet { current, .. } => {
            vec![("clearance-revision", current.to_string())]
        }
        ServiceError::RevisionGone { oldest, .. } => vec![("clearance-oldest-revision", oldest.to_string())],
        ServiceError::Limit(exceeded) => vec![
            ("clearance-limit", exceeded.limit.to_owned()),
            ("clearance-asked", exceeded.asked.to_string()),
            ("clearance-allowed", exceeded.allowed.to_string()),
        ],
        ServiceError::NotFound { .. }
        | ServiceError::AlreadyExists { .. }
        | ServiceError::KeyReused { .. }
        | ServiceError::DeadlineExceeded
        | ServiceError::HashMismatch { .. }
        | ServiceError::ShuttingDown
        | ServiceError::Internal { .. } => Vec::new(),
    }
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
}
