//! The contender over parry's tree in double precision. There is a crate for each precision, so it is compiled twice.

pub use parry3d_f64 as parry;

#[path = "contender.rs"]
pub mod contender;
