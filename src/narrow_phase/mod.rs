//! How far apart two shapes are, as a proved bracket.

mod outcome;

pub use outcome::{Bracket, Cost, Separation, Termination};
