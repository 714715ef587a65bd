//! The change of normal and witness points under a twist of either body, from what both sides are like.
//!
//! Let n be the unit normal from A to B, d the signed distance, x2 - x1 = d n. A twist (v, w) of a body moves its witness, held fast in it, by
//! u = v + w x r (r from the body's origin) and turns its surface by w. With radii of curvature R (zero at corners, infinite along flat
//! directions L, along which the witness slides by s instead)
//!
//! ```text
//! dx1 = uA + RA (dn - wA x n) + sA        (dn - wA x n) . e = 0 for e in LA
//! dx2 = uB - RB (dn - wB x n) + sB        (dn - wB x n) . e = 0 for e in LB
//! dx2 - dx1 = dd n + d dn
//! ```
//!
//! so that `dd = n . (uB - uA)`, and across n, with `M = d I + RA + RB`,
//!
//! ```text
//! M dn - sB + sA = P (uB - uA) + RA (wA x n) + RB (wB x n).
//! ```
//!
//! Along what is flat dn is told by the second column of conditions; across it M tells it, as no slide reaches there; then the slides are
//! what is left over. That has one solution where no direction is flat on both sides and M is positive across. (For smooth
//! shapes: Montaut and others, "Differentiable collision detection: a randomized smoothing approach", ICRA 2023, by the implicit function theorem; here for
//! every feature.)

use arrayvec::ArrayVec;

use super::side::{Mat2, Side, Vec2};
use crate::geometry::Vec3;

/// Flat directions of two sides that are nearer to parallel than this (sine) are one.
const PARALLEL: f64 = 1e-7;

/// Both sides at the witness, in the frame of both placements.
pub(super) struct Response {
    normal: Vec3,
    /// Two axes across the normal.
    axes: [Vec3; 2],
    /// What is flat on A, then on B; at most two, and not parallel.
    flat: ArrayVec<(Vec2, usize), 2>,
    radii: [Mat2; 2],
    bend: Mat2,
    /// M restricted to what is not flat, inverted.
    inverse: Mat2,
    /// Of M where it matters, metres; infinite where nothing can bend.
    pub least_eigenvalue: f64,
    /// A direction is flat on both sides: there is no one witness.
    pub is_shared: bool,
}

/// What a twist does.
#[derive(Clone, Copy, Debug)]
pub(super) struct Change {
    pub distance: f64,
    pub normal: Vec3,
    pub points: [Vec3; 2],
}

impl Response {
    pub fn new(normal: Vec3, axes: [Vec3; 2], signed_distance: f64, [a, b]: [&Side; 2]) -> Self {
        let mut flat: ArrayVec<(Vec2, usize), 2> = a.flat.iter().map(|along| (*along, 0)).collect();
        let mut is_shared = false;
        for along in &b.flat {
            let is_new = match flat[..] {
                [] => true,
                [(other, _)] => other.perp(along).abs() > PARALLEL,
                _ => false,
            };
            if is_new {
                flat.push((*along, 1));
            }
            is_shared |= !is_new;
        }
        let radii = [a.radii, b.radii];
        let bend = Mat2::identity() * signed_distance + a.radii + b.radii;
        let (inverse, least_eigenvalue) = match flat[..] {
            [] => {
                let least = least_eigenvalue(&bend);
                (bend.try_inverse().unwrap_or_else(Mat2::zeros), least)
            }
            [(along, _)] => {
                let across = Vec2::new(-along.y, along.x);
                let bends = across.dot(&(bend * across));
                (across * across.transpose() / bends, bends)
            }
            _ => (Mat2::zeros(), f64::INFINITY),
        };
        Self { normal, axes, flat, radii, bend, inverse, least_eigenvalue, is_shared }
    }

    fn across(&self, v: Vec3) -> Vec2 {
        Vec2::new(self.axes[0].dot(&v), self.axes[1].dot(&v))
    }

    fn whole(&self, v: Vec2) -> Vec3 {
        self.axes[0] * v.x + self.axes[1] * v.y
    }

    /// The twist (`v`, `w`) of one body (0: A, 1: B) about its origin, from which its witness is at `arm`.
    pub fn change(&self, body: usize, v: Vec3, w: Vec3, arm: Vec3) -> Change {
        let moved = v + w.cross(&arm);
        let sign = if body == 0 { -1.0 } else { 1.0 };
        let turned = self.across(w.cross(&self.normal));
        let turned_by = |side: usize| if side == body { turned } else { Vec2::zeros() };
        let asked = self.across(moved) * sign + self.radii[body] * turned;
        let along_flat = self.along_flat(turned_by);
        let dn = along_flat + self.inverse * (asked - self.bend * along_flat);
        // What the slides have to make up for: sB - sA.
        let [slide_a, slide_b] = self.slides(self.bend * dn - asked);
        let of_side = |side: usize| self.radii[side] * (dn - turned_by(side));
        let moved_if = |side: usize| if side == body { moved } else { Vec3::zeros() };
        Change {
            distance: sign * self.normal.dot(&moved),
            normal: self.whole(dn),
            points: [moved_if(0) + self.whole(of_side(0) + slide_a), moved_if(1) + self.whole(slide_b - of_side(1))],
        }
    }

    /// The part of dn in the span of what is flat: each flat direction turns with its body.
    fn along_flat(&self, turned_by: impl Fn(usize) -> Vec2) -> Vec2 {
        let told = |(along, side): (Vec2, usize)| along.dot(&turned_by(side));
        match self.flat[..] {
            [one] => one.0 * told(one),
            [one, other] => {
                let both = Mat2::from_rows(&[one.0.transpose(), other.0.transpose()]);
                both.try_inverse().unwrap_or_else(Mat2::zeros) * Vec2::new(told(one), told(other))
            }
            _ => Vec2::zeros(),
        }
    }

    /// `sB - sA = rest`, each along what is flat on its side.
    fn slides(&self, rest: Vec2) -> [Vec2; 2] {
        let mut slides = [Vec2::zeros(); 2];
        let signed = |side: usize| if side == 0 { -1.0 } else { 1.0 };
        match self.flat[..] {
            [(along, side)] => slides[side] = along * (along.dot(&rest) * signed(side)),
            [(one, its), (other, others)] => {
                let both = Mat2::from_columns(&[one, other]);
                let parts = both.try_inverse().unwrap_or_else(Mat2::zeros) * rest;
                slides[its] += one * (parts.x * signed(its));
                slides[others] += other * (parts.y * signed(others));
            }
            _ => {}
        }
        slides
    }
}

/// Of a symmetric matrix.
fn least_eigenvalue(m: &Mat2) -> f64 {
    let (middle, half) = ((m.m11 + m.m22) / 2.0, (m.m11 - m.m22) / 2.0);
    middle - libm::hypot(half, m.m12)
}
