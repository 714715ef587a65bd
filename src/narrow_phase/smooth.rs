//! Ellipsoids and points apart: Newton's method on the direction between them.
//!
//! With support points a(n) of A and b(-n) of B and y(n) = b - a, the width of the gap across a unit n, p(n) = n . y(n),
//! is greatest where y is parallel to n, and is then the distance. On the sphere its gradient is the part of y across n,
//! its Hessian -(H + p I) with H the sum of the Hessians of both support functions (the radii of curvature), which are
//! known in closed form. Where p > 0 the Newton system is positive definite, and mostly so before, at first directions that do not separate yet; the steps converge quadratically
//! where GJK on smooth shapes gains a factor a round.
//!
//! Every direction tried is a proved lower bound and every pair of support points an upper one, as everywhere. When
//! steps do not help, or the gap turns out to be an overlap, the general way is taken.

use super::bracketing::Target;
use super::epa::Epa;
use super::line_of_centers;
use super::minkowski::{Difference, Vertex};
use super::outcome::{Cost, Termination};
use super::support::unit;
use crate::geometry::{Core, Placement, Vec3};

/// Steps at most. Ordinary pairs need four to six.
const MAX_STEPS: u32 = 16;

/// Two cores whose support functions have a Hessian everywhere.
pub(super) struct Smooth<'a> {
    a: &'a Core,
    b: &'a Core,
    b_in_a: &'a Placement,
}

impl<'a> Smooth<'a> {
    /// None for other kinds, and for ellipsoids so flat that a step would be a guess.
    pub fn of(difference: &Difference<'a>) -> Option<Self> {
        let &Difference { a, b, b_in_a, .. } = difference;
        (is_smooth(a) && is_smooth(b)).then_some(Self { a, b, b_in_a })
    }

    /// H u for a tangent u, at the direction towards B, n, whose vertex is `at`. Frame of A.
    fn curvature(&self, n: Vec3, at: &Vertex, u: Vec3) -> Vec3 {
        let of_a = curvature(self.a, n, at.on_a, u);
        let on_b = self.b_in_a.direction_into(at.on_a - at.w - self.b_in_a.translation);
        let (n_in_b, u_in_b) = (self.b_in_a.direction_into(n), self.b_in_a.direction_into(u));
        // B is met from the other side: its normal is -n, its Hessian even.
        of_a + self.b_in_a.direction(curvature(self.b, n_in_b * -1.0, on_b, u_in_b))
    }
}

fn is_smooth(core: &Core) -> bool {
    match core {
        Core::Point => true,
        Core::Ellipsoid { radii } => radii.min() > 1e-3 * radii.max(),
        Core::Cuboid { .. }
        | Core::AxialSegment { .. }
        | Core::Cylinder { .. }
        | Core::Cone { .. }
        | Core::Convex(_)
        | Core::Triangle(_)
        | Core::Segment(_)
        | Core::HalfSpace { .. }
        | Core::Plane { .. }
        | Core::Mesh(_)
        | Core::Compound(_) => false,
    }
}

/// Hessian of the support function h(n) = |A n|, A = diag(radii), applied to u: (A^2 u - p (p . u)) / h, with the support
/// point p = A^2 n / h.
fn curvature(core: &Core, n: Vec3, p: Vec3, u: Vec3) -> Vec3 {
    let Core::Ellipsoid { radii } = core else { return Vec3::zeros() };
    (radii.component_mul(&radii.component_mul(&u)) - p * p.dot(&u)) / n.dot(&p)
}

/// The bracket, when the steps reach one that is as narrow as asked or decides; none otherwise.
pub(super) fn newton(pair: &Smooth, difference: &mut Difference, target: &Target, cost: &mut Cost) -> Option<Epa> {
    let error = difference.error;
    // From the origin to C = A - B: the opposite of n.
    let mut direction = unit(difference.start())?;
    // Where the widest gap so far was met, and the step that was taken from there.
    let (mut widest, mut base, mut forward) = (f64::NEG_INFINITY, direction, Vec3::zeros());
    for _ in 0..MAX_STEPS {
        let vertex = difference.lowest(direction);
        cost.supports += 1;
        cost.gjk_iterations += 1;
        let gap = direction.dot(&vertex.w);
        let (lower, mut upper) = (gap - error, vertex.w.norm() + error);
        if widest == f64::NEG_INFINITY && target.may_be_decided_from_above(lower) {
            upper = upper.min(line_of_centers::upper_bound(difference));
        }
        let bracket = target.bracket(lower, upper);
        let found = |termination| Some(Epa { lower, upper, direction, nearest: vertex, termination });
        difference.memory.direction = direction;
        if target.is_met(&bracket) {
            return found(Termination::Converged);
        }
        if target.is_decided(&bracket) {
            return found(Termination::Decided);
        }
        if target.must_stop() {
            return None;
        }
        if gap < widest {
            // Too far: a quarter of the step.
            forward *= 0.25;
        } else if gap <= 0.0 && gap < 0.5 * widest {
            return None; // Not half way from where it was to a gap: an overlap.
        } else {
            (widest, base) = (gap, direction);
            forward = step(pair, direction, &vertex, gap)?;
        }
        direction = unit(base + forward)?;
    }
    None
}

/// One Newton step: the tangent d with (H + p I) d = the part of w across the direction.
fn step(pair: &Smooth, direction: Vec3, vertex: &Vertex, gap: f64) -> Option<Vec3> {
    let n = direction * -1.0;
    let u = unit(n.cross(&Vec3::ith(n.iamin(), 1.0)))?;
    let v = n.cross(&u);
    let (hu, hv) = (pair.curvature(n, vertex, u), pair.curvature(n, vertex, v));
    let (uu, uv, vv) = (u.dot(&hu), u.dot(&hv), v.dot(&hv));
    // Before there is a gap the matrix may not be definite with p; without it, it is, and the step shorter.
    let with = |p: f64| (uu + p, vv + p, (uu + p) * (vv + p) - uv * uv);
    let (uu, vv, determinant) = match with(gap) {
        definite @ (uu, _, determinant) if uu > 0.0 && determinant > 0.0 => definite,
        _ => with(0.0),
    };
    if !(determinant > 0.0) {
        return None;
    }
    let (gu, gv) = (u.dot(&vertex.w), v.dot(&vertex.w));
    let (du, dv) = ((gu * vv - gv * uv) / determinant, (gv * uu - gu * uv) / determinant);
    Some(u * du + v * dv)
}
