//! The derivatives of a pair where they exist, from the features that face one another.

use super::super::outcome::Separation;
use super::super::patch::{NoPatch, TouchingPiece, across, is_wall};
use super::derivatives::{DerivativeCost, DerivativeMethod, Derivatives, NoDerivatives, TwistMatrix};
use super::polish::{Polished, polish};
use super::response::{Change, Response};
use super::side::{Mat2, Side};
use crate::geometry::{Placement, Shape, Vec3};

/// By formula: from the features that face each other, and with `may_polish`, of smooth pairs, at a normal that is made more exact first.
pub(super) fn exact(
    [(a, at_a), (b, at_b)]: [(&Shape, &Placement); 2],
    found: &Separation,
    may_polish: bool,
) -> Result<Derivatives, NoDerivatives> {
    let piece_a = TouchingPiece::of(a, found.subshape_a, at_a, found.point_on_a)?;
    let piece_b = TouchingPiece::of(b, found.subshape_b, at_b, found.point_on_b)?;
    if is_wall(&piece_a.core) && is_wall(&piece_b.core) {
        return Err(NoPatch::Unbounded { a: a.kind(), b: b.kind() }.into());
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
    let may_polish = may_polish && is_smooth && piece_a.is_placed && piece_b.is_placed;
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
        method: if may_polish { DerivativeMethod::Exact } else { DerivativeMethod::ExactCell },
        conditioning: response.least_eigenvalue,
        residual: at.residual,
        epsilon: 0.0,
        samples: 0,
        seed: 0,
        is_valid,
        on_border,
        is_contested: false,
        cost: DerivativeCost::default(),
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
    pub(super) fn set(&mut self, body: usize, column: usize, change: &Change) {
        self.signed_distance[body][column] = change.distance;
        self.normal[body].set_column(column, &change.normal);
        self.point_on_a[body].set_column(column, &change.points[0]);
        self.point_on_b[body].set_column(column, &change.points[1]);
    }
}
