//! How long does the caller listen? The `grpc-timeout` of a call, kept by us so that it ends in DEADLINE_EXCEEDED.

use std::time::Duration;

use tonic::metadata::MetadataMap;

use crate::service::ServiceError;

/// The call's timeout, if it has one: up to eight digits and a unit (H, M, S, m, u, n).
///
/// # Errors
/// A header that is not of that form.
pub(super) fn grpc_timeout(metadata: &MetadataMap) -> Result<Option<Duration>, ServiceError> {
    let Some(value) = metadata.get("grpc-timeout") else { return Ok(None) };
    let parsed = value.to_str().ok().and_then(parse);
    parsed.map(Some).ok_or_else(|| ServiceError::invalid("grpc-timeout", "is not digits and a unit"))
}

fn parse(text: &str) -> Option<Duration> {
    let unit = text.chars().last().filter(char::is_ascii)?;
    let digits = &text[..text.len() - 1];
    if digits.is_empty() || digits.len() > 8 || !digits.bytes().all(|digit| digit.is_ascii_digit()) {
        return None;
    }
    let number: u64 = digits.parse().ok()?;
    match unit {
        'H' => Some(Duration::from_secs(3600 * number)),
        'M' => Some(Duration::from_secs(60 * number)),
        'S' => Some(Duration::from_secs(number)),
        'm' => Some(Duration::from_millis(number)),
        'u' => Some(Duration::from_micros(number)),
        'n' => Some(Duration::from_nanos(number)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_forms_of_the_specification_are_read_and_others_refused() {
        assert_eq!(parse("99999999H"), Some(Duration::from_secs(99_999_999 * 3600)));
        assert_eq!(parse("250m"), Some(Duration::from_millis(250)));
        assert_eq!(parse("7u"), Some(Duration::from_micros(7)));
        for bad in ["", "m", "100", "-1S", "+1S", "123456789m", "1.5S", "1S ", "1é"] {
            assert_eq!(parse(bad), None, "{bad:?}");
        }
    }
}
