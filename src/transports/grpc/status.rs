//! What does a caller see when a request fails? One status for each error, with the reason for programs in its metadata
//! (`proto/clearance/v1/service.proto` lists the keys).

use std::str::FromStr;

use tonic::metadata::{AsciiMetadataKey, MetadataMap};
use tonic::{Code, Status};

use crate::service::ServiceError;
use crate::transports::error_card::ErrorCard;

/// The status of an error.
#[must_use]
pub fn status_of(error: &ServiceError) -> Status {
    let card = ErrorCard::of(error);
    let mut metadata = MetadataMap::new();
    let mut put = |key: String, value: String| {
        // A name that is not ASCII has no place in metadata; the message has it.
        if let (Ok(key), Ok(value)) = (AsciiMetadataKey::from_str(&key), value.parse()) {
            metadata.insert(key, value);
        }
    };
    put("clearance-reason".to_owned(), card.reason.to_owned());
    for (key, value) in card.details {
        put(format!("clearance-{key}"), value);
    }
    Status::with_metadata(Code::from_i32(card.code.into()), error.to_string(), metadata)
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
