//! Two leaves of a walk: triangles by their features, everything else, and what features leave open, by GJK and EPA.

use super::bracketing::Target;
use super::course::Course;
use super::goal::{Depth, Goal};
use super::outcome::{Bracket, Cost, Separation, Termination};
use super::solver::Solver;
use super::support::unit;
use super::trees::Tree;
use super::triangles::TrianglePair;
use super::witness::{self, WITNESS_ERROR_ULPS};
use crate::geometry::tolerance::UNIT_ROUNDOFF;
use crate::geometry::{Vec3, length};

/// What is known of two leaves.
pub(super) enum Leaves {
    /// They are farther apart than matters: a lower bound above the threshold, metres.
    Farther(f64),
    /// As much as was asked.
    Known(Separation),
}

impl<'t, T: Tree<'t>> Course<'t, T> {
    /// What is in two leaves, as far as `goal` needs it and unless it is beyond `threshold`. `normal`: a direction worth asking about first, as
    /// for boxes.
    pub fn leaves(&self, a: T::Leaf, b: T::Leaf, goal: &Goal, threshold: f64, normal: Option<[Vec3; 2]>) -> Leaves {
        // A solver that was asked for by name does all the work itself.
        let triangles = self.triangles(a, b).filter(|_| goal.solver == Solver::Default);
        let by_features = triangles.and_then(|pair| {
            let farther = |gap: f64| {
                Some(self.lower_bound(gap, pair.error)).filter(|lower| *lower > threshold).map(Leaves::Farther)
            };
            let along = normal.filter(|_| threshold > 0.0).and_then(|[in_a, _]| farther(pair.gap(in_a)));
            along.or_else(|| self.by_features(&pair, goal, farther))
        });
        match by_features {
            Some(Leaves::Known(found)) => Leaves::Known(self.named(found, a, b)),
            Some(farther) => farther,
            None => Leaves::Known(self.by_gjk(a, b, goal)),
        }
    }

    /// What the features of two triangles say; none when that is too little.
    fn by_features(&self, pair: &TrianglePair, goal: &Goal, farther: impl Fn(f64) -> Option<Leaves>) -> Option<Leaves> {
        let target = Target::new(goal, self.radii, 1.0);
        let faces = pair.gap_along_faces();
        if let Some(out) = farther(faces.gap) {
            return Some(out);
        }
        if faces.gap > 0.0 {
            return self.by_near_points(pair, &target).map(Leaves::Known);
        }
        if goal.depth == Depth::Penetration {
            // EPA is dear: only for those pairs that may be the deepest.
            if let Some(out) = farther(pair.gap_along_all(faces).gap) {
                return Some(out);
            }
        } else if pair.surely_cross() {
            let best = pair.gap_along_all(faces);
            let (lower, upper, points) = (best.gap - pair.error, 0.0, [pair.a[0], pair.b[0]]);
            let cores =
                Cores { lower, upper, direction: best.direction, estimate: best.gap, points, error: pair.error };
            return Some(Leaves::Known(self.placed(&cores, target.bracket(lower, upper), Termination::Decided)));
        }
        self.by_near_points(pair, &target).map(Leaves::Known)
    }

    fn by_near_points(&self, pair: &TrianglePair, target: &Target) -> Option<Separation> {
        let near = pair.near_points();
        let across = near.on_b - near.on_a;
        let normal = unit(across)?;
        let (gap, distance) = (pair.gap(normal), across.norm());
        let (lower, upper) = (gap - pair.error, distance + pair.error);
        let bracket = target.bracket(lower, upper);
        let is_signed = bracket.lower > 0.0 || bracket.upper <= 0.0;
        let termination = if target.is_decided(&bracket) {
            Termination::Decided
        } else if target.is_met(&bracket) {
            Termination::Converged
        } else if is_signed && target.goal.depth != Depth::Verdict && distance - gap <= 2.0 * pair.error {
            Termination::RoundingFloor
        } else {
            return None;
        };
        let points = [near.on_a, near.on_b];
        let cores = Cores { lower, upper, direction: normal, estimate: distance, points, error: pair.error };
        Some(self.placed(&cores, bracket, termination))
    }

    /// From the cores in A's frame to the shapes in the frame of the placements.
    pub fn placed(&self, cores: &Cores, bracket: Bracket, termination: Termination) -> Separation {
        let piece = self.a.piece;
        let [on_a, on_b] = cores.points;
        let signed_distance = (cores.estimate - self.radii).clamp(bracket.lower, bracket.upper);
        let normal = piece.at.direction(cores.direction);
        let point_on_a = piece.at.point(on_a) + normal * piece.swept_radius;
        let from_nearest = witness::from_nearest(cores.lower, cores.upper);
        let normal_error = witness::normal_error(cores.lower, from_nearest);
        let short = (on_b - on_a - cores.direction * (signed_distance + self.radii)).norm();
        let of_cores = short + from_nearest + 2.0 * cores.error;
        let rounding = WITNESS_ERROR_ULPS * UNIT_ROUNDOFF * (self.radii + length(piece.at.translation));
        Separation {
            bracket,
            signed_distance,
            normal,
            point_on_a,
            point_on_b: point_on_a + normal * signed_distance,
            point_error: of_cores + self.radii * normal_error.min(2.0) + rounding,
            normal_error,
            termination,
            subshape_a: piece.part,
            subshape_b: self.b.piece.part,
            cost: Cost { pairs: 1, ..Cost::default() },
        }
    }
}

/// What is known of two cores, in A's frame. Metres.
pub(super) struct Cores {
    /// Proved bounds of their signed distance.
    pub lower: f64,
    pub upper: f64,
    /// The best guess between them.
    pub estimate: f64,
    /// The unit direction from A to B that proves `lower`, or stands for it.
    pub direction: Vec3,
    /// A point of A and one of B; apart, the pair that proves `upper`.
    pub points: [Vec3; 2],
    /// How far the points may be off.
    pub error: f64,
}
