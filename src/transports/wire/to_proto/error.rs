//! What does an error look like to a program? One table of codes, reasons and details, whatever door it leaves through
//! (`proto/clearance/v1/service.proto` lists them).

use crate::service::ServiceError;
use crate::transports::wire::v1;
use crate::transports::wire::v1::ErrorReason;

/// Numbers of gRPC's kinds of errors.
mod code {
    pub const INVALID_ARGUMENT: u8 = 3;
    pub const DEADLINE_EXCEEDED: u8 = 4;
    pub const NOT_FOUND: u8 = 5;
    pub const ALREADY_EXISTS: u8 = 6;
    pub const RESOURCE_EXHAUSTED: u8 = 8;
    pub const FAILED_PRECONDITION: u8 = 9;
    pub const ABORTED: u8 = 10;
    pub const OUT_OF_RANGE: u8 = 11;
    pub const INTERNAL: u8 = 13;
    pub const UNAVAILABLE: u8 = 14;
    pub const DATA_LOSS: u8 = 15;
}

/// An error as it leaves the house, beside its text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ErrorCard {
    /// The number of the gRPC status.
    pub code: u8,
    /// The reason for programs.
    pub reason: ErrorReason,
    /// What is known by name, for example `clearance-field`.
    pub details: Vec<(&'static str, String)>,
}

impl ErrorCard {
    /// The card of an error.
    #[must_use]
    pub fn of(error: &ServiceError) -> Self {
        let (code, reason) = code_and_reason(error);
        Self { code, reason, details: details(error) }
    }

    /// The reason's name, without its prefix.
    #[must_use]
    pub fn reason_name(&self) -> &'static str {
        reason_name(self.reason)
    }
}

/// The name of a reason as doors tell it: without the prefix that protobuf wants.
#[must_use]
pub fn reason_name(reason: ErrorReason) -> &'static str {
    let name = reason.as_str_name();
    name.strip_prefix("ERROR_REASON_").unwrap_or(name)
}

/// An error as a message of its own.
#[must_use]
pub fn query_error(error: &ServiceError) -> v1::QueryError {
    let ErrorCard { code, reason, details } = ErrorCard::of(error);
    let details = details.into_iter().map(|(key, value)| (key.to_owned(), value)).collect();
    v1::QueryError { code: code.into(), reason: reason.into(), message: error.to_string(), details }
}

fn code_and_reason(error: &ServiceError) -> (u8, ErrorReason) {
    match error {
        ServiceError::Invalid { .. } => (code::INVALID_ARGUMENT, ErrorReason::InvalidField),
        ServiceError::NotFound { .. } => (code::NOT_FOUND, ErrorReason::NotFound),
        ServiceError::AlreadyExists { .. } => (code::ALREADY_EXISTS, ErrorReason::AlreadyExists),
        ServiceError::EditRefused { .. } => (code::FAILED_PRECONDITION, ErrorReason::EditRefused),
        ServiceError::EffectNotDeclared { .. } => (code::FAILED_PRECONDITION, ErrorReason::EffectNotDeclared),
        ServiceError::EffectNotBuilt { .. } => (code::FAILED_PRECONDITION, ErrorReason::EffectNotBuilt),
        ServiceError::KeyReused { .. } => (code::INVALID_ARGUMENT, ErrorReason::KeyReused),
        ServiceError::WrongEpoch { .. } => (code::FAILED_PRECONDITION, ErrorReason::WrongEpoch),
        ServiceError::RevisionMovedOn { .. } => (code::ABORTED, ErrorReason::RevisionMovedOn),
        ServiceError::RevisionGone { .. } => (code::OUT_OF_RANGE, ErrorReason::RevisionGone),
        ServiceError::RevisionNotYet { .. } => (code::UNAVAILABLE, ErrorReason::RevisionNotYet),
        ServiceError::Limit(_) => (code::RESOURCE_EXHAUSTED, ErrorReason::LimitExceeded),
        ServiceError::DeadlineExceeded => (code::DEADLINE_EXCEEDED, ErrorReason::DeadlineExceeded),
        ServiceError::HashMismatch { .. } => (code::DATA_LOSS, ErrorReason::HashMismatch),
        ServiceError::ShuttingDown => (code::UNAVAILABLE, ErrorReason::ShuttingDown),
        ServiceError::Internal { .. } => (code::INTERNAL, ErrorReason::Internal),
    }
}

fn details(error: &ServiceError) -> Vec<(&'static str, String)> {
    match error {
        ServiceError::Invalid { field, .. } | ServiceError::EditRefused { field, .. } => {
            vec![("clearance-field", field.clone())]
        }
        ServiceError::EffectNotDeclared { effect, a, b } => vec![
            ("clearance-effect", effect.to_string()),
            ("clearance-a", a.to_string()),
            ("clearance-b", b.to_string()),
        ],
        ServiceError::EffectNotBuilt { field, effect } => {
            vec![("clearance-field", (*field).to_owned()), ("clearance-effect", (*effect).to_owned())]
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
        let told = query_error(&ServiceError::Limit(exceeded));
        assert_eq!((told.code, told.reason()), (8, ErrorReason::LimitExceeded));
        let of = |key: &str| told.details[key].as_str();
        assert_eq!((of("clearance-limit"), of("clearance-asked"), of("clearance-allowed")), ("max_items", "7", "5"));
    }

    #[test]
    fn reasons_are_told_without_the_prefix_of_protobuf() {
        let card = ErrorCard::of(&ServiceError::invalid("items[3].pose", "is odd"));
        assert_eq!((card.code, card.reason_name()), (3, "INVALID_FIELD"));
        assert_eq!(card.details, [("clearance-field", "items[3].pose".to_owned())]);
    }
}
