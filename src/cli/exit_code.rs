//! How a command ends. `docs/operations.md` lists the same table.

use std::process::ExitCode;

/// Why a command ended, as the number its caller sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Exit {
    /// What was asked was done. Verdicts do not matter: a collision that was found is a success.
    Success = 0,
    /// It was begun and could not be finished: the text on stderr says why.
    Failure = 1,
    /// The flags make no sense together, or are not known (clap's own code).
    Usage = 2,
    /// A file that was named cannot be read, or does not hold what it should.
    Input = 3,
    /// The daemon asked with `--server` cannot be reached, or refused the request.
    Daemon = 4,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit as u8)
    }
}
