//! The exact solver's door: two placed convex shapes in, a bracket as narrow as doubles can say out.

use dashu_int::IBig;
use dashu_int::ops::BitTest;

use super::depth::{Depth, depth};
use super::integers::approximate;
use super::nearest::{Nearest, nearest, weights_of_origin};
use super::pair::{Corner, Frames, Pair};
use super::polytope::Polytope;
use super::root::Root;
use super::vector::Vector;
use std::f64::consts::PI;

use crate::geometry::Vec3;
use crate::narrow_phase::convex::Convex;
use crate::narrow_phase::goal::{self, Goal};
use crate::narrow_phase::outcome::{Bracket, Cost, Separation, Termination};
use crate::narrow_phase::support::radius;
use crate::narrow_phase::witness;

/// Rounding of a direction to doubles and its turn into the frame of both, radians.
const DIRECTION_ERROR: f64 = witness::WITNESS_ERROR_ULPS * f64::EPSILON;

/// The signed distance of two rounded polytopes, with a bracket whose ends are next to each other, or equal where the
/// distance is a double. An overlap is measured if the goal asks for it and only proved otherwise.
///
/// `toward` is a guess of the direction from A to B, in the frame of both placements.
///
/// None where no rational answer is to be had: one of the cores is curved, a placement is not known exactly, the numbers
/// differ so much in size that integers for them exceed 4096 bits, or the caller's time ran out.
pub(in crate::narrow_phase) fn separation(a: &Convex, b: &Convex, toward: Vec3, goal: &Goal) -> Option<Separation> {
    let (core_a, radius_a) = Polytope::of(a.core)?;
    let (core_b, radius_b) = Polytope::of(b.core)?;
    let frames = Frames::new(&a.given, &b.given, core_a.span.union(core_b.span))?;
    let mut pair = Pair::new(core_a, core_b, frames);
    let radii = [&a.given.radii()[..], &b.given.radii(), &[radius_a, radius_b]].concat();
    let toward = Vector::along(-a.at.direction_into(toward));

    let found = match nearest(&mut pair, &toward, goal.stop)? {
        Nearest::Outside(feature) => {
            let bracket = pair.metres(feature.distance()).less(&radii);
            let on_a = pair.mix_on_a(&feature.corners, &feature.weights);
            Found { bracket, direction: Some(feature.direction), on_a, normal_error: DIRECTION_ERROR, point_error: 0.0 }
        }
        Nearest::Inside(enclosing) if goal.depth == goal::Depth::Penetration => {
            match depth(&mut pair, enclosing.clone(), goal.stop)? {
                Depth::Solid { depth, outward, corners, weights } => {
                    let bracket = pair.metres(depth).less(&radii);
                    let on_a = pair.mix_on_a(&corners, &weights);
                    Found { bracket, direction: Some(outward.negated()), on_a, normal_error: PI, point_error: 0.0 }
                }
                Depth::Flat(across) => {
                    // Either side will do: the one the guess was on.
                    let across = if across.dot(&toward) < IBig::ZERO { across.negated() } else { across };
                    let direction = (!across.is_zero()).then_some(across);
                    let bracket = Root::zero().less(&radii);
                    Found {
                        bracket,
                        direction,
                        on_a: pair.shared_point(&enclosing),
                        normal_error: PI,
                        point_error: 0.0,
                    }
                }
            }
        }
        Nearest::Inside(enclosing) => {
            // Any direction bounds the depth from above.
            let height = toward.dot(&pair.lowest(&toward).w);
            let bound = Root {
                negative: true,
                numerator: &height * &height,
                denominator: toward.square().max(IBig::ONE),
                exponent: 0,
            };
            let lower = pair.metres(bound).less(&radii).lower;
            let bracket = Bracket { lower, upper: Root::zero().less(&radii).upper };
            // A shared point says nothing of the boundaries.
            let point_error = radius(a.core) + radius(b.core) + bracket.width();
            Found { bracket, direction: None, on_a: pair.shared_point(&enclosing), normal_error: PI, point_error }
        }
    };
    Some(found.placed(a, b, toward.unit(), pair.supports))
}

/// What is known in A's frame.
struct Found {
    bracket: Bracket,
    /// From the origin to the difference, where there is one.
    direction: Option<Vector>,
    /// Metres.
    on_a: Vec3,
    normal_error: f64,
    /// But for rounding, metres.
    point_error: f64,
}

impl Found {
    fn placed(self, a: &Convex, b: &Convex, guess: Vec3, supports: u64) -> Separation {
        let direction = self.direction.map_or(guess, |direction| direction.unit());
        let direction = if direction == Vec3::zeros() { Vec3::x() } else { direction };
        let signed_distance = self.bracket.lower + 0.5 * self.bracket.width();
        let normal = a.at.direction(-direction);
        let point_on_a = a.at.point(self.on_a) + normal * a.swept_radius;
        Separation {
            bracket: self.bracket,
            signed_distance,
            normal,
            point_on_a,
            point_on_b: point_on_a + normal * signed_distance,
            point_error: self.point_error + witness::rounding_of_points(a, b, signed_distance),
            normal_error: self.normal_error,
            termination: Termination::Exact,
            subshape_a: 0,
            subshape_b: 0,
            cost: Cost { pairs: 1, supports, ..Cost::default() },
        }
    }
}

impl Pair<'_> {
    /// A root of integer lengths in metres.
    fn metres(&self, root: Root) -> Root {
        let Frames { factor, exponent, .. } = &self.frames;
        Root { denominator: root.denominator * factor * factor, exponent: *exponent, ..root }
    }

    /// The point of A that the weights mix from the corners' points of A; metres, A's frame.
    fn mix_on_a(&self, corners: &[Corner], weights: &[IBig]) -> Vec3 {
        let bits = weights.iter().map(BitTest::bit_len).max().unwrap_or(0);
        let exponent = -i32::try_from(bits).unwrap_or(i32::MAX);
        let weights: Vec<f64> = weights.iter().map(|w| approximate(w, exponent)).collect();
        let sum: f64 = weights.iter().sum();
        corners.iter().zip(weights).map(|(corner, w)| self.a.corner(corner.a) * (w / sum)).sum()
    }

    /// A point of both: what mixes the origin from the corners mixes it from their points of A.
    fn shared_point(&self, enclosing: &[Corner]) -> Vec3 {
        self.mix_on_a(enclosing, &weights_of_origin(enclosing))
    }
}
