//! A name of shared memory for the time of one command. Memory of a name stays after its last process is gone until somebody uses
//! the name again, and nobody will: what the command leaves goes with it, and what commands left that were killed goes when
//! the next one begins.

use std::fs;
use std::path::Path;

/// Where names of shared memory are files.
const SHARED_MEMORY: &str = "/dev/shm";

/// It, and names that begin with it, are of this process.
#[derive(Debug)]
pub struct OwnName(String);

impl OwnName {
    /// A name that says what it is for, in small letters.
    #[must_use]
    pub fn new(what: &str) -> Self {
        let lives = |process: &str| Path::new("/proc").join(process).exists();
        remove(|file| owner(file, what).is_some_and(|process| !lives(process)));
        Self(format!("{what}-{}", std::process::id()))
    }

    /// The name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.0
    }

    /// Another name, for a part of it.
    #[must_use]
    pub fn of(&self, part: &str) -> String {
        format!("{}-{part}", self.0)
    }
}

impl Drop for OwnName {
    fn drop(&mut self) {
        let own = &self.0;
        remove(|file| file.strip_prefix(own.as_str()).is_some_and(|rest| rest.starts_with(['.', '-'])));
    }
}

/// Whose file it is, if it is one of such a name.
fn owner<'f>(file: &'f str, what: &str) -> Option<&'f str> {
    let rest = file.strip_prefix(what)?.strip_prefix('-')?;
    let (process, _) = rest.split_once(['.', '-'])?;
    process.bytes().all(|byte| byte.is_ascii_digit()).then_some(process)
}

fn remove(goes: impl Fn(&str) -> bool) {
    for file in fs::read_dir(SHARED_MEMORY).into_iter().flatten().flatten() {
        if file.file_name().to_str().is_some_and(&goes) {
            // Somebody else may have been quicker, and another user's is not ours to remove.
            _ = fs::remove_file(file.path());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whose_a_file_is_stands_in_its_name() {
        assert_eq!(owner("bench-17.data", "bench"), Some("17"));
        assert_eq!(owner("bench-17-echo.data", "bench"), Some("17"));
        for other in ["bench-x.data", "bench.17", "demo-17.data", "bench-17", "clearance.data"] {
            assert_eq!(owner(other, "bench"), None, "{other}");
        }
    }

    #[test]
    fn memory_of_a_command_goes_with_it_and_that_of_a_dead_one_with_the_next() {
        let file = |name: String| Path::new(SHARED_MEMORY).join(name);
        let what = "own-name-test";
        // Process numbers end at 2^22.
        let (dead, alive) = (file(format!("{what}-99999999.data")), file(format!("{what}-1.data")));
        fs::write(&dead, "").unwrap();
        fs::write(&alive, "").unwrap();
        let name = OwnName::new(what);
        let own = [file(format!("{}.data", name.name())), file(format!("{}.data", name.of("echo")))];
        own.iter().for_each(|own| fs::write(own, "").unwrap());
        assert!(!dead.exists() && alive.exists() && own.iter().all(|own| own.exists()));
        drop(name);
        assert!(alive.exists() && own.iter().all(|own| !own.exists()));
        fs::remove_file(alive).unwrap();
    }
}
