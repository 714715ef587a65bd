//! The contender over parry's tree in single precision.

pub use parry3d as parry;

#[path = "contender.rs"]
pub mod contender;
