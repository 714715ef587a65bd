//! What is measured?

use std::io::Write;

use super::super::exit_code::Failed;
use super::transports::{self, Transports};

/// Flags of `clearance bench`.
#[derive(clap::Args, Clone, Debug)]
pub struct Bench {
    #[command(subcommand)]
    what: What,
}

#[derive(clap::Subcommand, Clone, Debug)]
enum What {
    /// Each door against the same work in this process, and against its bare stack.
    Transports(Transports),
}

/// Measures, and writes a table.
///
/// # Errors
/// A door or stack that cannot be opened, or output that cannot be written.
pub fn run(bench: &Bench, output: &mut dyn Write) -> Result<(), Failed> {
    match &bench.what {
        What::Transports(flags) => transports::run(flags, output),
    }
}
