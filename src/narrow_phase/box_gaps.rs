//! How far apart two boxes are at least: one turned box against two siblings, by gaps along directions.
//!
//! The gap of two sets along a unit direction n, `min n . b - max n . a`, is a lower bound of their signed distance, apart
//! and in an overlap (`docs/derivations/bracket.md`), and so for whatever is in the boxes. Which directions are worth
//! asking about is a matter of speed alone:
//! - that of the nearest pair known so far: most boxes around it are parted by the same plane;
//! - from the point of one box nearest the other's centre to the point of the other nearest to that: for boxes apart it is
//!   close to the best there is, for the price of two clamped points;
//! - the six face normals: they part boxes that all but touch, and bound the depth of those that overlap. The nine products
//!   of edges (Gottschalk 1996 has all fifteen) part few more and cost as much again.
//!
//! All values are as computed; [`BOX_ERROR_ULPS`] bounds how far they are off.

use crate::geometry::vector::sizes;
use crate::geometry::{OrientedBox, Placement, Twin, TwinBox, TwinVec3, Vec3};

/// Error of a gap of two boxes of a walk, in units of roundoff times the extent of the two meshes and their distance.
/// Derived in `docs/derivations/mesh.md`, which arrives at less than 450.
pub(super) const BOX_ERROR_ULPS: f64 = 512.0;

/// One box and a pair of siblings that it is held against; everything along the one's axes, from its centre.
pub(super) struct Facing<'a> {
    one: OrientedBox,
    half: TwinVec3,
    two: &'a TwinBox,
    /// The siblings' centres.
    offset: TwinVec3,
    /// The siblings' axes.
    axes: [TwinVec3; 3],
}

impl<'a> Facing<'a> {
    /// `place`: the frame of the siblings in that of the one.
    #[inline(always)]
    pub fn new(one: OrientedBox, two: &'a TwinBox, place: &Placement) -> Self {
        let turn = one.axes.tr_mul(&place.rotation);
        let from = one.axes.tr_mul(&(place.translation - one.center));
        let offset = two.center.turned(&turn) + TwinVec3::splat(from);
        let [u, v, w] = two.axes;
        let axes = [u.turned(&turn), v.turned(&turn), w.turned(&turn)];
        Self { one, half: TwinVec3::splat(one.half_extents), two, offset, axes }
    }

    /// Distances of the centres: no bounds of anything.
    #[inline(always)]
    pub fn between_centers(&self) -> Twin {
        let [first, second] = self.offset.dot(self.offset).0;
        Twin([first.sqrt(), second.sqrt()])
    }

    /// Along a unit direction from the one to the siblings, given in both frames.
    #[inline(always)]
    pub fn along(&self, in_one: Vec3, in_two: Vec3) -> Twin {
        let direction = self.one.axes.tr_mul(&in_one);
        let reach = sizes(direction).dot(&self.one.half_extents);
        let reach_of_two = on_axes(&self.two.axes, TwinVec3::splat(in_two)).abs().dot(self.two.half_extents);
        self.offset.dot(TwinVec3::splat(direction)) - Twin::splat(reach) - reach_of_two
    }

    /// Along the line between two points of the boxes that are near one another; minus infinity where they meet.
    #[inline(always)]
    pub fn between_near_points(&self) -> Twin {
        let from_two = on_axes(&self.axes, self.offset.clamped(self.half) - self.offset);
        let across = from_two.clamped(self.two.half_extents) - from_two;
        let [u, v, w] = self.axes;
        let direction = u * across.x + v * across.y + w * across.z;
        let reach = direction.abs().dot(self.half) + across.abs().dot(self.two.half_extents);
        let gap = self.offset.dot(direction) - reach;
        // Squares too small to be exact have no direction to tell: NaN, which no comparison takes for a gap.
        let square = across.dot(across);
        let [first, second] = square.0;
        let length = |square: f64| if square > LEAST_SQUARE { square.sqrt() } else { f64::NAN };
        let length = Twin([length(first), length(second)]);
        gap.over(length).max(Twin::splat(f64::NEG_INFINITY))
    }

    /// Along the best of the six face normals.
    #[inline(always)]
    pub fn along_faces(&self) -> Twin {
        let [u, v, w] = self.axes;
        let (u, v, w) = (u.abs(), v.abs(), w.abs());
        let h = self.two.half_extents;
        let of_one = self.offset.abs() - self.half - (u * h.x + v * h.y + w * h.z);
        let reach = TwinVec3 { x: u.dot(self.half), y: v.dot(self.half), z: w.dot(self.half) };
        let of_two = on_axes(&self.axes, self.offset).abs() - h - reach;
        of_one.largest().max(of_two.largest())
    }
}

/// The components of `v` along three axes.
#[inline(always)]
fn on_axes([x, y, z]: &[TwinVec3; 3], v: TwinVec3) -> TwinVec3 {
    TwinVec3 { x: x.dot(v), y: y.dot(v), z: z.dot(v) }
}

/// Square metres. Squares above it have no denormal part that would matter in their sum.
const LEAST_SQUARE: f64 = 1e-280;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Pose, Quaternion};

    /// Oracle: the corners of both boxes, whose gap along any direction is no less, and points inside, which are no nearer.
    #[test]
    fn gaps_are_below_the_distance_of_points_of_the_boxes() {
        let mut state = 7u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64 * 2.0 - 1.0
        };
        let (mut apart, mut meeting) = (0, 0);
        for _ in 0..400 {
            let mut pose = |reach: f64| {
                let q = Quaternion { w: next(), x: next(), y: next(), z: next() };
                Pose::new(Vec3::new(next(), next(), next()) * reach, q).unwrap().placement()
            };
            let mut any = || {
                let at = pose(1.0);
                OrientedBox { center: at.translation, axes: at.rotation, half_extents: Vec3::new(0.6, 0.9, 0.1) }
            };
            let (one, two) = (any(), [any(), any()]);
            let place = pose(1.5);
            let twin = TwinBox::new([&two[0], &two[1]]);
            let facing = Facing::new(one, &twin, &place);
            let n = Vec3::new(0.6, 0.0, 0.8);
            let gaps = [facing.along(n, place.direction_into(n)), facing.between_near_points(), facing.along_faces()];
            for (lane, other) in two.iter().enumerate() {
                let point =
                    |b: &OrientedBox, x: [f64; 3]| b.center + b.axes * b.half_extents.component_mul(&Vec3::from(x));
                let best = gaps.map(|g| g.0[lane]).into_iter().fold(f64::NEG_INFINITY, f64::max);
                if best > 0.0 {
                    apart += 1
                } else {
                    meeting += 1
                }
                let mut nearest = f64::INFINITY;
                for _ in 0..200 {
                    let a = point(&one, [next(), next(), next()].map(|x| (3.0 * x).clamp(-1.0, 1.0)));
                    let b = place.point(point(other, [next(), next(), next()].map(|x| (3.0 * x).clamp(-1.0, 1.0))));
                    nearest = nearest.min((b - a).norm());
                }
                let extent = 6.0;
                assert!(best - BOX_ERROR_ULPS * f64::EPSILON * extent <= nearest, "{best} {nearest}");
            }
        }
        assert!(apart > 100 && meeting > 20, "{apart} {meeting}");
    }
}
