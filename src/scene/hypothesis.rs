//! What would a scene be after some edits? A snapshot that is asked like any other, and never published.
//!
//! It shares with the snapshot it is made on whatever the edits leave alone, as the next revision would, so that it costs
//! what an `Apply` of the same edits costs, however large the scene is. It keeps the revision of that snapshot: what is
//! answered from it is answered about that revision.

use super::{BodyId, Edit, Refusal, Snapshot};
use crate::limits::{LimitExceeded, Limits};

/// A snapshot with edits that nobody else sees.
#[derive(Clone, Debug)]
pub struct Hypothesis {
    /// As the scene would be.
    pub snapshot: Snapshot,
    /// The ids of the bodies that were added, in the order of the edits that added them: those that the scene would give
    /// next. The scene may give them to other bodies later.
    pub added: Vec<BodyId>,
}

impl Snapshot {
    /// The scene as it would be after these edits, made in their order, each in the state that the earlier ones lead to.
    /// Edits may be made on a hypothesis too.
    ///
    /// # Errors
    /// As for [`Scene::apply`](super::Scene::apply): too many edits, or the first that cannot be made.
    pub fn suppose(&self, edits: &[Edit], limits: &Limits) -> Result<Hypothesis, Refusal> {
        LimitExceeded::check("max_edits", edits.len(), limits.max_edits)?;
        let mut snapshot = self.clone();
        let mut added = Vec::new();
        for (index, edit) in edits.iter().enumerate() {
            let outcome = snapshot.change(edit, limits);
            added.extend(outcome.map_err(|fault| Refusal::Edit { index, field: fault.field, reason: fault.reason })?);
        }
        snapshot.settle(self, self.revision);
        snapshot.changes.suppose();
        Ok(Hypothesis { snapshot, added })
    }
}
