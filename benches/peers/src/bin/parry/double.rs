//! The contender over parry in double precision. The crate is one for each precision, so the contender is compiled twice.

pub use parry3d_f64 as parry;

#[path = "contender.rs"]
pub mod contender;
