//! The contender over parry in single precision.

pub use parry3d as parry;

#[path = "contender.rs"]
pub mod contender;
