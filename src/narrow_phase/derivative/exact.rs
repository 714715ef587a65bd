//! The derivatives of a pair where they exist, from the features that face one another.

use nalgebra::SMatrix;

use super::super::outcome::Separation;
use super::super::patch::{NoPatch, TouchingPiece, across, is_wall};
use super::polish::{Polished, polish};
use super::response::{Change, Response};
use super::side::{Mat2, Side};
use crate::geometry::{Placement, Shape, Vec3};

/// Where derivatives come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DerivativeMethod {
    /// Both sides are smooth and strictly convex: they hold in a neighbourhood, through contact into a shallow overlap.
    ExactSmooth,
    /// They hold as long as the same features face one another, and say nothing of others.
    ExactCell,
}

/// A change per twist of a body: a row for the distance, three for a vector. Columns: velocity along x, y, z (metres), then turn about x, y, z
/// (radians), of the body about its own origin, in the axes of both placements.
pub type TwistMatrix = SMatrix<f64, 3, 6>;

/// How a pair changes when its bodies move. Of A, then of B.
#[derive(Clone, Debug, PartialEq)]
pub struct Derivatives {
    /// Of the signed distance; metres per metre and per radian.
    pub signed_distance: [[f64; 6]; 2],
    /// Of the unit normal; per metre and per radian.
    pub normal: [TwistMatrix; 2],
    /// Of the witness on A: of the point in space, not of one held fast in the body.
    pub point_on_a: [TwistMatrix; 2],
    /// Of the witness on B.
    pub point_on_b: [TwistMatrix; 2],
    /// Where they come from.
    pub method: DerivativeMethod,
    /// How well they are conditioned: the least eigenvalue of the sum of distance and radii of curvature, metres, that a change of the
    /// normal is divided by. Infinite where the normal is held by a face, not positive in an overlap so deep that the
    /// normal of least depth is none of these.
    pub conditioning: f64,
    /// How far the vector between the witnesses is from the normal's line, metres, as a bound of what is wrong with the normal: that by
    /// conditioning. Of smooth pairs after Newton's method.
    pub residual: f64,
    /// Whether derivatives exist: false where the witness is not one point, or where the conditioning is not positive. Then they are those of one
    /// choice.
    pub is_valid: bool,
    /// Whether the witness is where several features meet, so that a move may lead to another one.
    pub on_border: bool,
}

/// The derivatives of what `found` says of two shapes in these places.
///
/// `found` has to be what [`separation`](crate::narrow_phase::separation) says of them, asked for a distance or, in an overlap, a
/// penetration. Of shapes of several pieces they are those of the two pieces that it names.
///
/// # Errors
/// [`NoPatch`] when neither shape has bounds, or `found` does not tell which piece it is about.
pub fn derivatives(
    a: &Shape,
    b: &Shape,
    at_a: &Placement,
    at_b: &Placement,
    found: &Separation,
) -> Result<Derivatives, NoPatch> {
    let piece_a = TouchingPiece::of(a, found.subshape_a, at_a, found.point_on_a)?;
    let piece_b = TouchingPiece::of(b, found.subshape_b, at_b, found.point_on_b)?;
    if is_wall(&piece_a.core) && is_wall(&piece_b.core) {
        return Err(NoPatch::Unbounded { a: a.kind(), b: b.kind() });
    }
    let given = Polished {
        normal: found.normal,
        points: [Vec3::zeros(), found.normal * found.signed_distance],
        signed_distance: found.signed_distance,
        residual: found.point_error,
    };
    let sides = |normal: Vec3| {
        let [x, y] = across(normal);
        [Side::of(&piece_a, [x, y, normal]), Side::of(&piece_b, [x, y, -normal])]
    };
    let first = sides(found.normal);
    let is_smooth = first.iter().all(|side| side.is_smooth);
    let may_polish = is_smooth && piece_a.is_placed && piece_b.is_placed;
    let polished = may_polish.then(|| polish(&piece_a, &piece_b, &given, |normal| radii(&sides(normal)))).flatten();
    let (at, sides) = polished.map_or_else(|| (given, first), |polished| (polished, sides(polished.normal)));
    let response = Response::new(at.normal, across(at.normal), at.signed_distance, [&sides[0], &sides[1]]);
    let witness = [0, 1].map(|side| found.point_on_a + at.points[side]);
    let arms = [witness[0] - at_a.translation, witness[1] - at_b.translation];
    let on_border = response.is_shared || sides.iter().any(|side| side.on_border);
    let is_valid = !response.is_shared && response.least_eigenvalue > 0.0;
    let mut all = Derivatives {
        signed_distance: [[0.0; 6]; 2],
        normal: [TwistMatrix::zeros(); 2],
        point_on_a: [TwistMatrix::zeros(); 2],
        point_on_b: [TwistMatrix::zeros(); 2],
        method: if is_smooth { DerivativeMethod::ExactSmooth } else { DerivativeMethod::ExactCell },
        conditioning: response.least_eigenvalue,
        residual: at.residual,
        is_valid,
        on_border,
    };
    for body in 0..2 {
        for column in 0..6 {
            let axis = Vec3::ith(column % 3, 1.0);
            let (v, w) = if column < 3 { (axis, Vec3::zeros()) } else { (Vec3::zeros(), axis) };
            all.set(body, column, &response.change(body, v, w, arms[body]));
        }
    }
    Ok(all)
}

/// The sum of both tensors.
fn radii(sides: &[Side; 2]) -> Mat2 {
    sides[0].radii + sides[1].radii
}

impl Derivatives {
    fn set(&mut self, body: usize, column: usize, change: &Change) {
        self.signed_distance[body][column] = change.distance;
        self.normal[body].set_column(column, &change.normal);
        self.point_on_a[body].set_column(column, &change.points[0]);
        self.point_on_b[body].set_column(column, &change.points[1]);
    }
}
