//! The doors: each turns what arrives into a call of [`crate::service`] and its answer into what leaves.

pub mod echo;
#[cfg(feature = "grpc")]
pub mod grpc;
#[cfg(any(feature = "grpc", feature = "shared-memory", feature = "zenoh"))]
pub mod requests;
#[cfg(feature = "shared-memory")]
pub mod shared_memory;
#[cfg(any(feature = "grpc", feature = "shared-memory", feature = "zenoh"))]
pub mod wire;
#[cfg(feature = "zenoh")]
pub mod zenoh;
