//! Polytopes of fixed directions as volumes of the tree (Klosowski and others, "Efficient collision detection using
//! bounding volume hierarchies of k-DOPs", 1998): an upright box with its edges, and perhaps its corners, cut off.
//!
//! A volume is an interval along each of `PAIRS` directions, so `2 PAIRS` planes. Two of them count as meeting if all
//! intervals meet. Points in common imply that; the reverse holds for three pairs only (an upright box), so with more some
//! pairs are reported whose polytopes are apart. No pair is reported that an upright box would not have reported.
//!
//! A bound is the intervals in `f32`, compared as in `aabb.rs`: lower ends and negated upper ends rounded down by one
//! monotone function, so that numbers decide without the `f64` volumes unless two of them are equal.

use std::ops::{Add, Mul};

use wide::f32x8;

use super::aabb::{LONGEST_SIDE, down, most_of, surely_below, surely_up_to};
use super::volume::{BoundingVolume, Growth, LANES, Meeting};
use crate::geometry::{Aabb, Vec3};

/// Three edges, six diagonals of faces, four diagonals of the cube; not normalised, so that products are exact.
const DIRECTIONS: [[f64; 3]; 13] = [
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [0.0, 1.0, 1.0],
    [0.0, 1.0, -1.0],
    [1.0, 0.0, 1.0],
    [-1.0, 0.0, 1.0],
    [1.0, 1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 1.0, 1.0],
    [1.0, 1.0, -1.0],
    [1.0, -1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

/// Pairs of the edges alone, and with the diagonals of faces.
const UPRIGHT: usize = 3;
const WITH_FACES: usize = 9;

/// Relative to the sum of a point's coordinates: twice what two additions can be off by.
const SUM_ERROR: f64 = 2.0 * f64::EPSILON;

/// Intervals along 3, 9 or 13 fixed directions: the axes, then the diagonals of faces, then those of the cube. Metres
/// times the length of the direction, which is 1, the root of 2, or the root of 3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KDop<const PAIRS: usize> {
    /// Lower ends.
    pub min: [f64; PAIRS],
    /// Upper ends.
    pub max: [f64; PAIRS],
}

/// The box with its edges cut off: eighteen planes.
pub type Dop18 = KDop<9>;

/// The box with edges and corners cut off: twenty-six planes.
pub type Dop26 = KDop<13>;

impl<const PAIRS: usize> KDop<PAIRS> {
    const KNOWN: () = assert!(PAIRS == UPRIGHT || PAIRS == WITH_FACES || PAIRS == DIRECTIONS.len());

    /// Around all `points`, metres; ends along diagonals are rounded outward. Without points it is empty, and no tree
    /// can hold it.
    #[must_use]
    pub fn around(points: impl IntoIterator<Item = Vec3>) -> Self {
        let () = Self::KNOWN;
        let mut dop = Self { min: [f64::INFINITY; PAIRS], max: [f64::NEG_INFINITY; PAIRS] };
        for p in points {
            for pair in 0..PAIRS {
                let (low, high) = along(pair, &p);
                dop.min[pair] = dop.min[pair].min(low);
                dop.max[pair] = dop.max[pair].max(high);
            }
        }
        dop
    }
}

impl<const PAIRS: usize> From<Aabb> for KDop<PAIRS> {
    /// Around the corners of a box that is not empty: as tight as the box, no tighter.
    fn from(aabb: Aabb) -> Self {
        let corner = |i: usize| {
            let end = |axis: usize| if i >> axis & 1 == 0 { aabb.min[axis] } else { aabb.max[axis] };
            Vec3::new(end(0), end(1), end(2))
        };
        Self::around((0..8).map(corner))
    }
}

/// What the product of a direction with a point is between.
fn along(pair: usize, p: &Vec3) -> (f64, f64) {
    let [x, y, z] = DIRECTIONS[pair];
    let product = x * p.x + y * p.y + z * p.z;
    if pair < UPRIGHT {
        return (product, product);
    }
    let error = SUM_ERROR * ((x * p.x).abs() + (y * p.y).abs() + (z * p.z).abs());
    (product - error, product + error)
}

/// Lower ends and negated upper ends, rounded down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DopBound<const PAIRS: usize> {
    pub(super) low: [f32; PAIRS],
    pub(super) high: [f32; PAIRS],
}

