//! Numbers on the wire: counts and indices, which are 32 bits wide, and columns of doubles.

use prost::bytes::Bytes;

/// The caps of the service keep every count far below the width of the wire.
pub(super) fn count(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}

/// A column of doubles, eight bytes each.
pub(super) fn little_endian(numbers: impl Iterator<Item = f64>) -> Bytes {
    // Number by number, as bytes one by one are several times as slow.
    let mut bytes = Vec::with_capacity(numbers.size_hint().0 * size_of::<f64>());
    numbers.for_each(|number| bytes.extend_from_slice(&number.to_le_bytes()));
    bytes.into()
}
