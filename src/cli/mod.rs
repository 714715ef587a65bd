//! The commands: flags and files in, lines out.

mod backend;
#[cfg(feature = "grpc")]
mod bench;
mod case;
mod command;
mod daemon_flags;
#[cfg(feature = "grpc")]
mod demo;
mod exit_code;
#[cfg(feature = "grpc")]
mod folder;
mod json_field;
#[cfg(all(feature = "grpc", feature = "shared-memory"))]
mod own_name;
mod pairs;
mod robot_files;
mod sample;
mod scene_effects;
mod scene_file;
mod serve;
mod state_line;
mod states;
mod study;
mod touching;
mod words;

pub use case::{Case, read_line};
pub use command::run;
