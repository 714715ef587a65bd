//! Counts and indices, which are 32 bits wide on the wire.

/// The caps of the service keep every count far below the width of the wire.
pub(super) fn count(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}
