//! What do the pieces of a mesh cost, and how well do they fit it?

use std::sync::Arc;

use crate::geometry::{Aabb, Compound, TriangleMesh};
use crate::narrow_phase::{Fit, FitGoal, fit};

/// Everything about a decomposition but the time it took: the kernel has no clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshCard {
    /// How many convex hulls there are.
    pub pieces: usize,
    /// What they take in memory.
    pub bytes: usize,
    /// How far they reach beyond the mesh, and what they lose of it.
    pub fit: Fit,
}

/// Distances that are worked out at most for each of the two figures: a second or so.
const MOST_POINTS: usize = 20_000;

/// The width of the figures' brackets that is aimed at when the caller does not say, as a share of the mesh's longest side.
const ACCURACY: f64 = 1e-3;

impl MeshCard {
    /// The card of `pieces` made of `mesh`. `accuracy`: how wide the brackets may be, metres; `stop` ends the work with those reached.
    #[must_use]
    pub fn of(
        mesh: &Arc<TriangleMesh>,
        pieces: &Arc<Compound>,
        accuracy: Option<f64>,
        stop: &dyn Fn() -> bool,
    ) -> Self {
        let longest = |bounds: Aabb| 2.0 * bounds.half_extents().max();
        let accuracy = accuracy.unwrap_or_else(|| ACCURACY * longest(mesh.bounds()));
        let fit = fit(mesh, pieces, &FitGoal { accuracy, most_points: MOST_POINTS, stop });
        Self { pieces: pieces.parts().len(), bytes: pieces.memory(), fit }
    }
}
