//! What does a pair say when its bodies are moved a little, and what is little?

use nalgebra::SVector;

use super::super::goal::{Accuracy, Depth, Goal};
use super::super::outcome::{Separation, Termination};
use super::super::patch::TouchingPiece;
use super::super::separation::separation;
use super::derivatives::{DerivativeCost, DerivativeMethod, Derivatives, NoDerivatives, TwistMatrix};
use crate::geometry::{Aabb, Placement, Pose, Quaternion, Shape, Vec3, length};

/// Two shapes in their places.
pub(super) type Pair<'a> = [(&'a Shape, &'a Placement); 2];

/// What derivatives are of: signed distance, normal, point on A, point on B.
pub(super) type Quantities = SVector<f64, 10>;

pub(super) fn quantities(found: &Separation) -> Quantities {
    let (n, p, q) = (found.normal, found.point_on_a, found.point_on_b);
    Quantities::from([found.signed_distance, n.x, n.y, n.z, p.x, p.y, p.z, q.x, q.y, q.z])
}

/// A body after it was moved by `v` and turned by the vector `w` about its own origin, both in the axes of the placement.
pub(super) fn moved(at: &Placement, v: Vec3, w: Vec3) -> Placement {
    let translation = at.translation + v;
    let angle = length(w);
    if angle == 0.0 {
        return Placement { translation, ..*at };
    }
    let turn = Quaternion::about_axis(w / angle, angle);
    let rotation_of = |q| Pose::new(Vec3::zeros(), q).ok();
    // A pose stays one, so that exact arithmetic still knows what is meant.
    let turned = at.quaternion.and_then(|q| Some(rotation_of(turn)?.compose(&rotation_of(q)?).rotation()));
    let rotation = turned.map_or_else(|| turn.matrix() * at.rotation, Quaternion::matrix);
    Placement { rotation, translation, quaternion: turned }
}

/// How separations of a pair are asked in moved places.
pub(super) struct MovedPair<'a> {
    shapes: [&'a Shape; 2],
    goal: Goal<'a>,
}

impl<'a> MovedPair<'a> {
    /// `again` has the caller's solver and when to stop.
    pub fn new(pair: Pair<'a>, again: &Goal<'a>, accuracy: Accuracy) -> Self {
        let goal = Goal { depth: Depth::Penetration, accuracy, margin: 0.0, cut_off: f64::INFINITY, ..*again };
        Self { shapes: pair.map(|(shape, _)| shape), goal }
    }

    pub fn ask(&self, at: [&Placement; 2]) -> Result<Separation, NoDerivatives> {
        if (self.goal.stop)() {
            return Err(NoDerivatives::Stopped);
        }
        let found = separation(self.shapes[0], self.shapes[1], at[0], at[1], &self.goal)?;
        if found.termination == Termination::TimeLimit { Err(NoDerivatives::Stopped) } else { Ok(found) }
    }
}

/// Half the longest side of a box: of a ball its radius.
pub(super) fn radius(bounds: Aabb) -> f64 {
    bounds.half_extents().amax()
}

/// Of the core of a piece; none of walls.
pub(super) fn core_radius(piece: &TouchingPiece) -> Option<f64> {
    piece.core.bounds().map(radius)
}

/// What moves are measured by, of two radii (none of what has no bounds): the smaller one that is not zero. Points by
/// themselves are measured by how far they are apart, and where they meet nothing measures them.
pub(super) fn size(radii: [Option<f64>; 2], signed_distance: f64) -> f64 {
    let sizes = radii.into_iter().flatten().filter(|radius| *radius > 0.0);
    sizes.reduce(f64::min).unwrap_or(if signed_distance == 0.0 { 1.0 } else { signed_distance.abs() })
}

impl Derivatives {
    /// Before anything is known.
    pub(super) fn unknown(method: DerivativeMethod) -> Self {
        Self {
            signed_distance: [[0.0; 6]; 2],
            normal: [TwistMatrix::zeros(); 2],
            point_on_a: [TwistMatrix::zeros(); 2],
            point_on_b: [TwistMatrix::zeros(); 2],
            method,
            conditioning: f64::NAN,
            residual: 0.0,
            epsilon: 0.0,
            samples: 0,
            seed: 0,
            is_valid: false,
            on_border: false,
            is_contested: false,
            cost: DerivativeCost::default(),
        }
    }

    /// How all quantities change with one component of the twist of a body.
    pub(super) fn set_quantities(&mut self, body: usize, column: usize, change: &Quantities) {
        let part = |from: usize| change.fixed_rows::<3>(from).into_owned();
        self.signed_distance[body][column] = change[0];
        self.normal[body].set_column(column, &part(1));
        self.point_on_a[body].set_column(column, &part(4));
        self.point_on_b[body].set_column(column, &part(7));
    }

    /// Whether all of them are numbers.
    pub(super) fn are_finite(&self) -> bool {
        let of = |matrices: &[TwistMatrix; 2]| matrices.iter().all(|m| m.iter().all(|x| x.is_finite()));
        let distances = self.signed_distance.iter().flatten().all(|x| x.is_finite());
        distances && of(&self.normal) && of(&self.point_on_a) && of(&self.point_on_b)
    }
}
