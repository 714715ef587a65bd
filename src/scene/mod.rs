//! What is in the world: commands that change it, and immutable snapshots that queries read.

mod id;

pub use id::{BodyId, Epoch, Revision};
