//! Which command was asked for, and how did it end?

use std::io::{self, Write};
use std::process::ExitCode;

use clap::{Parser, Subcommand};

use super::exit_code::Exit;
use super::pairs::{self, Pairs};
use super::serve::{self, Serve};

/// How far apart, touching or not, which pair, where: collision and distance queries as proved brackets.
#[derive(Parser, Debug)]
#[command(name = "clearance", version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand, Debug)]
enum Command {
    /// The distance of two shapes, case by case: JSON lines in, JSON lines out.
    Pairs(Pairs),
    /// The daemon: answers questions about scenes until it is told to end.
    Serve(Serve),
}

/// Reads the command line, does what it says, and returns how that ended.
#[must_use]
pub fn run() -> ExitCode {
    let mut output = io::stdout().lock();
    let ended = match Arguments::parse().command {
        Command::Pairs(arguments) => pairs::run(&arguments, &mut output),
        Command::Serve(arguments) => return serve::run(&arguments, &mut output).into(),
    };
    let ended = ended.and_then(|()| output.flush());
    match ended {
        Ok(()) => Exit::Success.into(),
        // The reader has seen enough, as in `clearance pairs FILE | head`.
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Exit::Success.into(),
        Err(error) => {
            eprintln!("clearance: {error}");
            Exit::Input.into()
        }
    }
}
