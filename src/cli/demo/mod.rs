//! `clearance demo`: a daemon, a real robot, real scenes, real questions, and what an edit changes.

mod report;
mod tour;

pub use tour::{Demo, run};
