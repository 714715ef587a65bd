//! For how long does a plane that parts two moving elements now go on parting them?
//!
//! Along a fixed unit vector n the gap of two bodies is m(s) = min n . (b - a), and the signed distance is never less. A point at x
//! from its body's origin has moved after a time s by s (v + w x x), and by no more than s^2 |w|^2 |x| / 2 beside that; so
//!
//! ```text
//! m(s) >= n . (p + s v) + min (n + s n x w_B) . x_B - max (n + s n x w_A) . x_A - s^2 (|w_A|^2 r_A + |w_B|^2 r_B) / 2
//! ```
//!
//! with one support value for each body. The right-hand side is concave in s: where it is positive at both ends of a stretch of time, the
//! bodies are apart in all of it, and a chord under it shows how long they are. Without rotation it is a straight line and
//! exact, and this is the ray cast of van den Bergen (2004); with rotation it is conservative advancement (Mirtich 1996)
//! with the second order taken along, so that it converges like Newton's method. `docs/derivations/advancement.md` has the rounding.

use super::approach::{Approach, Instant};
use super::element::Element;
use super::support::{support, unit};
use crate::geometry::tolerance::{SUPPORT_ERROR_ULPS, UNIT_ROUNDOFF};
use crate::geometry::vector::opposite;
use crate::geometry::{Placement, Vec3, length};

/// Errors of support values are taken with this many units of roundoff: those of a bracket, and what is summed up here.
const VALUE_ERROR_ULPS: f64 = SUPPORT_ERROR_ULPS + 32.0;

/// Looks ahead from the right end, at most, before the chord decides.
const LOOKS: usize = 3;

/// How two elements part along one direction, from now on.
pub(super) struct Forecast<'a> {
    sides: [Side<'a>; 2],
    /// From A to B, unit length.
    normal: Vec3,
    /// From A's origin to B's now, and what B gains until the end; metres.
    between: Vec3,
    gain: Vec3,
    /// Swept radii, metres.
    radii: f64,
    /// Height of a wall over its body's origin, along `normal` from A to B; metres.
    wall: f64,
    /// What the height of a wall that turns may change by, metres in the whole motion.
    sway: f64,
    /// Roundings that do not depend on the time looked at, metres.
    error: f64,
}

struct Side<'a> {
    /// None for a wall.
    convex: Option<(&'a Element<'a>, Placement)>,
    /// The body's origin, with A's origin as that of the frame; metres.
    origin: Vec3,
    turn: Vec3,
    reach: f64,
}

/// The bound at some time, and its slope there.
struct Value {
    gap: f64,
    slope: f64,
}

impl<'a> Forecast<'a> {
    /// `normal`: any direction from A to B; one that parts them well now forecasts best. Against a wall the wall's own
    /// is taken. None where there is no direction, or where both are walls.
    pub fn new(
        a: &'a Element<'a>,
        b: &'a Element<'a>,
        approach: &Approach,
        now: &Instant,
        reaches: [f64; 2],
        normal: Vec3,
    ) -> Option<Self> {
        let mut normal = unit(normal)?;
        let mut sway = 0.0;
        let mut wall = 0.0;
        let mut error = 0.0;
        let turns = approach.turns();
        let side = |element: &'a Element<'a>, index: usize| {
            let body = &now.at[index];
            let (at, composing) = element.placed(body);
            let convex = element.plane().is_none().then_some((element, at));
            let reach = reaches[index];
            let off = 2.0 * now.turn_errors[index] * reach + composing;
            (Side { convex, origin: body.translation, turn: turns[index], reach }, off)
        };
        let ((side_a, off_a), (side_b, off_b)) = (side(a, 0), side(b, 1));
        if a.plane().is_some() && b.plane().is_some() {
            return None;
        }
        for (element, index) in [(a, 0), (b, 1)] {
            let Some((own_normal, offset, thin)) = element.plane() else { continue };
            // Both are divided by the largest component first, so that normals of extreme length neither over- nor underflow.
            let largest = own_normal.amax();
            let direction = own_normal / largest;
            let own_unit = direction.normalize();
            let (at, _) = element.placed(&now.at[index]);
            let up = at.direction(own_unit);
            let height = offset / largest / direction.dot(&own_unit);
            // From A to B: up from a wall A, down to a wall B; of a plane, on the side that was asked about.
            let outwards = if index == 0 { 1.0 } else { -1.0 };
            let side = if thin && normal.dot(&up) * outwards < 0.0 { -1.0 } else { 1.0 };
            normal = up * (side * outwards);
            // Along `normal`: of a wall A its surface is at side * height, and of a wall B it is at minus that.
            wall = -side * height;
            sway = length(turns[index]) * reaches[index] * (1.0 + 16.0 * UNIT_ROUNDOFF);
            error += VALUE_ERROR_ULPS * UNIT_ROUNDOFF * (height.abs() + reaches[index]);
        }
        let radii = (a.swept_radius + b.swept_radius) * (1.0 + 16.0 * UNIT_ROUNDOFF);
        error += off_a + off_b + 2.0 * now.drift;
        let between = now.at[1].translation;
        Some(Self { sides: [side_a, side_b], normal, between, gain: approach.gain, radii, wall, sway, error })
    }

