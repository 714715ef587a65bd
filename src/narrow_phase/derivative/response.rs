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
use nalgebra::SMatrix;

use super::derivatives::{Derivatives, TwistMatrix};
use super::side::{Mat2, Side, Vec2};
use crate::geometry::Vec3;

/// Flat directions of two sides that are nearer to parallel than this (sine) are one.
const PARALLEL: f64 = 1e-7;

/// In the plane across the normal, for each of six twists of a body.
type Plane = SMatrix<f64, 2, 6>;

/// Both sides at the witness, in the frame of both placements.
pub(super) struct Response {
    normal: Vec3,
    /// Two axes across the normal.
    axes: [Vec3; 2],
    radii: [Mat2; 2],
    /// M restricted to what is not flat, inverted.
    inverse: Mat2,
    flat: Option<Flat>,
    /// Of M where it matters, metres; infinite where nothing can bend.
    pub least_eigenvalue: f64,
    /// A direction is flat on both sides: there is no one witness.
    pub is_shared: bool,
}

/// What flat directions do to the solution.
struct Flat {
    /// M.
    bend: Mat2,
    /// The change of the normal when one side's flat directions turn by (wx, wy) with their body: by body.
    turn: [Mat2; 2],
    /// The slides of A and of B that make up for what is left of the equation.
    slide: [Mat2; 2],
}

impl Response {
    /// Without flat directions.
    pub fn smooth(normal: Vec3, axes: [Vec3; 2], signed_distance: f64, radii: [Mat2; 2]) -> Self {
        let bend = Mat2::identity() * signed_distance + radii[0] + radii[1];
        let (inverse, least_eigenvalue) = (inverted(&bend), least_eigenvalue(&bend));
        Self { normal, axes, radii, inverse, flat: None, least_eigenvalue, is_shared: false }
    }

    pub fn new(normal: Vec3, axes: [Vec3; 2], signed_distance: f64, [a, b]: [&Side; 2]) -> Self {
        let smooth = Self::smooth(normal, axes, signed_distance, [a.radii, b.radii]);
        if a.flat.is_empty() && b.flat.is_empty() {
            return smooth;
        }
        let bend = Mat2::identity() * signed_distance + a.radii + b.radii;
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
        let (mut turn, mut slide) = ([Mat2::zeros(); 2], [Mat2::zeros(); 2]);
        // sB - sA is what is left: a slide of A is its opposite.
        let signed = |side: usize| if side == 0 { -1.0 } else { 1.0 };
        let (inverse, least_eigenvalue) = if let [(along, side)] = flat[..] {
            let across = Vec2::new(-along.y, along.x);
            let bends = across.dot(&(bend * across));
            let inverse = across * across.transpose() / bends;
            let project = along * along.transpose();
            turn[side] = project - inverse * bend * project;
            slide[side] = project * signed(side);
            (inverse, bends)
        } else {
            // Both are held: the dual of the two directions tells the normal, the directions themselves the slides.
            let [(one, its), (other, others)] = [flat[0], flat[1]];
            let dual = inverted(&Mat2::from_rows(&[one.transpose(), other.transpose()]));
            turn[its] += dual.column(0) * one.transpose();
            turn[others] += dual.column(1) * other.transpose();
            let parts = inverted(&Mat2::from_columns(&[one, other]));
            slide[its] += one * parts.row(0) * signed(its);
            slide[others] += other * parts.row(1) * signed(others);
            (Mat2::zeros(), f64::INFINITY)
        };
        Self { inverse, flat: Some(Flat { bend, turn, slide }), least_eigenvalue, is_shared, ..smooth }
    }

    /// Writes what follows for all twists, and how well it is conditioned. `arms`: from the origin of each body to its witness.
    #[inline]
    pub fn tell(&self, arms: [Vec3; 2], all: &mut Derivatives) {
        for (body, arm) in arms.into_iter().enumerate() {
            self.fill_body(body, arm, all);
        }
        all.conditioning = self.least_eigenvalue;
        all.is_valid = !self.is_shared && self.least_eigenvalue > 0.0;
    }

    /// Those with respect to one body's twists about its origin.
    fn fill_body(&self, body: usize, arm: Vec3, all: &mut Derivatives) {
        let [x, y] = self.axes;
        let (radii, sign) = (&self.radii[body], if body == 0 { -1.0 } else { 1.0 });
        // e . (v + w x r) = e . v + (r x e) . w: the witness moves so along an axis e.
        let along = |axis: Vec3| [axis, arm.cross(&axis)];
        let moved = rows(along(x), along(y));
        // e . (w x n) = (n x e) . w, and n x x = y, n x y = -x.
        let turned = rows([Vec3::zeros(), y], [Vec3::zeros(), -x]);
        let bent = radii * turned;
        let asked = moved * sign + bent;
        let mut dn = self.inverse * asked;
        let (mut on_a, mut on_b);
        if let Some(Flat { bend, turn, slide }) = &self.flat {
            dn += turn[body] * turned;
            let rest = bend * dn - asked;
            (on_a, on_b) = (self.radii[0] * dn + slide[0] * rest, slide[1] * rest - self.radii[1] * dn);
        } else {
            (on_a, on_b) = (self.radii[0] * dn, -(self.radii[1] * dn));
        }
        if body == 0 {
            on_a += moved - bent;
        } else {
            on_b += moved + bent;
        }
        let outward = along(self.normal);
        let distance = [outward[0] * sign, outward[1] * sign];
        let [v, w] = distance;
        all.signed_distance[body] = [v.x, v.y, v.z, w.x, w.y, w.z];
        self.whole(&dn, &mut all.normal[body]);
        self.whole(&on_a, &mut all.point_on_a[body]);
        self.whole(&on_b, &mut all.point_on_b[body]);
        // Along the normal only the body's own witness moves with it.
        let own = if body == 0 { &mut all.point_on_a[0] } else { &mut all.point_on_b[1] };
        for k in 0..6 {
            let along = outward[k / 3][k % 3];
            (0..3).for_each(|row| own[(row, k)] += self.normal[row] * along);
        }
    }

    /// In the frame of both placements.
    #[inline(always)]
    fn whole(&self, plane: &Plane, into: &mut TwistMatrix) {
        let [x, y] = self.axes;
        for k in 0..6 {
            let (u, v) = (plane[(0, k)], plane[(1, k)]);
            (0..3).for_each(|row| into[(row, k)] = x[row] * u + y[row] * v);
        }
    }
}

#[inline]
fn rows([vx, wx]: [Vec3; 2], [vy, wy]: [Vec3; 2]) -> Plane {
    Plane::new(vx.x, vx.y, vx.z, wx.x, wx.y, wx.z, vy.x, vy.y, vy.z, wy.x, wy.y, wy.z)
}

/// Zero where there is none: then the least eigenvalue says so.
#[inline]
pub(super) fn inverted(m: &Mat2) -> Mat2 {
    let determinant = m.m11 * m.m22 - m.m12 * m.m21;
    if determinant == 0.0 { Mat2::zeros() } else { Mat2::new(m.m22, -m.m12, -m.m21, m.m11) / determinant }
}

/// Of a symmetric matrix.
#[inline]
fn least_eigenvalue(m: &Mat2) -> f64 {
    let (middle, half) = ((m.m11 + m.m22) / 2.0, (m.m11 - m.m22) / 2.0);
    middle - (half * half + m.m12 * m.m12).sqrt()
}
