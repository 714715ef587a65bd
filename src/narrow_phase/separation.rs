//! The door of the narrow phase: any shape against any shape.

use super::convex::{self, Convex};
use super::far_apart;
use super::given::Given;
use super::goal::Goal;
use super::outcome::Separation;
use super::pair_cache::PairCache;
use super::pieces::Pieces;
use super::solver::{Solver, Unclaimed};
use super::support::is_convex;
use super::union;
use super::witness::WITNESS_ERROR_ULPS;
use crate::geometry::tolerance::UNIT_ROUNDOFF;
use crate::geometry::{Core, Placement, Shape, length};

/// Why a pair gets no answer.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoSeparation {
    /// Two shapes without bounds, such as two half-spaces: their distance is not asked for.
    #[error("a {a} and a {b} are both unbounded, so they have no signed distance")]
    Unbounded {
        /// Kind of the first shape.
        a: &'static str,
        /// Kind of the second.
        b: &'static str,
    },
    /// Nothing is near or far from a shape without a point: voxels without a cell.
    #[error("a {a} and a {b} have no signed distance, as there is nothing in one of them")]
    Empty {
        /// Kind of the first shape.
        a: &'static str,
        /// Kind of the second.
        b: &'static str,
    },
    /// The solver that was asked for does not take such shapes.
    #[error(transparent)]
    Unclaimed(#[from] Unclaimed),
}

/// How far shape `a` is from shape `b`, both placed in one frame, as far as `goal` needs to know.
///
/// Metres. The bracket is valid whatever stopped the work. Of shapes made of several pieces it is that of the least
/// pair of pieces: in an overlap the deepest pair, not a translation that frees the whole.
///
/// # Errors
/// [`NoSeparation`] when neither shape has bounds, one is empty, or the goal's solver does not take one of them.
pub fn separation(
    a: &Shape,
    b: &Shape,
    at_a: &Placement,
    at_b: &Placement,
    goal: &Goal,
) -> Result<Separation, NoSeparation> {
    separation_again(a, b, at_a, at_b, goal, &mut PairCache::new())
}

/// The same for a pair that was asked about before, in places nearby: the search starts where the last one ended, which
/// saves most of it. `cache` is the caller's, one for each pair; a new one knows nothing. Only pairs of convex shapes use it.
///
/// # Errors
/// As [`separation`].
pub fn separation_again(
    a: &Shape,
    b: &Shape,
    at_a: &Placement,
    at_b: &Placement,
    goal: &Goal,
    cache: &mut PairCache,
) -> Result<Separation, NoSeparation> {
    if goal.solver != Solver::Default {
        goal.solver.claims(a, b)?;
    }
    if is_convex(a.core()) && is_convex(b.core()) {
        let one = Convex {
            core: a.core(),
            swept_radius: a.swept_radius(),
            at: at_a,
            placement_error: 0.0,
            given: Given::alone(a, at_a),
        };
        let other = Convex {
            core: b.core(),
            swept_radius: b.swept_radius(),
            at: at_b,
            placement_error: 0.0,
            given: Given::alone(b, at_b),
        };
        return Ok(convex::separation_again(one, other, goal, cache));
    }
    if a.is_empty() || b.is_empty() {
        return Err(NoSeparation::Empty { a: a.kind(), b: b.kind() });
    }
    if let Some(found) = far_apart::parted(a, b, at_a, at_b, goal) {
        return Ok(found);
    }
    let own_frame = Placement::identity();
    let composed = matches!(a.core(), Core::Compound(_)) || matches!(b.core(), Core::Compound(_));
    let pieces_a = Pieces::new(a, own_frame, at_a, composed);
    let pieces_b = Pieces::new(b, Placement::relative(at_a, at_b), at_b, composed);
    let found =
        union::separation(&pieces_a, &pieces_b, goal).ok_or(NoSeparation::Unbounded { a: a.kind(), b: b.kind() })?;
    let point_on_a = at_a.point(found.point_on_a);
    let normal = at_a.direction(found.normal);
    let point_on_b = point_on_a + normal * found.signed_distance;
    // Both points are turned and moved into the frame of both placements.
    let reach = length(found.point_on_a) + found.signed_distance.abs() + length(at_a.translation);
    let point_error = found.point_error + WITNESS_ERROR_ULPS * UNIT_ROUNDOFF * reach;
    let normal_error = found.normal_error + WITNESS_ERROR_ULPS * f64::EPSILON;
    Ok(Separation { normal, point_on_a, point_on_b, point_error, normal_error, ..found })
}
