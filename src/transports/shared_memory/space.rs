//! Is there room in /dev/shm, and does it stay ours? Writing to shared memory that has no page behind it ends a process
//! with SIGBUS, so pages are taken before anything is written, when lack of them is still an error.

use std::fs::{self, OpenOptions};
use std::io;
use std::path::Path;

use rustix::fs::{FallocateFlags, fallocate, statvfs};

/// Where POSIX shared memory is on Linux.
const FOLDER: &str = "/dev/shm";
/// Room that is left beside what is needed: for wake-ups and connections, bytes.
const BESIDE: u64 = 1 << 20;

/// Why there is no room.
#[derive(Debug, thiserror::Error)]
pub enum NoSpace {
    /// Too little is free.
    #[error(
        "/dev/shm has {free} bytes free, {needed} are needed; shared_memory limits or the size of /dev/shm can be changed"
    )]
    Full {
        /// What is needed, bytes.
        needed: u64,
        /// What is there, bytes.
        free: u64,
    },
    /// It cannot be asked or taken.
    #[error("/dev/shm: {0}")]
    System(#[from] io::Error),
}

/// # Errors
/// Less than `bytes` is free, or there is no /dev/shm.
pub(super) fn check(bytes: usize) -> Result<(), NoSpace> {
    let system = statvfs(FOLDER).map_err(io::Error::from)?;
    let (free, needed) = (system.f_bavail.saturating_mul(system.f_frsize), bytes as u64 + BESIDE);
    if free < needed { Err(NoSpace::Full { needed, free }) } else { Ok(()) }
}

/// Puts pages behind all data segments whose names begin with `prefix`. Those that have them already are not changed.
///
/// # Errors
/// There are not enough.
pub(super) fn take(prefix: &str) -> Result<(), NoSpace> {
    for file in fs::read_dir(FOLDER)? {
        let file = file?;
        let name = file.file_name();
        if name.to_str().is_some_and(|name| name.starts_with(prefix) && name.ends_with(".data")) {
            take_file(&file.path())?;
        }
    }
    Ok(())
}

fn take_file(path: &Path) -> Result<(), NoSpace> {
    // Another process may have taken its segment away since the folder was read.
    let file = match OpenOptions::new().read(true).write(true).open(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        opened => opened?,
    };
    let bytes = file.metadata()?.len();
    if bytes == 0 {
        return Ok(());
    }
    fallocate(&file, FallocateFlags::empty(), 0, bytes).map_err(|error| NoSpace::System(error.into()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_than_there_is_is_refused_with_both_numbers() {
        check(1).unwrap();
        let NoSpace::Full { needed, free } = check(usize::MAX >> 2).unwrap_err() else { panic!("not full") };
        assert!(free < needed);
    }
}
