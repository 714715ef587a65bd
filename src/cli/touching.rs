//! The list of touching triangles in the answers of `clearance pairs --touching`.

use serde::Serialize;

use super::case::Case;
use crate::narrow_phase::{Within, touching_pairs};

/// Which pairs of triangles touch or are too close to tell; by their numbers, in order.
#[derive(Serialize)]
pub(super) struct Listed {
    touching: Vec<[u32; 2]>,
    /// Whether the limit or the time cut the list.
    truncated: bool,
}

/// The list for a mesh against a mesh or a convex shape; none for other pairs.
pub(super) fn listed(case: &Case, limit: usize, stop: &dyn Fn() -> bool) -> Option<Listed> {
    let mut found = Vec::new();
    let within = Within { limit, stop, ..Within::contact() };
    let (at_a, at_b) = (case.pose_a.placement(), case.pose_b.placement());
    let end = touching_pairs(&case.a, &case.b, &at_a, &at_b, &within, &mut found).ok()?;
    let touching = found.iter().map(|pair| [pair.a, pair.b]).collect();
    Some(Listed { touching, truncated: end.truncated })
}
