//! Generated from `proto/clearance/v1`; the comments there say what everything means.

tonic::include_proto!("clearance.v1");
