//! The distance of two convex cores in double-doubles: GJK from the best direction that doubles found.
//!
//! As in doubles every direction asked about bounds the distance from below and the nearest point from above. An overlap is
//! proved by a tetrahedron around the origin, and not measured: a depth that doubles leave wide is no matter of digits.

use super::frames::Frames;
use super::number::DoubleDouble;
use super::simplex::{Feature, Nearest, Vertex, inner_ball};
use super::support::support;
use super::vector::Vector;
use super::wall::bracket;
use crate::geometry::Vec3;
use crate::narrow_phase::convex::Convex;
use crate::narrow_phase::goal::Goal;
use crate::narrow_phase::outcome::{Bracket, Cost, Separation, Termination};
use crate::narrow_phase::support::radius;
use crate::narrow_phase::witness;

/// Rounds at most. Smooth pairs need some 100 to use all digits.
const MAX_ROUNDS: u32 = 250;

/// The signed distance, as far as the goal asks and 106 bits tell. `toward` is a guess of the direction from A to B, in the
/// frame of both placements. None where a placement is not known exactly.
pub(in crate::narrow_phase) fn separation(a: &Convex, b: &Convex, toward: Vec3, goal: &Goal) -> Option<Separation> {
    let frames = Frames::new(&a.given, &b.given, radius(a.core) + radius(b.core))?;
    let radii = [a.given.radii(), b.given.radii()];
    let mut search = Search { a, b, frames, supports: 0 };
    let first = Vector::from(-a.at.direction_into(toward)).unit()?;
    let mut best = Best {
        lower: DoubleDouble::from(f64::NEG_INFINITY),
        upper: DoubleDouble::from(f64::INFINITY),
        direction: first,
        nearest: search.lowest(first),
    };
    best.raise(first, best.nearest);
    let mut feature = Feature::point(best.nearest);
    best.fall(feature.nearest());
    for _ in 0..MAX_ROUNDS {
        let known = bracket(&search.frames, best.lower, best.upper, &radii);
        if (goal.accuracy.is_met(&known) && goal.gives_a_verdict(&known)) || (goal.stop)() {
            break;
        }
        let Some(direction) = feature.direction() else { break };
        let lowest = search.lowest(direction);
        best.raise(direction, lowest);
        if feature.vertices.iter().any(|v| v.w == lowest.w) {
            break;
        }
        match feature.joined(lowest) {
            Nearest::Inside(vertices) => {
                if let Some(ball) = inner_ball(&vertices) {
                    best.upper = -ball;
                }
                break;
            }
            Nearest::Outside(nearer) => {
                let square = |w: Vector| w.dot(w);
                if !(square(nearer.nearest().w) < square(feature.nearest().w)) {
                    break;
                }
                feature = nearer;
                best.fall(feature.nearest());
            }
        }
    }
    let known = bracket(&search.frames, best.lower, best.upper, &radii);
    Some(best.placed(&search, known, goal))
}

struct Search<'a> {
    a: &'a Convex<'a>,
    b: &'a Convex<'a>,
    frames: Frames,
    supports: u64,
}

impl Search<'_> {
    /// The vertex of the scaled difference where `direction . w` is least.
    fn lowest(&mut self, direction: Vector) -> Vertex {
        self.supports += 1;
        let Frames { rotation, translation, scale, .. } = &self.frames;
        let on_a = support(self.a.core, -direction, *scale);
        let on_b = support(self.b.core, rotation.apply_transposed(direction), *scale);
        Vertex { w: on_a - (rotation.apply(on_b) + *translation), on_a }
    }
}

/// The best bounds of the scaled cores, each still off by the frames' error, and what they came from.
struct Best {
    lower: DoubleDouble,
    upper: DoubleDouble,
    direction: Vector,
    nearest: Vertex,
}

impl Best {
    fn raise(&mut self, direction: Vector, lowest: Vertex) {
        let value = direction.dot(lowest.w);
        if self.lower < value {
            (self.lower, self.direction) = (value, direction);
        }
    }

    fn fall(&mut self, nearest: Vertex) {
        let distance = nearest.w.norm();
        if distance < self.upper {
            (self.upper, self.nearest) = (distance, nearest);
        }
    }

    fn placed(&self, search: &Search, bracket: Bracket, goal: &Goal) -> Separation {
        let (a, b) = (search.a, search.b);
        let Frames { error, scale, .. } = search.frames;
        let (lower, upper) = (self.lower.to_f64() - error, self.upper.to_f64() + error);
        let signed_distance = bracket.lower + 0.5 * bracket.width();
        let normal = a.at.direction(-self.direction.rounded());
        let point_on_a = a.at.point(self.nearest.on_a.rounded() / scale) + normal * a.swept_radius;
        let distance = DoubleDouble::from((signed_distance + a.swept_radius + b.swept_radius) * scale);
        let short = (self.nearest.w - self.direction * distance).norm().to_f64();
        let from_nearest = witness::from_nearest(lower, upper);
        let normal_error = witness::normal_error(lower, from_nearest);
        let radii = (a.swept_radius + b.swept_radius) * normal_error.min(2.0);
        let rounding = witness::rounding_of_points(a, b, signed_distance);
        let met = goal.accuracy.is_met(&bracket);
        Separation {
            bracket,
            signed_distance,
            normal,
            point_on_a,
            point_on_b: point_on_a + normal * signed_distance,
            point_error: (short + from_nearest + 2.0 * error) / scale + radii + rounding,
            normal_error,
            termination: if met { Termination::Converged } else { Termination::RoundingFloor },
            subshape_a: 0,
            subshape_b: 0,
            cost: Cost { supports: search.supports, ..Cost::default() },
        }
    }
}
