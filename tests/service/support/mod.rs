//! Doors to the daemon under test, and the messages that go through them.

#[cfg(any(feature = "shared-memory", feature = "zenoh"))]
pub mod by_name;
pub mod certificates;
pub mod daemon;
pub mod door;
pub mod messages;
pub mod network;
#[cfg(feature = "shared-memory")]
pub mod shared_memory_door;
pub mod watchdog;
#[cfg(feature = "zenoh")]
pub mod zenoh_door;
