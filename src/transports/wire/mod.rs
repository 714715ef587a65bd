//! The messages of `proto/clearance/v1`, as compiled by `build.rs`, and what they mean in plain structs.

mod descriptors;
#[allow(missing_docs, clippy::all, clippy::wildcard_enum_match_arm, unused_qualifications)]
pub mod v1;

pub use descriptors::DESCRIPTORS;