/// Eight of them by component.
#[derive(Clone, Debug)]
pub struct DopLanes<const PAIRS: usize> {
    low: [[f32; LANES]; PAIRS],
    high: [[f32; LANES]; PAIRS],
}

/// For each component of a bound (lower ends, then negated upper ones) the largest value with which it may still meet the
/// question, and with which it does.
#[derive(Clone, Copy, Debug)]
pub struct DopProbe<const PAIRS: usize> {
    most: [[f32; PAIRS]; 2],
    sure: [[f32; PAIRS]; 2],
}

/// Half the surface, and a little for the length, of the smallest of up to four boxes: those whose sides are intervals
/// of a polytope. Each holds the polytope, so no polytope within it costs more. `width` is that along a direction that is
/// not normalised.
#[inline(always)]
fn least_price<T: Copy + Add<Output = T> + Mul<Output = T>>(
    pairs: usize,
    width: impl Fn(usize) -> T,
    number: impl Fn(f32) -> T,
    lesser: impl Fn(T, T) -> T,
) -> T {
    let price = |x: T, y: T, z: T| {
        let sum = x + y + z;
        x * y + y * z + z * x + sum * sum * number(1.0 / 64.0)
    };
    let mut least = price(width(0), width(1), width(2));
    if pairs >= WITH_FACES {
        let shorter = number(std::f32::consts::FRAC_1_SQRT_2);
        for axis in 0..3 {
            // The axis and the two diagonals of the face across it.
            let first = UPRIGHT + 2 * axis;
            least = lesser(least, price(width(axis), width(first) * shorter, width(first + 1) * shorter));
        }
    }
    least
}

impl<const PAIRS: usize> BoundingVolume for KDop<PAIRS> {
    type Bound = DopBound<PAIRS>;
    type Lanes = DopLanes<PAIRS>;
    type Probe = DopProbe<PAIRS>;

    #[inline(always)]
    fn bound(&self) -> DopBound<PAIRS> {
        DopBound { low: self.min.map(down), high: self.max.map(|x| down(-x)) }
    }

    /// Whether the closed intervals meet along every direction: so it is whenever the volumes have a point in common.
    #[inline(always)]
    fn overlaps(&self, other: &Self) -> bool {
        (0..PAIRS).all(|i| self.min[i] <= other.max[i] && other.min[i] <= self.max[i])
    }

    #[inline(always)]
    fn probe(&self) -> DopProbe<PAIRS> {
        // Lower ends are held against the upper ones of the question, and the other way round.
        let most = [self.max.map(down), self.min.map(|x| down(-x))];
        DopProbe { most, sure: most.map(|side| side.map(surely_below)) }
    }

    #[inline(always)]
    fn probe_of(bound: &DopBound<PAIRS>) -> DopProbe<PAIRS> {
        let opposite = [bound.high, bound.low];
        let (most, sure) = (most_of, surely_up_to);
        DopProbe { most: opposite.map(|side| side.map(most)), sure: opposite.map(|side| side.map(sure)) }
    }

    #[inline(always)]
    fn nothing() -> DopBound<PAIRS> {
        DopBound { low: [f32::INFINITY; PAIRS], high: [f32::INFINITY; PAIRS] }
    }

    #[inline(always)]
    fn union(a: &DopBound<PAIRS>, b: &DopBound<PAIRS>) -> DopBound<PAIRS> {
        let lesser =
            |a: &[f32; PAIRS], b: &[f32; PAIRS]| std::array::from_fn(|i| if b[i] < a[i] { b[i] } else { a[i] });
        DopBound { low: lesser(&a.low, &b.low), high: lesser(&a.high, &b.high) }
    }

