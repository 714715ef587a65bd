//! What was measured, as a table for people or as objects for programs, with the targets that it is held against.

use std::io::Write;

use serde_json::{Value, json};

use super::super::exit_code::Failed;
use super::sampling::Times;
use super::throughput::{ITEMS, Throughput};

/// One door with one number of items.
#[derive(Clone, Debug)]
pub(super) struct Row {
    /// The door.
    pub door: &'static str,
    /// Robot states of one question.
    pub items: usize,
    /// Bytes of a request.
    pub sent: usize,
    /// Bytes of an answer.
    pub came: usize,
    /// Through the door.
    pub through: Times,
    /// The same within the process.
    pub within: Times,
    /// The same bytes through the bare stack.
    pub bare: Times,
}

/// From so many items on, a door may cost this much of its bare stack.
const LARGE: usize = 1024;
const MOST_OVERHEAD: f64 = 1.2;
/// Below, it may cost the bare stack and the larger of a part of it and of a time, seconds.
const PART_BEYOND: f64 = 0.2;
const TIME_BEYOND: f64 = 5e-6;

impl Row {
    /// What the door takes beyond the work, seconds.
    fn beyond(&self) -> f64 {
        self.through.quantile(0.5) - self.within.quantile(0.5)
    }

    /// That as a multiple of the bare stack.
    fn overhead(&self) -> f64 {
        self.beyond() / self.bare.quantile(0.5)
    }

    /// How large the overhead may be.
    fn allowed(&self) -> f64 {
        let bare = self.bare.quantile(0.5);
        if self.items >= LARGE { MOST_OVERHEAD } else { 1.0 + PART_BEYOND.max(TIME_BEYOND / bare) }
    }
}

/// Where the figures go.
pub(super) struct Report<'a> {
    output: &'a mut dyn Write,
    json: bool,
}

/// Microseconds with as many digits as say something.
fn microseconds(seconds: f64) -> String {
    let microseconds = seconds * 1e6;
    if microseconds < 100.0 { format!("{microseconds:.1}") } else { format!("{microseconds:.0}") }
}

fn met(is_met: bool) -> &'static str {
    if is_met { "met" } else { "missed" }
}

impl<'a> Report<'a> {
    pub fn new(output: &'a mut dyn Write, json: bool) -> Self {
        Self { output, json }
    }

    fn say(&mut self, line: &str, object: &Value) -> Result<(), Failed> {
        let written = if self.json {
            if object.is_null() { Ok(()) } else { writeln!(self.output, "{object}") }
        } else {
            writeln!(self.output, "{line}")
        };
        written.and_then(|()| self.output.flush()).map_err(|error| Failed::output(&error))
    }

    pub fn begin(&mut self, threads: usize) -> Result<(), Failed> {
        let line = format!(
            "One question at a time, about states of a robot with one small shape; {threads} threads for questions. Microseconds, p50 / p99.\n\
             overhead = (p50 through the door - p50 within the process) / p50 of the same bytes through the bare stack\n\n\
             {:<18} {:>6} {:>9} {:>7} {:>19} {:>19} {:>17} {:>8} {:>7}",
            "door",
            "items",
            "sent",
            "came",
            "through the door",
            "within the process",
            "bare stack",
            "overhead",
            "target"
        );
        self.say(&line, &json!({"what": "begin", "threads": threads}))
    }

    pub fn row(&mut self, row: &Row) -> Result<(), Failed> {
        let pair =
            |times: &Times| format!("{} / {}", microseconds(times.quantile(0.5)), microseconds(times.quantile(0.99)));
        let (overhead, allowed) = (row.overhead(), row.allowed());
        let is_met = overhead <= allowed;
        let line = format!(
            "{:<18} {:>6} {:>9} {:>7} {:>19} {:>19} {:>17} {overhead:>8.2} {allowed:>7.2} {}",
            row.door,
            row.items,
            row.sent,
            row.came,
            pair(&row.through),
            pair(&row.within),
            pair(&row.bare),
            met(is_met)
        );
        let both =
            |times: &Times| json!({"p50": times.quantile(0.5), "p99": times.quantile(0.99), "samples": times.count()});
        let object = json!({
            "what": "door", "door": row.door, "items": row.items, "sent": row.sent, "came": row.came,
            "through": both(&row.through), "within": both(&row.within), "bare": both(&row.bare),
            "overhead": overhead, "target": allowed, "met": is_met,
        });
        self.say(&line, &object)
    }

    pub fn sockets(&mut self) -> Result<(), Failed> {
        let line = format!("\n{:<18} {:>6} {:>19} {:>19}", "bare sockets", "items", "TCP", "Unix socket");
        self.say(&line, &Value::Null)
    }

    pub fn socket(&mut self, items: usize, tcp: &Times, unix: &Times) -> Result<(), Failed> {
        let pair =
            |times: &Times| format!("{} / {}", microseconds(times.quantile(0.5)), microseconds(times.quantile(0.99)));
        let line = format!("{:<18} {items:>6} {:>19} {:>19}", "", pair(tcp), pair(unix));
        let both =
            |times: &Times| json!({"p50": times.quantile(0.5), "p99": times.quantile(0.99), "samples": times.count()});
        self.say(&line, &json!({"what": "sockets", "items": items, "tcp": both(tcp), "unix": both(unix)}))
    }

    pub fn throughput(&mut self, measured: &[Throughput]) -> Result<(), Failed> {
        let line = format!(
            "\nA planner's states of a UR5 before a shelf, always some batches of {ITEMS} under way\n{:<29} {:>17} {:>28}   target",
            "way", "states a second", "of that within the process"
        );
        self.say(&line, &Value::Null)?;
        let here = measured.first().map_or(f64::NAN, Throughput::median);
        for way in measured {
            let (median, part) = (way.median(), way.median() / here);
            let target = way.target.map_or(String::new(), |target| format!("{target:.1} {}", met(part >= target)));
            let line = format!("{:<29} {median:>17.0} {part:>28.2}   {target}", way.way);
            let object = json!({"what": "throughput", "way": way.way, "items": ITEMS, "per_second": median, "part": part, "target": way.target});
            self.say(&line, &object)?;
        }
        Ok(())
    }
}
