//! The messages of `proto/clearance/v1`, and what they mean in plain structs.

pub mod v1;