    #[inline(always)]
    fn holds(outer: &DopBound<PAIRS>, inner: &DopBound<PAIRS>) -> bool {
        (0..PAIRS).all(|i| outer.low[i] <= inner.low[i] && outer.high[i] <= inner.high[i])
    }

    #[inline(always)]
    fn cost(bound: &DopBound<PAIRS>) -> f32 {
        let width = |i: usize| (-bound.high[i] - bound.low[i]).min(LONGEST_SIDE);
        least_price(PAIRS, width, |x| x, f32::min)
    }

    /// Twice the centre of the box.
    #[inline(always)]
    fn centre(bound: &DopBound<PAIRS>) -> [f32; 3] {
        let middle = |axis: usize| (bound.low[axis] - bound.high[axis]).clamp(-f32::MAX, f32::MAX);
        [middle(0), middle(1), middle(2)].map(|x| if x.is_nan() { 0.0 } else { x })
    }

    #[inline(always)]
    fn no_lanes() -> DopLanes<PAIRS> {
        DopLanes { low: [[f32::INFINITY; LANES]; PAIRS], high: [[f32::INFINITY; LANES]; PAIRS] }
    }

    #[inline(always)]
    fn put(lanes: &mut DopLanes<PAIRS>, lane: usize, bound: &DopBound<PAIRS>) {
        for i in 0..PAIRS {
            lanes.low[i][lane] = bound.low[i];
            lanes.high[i][lane] = bound.high[i];
        }
    }

    #[inline(always)]
    fn clear(lanes: &mut DopLanes<PAIRS>, lane: usize) {
        Self::put(lanes, lane, &DopBound { low: [f32::INFINITY; PAIRS], high: [f32::INFINITY; PAIRS] });
    }

    #[inline(always)]
    fn get(lanes: &DopLanes<PAIRS>, lane: usize) -> DopBound<PAIRS> {
        DopBound { low: lanes.low.map(|of| of[lane]), high: lanes.high.map(|of| of[lane]) }
    }

    #[inline(always)]
    fn meeting(lanes: &DopLanes<PAIRS>, probe: &DopProbe<PAIRS>) -> Meeting {
        let mut within = f32x8::splat(f32::from_bits(u32::MAX));
        let mut surely = within;
        for i in 0..PAIRS {
            for (side, lane) in [lanes.low[i], lanes.high[i]].into_iter().enumerate() {
                let lane = f32x8::from(lane);
                within &= lane.simd_le(f32x8::splat(probe.most[side][i]));
                surely &= lane.simd_le(f32x8::splat(probe.sure[side][i]));
            }
        }
        Meeting { maybe: within.to_bitmask() as u8, surely: surely.to_bitmask() as u8 }
    }

    #[inline(always)]
    fn growth(lanes: &DopLanes<PAIRS>, _count: usize, bound: &DopBound<PAIRS>) -> Growth {
        let lesser = f32x8::fast_min;
        let longest = f32x8::splat(LONGEST_SIDE);
        let low = |i: usize| f32x8::from(lanes.low[i]);
        let high = |i: usize| f32x8::from(lanes.high[i]);
        let width = |low: f32x8, high: f32x8| lesser(-high - low, longest);
        let before = least_price(PAIRS, |i| width(low(i), high(i)), f32x8::splat, lesser);
        let after_of = |i: usize| {
            let joined = |own: f32x8, further: f32| lesser(own, f32x8::splat(further));
            width(joined(low(i), bound.low[i]), joined(high(i), bound.high[i]))
        };
        let after = least_price(PAIRS, after_of, f32x8::splat, lesser);
        Growth { after: after.to_array(), by: (after - before).to_array() }
    }
}
