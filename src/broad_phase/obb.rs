//! Turned boxes as volumes of the tree (Gottschalk, Lin, Manocha, "OBBTree", 1996): tight around what is long and askew.
//!
//! A volume is a box of `geometry`, in `f64`. A bound is one in `f32`: centre, half extents and axes, the eight of a node
//! side by side. Axes rounded to `f32` are orthonormal to about 1e-7 only, so a bound is the set `center + axes * x`,
//! `|x_i| <= half_i` with the axes as they are stored, and comparisons allow for the skew: see the constants. In `f64`
//! the eight would be twice as large and compared half as fast, and the slack is below what the tree can notice.
//!
//! Two boxes are apart if a face normal of either or a product of two edges shows a gap: fifteen axes. Products are not
//! normalised, so every term is linear in lengths and nothing overflows; where two edges are nearly parallel their product
//! nearly vanishes and shows no gap, and then a face normal shows what there is.

use wide::f32x8;

use super::aabb::{LONGEST_SIDE, down, price};
use super::volume::{BoundingVolume, LANES, Meeting};
use crate::geometry::{Mat3, OrientedBox, Vec3};

/// All slacks here are relative to this size of a pair: the distance between the centres and all half extents, each
/// summed over components.
///
/// Two boxes of `f64` count as meeting while no axis shows a gap beyond this share of their size, 256 roundings. The skew
/// of 16 roundings that a box may have, the products and the sums come to some 100. So boxes that share a point always
/// meet; boxes that are apart by less may.
const VOLUME_SLACK: f64 = 256.0 * f64::EPSILON / 2.0;

/// The same for bounds. The skew of their axes and the roundings come to 3e-6. The rest is for what the tree must not
/// miss: with edges at an angle s, boxes count as meeting although a gap of `VOLUME_SLACK / s` is between them, but a face
/// normal shows that gap to within s. The worst s, the root of the slack, makes it 2e-7 of the size; it is below ten times
/// that when seen from larger bounds around the boxes.
const BOUND_SLACK: f32 = 1.0 / 32_768.0;

/// Sizes where `f32` is no longer relative.
const LEAST_GAP: f32 = 1e-35;

/// How much more than its extent along the stored axes a box needs to be held: thrice their skew.
const SKEW: f64 = 1e-6;

/// How much more a union takes. What a union holds, and what that holds in turn, is then known to be held: the size of a
/// box within another is, from anywhere, at most five times the other's.
const UNION_SKEW: f64 = 16.0 * SKEW;

/// Coordinates beyond this, metres, have a bound that holds everything.
const FARTHEST: f64 = 1e36;

/// A turned box in single precision. Infinite half extents hold everything.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObbBound {
    pub(super) center: [f32; 3],
    pub(super) half_extents: [f32; 3],
    /// Unit vectors along the edges.
    pub(super) axes: [[f32; 3]; 3],
}

/// Eight turned boxes by component.
#[derive(Clone, Debug)]
pub struct ObbLanes {
    center: [[f32; LANES]; 3],
    half_extents: [[f32; LANES]; 3],
    axes: [[[f32; LANES]; 3]; 3],
    /// Lanes that are not empty, a bit each.
    held: u8,
}

