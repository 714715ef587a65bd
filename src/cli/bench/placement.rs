//! Who runs where? While one question after the other is timed, the caller has a core of its own and the daemon the others:
//! else the scheduler puts both now on one core and now on two, and a wake-up costs 5 or 30 microseconds by chance.

use rustix::thread::{CpuSet, sched_getaffinity, sched_setaffinity};

use super::super::exit_code::Failed;

/// The cores of this process, shared out.
#[derive(Debug)]
pub(super) struct Placement {
    all: CpuSet,
    caller: CpuSet,
    daemon: CpuSet,
}

impl Placement {
    /// The first core for the caller; with one core alone nothing is shared out.
    pub fn new() -> Result<Self, Failed> {
        let all = sched_getaffinity(None).map_err(Failed::failure)?;
        let (mut caller, mut daemon) = (all, all);
        if let Some(first) = (0..CpuSet::MAX_CPU).find(|core| all.is_set(*core)).filter(|_| all.count() > 1) {
            caller.clear();
            caller.set(first);
            daemon.unset(first);
        }
        Ok(Self { all, caller, daemon })
    }

    /// From now on this thread, and those that it starts, run where the daemon does.
    pub fn as_daemon(&self) -> Result<(), Failed> {
        sched_setaffinity(None, &self.daemon).map_err(Failed::failure)
    }

    /// From now on this thread, and those that it starts, run where the caller does.
    pub fn as_caller(&self) -> Result<(), Failed> {
        sched_setaffinity(None, &self.caller).map_err(Failed::failure)
    }

    /// From now on this thread, and those that it starts, run anywhere.
    pub fn anywhere(&self) -> Result<(), Failed> {
        sched_setaffinity(None, &self.all).map_err(Failed::failure)
    }
}
