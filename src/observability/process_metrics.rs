//! What does the process take of the machine? Read from /proc at the moment of a scrape, under the names that all clients of
//! Prometheus give them.

use std::fmt;

use procfs::process::{LimitValue, Process, Stat};
use prometheus_client::collector::Collector;
use prometheus_client::encoding::DescriptorEncoder;

use super::exposition::Exposition;

/// Memory, time, files and threads of this process.
#[derive(Debug)]
pub(super) struct ProcessMetrics {
    started: Option<f64>,
}

impl ProcessMetrics {
    pub fn new() -> Self {
        // Seconds since 1970, worked out once: a clock that is set later changes nothing.
        let started = || {
            let ticks = Process::myself().and_then(|own| own.stat()).ok()?.starttime;
            let boot = procfs::boot_time_secs().ok()?;
            Some(boot as f64 + seconds(ticks))
        };
        Self { started: started() }
    }
}

fn seconds(ticks: u64) -> f64 {
    ticks as f64 / procfs::ticks_per_second() as f64
}

impl Collector for ProcessMetrics {
    fn encode(&self, encoder: DescriptorEncoder) -> fmt::Result {
        let mut out = Exposition::new(encoder);
        if let Some(started) = self.started {
            out.gauge("process_start_time_seconds", "When the process started, since 1970", started)?;
        }
        // Where /proc cannot be read there is nothing to tell.
        let Ok(own) = Process::myself() else { return Ok(()) };
        if let Ok(stat) = own.stat() {
            of_stat(&mut out, &stat)?;
        }
        if let Ok(files) = own.fd_count() {
            out.gauge("process_open_fds", "Open files", files as f64)?;
        }
        if let Ok(limits) = own.limits() {
            let most = match limits.max_open_files.soft_limit {
                LimitValue::Unlimited => f64::INFINITY,
                LimitValue::Value(most) => most as f64,
            };
            out.gauge("process_max_fds", "Files that may be open", most)?;
        }
        Ok(())
    }
}

fn of_stat(out: &mut Exposition<'_>, stat: &Stat) -> fmt::Result {
    let resident = stat.rss.saturating_mul(procfs::page_size());
    out.gauge("process_resident_memory_bytes", "Memory that is in use", resident as f64)?;
    out.gauge("process_virtual_memory_bytes", "Memory that is mapped", stat.vsize as f64)?;
    out.gauge("process_threads", "Threads", stat.num_threads as f64)?;
    let busy = seconds(stat.utime.saturating_add(stat.stime));
    out.counter("process_cpu_seconds", "Time that processors worked for the process", busy)
}