const UPRIGHT: [[f32; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

impl ObbBound {
    const NOTHING: Self = Self { center: [0.0; 3], half_extents: [f32::NEG_INFINITY; 3], axes: UPRIGHT };

    pub(super) const EVERYTHING: Self = Self { center: [0.0; 3], half_extents: [f32::INFINITY; 3], axes: UPRIGHT };

    /// The numbers as they are, for exact products.
    fn widened(&self) -> OrientedBox {
        let vector = |x: [f32; 3]| Vec3::from(x.map(f64::from));
        OrientedBox {
            center: vector(self.center),
            axes: Mat3::from_columns(&self.axes.map(vector)),
            half_extents: vector(self.half_extents),
        }
    }

    /// Holds all the boxes, along these axes.
    fn along<const N: usize>(axes: [[f32; 3]; 3], boxes: &[OrientedBox; N], skew: f64) -> Self {
        let frame = Self { axes, ..Self::EVERYTHING }.widened().axes;
        // From the first box on, so that the place in the world does not matter.
        let origin = boxes[0].center;
        let (mut low, mut high) = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
        for inner in boxes {
            let (at, reach) = (frame.tr_mul(&(inner.center - origin)), extents(&frame, inner));
            (low, high) = (low.inf(&(at - reach)), high.sup(&(at + reach)));
        }
        let middle = origin + frame * (0.5 * low + 0.5 * high);
        if !(middle.amax() < FARTHEST && (high - low).amax() < FARTHEST) {
            return Self::EVERYTHING;
        }
        let center = [middle.x as f32, middle.y as f32, middle.z as f32];
        // Measured from the centre as it is stored: all are held, whatever it became.
        let stored = Vec3::from(center.map(f64::from));
        let half = boxes.iter().fold(Vec3::zeros(), |half: Vec3, inner| half.sup(&needed(&frame, stored, inner, skew)));
        Self { center, half_extents: [half.x, half.y, half.z].map(|half| -down(-half)), axes }
    }

    fn holds(&self, inner: &Self, skew: f64) -> bool {
        let outer = self.widened();
        let needed = needed(&outer.axes, outer.center, &inner.widened(), skew);
        (0..3).all(|i| needed[i] <= outer.half_extents[i])
    }
}

/// How far a box reaches from its centre along the columns of `frame`.
fn extents(frame: &Mat3, inner: &OrientedBox) -> Vec3 {
    frame.tr_mul(&inner.axes).abs() * inner.half_extents
}

/// Half extents that a box about `center` needs along the columns of `frame` to hold `inner`, skew included.
fn needed(frame: &Mat3, center: Vec3, inner: &OrientedBox, skew: f64) -> Vec3 {
    let apart = inner.center - center;
    let size = sum(apart.abs()) + sum(inner.half_extents);
    (frame.tr_mul(&apart).abs() + extents(frame, inner)).add_scalar(skew * size)
}

fn sum(x: Vec3) -> f64 {
    x.x + x.y + x.z
}

impl BoundingVolume for OrientedBox {
    type Bound = ObbBound;
    type Lanes = ObbLanes;
    type Probe = ObbBound;

    fn bound(&self) -> ObbBound {
        let axis = |k: usize| [0, 1, 2].map(|i| self.axes[(i, k)] as f32);
        ObbBound::along([axis(0), axis(1), axis(2)], &[*self], SKEW)
    }

    /// Whether none of the fifteen axes shows a gap beyond 256 roundings of the pair's size. The same bits either way
    /// round: each number that is compared is a sum or product of the same numbers in the same order for both.
    fn overlaps(&self, other: &Self) -> bool {
        let (a, b) = (&self.half_extents, &other.half_extents);
        let apart = other.center - self.center;
        let slack = VOLUME_SLACK * (sum(apart.abs()) + (sum(*a) + sum(*b))) + f64::MIN_POSITIVE;
        let turn = self.axes.tr_mul(&other.axes).abs();
        let gap = |along: f64, reach: f64| along.abs() > reach + slack;
        let faces = |i: usize| {
            let of_other = turn[(i, 0)] * b[0] + turn[(i, 1)] * b[1] + turn[(i, 2)] * b[2];
            let of_self = turn[(0, i)] * a[0] + turn[(1, i)] * a[1] + turn[(2, i)] * a[2];
            gap(self.axes.column(i).dot(&apart), a[i] + of_other)
                || gap(other.axes.column(i).dot(&apart), b[i] + of_self)
        };
        let edges = |i: usize, j: usize| {
            let ((k, l), (m, n)) = (others(i), others(j));
            let axis = self.axes.column(i).cross(&other.axes.column(j));
            let of_self = a[k] * turn[(l, j)] + a[l] * turn[(k, j)];
            let of_other = b[m] * turn[(i, n)] + b[n] * turn[(i, m)];
            gap(axis.dot(&apart), of_self + of_other)
        };
        !((0..3).any(faces) || (0..3).any(|i| (0..3).any(|j| edges(i, j))))
    }

    fn probe(&self) -> ObbBound {
        self.bound()
    }

    fn probe_of(bound: &ObbBound) -> ObbBound {
        *bound
    }

    /// Along the axes of the one, of the other, or of the world, whichever has the least cost: a large box keeps its axes
    /// when it takes in a small one, boxes turned alike stay so, and those turned in every way are no worse off than
    /// upright boxes around them. Gottschalk's fit to points has none here: a bound knows no points.
    fn nothing() -> ObbBound {
        ObbBound::NOTHING
    }

    fn union(a: &ObbBound, b: &ObbBound) -> ObbBound {
        if *b == ObbBound::NOTHING {
            return *a;
        }
        if *a == ObbBound::NOTHING {
            return *b;
        }
        if a == b || *a == ObbBound::EVERYTHING || a.holds(b, UNION_SKEW) {
            return *a;
        }
        if *b == ObbBound::EVERYTHING || b.holds(a, UNION_SKEW) {
            return *b;
        }
        let both = [a.widened(), b.widened()];
        let candidates = [b.axes, UPRIGHT].map(|axes| ObbBound::along(axes, &both, UNION_SKEW));
        candidates.into_iter().fold(ObbBound::along(a.axes, &both, UNION_SKEW), |best, next| {
            if Self::cost(&next) < Self::cost(&best) { next } else { best }
        })
    }

    fn holds(outer: &ObbBound, inner: &ObbBound) -> bool {
        outer == inner || *outer == ObbBound::EVERYTHING || outer.holds(inner, SKEW)
    }

    /// That of an upright box. Surface and sum of sides (twice the mean width) of a box within another are no larger,
    /// however it is turned.
    fn cost(bound: &ObbBound) -> f32 {
        let [x, y, z] = bound.half_extents.map(|half| (2.0 * half).min(LONGEST_SIDE));
        price(x, y, z)
    }

    fn centre(bound: &ObbBound) -> [f32; 3] {
        bound.center
    }

    fn no_lanes() -> ObbLanes {
        ObbLanes { center: [[0.0; LANES]; 3], half_extents: [[0.0; LANES]; 3], axes: [[[0.0; LANES]; 3]; 3], held: 0 }
    }

    fn put(lanes: &mut ObbLanes, lane: usize, bound: &ObbBound) {
        for i in 0..3 {
            lanes.center[i][lane] = bound.center[i];
            lanes.half_extents[i][lane] = bound.half_extents[i];
            for k in 0..3 {
                lanes.axes[i][k][lane] = bound.axes[i][k];
            }
        }
        lanes.held |= 1 << lane;
    }

    fn clear(lanes: &mut ObbLanes, lane: usize) {
        lanes.held &= !(1 << lane);
    }

    fn get(lanes: &ObbLanes, lane: usize) -> ObbBound {
        let vector = |components: &[[f32; LANES]; 3]| [components[0][lane], components[1][lane], components[2][lane]];
        ObbBound {
            center: vector(&lanes.center),
            half_extents: vector(&lanes.half_extents),
            axes: [vector(&lanes.axes[0]), vector(&lanes.axes[1]), vector(&lanes.axes[2])],
        }
    }

    fn meeting(lanes: &ObbLanes, probe: &ObbBound) -> Meeting {
        let apart = apart(lanes, probe);
        Meeting { maybe: lanes.held & !apart, surely: 0 }
    }
}

/// Which lanes an axis shows a gap for, in terms of the lane's own frame. A comparison with what is infinite or not a
/// number, from a bound that holds everything, shows none.
#[inline(always)]
fn apart(lanes: &ObbLanes, probe: &ObbBound) -> u8 {
    let splat = |x: [f32; 3]| x.map(f32x8::splat);
    let (centers, a) = (lanes.center.map(f32x8::from), lanes.half_extents.map(f32x8::from));
    let (b, at) = (splat(probe.half_extents), splat(probe.center));
    let d: [f32x8; 3] = std::array::from_fn(|i| at[i] - centers[i]);
    let own: [[f32x8; 3]; 3] = lanes.axes.map(|axis| axis.map(f32x8::from));
    let their = probe.axes.map(splat);
    let dot = |x: &[f32x8; 3], y: &[f32x8; 3]| x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
    let total = |x: &[f32x8; 3]| x[0].abs() + x[1].abs() + x[2].abs();
    let slack = (total(&d) + (total(&a) + total(&b))) * f32x8::splat(BOUND_SLACK) + f32x8::splat(LEAST_GAP);
    let turn: [[f32x8; 3]; 3] = std::array::from_fn(|i| std::array::from_fn(|j| dot(&own[i], &their[j])));
    let abs = turn.map(|row| row.map(f32x8::abs));
    let along: [f32x8; 3] = std::array::from_fn(|i| dot(&own[i], &d));
    let mut gap = f32x8::ZERO;
    for i in 0..3 {
        gap |= along[i].abs().simd_gt(a[i] + dot(&abs[i], &b) + slack);
        let column = [abs[0][i], abs[1][i], abs[2][i]];
        gap |= dot(&their[i], &d).abs().simd_gt(b[i] + dot(&column, &a) + slack);
    }
    if gap.to_bitmask() as u8 | !lanes.held == u8::MAX {
        return u8::MAX;
    }
    for i in 0..3 {
        let (k, l) = others(i);
        for j in 0..3 {
            let (m, n) = others(j);
            let across = along[l] * turn[k][j] - along[k] * turn[l][j];
            let of_lane = a[k] * abs[l][j] + a[l] * abs[k][j];
            let of_probe = b[m] * abs[i][n] + b[n] * abs[i][m];
            gap |= across.abs().simd_gt(of_lane + of_probe + slack);
        }
    }
    gap.to_bitmask() as u8
}

/// The two axes after this one, in turn.
#[inline(always)]
fn others(axis: usize) -> (usize, usize) {
    ((axis + 1) % 3, (axis + 2) % 3)
}
