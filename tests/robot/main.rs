//! Robots and mesh files, from text and bytes to poses and shapes.

mod arm;
mod bad_input;
mod mesh_files;
mod pairs_and_groups;
mod random_trees;
mod ur5;
