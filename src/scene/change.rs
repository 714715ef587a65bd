//! What one edit does to the next snapshot, while nobody else sees it yet.
//!
//! Every change checks first and then cannot fail. A fault may leave the draft half changed by earlier edits: the scene
//! throws it away.

use super::{BodyId, Edit, Reason, Revision, Snapshot};
use crate::limits::Limits;

/// What is wrong with one edit.
#[derive(Debug)]
pub(super) struct Fault {
    pub(super) field: &'static str,
    pub(super) reason: Reason,
}

impl Reason {
    /// The reason as the fault of a field.
    pub(super) fn of(self, field: &'static str) -> Fault {
        Fault { field, reason: self }
    }
}

impl Snapshot {
    /// Makes one edit. Gives the id of the body if it added one.
    pub(super) fn change(&mut self, edit: &Edit, limits: &Limits) -> Result<Option<BodyId>, Fault> {
        match edit {
            Edit::AddBody(body) => return self.add_body(body, limits).map(Some),
            Edit::RemoveBody { body } => self.remove_body(body)?,
            Edit::MoveBody { body, pose } => self.move_body(body, pose)?,
            Edit::ReplaceShape { body, shape, scale, padding } => self.replace_shape(body, shape, *scale, *padding)?,
            Edit::InsertPoints { body, points } => self.insert_points(body, points, limits)?,
            Edit::ClearBox { body, bounds } => self.clear_box(body, bounds)?,
            Edit::SetGroups { body, groups } => self.set_groups(body, groups, limits)?,
            Edit::SetLayers { body, layers, mask } => self.set_layers(body, *layers, *mask)?,
            Edit::SetEnabled { body, enabled } => self.set_enabled(body, *enabled)?,
            Edit::AddRobot { name, model, base } => self.add_robot(name, model, base, limits)?,
            Edit::MoveRobot { robot, base } => self.move_robot(robot, base)?,
            Edit::RemoveRobot { robot } => self.remove_robot(robot)?,
            Edit::SetAllowedCollision { a, b, allowed } => self.set_allowed_collision(a, b, *allowed, limits)?,
            Edit::SetPairMargin { a, b, margin } => self.set_pair_margin(a, b, *margin, limits)?,
            Edit::DeclareEffects { a, b, effects } => self.declare_effects(a, b, *effects, limits)?,
        }
        Ok(None)
    }

    /// Works out what is kept beside the edited content, where the edits touched what it depends on.
    pub(super) fn settle(&mut self, before: &Self, revision: Revision) {
        self.revision = revision;
        self.broad_phase.settle();
        if !self.allowed.is_as_in(&before.allowed) || !self.effects.is_as_in(&before.effects) {
            self.settle_self_pairs();
        }
        if self.largest_margin_gone {
            self.largest_margin = self.margins.values().fold(0.0, f64::max);
            self.largest_margin_gone = false;
        }
    }
}
