//! Which pairs are worth another look? Those of which a side, or what the scene says of them, changed since a revision.

use super::pairs::{Pairs, party};
use super::search::Search;
use crate::scene::{Body, BodyId, Changes, Loners, Snapshot};

impl Pairs<'_> {
    /// Offers every pair that changed, once: those with a changed side first, then those that only an entry changed.
    pub(super) fn changed(&self, changes: &Changes, search: &mut Search) {
        let mut loners = self.snapshot().loners();
        for body in changes.bodies().iter().filter_map(|change| self.walker(change.id, &mut loners)) {
            if search.is_settled() {
                return;
            }
            // Two changed bodies are offered by the lower id.
            self.against_bodies(search, &party(body), body.bounds, &mut |other| {
                let again = other.id <= body.id && changes.has_body(other.id);
                (!again && other.id != body.id && self.admits(body, other)).then(|| self.margin(body, other))
            });
        }
        let named = changes.bodies_of_entries(self.snapshot());
        for body in named.iter().filter(|id| !changes.has_body(**id)).filter_map(|id| self.walker(*id, &mut loners)) {
            if search.is_settled() {
                return;
            }
            self.against_bodies(search, &party(body), body.bounds, &mut |other| {
                let again =
                    changes.has_body(other.id) || (other.id <= body.id && named.binary_search(&other.id).is_ok());
                let counts = !again && other.id != body.id && changes.has_entry_for(body.member(), other.member());
                (counts && self.admits(body, other)).then(|| self.margin(body, other))
            });
        }
    }

    fn walker(&self, id: BodyId, loners: &mut Loners) -> Option<&Body> {
        let body = self.snapshot().body(id)?;
        (self.passes(body) && !loners.has(body.member())).then_some(&**body)
    }
}

/// Whether a pair of bodies changed: one of them did, or an entry that speaks of both.
pub(super) fn pair_changed(snapshot: &Snapshot, changes: &Changes, a: BodyId, b: BodyId) -> bool {
    if changes.has_body(a) || changes.has_body(b) {
        return true;
    }
    match (snapshot.body(a), snapshot.body(b)) {
        (Some(a), Some(b)) => changes.has_entry_for(a.member(), b.member()),
        // Whoever left the scene has changed.
        (None, _) | (_, None) => true,
    }
}
