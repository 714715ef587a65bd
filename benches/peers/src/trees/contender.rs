//! What makes a program a contender over trees: it keeps them, changes and asks them when told to, and takes the time.

use std::collections::HashMap;
use std::hint::black_box;
use std::io::{self, BufRead, Write};
use std::path::Path;

use super::boxes::{BoxRecord, Boxes, RayRecord};
use super::memory::held;
use crate::timer::{Timer, tick, ticks_per_nanosecond};

/// A library under comparison. Boxes and rays are converted before the clock starts.
pub trait Trees {
    /// A box as the library has it.
    type Bounds: Copy;
    type Ray;
    /// A tree with whatever a user of the library keeps beside it, so as to change it.
    type Tree;

    /// The ways in which this is done with so many boxes; none when it cannot be done.
    fn configs(operation: &str, boxes: usize) -> &'static [&'static str];

    fn bounds(record: &BoxRecord) -> Self::Bounds;

    fn ray(record: &RayRecord) -> Self::Ray;

    /// A tree of the boxes, which are known by their indices.
    fn build(config: &str, boxes: &[Self::Bounds]) -> Self::Tree;

    /// Makes the tree ready for questions about boxes some of which have moved; none moves twice.
    fn apply(config: &str, tree: &mut Self::Tree, moves: &[(u32, Self::Bounds)]);

    /// Visits every pair of boxes that overlap once.
    fn pairs(tree: &mut Self::Tree, boxes: &[Self::Bounds], visit: impl FnMut(u32, u32));

    /// How many boxes overlap this one.
    fn query(tree: &Self::Tree, query: &Self::Bounds) -> usize;

    /// Distance along the ray to the first box, metres; infinite where none is hit.
    fn first_hit(tree: &Self::Tree, boxes: &[Self::Bounds], ray: &Self::Ray) -> f64;

    /// Makes a version of the tree in which one box has moved while the version before can still be read, and only then
    /// drops that.
    fn publish(config: &str, tree: &mut Self::Tree, index: u32, bounds: Self::Bounds);
}

/// A tree that has taken part in moves.
struct Kept<T> {
    tree: T,
    /// After which frames its boxes are where they are.
    frames: u64,
    /// Bytes: when it was built, and now.
    built: usize,
    bytes: usize,
}

/// Queries at the end of their list that are asked before a pass begins.
const WARMING: usize = 16;

struct Session<T: Trees> {
    data: Boxes,
    boxes: Vec<T::Bounds>,
    /// The boxes before the frames that were read last.
    before: Vec<T::Bounds>,
    /// The frames that were read last: index and new box of all that move.
    frames: Vec<Vec<(u32, T::Bounds)>>,
    /// How often frames were read.
    read: u64,
    kept: HashMap<String, Kept<T::Tree>>,
    timer: Timer,
}

/// Ticks and answer.
type Sample = (f64, f64);

impl<T: Trees> Session<T> {
    fn open(path: &str) -> io::Result<Self> {
        let data = Boxes::open(Path::new(path))?;
        let boxes: Vec<T::Bounds> = data.boxes.iter().map(T::bounds).collect();
        let before = boxes.clone();
        Ok(Self { data, boxes, before, frames: Vec::new(), read: 0, kept: HashMap::new(), timer: Timer::new() })
    }

    /// Reads frames for the next passes of `moves`; every tree is behind until its pass.
    fn read_frames(&mut self, percent: u32, first: u64, count: u64) -> io::Result<()> {
        self.before.clone_from(&self.boxes);
        self.frames.clear();
        for index in first..first + count {
            let mut frame = Vec::new();
            for one in self.data.frame(percent, index)? {
                let record = &mut self.data.boxes[one.index as usize];
                for (axis, by) in one.by.into_iter().enumerate() {
                    record[axis] += f64::from(by);
                    record[axis + 3] += f64::from(by);
                }
                let bounds = T::bounds(record);
                self.boxes[one.index as usize] = bounds;
                frame.push((one.index, bounds));
            }
            self.frames.push(frame);
        }
        self.read += 1;
        Ok(())
    }

    /// The tree of that configuration, of the boxes as they are after so many readings of frames (now or one less): as
    /// its moves have left it, or built anew where it took no part in the last.
    fn kept(&mut self, config: &str, read: u64) -> Kept<T::Tree> {
        if let Some(kept) = self.kept.remove(config).filter(|kept| kept.frames == read) {
            return kept;
        }
        let boxes = if read == self.read { &self.boxes } else { &self.before };
        let start = held();
        let tree = T::build(config, boxes);
        let built = held() - start;
        Kept { tree, frames: read, built, bytes: built }
    }

    fn time<R>(&self, ask: impl FnOnce() -> R, answer: impl FnOnce(R) -> f64) -> Sample {
        let start = tick();
        let result = black_box(ask());
        let end = tick();
        ((end - start) as f64 - self.timer.cost, answer(result))
    }

