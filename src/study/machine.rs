//! On what was it measured: processor, system, versions, and the command.

use std::fs;
use std::time::{SystemTime, UNIX_EPOCH};

use super::race;
use super::table::{Table, number};

/// What stands at the head of a report.
#[derive(Clone, Debug)]
pub(super) struct Machine {
    /// Name and value.
    pub facts: Vec<(&'static str, String)>,
}

/// Crates whose versions bear on figures.
const CRATES: [&str; 5] = ["nalgebra", "parry3d-f64", "clarabel", "dashu-int", "wide"];

impl Machine {
    pub fn here(command: &str) -> Self {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let first_line =
            |path: &str| fs::read_to_string(path).ok().and_then(|text| text.lines().next().map(str::to_owned));
        let unknown = || "not told by the system".to_owned();
        let build = if cfg!(debug_assertions) { "with debug assertions: times mean little" } else { "optimised" };
        let load = first_line("/proc/loadavg");
        let load = load.map_or_else(unknown, |line| line.split(' ').take(3).collect::<Vec<_>>().join(" "));
        let (clock, spread) = race::noise();
        let facts = vec![
            ("date", date()),
            ("command", command.to_owned()),
            ("clearance", env!("CARGO_PKG_VERSION").to_owned()),
            ("build", format!("{build}, for {}-{}", std::env::consts::ARCH, std::env::consts::OS)),
            ("crates", versions()),
            ("processor", processor().unwrap_or_else(unknown)),
            ("cores", cores.to_string()),
            ("instruction sets", instruction_sets()),
            ("system", first_line("/proc/sys/kernel/osrelease").map_or_else(unknown, |line| format!("Linux {line}"))),
            ("load before", load),
            (
                "noise",
                format!(
                    "clock {} ns in a block of 64; equal rounds differ by {:.1} %",
                    number(64e9 * clock),
                    100.0 * spread
                ),
            ),
        ];
        Self { facts }
    }

    pub fn table(&self) -> Table {
        let mut table = Table::new("machine", &["what", "value"]);
        self.facts.iter().for_each(|(name, value)| table.push(vec![(*name).to_owned(), value.clone()]));
        table
    }
}

fn processor() -> Option<String> {
    let text = fs::read_to_string("/proc/cpuinfo").ok()?;
    let line = text.lines().find(|line| line.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim().to_owned())
}

#[cfg(target_arch = "x86_64")]
fn instruction_sets() -> String {
    let sets = [
        ("AVX2", std::arch::is_x86_feature_detected!("avx2")),
        ("FMA", std::arch::is_x86_feature_detected!("fma")),
        ("AVX-512F", std::arch::is_x86_feature_detected!("avx512f")),
    ];
    let names: Vec<&str> = sets.into_iter().filter_map(|(name, there)| there.then_some(name)).collect();
    if names.is_empty() { "none beyond the baseline".to_owned() } else { names.join(", ") }
}

#[cfg(not(target_arch = "x86_64"))]
fn instruction_sets() -> String {
    "the target's own".to_owned()
}

/// From the lock file this program was built with.
fn versions() -> String {
    let lock = include_str!("../../Cargo.lock");
    let version = |name: &&str| {
        let after = lock.split(&format!("name = \"{name}\"\nversion = \"")).nth(1)?;
        Some(format!("{name} {}", after.split('"').next()?))
    };
    CRATES.iter().filter_map(version).collect::<Vec<_>>().join(", ")
}

/// UTC, by the civil calendar (Hinnant's algorithm).
fn date() -> String {
    let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
    let (year, month, day) = civil((seconds / 86_400) as i64);
    format!("{year:04}-{month:02}-{day:02} {:02}:{:02} UTC", seconds / 3600 % 24, seconds / 60 % 60)
}

fn civil(days: i64) -> (i64, i64, i64) {
    let shifted = days + 719_468;
    let era = shifted.div_euclid(146_097);
    let of_era = shifted.rem_euclid(146_097);
    let year_of_era = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month_from_march = (5 * of_year + 2) / 153;
    let day = of_year - (153 * month_from_march + 2) / 5 + 1;
    let month = if month_from_march < 10 { month_from_march + 3 } else { month_from_march - 9 };
    (year_of_era + era * 400 + i64::from(month <= 2), month, day)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_are_dates() {
        assert_eq!([0, 11_016, 20_787].map(civil), [(1970, 1, 1), (2000, 2, 29), (2026, 11, 30)]);
    }

    #[test]
    fn every_named_crate_is_in_the_lock_file() {
        assert_eq!(versions().matches(", ").count() + 1, CRATES.len());
    }
}
