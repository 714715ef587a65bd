//! What the contenders of the trees share. `README.md` has the rules and the layout of the file.

mod boxes;
mod contender;
mod memory;

pub use boxes::{BoxRecord, RayRecord};
pub use contender::{Trees, serve};
pub use memory::Counted;
