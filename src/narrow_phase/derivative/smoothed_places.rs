//! How does the mean of a separation over random places change with the place?
//!
//! With g the ten numbers of a separation, T the places of both bodies, z twelve independent normal numbers and S the reach of each of them
//! (lengths for translations, radians for turns, about each body's own origin in the axes of the placements), the mean is
//! `g_S(T) = E g(T + S z)`. Moving T under the integral onto the density (Stein 1981) gives its derivative without one of g:
//!
//! ```text
//! d g_S / d T_k = E [ g(T + S z) z_k ] / S_k
//! ```
//!
//! As z and -z are equally likely, so is half of what both say: `(g(T + S z) - g(T - S z)) z_k / (2 S_k)`. The part of g that is even in z drops out
//! of every sample, above all g(T) itself: E[z] = 0, so g(T) z_k may be subtracted from a sample (a control variate), and in the half
//! difference that has happened already, once with each sign.

use nalgebra::SMatrix;

use super::super::goal::{Accuracy, Goal};
use super::super::outcome::Separation;
use super::adaptive_epsilon::epsilon;
use super::counter_random::CounterRandom;
use super::derivatives::{DerivativeGoal, Derivatives, NoDerivatives};
use super::moments::Moments;
use super::moved_pair::{MovedPair, Pair, moved, quantities, radius, size};
use crate::geometry::tolerance::{DEFAULT_RELATIVE_TOLERANCE, UNIT_ROUNDOFF};
use crate::geometry::{Placement, Vec3, length};

/// Separations in moved places are exact to this part of the moves, which is far below what chance leaves.
const EXACTNESS: f64 = 1e-6;

/// Moves that are fewer roundings of a coordinate than this tell nothing.
const FEWEST_ROUNDINGS: f64 = 1e4;

/// Smoothing of order zero.
pub(super) fn smoothed_places(
    pair: Pair,
    found: &Separation,
    goal: &DerivativeGoal,
    again: &Goal,
    all: &mut Derivatives,
) -> Result<(), NoDerivatives> {
    let size = size(pair.map(|(shape, _)| shape.bounds().map(radius)), found.signed_distance);
    let epsilon = epsilon(goal, size, found.signed_distance);
    let reach = epsilon * size;
    let accuracy = Accuracy { absolute: EXACTNESS * reach, relative: DEFAULT_RELATIVE_TOLERANCE };
    let places = MovedPair::new(pair, again, accuracy);
    let random = CounterRandom::new(goal.seed, goal.stream);
    let mut moments = Moments::<10, 12>::new();
    for sample in 0..goal.samples {
        let z = twelve_normals(&random, sample);
        let moved_by = |way: f64| {
            let body = |body: usize| {
                let part = |from: usize| Vec3::from_fn(|axis, _| z[6 * body + from + axis]) * way;
                moved(pair[body].1, part(0) * reach, part(3) * epsilon)
            };
            [body(0), body(1)]
        };
        let told = |[a, b]: &[Placement; 2]| places.ask([a, b]);
        let half = (quantities(&told(&moved_by(1.0))?) - quantities(&told(&moved_by(-1.0))?)) * 0.5;
        let per_unit = |column: usize| z[column] / if column % 6 < 3 { reach } else { epsilon };
        moments.add(&SMatrix::from_fn(|row, column| half[row] * per_unit(column)));
    }
    for column in 0..12 {
        all.set_quantities(column / 6, column % 6, &moments.mean().column(column).into_owned());
    }
    all.residual = moments.standard_error();
    all.epsilon = epsilon;
    all.samples = goal.samples;
    all.seed = goal.seed;
    let extent = pair.iter().fold(size, |extent, (_, at)| extent.max(length(at.translation)));
    let is_above_rounding = reach > FEWEST_ROUNDINGS * UNIT_ROUNDOFF * extent;
    all.is_valid = is_above_rounding && all.are_finite();
    all.cost.separations = 2 * u64::from(goal.samples);
    Ok(())
}

/// Six blocks of two.
fn twelve_normals(random: &CounterRandom, sample: u32) -> [f64; 12] {
    let mut z = [0.0; 12];
    for (block, two) in (0..).zip(z.chunks_exact_mut(2)) {
        two.copy_from_slice(&random.normals(sample, block));
    }
    z
}
