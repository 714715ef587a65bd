//! Axis-aligned boxes as volumes of the tree: the lanes that nearly every question goes through.
//!
//! A bound is six numbers in `f32`: the least corner and the negated greatest one, each rounded down by the same monotone
//! function. So a union is a minimum, and two boxes meet exactly if each of six numbers of the one is at most one of the
//! other. Since rounding is monotone, `a <= b` implies `down(a) <= down(b)`, and `down(a) < down(b)` implies `a < b`: a
//! comparison of rounded numbers never misses an overlap, and is decided without the `f64` boxes unless two are equal.
//! Of two bounds only (when entries are held against each other) it is, unless two are equal but for the rounding.
//! Whatever lies beyond the range of `f32` becomes infinite on the outer side and the largest number on the inner one.

use wide::f32x8;

use super::volume::{BoundingVolume, Growth, LANES, Meeting};
use crate::geometry::Aabb;

/// Sides are cut to this, metres, where costs are taken, so that no cost overflows. Order among larger boxes is lost,
/// not correctness.
pub(super) const LONGEST_SIDE: f32 = 1e18;

/// The part of a number that [`down`] takes off before rounding to nearest, a little more than half a unit in the last
/// place.
const DOWN: f64 = (1.0 + 1.0 / 1_048_576.0) / 16_777_216.0;

/// Least positive number of `f32`: what is taken off where numbers are so small that the unit in the last place is fixed.
const LEAST: f64 = f32::from_bits(1) as f64;

/// Least corner and negated greatest corner, rounded down; then two zeros.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoxBound(pub(super) [f32; 8]);

/// Eight box bounds by component.
#[derive(Clone, Debug)]
pub struct BoxLanes(pub(super) [[f32; LANES]; 6]);

/// For each component of a bound the largest value with which it may still meet the question, and with which it does.
#[derive(Clone, Copy, Debug)]
pub struct BoxProbe {
    most: [f32; 6],
    sure: [f32; 6],
}

/// At most `x`, by two units in the last place of `f32` at the most; monotone.
#[inline(always)]
pub(super) fn down(x: f64) -> f32 {
    ((x - (x.abs() * DOWN + LEAST)) as f32).min(f32::MAX)
}

/// What may meet something, one of whose components is `opposite`, is at most this in the component across. No lane but
/// an empty one is above the largest number.
#[inline(always)]
pub(super) fn most_of(opposite: f32) -> f32 {
    (-opposite).min(f32::MAX)
}

/// A component up to this is less than `most`: before rounding too.
#[inline(always)]
pub(super) fn surely_below(most: f32) -> f32 {
    if most == f32::NEG_INFINITY { f32::NAN } else { most.next_down() }
}

/// A component up to this surely is, before rounding, at most the one across that was rounded to `opposite`.
///
/// `down` takes off at most `k |y| + 2 LEAST` from what becomes `y`, where `k` is little more than 2^-23. For a lane's `l`
/// and the number `m` across, `-opposite`, it is enough that `l + k |l| + 2 LEAST <= m - k |m| - 2 LEAST`, and the left
/// side grows with `l`: `l <= m - 7 * 2^-23 |m| - 14 LEAST` will do. Where `m` may stand for any number beyond the range,
/// nothing is sure.
#[inline(always)]
pub(super) fn surely_up_to(opposite: f32) -> f32 {
    const SLACK: f32 = 1.0 / 1_048_576.0;
    let most = most_of(opposite);
    let sure = most - (most.abs() * SLACK + 16.0 * LEAST as f32);
    if sure < -f32::MAX { f32::NAN } else { sure }
}

#[inline(always)]
fn rounded(aabb: &Aabb) -> [f32; 6] {
    let Aabb { min, max } = aabb;
    [down(min.x), down(min.y), down(min.z), down(-max.x), down(-max.y), down(-max.z)]
}

#[inline(always)]
pub(super) fn price(x: f32, y: f32, z: f32) -> f32 {
    let sum = x + y + z;
    x * y + y * z + z * x + sum * sum * (1.0 / 64.0)
}

impl BoundingVolume for Aabb {
    type Bound = BoxBound;
    type Lanes = BoxLanes;
    type Probe = BoxProbe;

    #[inline(always)]
    fn bound(&self) -> BoxBound {
        let [a, b, c, d, e, f] = rounded(self);
        BoxBound([a, b, c, d, e, f, 0.0, 0.0])
    }

    #[inline(always)]
    fn overlaps(&self, other: &Self) -> bool {
        Aabb::overlaps(self, other)
    }

    #[inline(always)]
    fn probe(&self) -> BoxProbe {
        // The least corner of a lane is held against the greatest of the question, and the other way round.
        let most = rounded(&Aabb { min: self.max, max: self.min });
        BoxProbe { most, sure: most.map(surely_below) }
    }

    #[inline(always)]
    fn probe_of(bound: &BoxBound) -> BoxProbe {
        let [a, b, c, d, e, f, ..] = bound.0;
        let (most, sure) = (most_of, surely_up_to);
        let opposite = [d, e, f, a, b, c];
        BoxProbe { most: opposite.map(most), sure: opposite.map(sure) }
    }

    #[inline(always)]
    fn nothing() -> BoxBound {
        BoxBound([f32::INFINITY; 8])
    }

    #[inline(always)]
    fn union(a: &BoxBound, b: &BoxBound) -> BoxBound {
        BoxBound(f32x8::from(a.0).fast_min(f32x8::from(b.0)).to_array())
    }

