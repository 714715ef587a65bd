//! A folder for what a command leaves behind while it runs: sockets, and the place where shared memory is found.

use std::fs;
use std::path::{Path, PathBuf};

use super::exit_code::Failed;

/// It goes with its owner.
#[derive(Debug)]
pub struct Folder(PathBuf);

impl Folder {
    /// An empty one, for this process alone.
    ///
    /// # Errors
    /// The system gives none.
    pub fn new() -> Result<Self, Failed> {
        let path = std::env::temp_dir().join(format!("clearance-{}", std::process::id()));
        fs::create_dir_all(&path).map_err(Failed::failure)?;
        Ok(Self(path))
    }

    /// Where it is.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.0
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // What is left of it is in the system's folder for such things.
        _ = fs::remove_dir_all(&self.0);
    }
}
