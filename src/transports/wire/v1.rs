//! The messages of `proto/clearance/v1` as compiled by `build.rs`; the comments in those files say what everything
//! means.

#![allow(missing_docs, clippy::all, unused_qualifications)]

include!(concat!(env!("OUT_DIR"), "/clearance.v1.rs"));

/// Descriptors of all messages and services, for the reflection service.
pub const DESCRIPTORS: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/clearance.descriptors"));
