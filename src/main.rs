//! The command line; `clearance --help` lists the commands.

use std::process::ExitCode;

fn main() -> ExitCode {
    clearance::cli::run()
}
