//! Queries on snapshots, in process: a robot with known truth, and bodies against brute force.

mod batches;
mod bodies;
mod casts;
mod edges;
mod motions;
mod ur5;
mod workload;