    /// The bound after `time` of the whole motion, rounded down, metres.
    fn value(&self, time: f64) -> Value {
        let n = self.normal;
        let mut gap = n.dot(&(self.between + self.gain * time)) + self.wall - self.radii - self.sway * time;
        let mut slope = n.dot(&self.gain) - self.sway;
        let mut rounding = length(self.between) + time * length(self.gain) + self.radii + self.wall.abs();
        for (side, sign) in self.sides.iter().zip([-1.0, 1.0]) {
            let Some((element, at)) = &side.convex else { continue };
            let turned = n.cross(&side.turn);
            let direction = n + turned * time;
            // The lowest of B, the highest of A.
            let local = at.direction_into(if sign > 0.0 { opposite(direction) } else { direction });
            let x = at.point(support(element.core(), local)) - side.origin;
            let rate = side.turn.norm_squared() * side.reach;
            let curve = 0.5 * time * time * rate * (1.0 + 32.0 * UNIT_ROUNDOFF);
            gap += sign * direction.dot(&x) - curve;
            slope += sign * turned.dot(&x) - time * rate;
            let size = 1.0 + time * length(side.turn);
            rounding += size * (side.reach + length(side.origin));
        }
        let scale = 1.0 + self.sides.iter().map(|side| time * length(side.turn)).fold(0.0, f64::max);
        gap -= VALUE_ERROR_ULPS * UNIT_ROUNDOFF * rounding + self.error * scale;
        Value { gap, slope }
    }

    /// How fast the gap closes now, metres in the whole motion; negative when it widens.
    pub fn closing(&self) -> f64 {
        -self.value(0.0).slope
    }

    /// What the bound is short of the truth now by rounding alone, metres: no gap below a few of these can be told.
    pub fn noise(&self) -> f64 {
        let reaches: f64 = self.sides.iter().map(|side| side.reach + length(side.origin)).sum();
        let rounding = length(self.between) + self.radii + self.wall.abs() + reaches;
        VALUE_ERROR_ULPS * UNIT_ROUNDOFF * rounding + self.error
    }

    /// For how long from now, at most `rest`, the elements are proved to stay apart by this plane. A little of the gap is left, so that
    /// the next plane has something to go by. Zero where it does not part them now.
    pub fn free_for(&self, rest: f64) -> f64 {
        let left = 4.0 * self.noise();
        let now = self.value(0.0).gap;
        if !(now > 0.0) {
            return 0.0;
        }
        let end = self.value(rest);
        if end.gap > 0.0 {
            return rest;
        }
        let left = left.min(0.25 * now);
        let (now, mut right, mut at_right) = (now - left, rest, end);
        for _ in 0..LOOKS {
            if !(at_right.slope < 0.0) {
                break;
            }
            // The tangent lies over a concave curve, so that it meets zero no earlier.
            let next = right - (at_right.gap - left) / at_right.slope;
            if !(next > 0.0 && next < right) {
                break;
            }
            let value = self.value(next);
            if value.gap > 0.0 {
                return next;
            }
            (right, at_right) = (next, value);
        }
        let chord = right * (now / (now - (at_right.gap - left))) * (1.0 - 8.0 * UNIT_ROUNDOFF);
        // Numbers beyond all bounds say nothing.
        if chord > 0.0 { chord } else { 0.0 }
    }
}
