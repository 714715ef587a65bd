//! What of a cylinder, a cone or an ellipsoid faces the other: a disc, a line on its side, or a point.
//!
//! A disc is told by 16 corners on its rim, at fixed places of the core. They miss up to 1.93 % of its radius at the rim and 2.55 % of its area.

use arrayvec::ArrayVec;

use super::super::support::{support, unit};
use super::contact_patch::PatchCost;
use super::face::{Face, View};
use super::flat_region::{Corners, hull};
use crate::geometry::{Core, Vec3};

/// Cosines of multiples of an eighth of a half turn, up to a quarter.
const COSINES: [f64; 5] = [1.0, 0.923_879_532_511_286_8, std::f64::consts::FRAC_1_SQRT_2, 0.382_683_432_365_089_8, 0.0];

/// Corners on a rim.
const RIM: usize = 16;

/// The face of a core with round parts. Curved surfaces have a single point each, their edges and generators two.
pub(super) fn round_face(core: &Core, view: &View, cost: &mut PatchCost) -> Face {
    let d = view.up();
    let (across, tangent) = (libm::hypot(d.x, d.y), view.tangent);
    let top = support(core, d);
    let points: ArrayVec<Vec3, RIM> = match core {
        Core::Cylinder { radius, half_length } => {
            if across <= tangent * d.z.abs() {
                rim(Vec3::new(*radius, 0.0, 0.0), Vec3::new(0.0, *radius, 0.0), half_length.copysign(d.z))
            } else if d.z.abs() <= tangent * across {
                [*half_length, -half_length].map(|z| Vec3::new(top.x, top.y, z)).into_iter().collect()
            } else {
                [top].into_iter().collect()
            }
        }
        Core::Cone { radius, half_length } => cone(*radius, *half_length, d, top, tangent),
        Core::Ellipsoid { radii } => ellipsoid(*radii, d, top, tangent),
        Core::Point
        | Core::Cuboid { .. }
        | Core::AxialSegment { .. }
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
        | Core::Block(_) => unreachable!("not round"),
    };
    cost.corners += points.len() as u64;
    let (mut corners, top) = (points.into_iter().map(|p| view.corner(p)).collect::<Corners>(), view.corner(top));
    let outline = hull(&corners, view.slack);
    corners.push(top);
    Face { outline, corners, top, complete: true }
}

/// Base, side or apex of a cone.
fn cone(radius: f64, half_length: f64, d: Vec3, top: Vec3, tangent: f64) -> ArrayVec<Vec3, RIM> {
    let across = libm::hypot(d.x, d.y);
    let base = || rim(Vec3::new(radius, 0.0, 0.0), Vec3::new(0.0, radius, 0.0), -half_length);
    // The side's normal is (2 h, r) away from the axis and along it. A cone is flat when all of its side faces the other.
    if d.z < 0.0 && across <= -tangent * d.z {
        return base();
    }
    if d.z > 0.0 && across * radius + 2.0 * half_length * d.z <= tangent * d.z * radius && radius > 0.0 {
        return base();
    }
    let (turned, near) = (across * radius - d.z * 2.0 * half_length, across * 2.0 * half_length + d.z * radius);
    if turned.abs() <= tangent * near {
        let out = unit(Vec3::new(d.x, d.y, 0.0)).map_or(Vec3::zeros(), |out| out * radius);
        let (apex, foot) = (Vec3::new(0.0, 0.0, half_length), Vec3::new(out.x, out.y, -half_length));
        return [apex, foot].into_iter().collect();
    }
    [top].into_iter().collect()
}

/// A point; of an ellipsoid without thickness along one axis or two, its disc or its segment.
fn ellipsoid(radii: Vec3, d: Vec3, top: Vec3, tangent: f64) -> ArrayVec<Vec3, RIM> {
    let axes = [0, 1, 2].map(|axis| Vec3::ith(axis, radii[axis]));
    let flat: ArrayVec<usize, 3> = (0..3).filter(|axis| radii[*axis] == 0.0).collect();
    let along = |axis: usize| d[axis].abs();
    let beside = |axis: usize| libm::hypot(d[(axis + 1) % 3], d[(axis + 2) % 3]);
    match flat[..] {
        [thin] if beside(thin) <= tangent * along(thin) => rim(axes[(thin + 1) % 3], axes[(thin + 2) % 3], 0.0),
        [one, other] if along(3 - one - other) <= tangent * beside(3 - one - other) => {
            let end = axes[3 - one - other];
            [end, -end].into_iter().collect()
        }
        _ => [top].into_iter().collect(),
    }
}

/// Corners on the ellipse with these semi-axes, at that height along z.
fn rim(x: Vec3, y: Vec3, height: f64) -> ArrayVec<Vec3, RIM> {
    let cosine = |k: usize| if k % 8 <= 4 { COSINES[k % 8] } else { -COSINES[8 - k % 8] };
    let signed = |k: usize| if k % 16 < 8 { cosine(k) } else { -cosine(k) };
    (0..RIM).map(|k| x * signed(k) + y * signed(k + 12) + Vec3::new(0.0, 0.0, height)).collect()
}
