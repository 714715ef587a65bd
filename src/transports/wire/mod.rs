//! The messages of `proto/clearance/v1`, as compiled by `build.rs`, and what they mean in plain structs.

/// Generated from `proto/clearance/v1`; the comments there say what everything means.
#[allow(missing_docs, clippy::all, clippy::wildcard_enum_match_arm, unused_qualifications)]
pub mod v1 {
    tonic::include_proto!("clearance.v1");
}

/// Descriptors of all messages and services, for the reflection service.
pub const DESCRIPTORS: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/clearance.descriptors"));
