//! A quick proof that two cores meet, or are near: how much of the line between their middles lies in each.
//!
//! Deep overlaps are told that way for the price of a support point or two, where GJK goes on until a tetrahedron encloses the
//! origin. It says nothing about how deep they are.

use super::bracketing::Target;
use super::goal::Depth;
use super::minkowski::Difference;
use crate::geometry::vector::{ORIGIN, sizes};
use crate::geometry::{Core, Vec3};

/// Roundings of a point of B and of how deep it is inside, in units of the error of a support value: 131 u |t| + 83 u r(B) for
/// the place and some 20 u S for the rest (`docs/derivations/bracket.md`, "On the line of centres").
const ERRORS: f64 = 3.0;

/// An upper bound of the signed distance of the cores, metres, when it shows an overlap and that is all that was asked. `lower`: a
/// lower bound; cores that it parts are not looked at.
#[inline]
pub(super) fn overlap(difference: &Difference, target: &Target, lower: f64) -> Option<f64> {
    if lower > 0.0 || target.goal.depth == Depth::Penetration {
        return None;
    }
    let upper = upper_bound(difference);
    target.is_decided(&target.bracket(lower, upper)).then_some(upper)
}

/// Infinite where nothing is known.
#[inline(never)]
fn upper_bound(difference: &Difference) -> f64 {
    let (Some(a), Some(b)) = (Middle::of(difference.a), Middle::of(difference.b)) else { return f64::INFINITY };
    let between = difference.b_in_a.point(b.center) - a.center;
    // How many times longer the line is than the part of it that is within each.
    let of_a = gauge(difference.a, between);
    let of_b = gauge(difference.b, difference.b_in_a.direction_into(-between));
    let (share_a, share_b) = (1.0 / of_a, 1.0 / of_b);
    let gap = 1.0 - share_a - share_b;
    let slack = ERRORS * difference.error;
    if gap > 0.0 {
        return gap * between.norm() + slack;
    }
    // In the middle of what both have of it there is room for a ball around the same point in each: a convex body with a ball of
    // radius r around its middle has one of (1 - g) r around a point of gauge g.
    let middle = (0.5 * (share_a + (1.0 - share_b))).clamp(0.0, 1.0);
    let room = (1.0 - middle * of_a) * a.inradius + (1.0 - (1.0 - middle) * of_b) * b.inradius;
    if room > 0.0 { slack - room } else { f64::INFINITY }
}

/// A point of a core, and the radius of a ball around it that is inside.
struct Middle {
    center: Vec3,
    inradius: f64,
}

/// Where the middle of a cone is, as a share of its height above the base: its centroid.
const CONE: f64 = 0.25;

impl Middle {
    /// None for cores without an inside, or whose inside is not known.
    fn of(core: &Core) -> Option<Self> {
        let at_origin = |inradius| Some(Self { center: ORIGIN, inradius });
        match core {
            Core::Cuboid { half_extents: half } | Core::Ellipsoid { radii: half } => {
                at_origin(half.x.min(half.y).min(half.z))
            }
            Core::Cylinder { radius, half_length } => at_origin(radius.min(*half_length)),
            Core::Cone { radius, half_length } => {
                let height = 2.0 * half_length;
                let to_side = (1.0 - CONE) * radius * height / (radius * radius + height * height).sqrt();
                // Of a cone that is a point the quotient is 0 / 0, and the minimum takes the other.
                let inradius = to_side.min(CONE * height);
                Some(Self { center: Vec3::new(0.0, 0.0, CONE * height - half_length), inradius })
            }
            Core::Convex(hull) => {
                hull.interior().map(|interior| Self { center: interior.center, inradius: interior.inradius })
            }
            Core::Point
            | Core::AxialSegment { .. }
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
            | Core::Block(_) => None,
        }
    }
}

/// How many times farther from the core's middle than its boundary t is, or an upper bound of it; infinite across what has no
/// extent. The gauge of Minkowski.
fn gauge(core: &Core, t: Vec3) -> f64 {
    // 0 / 0 is a component that a core without extent there has all the same.
    let times = |t: f64, extent: f64| if t == 0.0 { 0.0 } else { t / extent };
    let within = |radii: &Vec3| Vec3::new(times(t.x, radii.x), times(t.y, radii.y), times(t.z, radii.z)).norm();
    let aside = || (t.x * t.x + t.y * t.y).sqrt();
    match core {
        Core::Cuboid { half_extents: half } => {
            let t = sizes(t);
            times(t.x, half.x).max(times(t.y, half.y)).max(times(t.z, half.z))
        }
        Core::Ellipsoid { radii } => within(radii),
        Core::Cylinder { radius, half_length } => times(aside(), *radius).max(times(t.z.abs(), *half_length)),
        Core::Cone { radius, half_length } => {
            // rho / radius + z / height <= 1, z above the base, and z >= 0.
            let height = 2.0 * half_length;
            let to_side = (times(aside(), *radius) + times(t.z, height)) / (1.0 - CONE);
            to_side.max(times(-t.z, CONE * height))
        }
        Core::Convex(hull) => hull.interior().map_or(f64::INFINITY, |interior| within(&interior.radii)),
        Core::Point
        | Core::AxialSegment { .. }
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
        | Core::Block(_) => f64::INFINITY,
    }
}
