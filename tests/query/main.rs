//! Queries on snapshots, in process: a robot with known truth, and bodies against brute force.

mod batches;
mod bodies;
mod clearance;
mod edges;
mod motions;
mod random_motions;
mod ur5;
mod workload;
