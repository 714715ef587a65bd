//! What is in the world: edits that change it, and immutable snapshots that queries read.
//!
//! A [`Scene`] takes lists of [`Edit`]s, makes all of a list or nothing, and keeps its last [`Snapshot`]s. A snapshot
//! shares with the one before whatever did not change, so that an edit costs little however large the scene is.

mod body;
mod body_changes;
mod change;
mod change_log;
mod declared;
mod edit;
mod effects;
mod groups;
mod hypothesis;
mod id;
mod id_map;
mod memory;
mod options;
mod pair_changes;
mod pair_entries;
mod pair_table;
mod party;
mod refusal;
mod robot_changes;
mod robot_in_scene;
#[expect(clippy::module_inception, reason = "the scene itself is one of the things in the module on scenes")]
mod scene;
mod snapshot;
mod validate;

#[cfg(test)]
mod tests;

pub use body::Body;
pub use change_log::{BodyChange, ChangeKinds, Changes, RobotChange};
pub use declared::{Asker, Declaration, Loners, QuietBodies};
pub use edit::{BodyRef, Edit, NewBody};
pub use effects::{Effect, Effects};
pub use hypothesis::Hypothesis;
pub use id::{BodyId, Epoch, Revision};
pub use memory::Memory;
pub use options::SceneOptions;
pub use pair_entries::PairEntry;
pub use party::{Member, Party};
pub use refusal::{NotKept, Reason, Refusal};
pub use robot_in_scene::RobotInScene;
pub use scene::{Applied, Scene};
pub use snapshot::Snapshot;
pub use validate::SnapshotDefect;

pub use crate::broad_phase::{BroadPhaseHealth, BroadPhaseKind, Health as TreeHealth};
