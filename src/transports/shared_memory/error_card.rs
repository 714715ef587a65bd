//! What does an error look like to a program? A code, a reason and details by name, the same through every door
//! (`proto/clearance/v1/service.proto` lists them).

use crate::service::ServiceError;

/// An error as it leaves the house, beside its text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct ErrorCard {
    /// The number of the gRPC status.
    pub code: u8,
    /// A name of `ErrorReason` without its prefix.
    pub reason: &'static str,
    /// Keys without the prefix `clearance-`, and values.
    pub details: Vec<(&'static str, String)>,
}

impl ErrorCard {
    /// The card of an error.
    #[must_use]
    pub fn of(error: &ServiceError) -> Self {
        let (code, reason) = code_and_reason(error);
        Self { code, reason, details: details(error) }
    }
}

const INVALID_ARGUMENT: u8 = 3;
const DEADLINE_EXCEEDED: u8 = 4;
const NOT_FOUND: u8 = 5;
const ALREADY_EXISTS: u8 = 6;
const RESOURCE_EXHAUSTED: u8 = 8;
const FAILED_PRECONDITION: u8 = 9;
const ABORTED: u8 = 10;
const OUT_OF_RANGE: u8 = 11;
const INTERNAL: u8 = 13;
const UNAVAILABLE: u8 = 14;
const DATA_LOSS: u8 = 15;

fn code_and_reason(error: &ServiceError) -> (u8, &'static str) {
    match error {
        ServiceError::Invalid { .. } => (INVALID_ARGUMENT, "INVALID_FIELD"),
        ServiceError::NotFound { .. } => (NOT_FOUND, "NOT_FOUND"),
        ServiceError::AlreadyExists { .. } => (ALREADY_EXISTS, "ALREADY_EXISTS"),
        ServiceError::EditRefused { .. } => (FAILED_PRECONDITION, "EDIT_REFUSED"),
        ServiceError::KeyReused { .. } => (INVALID_ARGUMENT, "KEY_REUSED"),
        ServiceError::WrongEpoch { .. } => (FAILED_PRECONDITION, "WRONG_EPOCH"),
        ServiceError::RevisionMovedOn { .. } => (ABORTED, "REVISION_MOVED_ON"),
        ServiceError::RevisionGone { .. } => (OUT_OF_RANGE, "REVISION_GONE"),
        ServiceError::RevisionNotYet { .. } => (UNAVAILABLE, "REVISION_NOT_YET"),
        ServiceError::Limit(_) => (RESOURCE_EXHAUSTED, "LIMIT_EXCEEDED"),
        ServiceError::DeadlineExceeded => (DEADLINE_EXCEEDED, "DEADLINE_EXCEEDED"),
        ServiceError::HashMismatch { .. } => (DATA_LOSS, "HASH_MISMATCH"),
        ServiceError::ShuttingDown => (UNAVAILABLE, "SHUTTING_DOWN"),
        ServiceError::Internal { .. } => (INTERNAL, "INTERNAL"),
    }
}

fn details(error: &ServiceError) -> Vec<(&'static str, String)> {
    match error {
        ServiceError::Invalid { field, .. } | ServiceError::EditRefused { field, .. } => vec![("field", field.clone())],
        ServiceError::WrongEpoch { current, .. } => vec![("epoch", current.to_string())],
        ServiceError::RevisionMovedOn { current, .. } | ServiceError::RevisionNotYet { current, .. } => {
            vec![("revision", current.to_string())]
        }
        ServiceError::RevisionGone { oldest, .. } => vec![("oldest-revision", oldest.to_string())],
        ServiceError::Limit(exceeded) => vec![
            ("limit", exceeded.limit.to_owned()),
            ("asked", exceeded.asked.to_string()),
            ("allowed", exceeded.allowed.to_string()),
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

#[cfg(all(test, feature = "grpc"))]
mod tests {
    use super::*;
    use crate::limits::LimitExceeded;
    use crate::scene::{Epoch, Revision};
    use crate::transports::grpc::status_of;

    #[test]
    fn an_error_has_the_same_code_reason_and_details_as_through_grpc() {
        let (revision, text) = (Revision(4), || "x".to_owned());
        let errors = [
            ServiceError::invalid("items[3].pose", "is odd"),
            ServiceError::NotFound { what: "scene", name: text() },
            ServiceError::AlreadyExists { what: "scene", name: text() },
            ServiceError::EditRefused { field: text(), problem: text() },
            ServiceError::KeyReused { key: text() },
            ServiceError::WrongEpoch { asked: Epoch(1), current: Epoch(2) },
            ServiceError::RevisionMovedOn { expected: revision, current: Revision(5) },
            ServiceError::RevisionGone { asked: revision, oldest: Revision(5) },
            ServiceError::RevisionNotYet { asked: revision, current: Revision(3) },
            ServiceError::Limit(LimitExceeded { limit: "max_items", asked: 7, allowed: 5 }),
            ServiceError::DeadlineExceeded,
            ServiceError::HashMismatch { problem: text() },
            ServiceError::ShuttingDown,
            ServiceError::Internal { incident: 9 },
        ];
        for error in errors {
            let (card, status) = (ErrorCard::of(&error), status_of(&error));
            assert_eq!(i32::from(card.code), status.code() as i32, "{error}");
            let of = |key: &str| status.metadata().get(format!("clearance-{key}")).map(|value| value.to_str().unwrap());
            assert_eq!(of("reason"), Some(card.reason), "{error}");
            card.details.iter().for_each(|(key, value)| assert_eq!(of(key), Some(value.as_str()), "{error}"));
            assert_eq!(status.metadata().len(), 1 + card.details.len(), "{error}");
        }
    }
}