    #[inline(always)]
    fn holds(outer: &BoxBound, inner: &BoxBound) -> bool {
        f32x8::from(outer.0).simd_le(f32x8::from(inner.0)).all()
    }

    /// Half the surface, and a little for the length, so that lines and points are told apart too.
    #[inline(always)]
    fn cost(bound: &BoxBound) -> f32 {
        let side = |axis: usize| (-bound.0[axis + 3] - bound.0[axis]).min(LONGEST_SIDE);
        price(side(0), side(1), side(2))
    }

    /// Twice the centre.
    #[inline(always)]
    fn centre(bound: &BoxBound) -> [f32; 3] {
        let middle = |axis: usize| (bound.0[axis] - bound.0[axis + 3]).clamp(-f32::MAX, f32::MAX);
        [middle(0), middle(1), middle(2)].map(|x| if x.is_nan() { 0.0 } else { x })
    }

    #[inline(always)]
    fn no_lanes() -> BoxLanes {
        BoxLanes([[f32::INFINITY; LANES]; 6])
    }

    #[inline(always)]
    fn put(lanes: &mut BoxLanes, lane: usize, bound: &BoxBound) {
        for component in 0..6 {
            lanes.0[component][lane] = bound.0[component];
        }
    }

    #[inline(always)]
    fn clear(lanes: &mut BoxLanes, lane: usize) {
        Self::put(lanes, lane, &BoxBound([f32::INFINITY; 8]));
    }

    #[inline(always)]
    fn get(lanes: &BoxLanes, lane: usize) -> BoxBound {
        let all = &lanes.0;
        BoxBound([all[0][lane], all[1][lane], all[2][lane], all[3][lane], all[4][lane], all[5][lane], 0.0, 0.0])
    }

    #[inline(always)]
    fn joined(lanes: &BoxLanes, _count: usize) -> BoxBound {
        let [a, b, c, d, e, f] = lanes.0.map(f32x8::from);
        let zero = f32x8::ZERO;
        let by_lane = f32x8::transpose([a, b, c, d, e, f, zero, zero]);
        let [a, b, c, d, e, f, g, h] = by_lane;
        let least = a.fast_min(b).fast_min(c.fast_min(d)).fast_min(e.fast_min(f).fast_min(g.fast_min(h)));
        BoxBound(least.to_array())
    }

    #[inline(always)]
    fn meeting(lanes: &BoxLanes, probe: &BoxProbe) -> Meeting {
        let mut within = f32x8::splat(f32::from_bits(u32::MAX));
        let mut surely = within;
        for component in 0..6 {
            let lane = f32x8::from(lanes.0[component]);
            within &= lane.simd_le(f32x8::splat(probe.most[component]));
            surely &= lane.simd_le(f32x8::splat(probe.sure[component]));
        }
        Meeting { maybe: within.to_bitmask() as u8, surely: surely.to_bitmask() as u8 }
    }

    #[inline(always)]
    fn growth(lanes: &BoxLanes, _count: usize, bound: &BoxBound) -> Growth {
        let all = lanes.0.map(f32x8::from);
        let longest = f32x8::splat(LONGEST_SIDE);
        let price = |low: [f32x8; 6]| {
            let side = |axis: usize| (-low[axis + 3] - low[axis]).fast_min(longest);
            let (x, y, z) = (side(0), side(1), side(2));
            let sum = x + y + z;
            x * y + y * z + z * x + sum * sum * f32x8::splat(1.0 / 64.0)
        };
        let joined: [f32x8; 6] = std::array::from_fn(|i| all[i].fast_min(f32x8::splat(bound.0[i])));
        let after = price(joined);
        Growth { after: after.to_array(), by: (after - price(all)).to_array() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers of all scales, next to each other and to the ends of `f32`: where rounding makes two equal, or infinite.
    fn numbers() -> Vec<f64> {
        let far = f64::from(f32::MAX);
        let places = [
            0.0,
            f64::MIN_POSITIVE,
            LEAST / 2.0,
            LEAST,
            1e-40,
            1e-38,
            1e-3,
            1.0,
            16_777_217.0,
            1e30,
            far,
            1e39,
            f64::MAX,
        ];
        let near = |x: f64| [0.0, 1e-17, 3e-8, 6e-8, 1.2e-7, 2.4e-7, 1e-6, 2e-6, 1e-5].map(|by| x * (1.0 - by));
        let near: Vec<f64> = places.into_iter().flat_map(near).flat_map(|x| [x, x.next_up().min(f64::MAX)]).collect();
        near.iter().flat_map(|x| [*x, -x]).collect()
    }

    /// Oracle: the numbers before rounding.
    #[test]
    fn what_rounded_numbers_say_for_sure_holds_for_the_numbers_themselves() {
        let (mut sure_of_volumes, mut sure_of_bounds, mut unsure) = (0, 0, 0);
        for a in numbers() {
            for b in numbers() {
                let (low, opposite) = (down(a), down(-b));
                assert!(a > b || low <= down(b) && low <= most_of(opposite), "{a:e} and {b:e} are lost");
                let by_volume = low <= surely_below(down(b));
                let by_bound = low <= surely_up_to(opposite);
                assert!(a <= b || !(by_volume || by_bound), "{a:e} is not at most {b:e}");
                sure_of_volumes += usize::from(by_volume);
                sure_of_bounds += usize::from(by_bound);
                unsure += usize::from(a <= b && !by_bound);
            }
        }
        assert!(sure_of_volumes > sure_of_bounds && sure_of_bounds > unsure && unsure > 100);
    }
}
