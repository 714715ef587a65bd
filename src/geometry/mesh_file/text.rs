//! Bytes as text, words as numbers.

use super::MeshFileError;

/// The text without its byte-order mark.
pub(super) fn utf8(bytes: &[u8]) -> Result<&str, MeshFileError> {
    let text = std::str::from_utf8(bytes).map_err(|e| MeshFileError::NotText { position: e.valid_up_to() })?;
    Ok(text.strip_prefix('\u{feff}').unwrap_or(text))
}

/// The number nearest to what a word says.
pub(super) fn finite_number(word: &str, place: impl Fn() -> String) -> Result<f64, MeshFileError> {
    let number = word.parse::<f64>().ok().filter(|x| x.is_finite());
    number.ok_or_else(|| MeshFileError::BadNumber { place: place(), text: word.to_owned() })
}
