//! All experiments in order, and the folder they are written to.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;
use std::{fs, io};

use super::machine::Machine;
#[cfg(feature = "effect-motion")]
use super::motion;
use super::planner::Planner;
use super::section::Section;
#[cfg(feature = "effect-derivatives")]
use super::{alignment, smoothing};
use super::{batches, broad, distance, geometry, lecture, outputs, page, penetration, precision};

/// How much work a study is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Seconds that times are taken for, over all experiments; what is made ready before comes on top.
    pub seconds: f64,
    /// Pairs, poses and motions: a part of those of a full study.
    pub part: f64,
}

impl Effort {
    /// A figure worth keeping.
    pub const FULL: Self = Self { seconds: 400.0, part: 1.0 };
    /// In under two minutes on two cores.
    pub const QUICK: Self = Self { seconds: 60.0, part: 0.16 };

    /// So many of a full number, and not fewer than `least`.
    pub(super) fn of(&self, full: usize, least: usize) -> usize {
        ((full as f64 * self.part).ceil() as usize).max(least)
    }

    /// That part of the time, divided among `count`.
    pub(super) fn share(&self, part: f64, count: usize) -> super::race::Rounds {
        let least = if self.seconds < 30.0 { 1 } else { 3 };
        super::race::Rounds { seconds: self.seconds * part / count.max(1) as f64, least, most: 31 }
    }
}

/// Told to whoever waits.
pub struct Progress<'a> {
    /// Which experiment, and which part of all is done, 0 to 1.
    pub tell: &'a mut dyn FnMut(&str, f64),
}

/// A study could not be made.
#[derive(Debug, thiserror::Error)]
pub enum NoStudy {
    /// A file or folder.
    #[error("{path}: {error}", path = path.display())]
    File {
        /// Which.
        path: PathBuf,
        /// What is wrong with it.
        #[source]
        error: io::Error,
    },
    /// A file does not hold what it should.
    #[error("{path}: {what}", path = path.display())]
    Content {
        /// Which.
        path: PathBuf,
        /// What is wrong with it.
        what: String,
    },
    /// No experiment has that name.
    #[error("there is no experiment {name}; there are {known}")]
    Unknown {
        /// What was asked for.
        name: String,
        /// All of them.
        known: String,
    },
    /// Something of the study's own making was refused.
    #[error("{0}")]
    Own(String),
}

impl NoStudy {
    pub(super) fn own(error: impl ToString) -> Self {
        Self::Own(error.to_string())
    }
}

/// What is measured, and where it goes.
#[derive(Clone, Debug)]
pub struct Study {
    /// How much work.
    pub effort: Effort,
    /// The folder; made if it is not there.
    pub out: PathBuf,
    /// What `clearance bench transports --json` wrote.
    pub doors: Option<PathBuf>,
    /// Figures of other libraries, as `benches/peers/compare --save` writes them.
    pub peers: Option<PathBuf>,
    /// A robot in its scenes, for motions and states.
    pub planner: Arc<Planner>,
    /// The command line, for the report.
    pub command: String,
    /// Experiments by the names of their tables; none: all of them.
    pub only: Vec<String>,
}

/// An experiment: the name of its table, its share of the time, and what makes it.
type Experiment = (&'static str, f64, fn(&Study, &mut dyn FnMut(f64)) -> Result<Section, NoStudy>);

/// In the order of the report, without those whose effects were left out of the build. The shares are of the time that is measured;
/// together they are one.
const EXPERIMENTS: &[Experiment] = &[
    ("distance", distance::SHARE, distance::section),
    ("outputs", outputs::SHARE, outputs::section),
    ("precision", precision::SHARE, precision::section),
    ("penetration", penetration::SHARE, penetration::section),
    ("geometry", geometry::SHARE, geometry::section),
    #[cfg(feature = "effect-motion")]
    ("motion", motion::SHARE, motion::section),
    ("broad_phase", broad::SHARE, broad::section),
    ("batches", batches::SHARE, batches::section),
    ("lecture", lecture::SHARE, lecture::section),
    #[cfg(feature = "effect-derivatives")]
    ("derivatives", smoothing::SHARE, smoothing::section),
    #[cfg(feature = "effect-derivatives")]
    ("alignment", alignment::SHARE, alignment::section),
];

impl Study {
    /// Measures everything and writes the folder. Returns the page.
    ///
    /// # Errors
    /// A file that cannot be read or written, or one that holds something else.
    pub fn run(&self, progress: &mut Progress) -> Result<PathBuf, NoStudy> {
        let begun = Instant::now();
        let chosen = self.chosen()?;
        make_folder(&self.out)?;
        let machine = Machine::here(&self.command);
        let mut sections = Vec::new();
        let mut done = 0.0;
        for (name, share, make) in chosen {
            (progress.tell)(name, done);
            let section = make(self, &mut |part| (progress.tell)(name, done + share * part))?;
            write(&self.out.join(format!("{}.csv", section.table.name)), &section.table.csv())?;
            sections.push(section);
            done += share;
        }
        (progress.tell)("writing", 1.0);
        let page = self.out.join("index.html");
        write(&page, &page::html(&sections, &machine, begun.elapsed(), self.effort))?;
        write(&self.out.join("machine.csv"), &machine.table().csv())?;
        Ok(page)
    }

    /// The experiments that are wanted, in the order of the report; each as long as in a whole study.
    fn chosen(&self) -> Result<Vec<Experiment>, NoStudy> {
        let names: Vec<&str> = EXPERIMENTS.iter().map(|(name, ..)| *name).collect();
        if let Some(unknown) = self.only.iter().find(|wanted| !names.contains(&wanted.as_str())) {
            return Err(NoStudy::Unknown { name: unknown.clone(), known: names.join(", ") });
        }
        let is_wanted = |name: &str| self.only.is_empty() || self.only.iter().any(|wanted| wanted == name);
        Ok(EXPERIMENTS.iter().filter(|(name, ..)| is_wanted(name)).copied().collect())
    }
}

fn make_folder(path: &Path) -> Result<(), NoStudy> {
    fs::create_dir_all(path).map_err(|error| NoStudy::File { path: path.to_owned(), error })
}

fn write(path: &Path, text: &str) -> Result<(), NoStudy> {
    fs::write(path, text).map_err(|error| NoStudy::File { path: path.to_owned(), error })
}

pub(super) fn read(path: &Path) -> Result<String, NoStudy> {
    fs::read_to_string(path).map_err(|error| NoStudy::File { path: path.to_owned(), error })
}

#[cfg(all(test, feature = "effect-motion"))]
mod tests {
    use super::*;

    #[test]
    fn the_shares_add_up_to_the_whole() {
        let sum: f64 = EXPERIMENTS.iter().map(|(_, share, _)| share).sum();
        assert!((sum - 1.0).abs() < 1e-9, "{sum}");
    }
}