    fn pass(&mut self, operation: &str, config: &str, count: usize) -> io::Result<Vec<Sample>> {
        if operation == "build" {
            return Ok((0..count).map(|_| self.time(|| T::build(config, &self.boxes), |_| 0.0)).collect());
        }
        let behind = u64::from(operation == "moves");
        let mut kept = self.kept(config, self.read - behind);
        let start = held();
        let tree = &mut kept.tree;
        let mut samples = Vec::new();
        match operation {
            "moves" => {
                for frame in &self.frames {
                    samples.push(self.time(|| T::apply(config, tree, frame), |()| frame.len() as f64));
                }
            }
            "pairs" => {
                for _ in 0..count {
                    let mut found = 0_u64;
                    samples.push(self.time(|| T::pairs(tree, &self.boxes, |_, _| found += 1), |()| 0.0));
                    samples.last_mut().expect("there is one").1 = found as f64;
                }
            }
            "pair_sum" => {
                let mut sum = 0_u64;
                T::pairs(tree, &self.boxes, |a, b| sum = sum.wrapping_add(mixed(a.min(b), a.max(b))));
                samples.push((0.0, (sum >> 12) as f64));
            }
            "query" => {
                let queries: Vec<T::Bounds> = self.data.queries.iter().take(count).map(T::bounds).collect();
                for query in queries.iter().rev().take(WARMING).chain(&queries) {
                    samples.push(self.time(|| T::query(tree, query), |found| found as f64));
                }
                samples.drain(..WARMING.min(queries.len()));
            }
            "ray" => {
                let rays: Vec<T::Ray> = self.data.rays.iter().take(count).map(T::ray).collect();
                for ray in rays.iter().rev().take(WARMING).chain(&rays) {
                    samples.push(self.time(|| T::first_hit(tree, &self.boxes, ray), |distance| distance));
                }
                samples.drain(..WARMING.min(rays.len()));
            }
            "publish" => {
                for step in 0..count {
                    // Bodies all over the scene, a metre along x and back again.
                    let index = step.wrapping_mul(0x9E37_79B1) % self.boxes.len();
                    let mut record = self.data.boxes[index];
                    record[0] += 1.0;
                    record[3] += 1.0;
                    let (there, back, index) = (T::bounds(&record), self.boxes[index], index as u32);
                    samples.push(self.time(|| T::publish(config, tree, index, there), |()| 1.0));
                    T::publish(config, tree, index, back);
                }
            }
            _ => return Err(io::Error::other(format!("no such operation: {operation}"))),
        }
        let own = samples.capacity() * size_of::<Sample>();
        if operation == "moves" {
            kept.bytes = (kept.bytes + held()).saturating_sub(start + own);
            kept.frames = self.read;
        }
        self.kept.insert(config.to_owned(), kept);
        Ok(samples)
    }
}

/// A number for a pair, so that sums of them tell sets of pairs apart (the finaliser of `SplitMix64`: Steele, Lea, Flood,
/// "Fast splittable pseudorandom number generators", 2014).
fn mixed(low: u32, high: u32) -> u64 {
    let mut x = u64::from(low) << 32 | u64::from(high);
    x = (x ^ x >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    x = (x ^ x >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
    x ^ x >> 31
}

/// Answers the commands on standard input until it ends.
///
/// # Errors
/// An input that is no command, a file that cannot be read, or an output that is closed.
pub fn serve<T: Trees>() -> io::Result<()> {
    let mut out = io::stdout().lock();
    writeln!(out, "ready {:.9} {}", ticks_per_nanosecond(), Timer::new().step)?;
    out.flush()?;
    let mut session: Option<Session<T>> = None;
    for line in io::stdin().lock().lines() {
        let line = line?;
        let unknown = || io::Error::other(format!("no such command: {line}"));
        let words: Vec<&str> = line.split_whitespace().collect();
        if let ["open", path] = words.as_slice() {
            session = None; // the memory of the one before is free before the next is read
            let opened = session.insert(Session::open(path)?);
            writeln!(out, "opened {}", opened.boxes.len())?;
            out.flush()?;
            continue;
        }
        let session = session.as_mut().ok_or_else(unknown)?;
        match words.as_slice() {
            ["configs", operation] => writeln!(out, "{}", T::configs(operation, session.boxes.len()).join(" "))?,
            ["frames", percent, first, count] => {
                let number = |word: &str| word.parse::<u64>().map_err(|_| unknown());
                session.read_frames(number(percent)? as u32, number(first)?, number(count)?)?;
                writeln!(out, "read")?;
            }
            ["pass", operation, config, count] => {
                let samples = session.pass(operation, config, count.parse().map_err(|_| unknown())?)?;
                writeln!(out, "samples {}", samples.len())?;
                for (ticks, answer) in samples {
                    out.write_all(&ticks.to_le_bytes())?;
                    out.write_all(&answer.to_le_bytes())?;
                }
            }
            ["memory", config] => {
                let (built, bytes) = session.kept.get(*config).map_or((0, 0), |kept| (kept.built, kept.bytes));
                writeln!(out, "{built} {bytes}")?;
            }
            _ => return Err(unknown()),
        }
        out.flush()?;
    }
    Ok(())
}
