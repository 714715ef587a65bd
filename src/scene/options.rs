//! What is chosen when a scene is made, and never after.

use crate::broad_phase::BroadPhaseKind;

/// Choices for a new scene. No answer depends on them; what an answer costs does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SceneOptions {
    /// How bodies that meet, or are near, are found. `docs/broad_phase.md` says when which one pays.
    pub broad_phase: BroadPhaseKind,
}
