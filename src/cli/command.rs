//! Which command was asked for, and how did it end?

use std::io;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

#[cfg(feature = "grpc")]
use super::bench::{self, Bench};
#[cfg(feature = "grpc")]
use super::demo::{self, Demo};
use super::exit_code::Exit;
use super::pairs::{self, Pairs};
use super::serve::{self, Serve};
use super::states::{self, States};
use super::study::{self, StudyFlags};

/// How far apart, touching or not, which pair, where: collision and distance queries as proved brackets.
#[derive(Parser, Debug)]
#[command(name = "clearance", version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand, Debug)]
enum Command {
    /// What the doors cost, beside the bare stacks that they are made of.
    #[cfg(feature = "grpc")]
    Bench(Bench),
    /// A tour: a daemon, a robot arm in real scenes, real questions, and what an edit changes.
    #[cfg(feature = "grpc")]
    Demo(Demo),
    /// The distance of two shapes, case by case: JSON lines in, JSON lines out.
    Pairs(Pairs),
    /// The daemon: answers questions about scenes until it is told to end.
    Serve(Serve),
    /// A robot in a table of states: a verdict, a bracket and the nearest pair for each.
    States(States),
    /// What accuracy costs on this machine: a report with plots, and its numbers as CSV.
    Study(StudyFlags),
}

/// Reads the command line, does what it says, and returns how that ended.
#[must_use]
pub fn run() -> ExitCode {
    let mut output = io::stdout().lock();
    let ended = match Arguments::parse().command {
        #[cfg(feature = "grpc")]
        Command::Bench(arguments) => bench::run(&arguments, &mut output),
        #[cfg(feature = "grpc")]
        Command::Demo(arguments) => demo::run(&arguments, &mut output),
        Command::Pairs(arguments) => pairs::run(&arguments, &mut output),
        Command::Serve(arguments) => return serve::run(&arguments, &mut output).into(),
        Command::States(arguments) => states::run(&arguments, &mut output),
        Command::Study(arguments) => study::run(&arguments, &mut output),
    };
    let Err(failed) = ended else { return Exit::Success.into() };
    if failed.exit != Exit::Success {
        eprintln!("clearance: {}", failed.message);
    }
    failed.exit.into()
}
