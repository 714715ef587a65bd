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
use super::support::with_length;
use crate::geometry::vector::ORIGIN;
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

    /// The forms (u . H u, u . H v, v . H v) of the sum of both Hessians for tangents u and v at the vertex that lies farthest
    /// against the unit `direction`. Frame of A.
    #[inline]
    fn forms(&self, direction: Vec3, at: &Vertex, u: Vec3, v: Vec3) -> [f64; 3] {
        let on_b = at.on_a - at.w - self.b_in_a.translation;
        let of_a = forms(self.a, [u, v], [at.on_a.dot(&u), at.on_a.dot(&v)], -direction.dot(&at.on_a));
        let in_b = [self.b_in_a.direction_into(u), self.b_in_a.direction_into(v)];
        let of_b = forms(self.b, in_b, [on_b.dot(&u), on_b.dot(&v)], direction.dot(&on_b));
        [of_a[0] + of_b[0], of_a[1] + of_b[1], of_a[2] + of_b[2]]
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
        | Core::Compound(_)
        | Core::HeightField(_)
        | Core::PointCloud(_)
        | Core::Voxels(_)
        | Core::Column(_)
        | Core::Block(_) => false,
    }
}

/// The Hessian of the support function h(n) = |A n|, A = diag(radii), is (A^2 - p p^T) / h with the support point p = A^2 n / h: its
/// forms for two tangents in the core's frame, given their products with p, and h.
#[inline]
fn forms(core: &Core, [u, v]: [Vec3; 2], [pu, pv]: [f64; 2], h: f64) -> [f64; 3] {
    let Core::Ellipsoid { radii } = core else { return [0.0; 3] };
    let (au, av) = (radii.component_mul(&u), radii.component_mul(&v));
    let share = 1.0 / h;
    [(au.dot(&au) - pu * pu) * share, (au.dot(&av) - pu * pv) * share, (av.dot(&av) - pv * pv) * share]
}

/// Two unit vectors that are perpendicular to a unit vector and to one another: without a branch or a root, by Duff and others,
/// "Building an Orthonormal Basis, Revisited", JCGT 2017.
#[inline]
pub(super) fn tangents(n: Vec3) -> [Vec3; 2] {
    let sign = 1.0_f64.copysign(n.z);
    let a = -1.0 / (sign + n.z);
    let b = n.x * n.y * a;
    [Vec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x), Vec3::new(b, sign + n.y * n.y * a, -n.y)]
}

/// The bracket, when the steps reach one that is as narrow as asked or decides; none otherwise.
pub(super) fn newton(pair: &Smooth, difference: &mut Difference, target: &Target, cost: &mut Cost) -> Option<Epa> {
    let error = difference.error;
    // From the origin to C = A - B: the opposite of n.
    let mut toward = difference.start();
    // Where the widest gap so far was met, and the step that was taken from there.
    let (mut widest, mut base, mut forward) = (f64::NEG_INFINITY, ORIGIN, ORIGIN);
    for _ in 0..MAX_STEPS {
        let (along, length) = with_length(toward)?;
        let vertex = difference.lowest(along);
        let direction = along / length;
        cost.supports += 1;
        cost.gjk_iterations += 1;
        let gap = direction.dot(&vertex.w);
        let (lower, upper) = (gap - error, vertex.w.norm() + error);
        let bracket = target.bracket(lower, upper);
        let found = |termination| Some(Epa { lower, upper, direction, nearest: vertex, termination });
        difference.memory.direction = direction;
        if widest == f64::NEG_INFINITY
            && let Some(upper) = line_of_centers::overlap(difference, target, lower)
        {
            return Some(Epa { lower, upper, direction, nearest: vertex, termination: Termination::Decided });
        }
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
        toward = base + forward;
    }
    None
}

/// One Newton step: the tangent d with (H + p I) d = the part of w across the direction.
fn step(pair: &Smooth, direction: Vec3, vertex: &Vertex, gap: f64) -> Option<Vec3> {
    let [u, v] = tangents(direction);
    let [uu, uv, vv] = pair.forms(direction, vertex, u, v);
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
