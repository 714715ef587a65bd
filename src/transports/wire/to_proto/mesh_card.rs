//! The cost card of a mesh.

use super::count;
use crate::narrow_phase::Bracket;
use crate::service::TimedMeshCard;
use crate::transports::wire::v1;

/// What the convex pieces of a mesh cost.
#[must_use]
pub fn mesh_card(timed: &TimedMeshCard) -> v1::MeshCard {
    let fit = timed.card.fit;
    let bracket = |b: Bracket| v1::Bracket { lower: b.lower, upper: b.upper };
    v1::MeshCard {
        pieces: count(timed.card.pieces),
        bytes: timed.card.bytes as u64,
        build_seconds: timed.build.as_secs_f64(),
        inflation: Some(bracket(fit.inflation)),
        loss: Some(bracket(fit.loss)),
        closed: fit.closed,
        points: fit.points,
    }
}
