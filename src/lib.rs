//! `clearance`: how far apart, touching or not, which pair, where, and since when is that true.

pub mod app;
pub mod broad_phase;
pub mod cli;
pub mod geometry;
pub mod limits;
pub mod narrow_phase;
pub mod observability;
pub mod query;
pub mod robot;
pub mod scene;
pub mod service;
pub mod study;
pub mod transports;
