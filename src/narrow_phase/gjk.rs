//! Distance between two convex cores: the Gilbert-Johnson-Keerthi algorithm on their Minkowski difference.
//!
//! The loop keeps the feature (vertex, edge or face) of a simplex nearest the origin, asks for the support point
//! opposite to it, and reduces the enlarged simplex to its nearest feature again. Every direction that was asked about
//! bounds the distance from below, the nearest point bounds it from above; the best of both are kept, never the last.
//! Sources: Gilbert, Johnson, Keerthi 1988; van den Bergen 1999. Departures: the bracket decides when to stop, and the
//! search direction is the feature's own (see [`Feature::direction`]), which near a contact is far better than the
//! nearest point's.
//!
//! It ends when
//! - the bracket is as narrow as asked, or decides what was asked;
//! - a tetrahedron encloses the origin, by an exact test (the cores overlap: EPA's work);
//! - no further progress can be made in `f64`;
//! - the cap on rounds is reached, or the caller's time.

use super::bracketing::Target;
use super::minkowski::{Difference, Vertex};
use super::outcome::Cost;
use super::simplex::{Feature, Nearest, segment, tetrahedron, triangle};
use super::support::unit;
use crate::geometry::Vec3;

/// Rounds at most. Smooth pairs need some 50 for a relative width of 1e-9; the most seen in the test corpus is below
/// 100, on cones and ellipsoids of extreme proportions.
const MAX_ITERATIONS: u32 = 160;

/// What GJK found out about the difference C of two cores.
pub(super) struct Gjk {
    /// The signed distance of the cores is at least this, metres.
    pub lower: f64,
    /// The unit direction that proves it: `direction . c >= lower` for all c in C.
    pub direction: Vec3,
    /// The nearest feature found, also when the origin is enclosed (then the last before).
    pub feature: Feature,
    /// `|x|` of the nearest point plus its error, metres.
    pub upper: f64,
    /// How it ended.
    pub end: End,
}

/// How GJK ended.
pub(super) enum End {
    /// The bracket is as narrow as asked.
    Converged,
    /// The bracket decides what was asked.
    Decided,
    /// The origin is strictly inside these four vertices.
    Enclosed([Vertex; 4]),
    /// No progress in `f64`; the bracket may still be wide next to a small distance.
    Stalled,
    /// The cap on rounds.
    Limit,
    /// The caller's time ran out.
    OutOfTime,
}

/// Runs GJK on `difference`, starting between the centres.
pub(super) fn gjk(difference: &Difference, target: &Target, cost: &mut Cost) -> Gjk {
    let error = difference.error;
    let mut direction = unit(difference.centers()).unwrap_or_else(Vec3::x);
    let first = difference.lowest(direction);
    cost.supports += 1;
    let mut best = Gjk {
        lower: direction.dot(&first.w) - error,
        direction,
        feature: Feature::point(first),
        upper: first.w.norm() + error,
        end: End::Limit,
    };
    for _ in 0..MAX_ITERATIONS {
        if let Some(end) = settled(&best, target) {
            return Gjk { end, ..best };
        }
        if target.must_stop() {
            return Gjk { end: End::OutOfTime, ..best };
        }
        let x = best.feature.nearest().w;
        let Some(toward) = unit(best.feature.direction(x)) else {
            return Gjk { end: End::Stalled, ..best }; // The origin is on the feature.
        };
        direction = toward;
        let vertex = difference.lowest(direction);
        cost.supports += 1;
        cost.gjk_iterations += 1;
        let value = direction.dot(&vertex.w);
        if value - error > best.lower {
            best.lower = value - error;
            best.direction = direction;
            if let Some(end) = settled(&best, target) {
                return Gjk { end, ..best };
            }
        }
        if best.feature.vertices().iter().any(|v| v.w == vertex.w) {
            return Gjk { end: End::Stalled, ..best };
        }
        match reduce(&best.feature, vertex) {
            Nearest::Enclosed => {
                let [a, b, c] = best.feature.vertices;
                return Gjk { end: End::Enclosed([a, b, c, vertex]), ..best };
            }
            Nearest::Outside(feature) => {
                // Comparison order matters: a NaN is no progress.
                if !(feature.nearest().w.norm_squared() < x.norm_squared()) {
                    return Gjk { end: End::Stalled, ..best };
                }
                best.feature = feature;
                best.upper = feature.nearest().w.norm() + error;
            }
        }
    }
    best
}

fn settled(best: &Gjk, target: &Target) -> Option<End> {
    let bracket = target.bracket(best.lower, best.upper);
    if target.is_decided(&bracket) {
        return Some(End::Decided);
    }
    target.is_met(&bracket).then_some(End::Converged)
}

/// The feature nearest the origin of a feature and one more vertex.
fn reduce(feature: &Feature, vertex: Vertex) -> Nearest {
    let [a, b, c] = feature.vertices;
    match feature.len {
        1 => Nearest::Outside(segment(a, vertex)),
        2 => Nearest::Outside(triangle(a, b, vertex)),
        _ => tetrahedron(a, b, c, vertex),
    }
}
