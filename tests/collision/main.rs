//! The narrow phase against closed forms, against itself turned around, and against slower ways to the same answer.

mod closed_forms;
mod extremes;
mod samples;
mod sweep;
mod symmetry;
mod unions;
