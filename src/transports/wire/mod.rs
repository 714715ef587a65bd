//! The messages of `proto/clearance/v1`, and what they mean in plain structs.

#[cfg(test)]
pub(in crate::transports) mod descriptors;
pub mod from_proto;
pub mod to_proto;
pub mod v1;
