//! Sweep and prune: boxes sorted along one axis, so that only those whose intervals meet there are compared.
//!
//! [`SweepAndPrune`] keeps the order while boxes come, go and move (insertion sort, as boxes rarely overtake many), in
//! segments that versions share. It keeps no set of pairs.

mod axis;
mod questions;
mod segment;
mod sorted_list;
mod sweep_and_prune;
mod validate;

pub use sweep_and_prune::{SweepAndPrune, SweepHealth};
pub use validate::SweepDefect;
