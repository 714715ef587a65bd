//! Doors to the daemon under test, and the messages that go through them.

pub mod certificates;
pub mod daemon;
pub mod door;
pub mod messages;
pub mod watchdog;
