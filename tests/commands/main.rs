//! The commands that answer from the library, run as a user runs them, on data with known truth.

#[cfg(feature = "grpc")]
mod bench;
#[cfg(feature = "grpc")]
mod demo;
mod hard_cases;
mod robot_states;
#[cfg(feature = "grpc")]
mod states_from_a_daemon;

use std::ffi::OsStr;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

use serde_json::Value;

/// A file of `tests/data`.
fn data(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)
}

/// Runs `clearance` with nothing on its standard input.
fn clearance<S: AsRef<OsStr>>(arguments: &[S]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_clearance")).args(arguments).stdin(Stdio::null()).output().unwrap()
}

fn json_lines(text: &[u8]) -> Vec<Value> {
    let text = std::str::from_utf8(text).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap_or_else(|e| panic!("{e}: {line}"))).collect()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("not a number: {value}"))
}
