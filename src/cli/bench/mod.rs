//! `clearance bench`: figures that anyone can measure again.

mod asker;
mod doors;
mod flags;
mod placement;
mod report;
mod sampling;
mod throughput;
mod transports;
mod workload;

pub use flags::{Bench, run};
