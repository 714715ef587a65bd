//! The commands: flags and files in, lines out.

mod case;
mod command;
mod exit_code;
mod json_field;
mod pairs;
mod serve;
mod words;

pub use command::run;
