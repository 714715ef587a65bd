//! What the reflection service tells callers about the messages.

/// Descriptors of all messages and services of `proto/clearance/v1`.
pub const DESCRIPTORS: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/clearance.descriptors"));
