//! What makes a program a contender: it reads commands, makes passes over pairs, and times each pair (see `README.md`).

use std::hint::black_box;
use std::io::{self, BufRead, Write};

use crate::pairs::{PairSet, Pairs};
use crate::timer::{Timer, tick, ticks_per_nanosecond};

/// What a contender says of one pair: a signed distance, or 1 and 0 for touching or not; NaN when it has none.
pub struct Answer {
    pub value: f64,
    /// The proved interval, where there is one.
    pub bracket: Option<(f64, f64)>,
}

impl From<f64> for Answer {
    fn from(value: f64) -> Self {
        Self { value, bracket: None }
    }
}

/// A library under comparison.
pub trait Contender {
    /// The ways in which it can be asked this of the pairs of a set; none when it cannot.
    fn configs(&self, set: &PairSet, operation: &str) -> Vec<String>;

    /// Runs `pass` with whatever answers the question.
    fn ask(&mut self, set: &PairSet, operation: &str, config: &str, pass: &mut Pass);
}

/// Pairs at the end of a set that are asked about before a pass begins.
const WARMING: usize = 16;

/// One visit to each of the first `count` pairs of a set; goes out as four numbers a pair: ticks, answer, lower, upper.
pub struct Pass {
    count: usize,
    timer_cost: f64,
    bytes: Vec<u8>,
}

impl Pass {
    /// `ask(i)` answers about pair i of the set, with the clock running; `read` turns what it returned into numbers.
    #[inline(always)]
    pub fn run<T>(&mut self, mut ask: impl FnMut(usize) -> T, read: impl Fn(T) -> Answer) {
        self.bytes.reserve(32 * self.count);
        // Not counted: another program ran before, and the processor has to find its way again.
        for i in self.count - self.count.min(WARMING)..self.count {
            black_box(ask(i));
        }
        for i in 0..self.count {
            let start = tick();
            let answer = black_box(ask(i));
            let end = tick();
            let Answer { value, bracket } = read(answer);
            let (lower, upper) = bracket.unwrap_or((f64::NAN, f64::NAN));
            for number in [(end - start) as f64 - self.timer_cost, value, lower, upper] {
                self.bytes.extend_from_slice(&number.to_le_bytes());
            }
        }
    }
}

/// Answers the commands on standard input until it ends.
///
/// # Errors
/// An input that is no command, or an output that is closed.
pub fn serve(contender: &mut impl Contender, pairs: &Pairs) -> io::Result<()> {
    let timer = Timer::new();
    let mut out = io::stdout().lock();
    writeln!(out, "ready {:.9} {}", ticks_per_nanosecond(), timer.step)?;
    out.flush()?;
    for line in io::stdin().lock().lines() {
        let line = line?;
        let words: Vec<&str> = line.split_whitespace().collect();
        let unknown = || io::Error::other(format!("no such command: {line}"));
        let set = words.get(1).and_then(|name| pairs.sets.iter().find(|set| set.name == *name)).ok_or_else(unknown)?;
        match words.as_slice() {
            ["configs", _, operation] => writeln!(out, "{}", contender.configs(set, operation).join(" "))?,
            ["pass", _, operation, config, count] => {
                let count = count.parse::<usize>().map_err(|_| unknown())?.min(set.count);
                let mut pass = Pass { count, timer_cost: timer.cost, bytes: Vec::new() };
                contender.ask(set, operation, config, &mut pass);
                out.write_all(&pass.bytes)?;
            }
            _ => return Err(unknown()),
        }
        out.flush()?;
    }
    Ok(())
}
