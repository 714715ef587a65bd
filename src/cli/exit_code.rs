//! How a command ends. `docs/operations.md` lists the same table.

use std::io;
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

/// A command that ended before it was done.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failed {
    /// What the caller of the program sees.
    pub exit: Exit,
    /// What a person sees.
    pub message: String,
}

impl Failed {
    /// It could not be finished.
    #[must_use]
    pub fn failure(message: impl ToString) -> Self {
        Self { exit: Exit::Failure, message: message.to_string() }
    }

    /// A file is not what it should be.
    #[must_use]
    pub fn input(message: impl ToString) -> Self {
        Self { exit: Exit::Input, message: message.to_string() }
    }

    /// The daemon is not there, or refused.
    #[must_use]
    pub fn daemon(message: impl ToString) -> Self {
        Self { exit: Exit::Daemon, message: message.to_string() }
    }

    /// Output that could not be written. A reader that has seen enough, as in `clearance pairs FILE | head`, is fine.
    #[must_use]
    pub fn output(error: &io::Error) -> Self {
        let exit = if error.kind() == io::ErrorKind::BrokenPipe { Exit::Success } else { Exit::Failure };
        Self { exit, message: format!("output: {error}") }
    }
}
