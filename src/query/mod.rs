//! Questions to a snapshot of a scene, and their answers. Pure: no threads, clocks, files or network.

mod answer;
mod request;

pub use answer::{Answer, Indeterminacy, ItemAnswer, PairAnswer, Refused, Side, Verdict, Witness};
pub use request::{CheckStates, Context, Filter, Mode, PairQuery, Subject, Wants};
