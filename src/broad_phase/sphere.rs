//! Bounding spheres as volumes of the tree: the plainest ones, and what another volume may start from.
//!
//! A bound is a centre and a radius in `f32`. All comparisons go through `f64`, in which sums and products of them are
//! exact or nearly so, with a margin that is far above what rounding can do.

use super::aabb::down;
use super::volume::{BoundingVolume, LANES, Meeting};
use crate::geometry::Vec3;

/// A closed ball, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundingSphere {
    /// Where it is.
    pub center: Vec3,
    /// Not negative.
    pub radius: f64,
}

/// Comparisons of bounds err to the safe side by this much, relatively.
const SLACK: f64 = 1.0 + 1e-12;

/// Radii are cut to this, metres, where costs are taken, so that no cost overflows.
const LONGEST_RADIUS: f32 = 1e18;

/// Coordinates beyond this, metres, have a bound of infinite radius about the origin.
const FARTHEST: f64 = 1e37;

/// A ball of single precision. An infinite radius holds everything.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphereBound {
    center: [f32; 3],
    radius: f32,
}

impl SphereBound {
    const EVERYTHING: Self = Self { center: [0.0; 3], radius: f32::INFINITY };

    /// Holds every ball about `center` that reaches as far as `radius` beyond.
    fn around(center: [f64; 3], radius: f64) -> Self {
        if !(center.iter().all(|x| x.abs() < FARTHEST) && radius < FARTHEST) {
            return Self::EVERYTHING;
        }
        let rounded = center.map(|x| x as f32);
        let shift = distance(center, rounded.map(f64::from));
        Self { center: rounded, radius: -down(-(radius + shift) * SLACK) }
    }

    fn at(&self) -> [f64; 3] {
        self.center.map(f64::from)
    }

    fn reach(&self) -> f64 {
        f64::from(self.radius)
    }

    fn may_meet(&self, other: &Self) -> bool {
        distance(self.at(), other.at()) <= (self.reach() + other.reach()) * SLACK
    }
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    let [x, y, z] = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    (x * x + y * y + z * z).sqrt()
}

impl BoundingVolume for BoundingSphere {
    type Bound = SphereBound;
    type Lanes = [Option<SphereBound>; LANES];
    type Probe = SphereBound;

    fn bound(&self) -> SphereBound {
        SphereBound::around(self.center.into(), self.radius)
    }

    fn overlaps(&self, other: &Self) -> bool {
        (self.center - other.center).norm() <= self.radius + other.radius
    }

    fn probe(&self) -> SphereBound {
        self.bound()
    }

    fn probe_of(bound: &SphereBound) -> SphereBound {
        *bound
    }

    fn nothing() -> SphereBound {
        SphereBound { center: [0.0; 3], radius: f32::NEG_INFINITY }
    }

    /// The least ball about both, unless one holds the other.
    fn union(a: &SphereBound, b: &SphereBound) -> SphereBound {
        if Self::holds(a, b) {
            return *a;
        }
        if Self::holds(b, a) {
            return *b;
        }
        let (from, to) = (a.at(), b.at());
        let apart = distance(from, to);
        let radius = 0.5 * (apart + a.reach() + b.reach()) * SLACK;
        let part = if apart > 0.0 { ((radius - a.reach()) / apart).clamp(0.0, 1.0) } else { 0.0 };
        let center: [f64; 3] = std::array::from_fn(|axis| from[axis] + part * (to[axis] - from[axis]));
        // The centre was rounded on the way: both are held whatever it became.
        let needed = (distance(center, from) + a.reach()).max(distance(center, to) + b.reach());
        SphereBound::around(center, needed * SLACK)
    }

    fn holds(outer: &SphereBound, inner: &SphereBound) -> bool {
        outer == inner || outer.radius == f32::INFINITY || {
            (distance(outer.at(), inner.at()) + inner.reach()) * SLACK <= outer.reach()
        }
    }

    fn cost(bound: &SphereBound) -> f32 {
        let radius = bound.radius.min(LONGEST_RADIUS);
        radius * radius
    }

    fn centre(bound: &SphereBound) -> [f32; 3] {
        bound.center
    }

    fn no_lanes() -> Self::Lanes {
        [None; LANES]
    }

    fn put(lanes: &mut Self::Lanes, lane: usize, bound: &SphereBound) {
        lanes[lane] = Some(*bound);
    }

    fn clear(lanes: &mut Self::Lanes, lane: usize) {
        lanes[lane] = None;
    }

    fn get(lanes: &Self::Lanes, lane: usize) -> SphereBound {
        lanes[lane].unwrap_or(SphereBound::EVERYTHING)
    }

    fn meeting(lanes: &Self::Lanes, probe: &SphereBound) -> Meeting {
        let meets = |lane: usize| lanes[lane].is_some_and(|bound| bound.may_meet(probe));
        let maybe = (0..LANES).fold(0, |mask, lane| mask | u8::from(meets(lane)) << lane);
        Meeting { maybe, surely: 0 }
    }
}
