//! The doors: each turns what arrives into a call of [`crate::service`] and its answer into what leaves.

#[cfg(feature = "grpc")]
pub mod grpc;
#[cfg(feature = "grpc")]
pub mod requests;
#[cfg(feature = "shared-memory")]
pub mod shared_memory;
#[cfg(feature = "grpc")]
pub mod wire;
