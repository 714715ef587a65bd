//! What the Rust contenders share: the reader of the pairs, and the passes over them. `README.md` has the rules.

pub mod contender;
pub mod pairs;
