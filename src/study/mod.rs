//! What does accuracy cost? Work-precision runs on this machine, and their report.
//!
//! [`Study::run`] is the door: it goes through the experiments in order and writes a folder. Each experiment is a file of its
//! own that makes one [`Section`]: what was asked, what the figures say in words, drawings, and one table. `distance`,
//! `penetration` and `lecture` share `sweep`, which holds solvers against a `truth` that is a thousand times tighter; times are
//! those of `race`. Drawings are `plot` and `rungs`, in the frame of `scale`; `page` puts the sections into one file that
//! needs nothing else, `table` writes the numbers beside it.

#[cfg(feature = "effect-derivatives")]
mod alignment;
mod batches;
mod body;
mod broad;
#[cfg(feature = "effect-derivatives")]
mod contact_target;
mod distance;
mod double_double;
mod families;
mod geometry;
mod lecture;
mod machine;
mod markup;
#[cfg(feature = "effect-motion")]
mod motion;
mod outputs;
mod page;
mod peers;
mod penetration;
mod pieces;
mod planner;
mod plot;
mod precision;
mod race;
mod random;
mod rungs;
mod scale;
mod section;
#[cfg(feature = "effect-derivatives")]
mod smoothing;
mod sphere_cover;
#[expect(clippy::module_inception, reason = "the study of the floor `study`")]
mod study;
mod sweep;
mod table;
mod truth;

#[cfg(feature = "effect-derivatives")]
pub use contact_target::{Attempt, ContactTarget, Course};
pub use planner::{Planner, PlannerScene};
pub use section::{Figure, Section};
pub use study::{Effort, NoStudy, Progress, Study};
pub use table::Table;
