//! The daemon from outside: every behaviour written once and run through every door, then what only a socket or a
//! process can show. Nothing here waits without a watchdog, and nothing asserts how fast an answer comes.

mod access;
mod conformance;
mod connections;
mod crowds;
mod faults;
mod histories;
mod process;
#[cfg(feature = "shared-memory")]
mod shared_memory;
#[cfg(all(feature = "shared-memory", feature = "zenoh"))]
mod soak;
mod streams;
mod support;
mod watching;
mod web;
#[cfg(feature = "zenoh")]
mod zenoh;
