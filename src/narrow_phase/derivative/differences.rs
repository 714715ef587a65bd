//! How do the ten numbers of a separation differ when either body is moved there and back?
//!
//! A central difference over a step h errs by the third derivative, h^2 / 6 of it, and by the error e of what is subtracted, e / h. With
//! lengths measured by the size r of the smaller piece and the derivatives of order one then, their sum is least near h = r (e / r)^(1/3):
//! the step that is taken, and the sum that is told. A rotation is by that much less where the body's origin is farther off than r, so
//! that the witness travels no farther than h. Each body is moved by itself; no block is made from the other one.
//!
//! Where a quantity f bends, f(h) - 2 f(0) + f(-h) is of order h^2; where two features meet, its slope has a jump and that is of order h;
//! where the witness leaps it is of order one. Halves of exponents part them: slopes that differ by more than (h / r)^(1/2) are a border,
//! and a step that moves something by more than r (h / r)^(1/2) is a leap, after which there was no one witness point.

use super::super::goal::{Accuracy, Goal};
use super::super::outcome::Separation;
use super::super::patch::TouchingPiece;
use super::derivatives::{Derivatives, NoDerivatives};
use super::moved_pair::{MovedPair, Pair, Quantities, core_radius, moved, quantities, radius, size};
use crate::geometry::tolerance::UNIT_ROUNDOFF;
use crate::geometry::{Placement, Vec3, length};

/// Roundings of a witness point's coordinates.
const ROUNDING_ULPS: f64 = 4.0;

/// Steps are no longer than this part of the size.
const LONGEST: f64 = 0.1;

/// Turns of the normal that are not known to be less than this are judged by the depth.
const UNKNOWN_TURN: f64 = 0.1;

/// Separations: 24 moved places, and the place itself, as narrow as they are.
const ASKED: u64 = 25;

/// Central differences in the 24 places around a pair.
pub(super) fn differences(
    pair: Pair,
    found: &Separation,
    again: &Goal,
    all: &mut Derivatives,
) -> Result<(), NoDerivatives> {
    let places = MovedPair::new(pair, again, Accuracy { absolute: 0.0, relative: 0.0 });
    let [at_a, at_b] = pair.map(|(_, at)| at);
    let middle = places.ask([at_a, at_b])?;
    let size = smaller_piece(pair, found);
    let error = error(&[at_a, at_b], &middle, size);
    let part = libm::cbrt(error).min(LONGEST);
    all.epsilon = part;
    all.residual = part * part + error / part;
    all.cost.separations = ASKED;
    let mut kinks = Kinks { part, size, noise: error / part, is_border: false, is_leap: false };
    let here = quantities(&middle);
    for (body, (at, witness)) in [(at_a, middle.point_on_a), (at_b, middle.point_on_b)].into_iter().enumerate() {
        let arm = length(witness - at.translation).max(size);
        for column in 0..6 {
            let axis = Vec3::ith(column % 3, 1.0);
            let moved_by = |way: f64| match column {
                0..3 => moved(at, axis * (way * part * size), Vec3::zeros()),
                _ => moved(at, Vec3::zeros(), axis * (way * part * size / arm)),
            };
            let (there, back) = (moved_by(1.0), moved_by(-1.0));
            let told = |at: &Placement| places.ask(if body == 0 { [at, at_b] } else { [at_a, at] });
            let (after, before) = (quantities(&told(&there)?), quantities(&told(&back)?));
            // Translations round; what they came to is known without error.
            let way = match column {
                0..3 => (there.translation - back.translation)[column],
                _ => 2.0 * part * size / arm,
            };
            all.set_quantities(body, column, &((after - before) / way));
            kinks.see(&here, &after, &before);
        }
    }
    all.on_border = kinks.is_border || kinks.is_leap;
    // Errors as large as derivatives are leave nothing.
    all.is_valid = !kinks.is_leap && all.residual < 1.0 && all.are_finite();
    Ok(())
}

/// The size of the smaller of the pieces that touch; of the whole shapes, where no piece is told.
fn smaller_piece(pair: Pair, found: &Separation) -> f64 {
    let ends = [(found.subshape_a, found.point_on_a), (found.subshape_b, found.point_on_b)];
    let radii = [0, 1].map(|side| {
        let ((shape, at), (number, witness)) = (pair[side], ends[side]);
        match TouchingPiece::of(shape, number, at, witness) {
            Ok(piece) => core_radius(&piece).map(|core| core + piece.swept_radius),
            Err(_) => shape.bounds().map(radius),
        }
    });
    size(radii, found.signed_distance)
}

/// The error of a separation's quantities, as a part of the size; of the normal, radians.
///
/// In an overlap nothing is proved of the normal. It is where the depth is least, and a depth that is off by e leaves it open by
/// (2 e / r)^(1/2), as the depth bends by about r.
fn error(at: &[&Placement; 2], found: &Separation, size: f64) -> f64 {
    let lengths = [at[0].translation, at[1].translation, found.point_on_a, found.point_on_b].map(length);
    let extent = lengths.into_iter().fold(size, f64::max);
    let rounding = ROUNDING_ULPS * UNIT_ROUNDOFF * extent / size;
    let width = found.bracket.width() / size;
    let turn = if found.normal_error < UNKNOWN_TURN { found.normal_error } else { (2.0 * width).sqrt() };
    rounding.max(width).max(found.point_error / size).max(turn)
}

/// Whether differences there and differences back tell the same.
struct Kinks {
    part: f64,
    size: f64,
    noise: f64,
    is_border: bool,
    is_leap: bool,
}

impl Kinks {
    fn see(&mut self, here: &Quantities, after: &Quantities, before: &Quantities) {
        let step = self.part * self.size;
        // Normals turn by radians; everything else is lengths.
        let lengths = |mut change: Quantities| {
            change.fixed_rows_mut::<3>(1).scale_mut(self.size);
            change / step
        };
        let (there, back) = (lengths(after - here), lengths(here - before));
        let fine = self.part.sqrt();
        for (forward, backward) in there.iter().zip(&back) {
            let steepest = forward.abs().max(backward.abs());
            // The noise of three values, of which one counts twice.
            let explained = fine * (1.0 + steepest.min(1.0 / fine)) + 4.0 * self.noise;
            self.is_border |= (forward - backward).abs() > explained;
            self.is_leap |= steepest > 1.0 / fine + 2.0 * self.noise;
        }
    }
}
