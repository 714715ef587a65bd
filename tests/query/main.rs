//! Queries on snapshots, in process: a robot with known truth, and bodies against brute force.

mod batches;
mod bodies;
mod casts;
mod changed_since;
mod clearance;
mod contacts;
mod derivatives;
mod edges;
mod effects;
mod effects_random;
mod left_out;
mod motions;
mod moving_scene;
mod overlays;
mod patches;
mod random_motions;
mod ur5;
mod workload;
