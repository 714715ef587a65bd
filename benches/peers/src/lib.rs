//! What the Rust contenders share: the readers of their data, and the passes over it. `README.md` has the rules.

pub mod contender;
pub mod pairs;
pub mod timer;
pub mod trees;
