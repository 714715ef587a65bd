//! Support functions: the point of a core that lies farthest in a direction.

use crate::geometry::vector::{ORIGIN, greatest_size};
use crate::geometry::{Aabb, Column, Core, Vec3, length};

/// A point of the convex, bounded core where `direction . x` is greatest, in the core's frame. Among equals the first.
///
/// The direction need not be of unit length; a zero one gets any point. For round cores the value `direction . x` is
/// within a few units in the last place of the true maximum, times the size of the core; for others within six.
///
/// # Panics
/// For cores that are not convex and bounded: callers have taken those apart ([`is_convex`]).
pub(super) fn support(core: &Core, direction: Vec3) -> Vec3 {
    farthest(core, direction, NO_HINT).0
}

/// No guess of a corner.
pub(super) const NO_HINT: u32 = u32::MAX;

/// The same, and which corner of the core it is (0 for a core without corners). `hint`: a corner that may be
/// near, or [`NO_HINT`].
#[inline(always)]
pub(super) fn farthest(core: &Core, direction: Vec3, hint: u32) -> (Vec3, u32) {
    let d = direction;
    match core {
        Core::Cuboid { half_extents } => {
            let corner = u32::from(d.x < 0.0) | u32::from(d.y < 0.0) << 1 | u32::from(d.z < 0.0) << 2;
            let h = half_extents;
            (Vec3::new(h.x.copysign(d.x), h.y.copysign(d.y), h.z.copysign(d.z)), corner)
        }
        Core::Convex(hull) => {
            let corner = hull.farthest(d, hint);
            (hull.points()[corner as usize], corner)
        }
        Core::Triangle(corners) => first_farthest(corners, d),
        Core::Point => (ORIGIN, 0),
        Core::AxialSegment { half_length } => (Vec3::new(0.0, 0.0, half_length.copysign(d.z)), u32::from(d.z < 0.0)),
        Core::Segment(ends) => first_farthest(ends, d),
        Core::Cylinder { .. } | Core::Cone { .. } | Core::Ellipsoid { .. } => (round(core, d), 0),
        Core::Column(column) => first_farthest(&column.corners(), d),
        Core::Block(block) => {
            let corner = u32::from(d.x >= 0.0) | u32::from(d.y >= 0.0) << 1 | u32::from(d.z >= 0.0) << 2;
            let pick = |axis: usize| if corner >> axis & 1 == 1 { block.max[axis] } else { block.min[axis] };
            (Vec3::new(pick(0), pick(1), pick(2)), corner)
        }
        Core::HalfSpace { .. }
        | Core::Plane { .. }
        | Core::Mesh(_)
        | Core::Compound(_)
        | Core::HeightField(_)
        | Core::PointCloud(_)
        | Core::Voxels(_) => {
            unreachable!("only convex, bounded cores have a support function")
        }
    }
}

/// The support point of a cylinder, a cone or an ellipsoid.
#[inline(always)]
fn round(core: &Core, d: Vec3) -> Vec3 {
    match core {
        Core::Cylinder { radius, half_length } => rim(*radius, half_length.copysign(d.z), d),
        Core::Cone { radius, half_length } => {
            // Apex or rim: the apex wins where its value, h d_z, is not below the rim's, r |d_xy| - h d_z.
            let base = rim(*radius, -half_length, d);
            let apex = Vec3::new(0.0, 0.0, *half_length);
            if d.dot(&apex) >= d.dot(&base) { apex } else { base }
        }
        Core::Ellipsoid { radii } => {
            // The image of a ball under A = diag(radii): A (A d) / |A d|.
            let stretched = radii.component_mul(&d);
            match unit(stretched) {
                Some(u) => radii.component_mul(&u),
                None => ORIGIN, // Flat across the direction: the centre is as far as any point.
            }
        }
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
    }
}

/// The corners of a polytope, in the core's frame; none for cores that are not polytopes.
pub(super) fn corners(core: &Core) -> Vec<Vec3> {
    match core {
        Core::Point => vec![ORIGIN],
        Core::Cuboid { half_extents } => {
            let sign = |corner: u32, axis: u32| if corner >> axis & 1 == 0 { -1.0 } else { 1.0 };
            (0..8).map(|n| half_extents.component_mul(&Vec3::new(sign(n, 0), sign(n, 1), sign(n, 2)))).collect()
        }
        Core::AxialSegment { half_length } => [-half_length, *half_length].map(|z| Vec3::new(0.0, 0.0, z)).into(),
        Core::Convex(hull) => hull.points().to_vec(),
        Core::Triangle(corners) => corners.to_vec(),
        Core::Segment(ends) => ends.to_vec(),
        Core::Column(column) => column.corners().to_vec(),
        Core::Block(block) => block.corners().to_vec(),
        Core::Cylinder { .. }
        | Core::Cone { .. }
        | Core::Ellipsoid { .. }
        | Core::HalfSpace { .. }
        | Core::Plane { .. }
        | Core::Mesh(_)
        | Core::Compound(_)
        | Core::HeightField(_)
        | Core::PointCloud(_)
        | Core::Voxels(_) => Vec::new(),
    }
}

/// Whether the core has a support function.
pub(super) fn is_convex(core: &Core) -> bool {
    match core {
        Core::HalfSpace { .. }
        | Core::Plane { .. }
        | Core::Mesh(_)
        | Core::Compound(_)
        | Core::HeightField(_)
        | Core::PointCloud(_)
        | Core::Voxels(_) => false,
        Core::Point
        | Core::Cuboid { .. }
        | Core::AxialSegment { .. }
        | Core::Cylinder { .. }
        | Core::Cone { .. }
        | Core::Ellipsoid { .. }
        | Core::Convex(_)
        | Core::Triangle(_)
        | Core::Segment(_)
        | Core::Column(_)
        | Core::Block(_) => true,
    }
}

/// Largest distance of a point of the core from its origin; an upper bound within rounding, metres.
#[inline]
pub(super) fn radius(core: &Core) -> f64 {
    let box_corner = |bounds: Aabb| length(bounds.min.abs().sup(&bounds.max.abs()));
    match core {
        Core::Point => 0.0,
        Core::Cuboid { half_extents } => length(*half_extents),
        Core::AxialSegment { half_length } => *half_length,
        Core::Cylinder { radius, half_length } | Core::Cone { radius, half_length } => {
            length(Vec3::new(*radius, *half_length, 0.0))
        }
        Core::Ellipsoid { radii } => greatest_size(*radii),
        Core::Convex(hull) => hull.radius(),
        Core::Triangle([a, b, c]) => length(*a).max(length(*b)).max(length(*c)),
        Core::Segment([a, b]) => length(*a).max(length(*b)),
        Core::HalfSpace { .. } | Core::Plane { .. } => 0.0,
        Core::Mesh(mesh) => box_corner(mesh.bounds()),
        Core::Compound(compound) => box_corner(compound.bounds()),
        Core::HeightField(field) => box_corner(field.bounds()),
        Core::PointCloud(cloud) => box_corner(cloud.bounds()),
        Core::Voxels(map) => map.bounds().map_or(0.0, box_corner),
        Core::Block(block) => box_corner(*block),
        Core::Column(column) => column.corners().iter().map(|p| length(*p)).fold(0.0, f64::max),
    }
}

/// Point of the disc of that radius at that height, farthest along `d`.
#[inline(always)]
fn rim(radius: f64, height: f64, d: Vec3) -> Vec3 {
    match unit(Vec3::new(d.x, d.y, 0.0)) {
        Some(u) => Vec3::new(radius * u.x, radius * u.y, height),
        None => Vec3::new(0.0, 0.0, height), // Straight along the axis: the centre is as far as the rim.
    }
}

/// `v / |v|`, also where squares would underflow; none for zero.
#[inline]
pub(super) fn unit(v: Vec3) -> Option<Vec3> {
    let square = v.norm_squared();
    if square > 1e-280 && square < 1e280 { Some(v / square.sqrt()) } else { extreme_unit(v) }
}

/// A vector in the direction of `v` with its length, which neither over- nor underflow when squared; none for zero.
#[inline]
pub(super) fn with_length(v: Vec3) -> Option<(Vec3, f64)> {
    let square = v.norm_squared();
    if square > 1e-280 && square < 1e280 { Some((v, square.sqrt())) } else { Some((extreme_unit(v)?, 1.0)) }
}

#[cold]
fn extreme_unit(v: Vec3) -> Option<Vec3> {
    let largest = greatest_size(v);
    (largest > 0.0).then(|| (v / largest).normalize())
}

fn first_farthest(points: &[Vec3], d: Vec3) -> (Vec3, u32) {
    let mut best = 0;
    let mut value = d.dot(&points[0]);
    for (i, p) in points.iter().enumerate().skip(1) {
        let v = d.dot(p);
        if v > value {
            (best, value) = (i, v);
        }
    }
    (points[best], best as u32)
}

/// A corner by the number that [`farthest`] gave it; none where there is no such corner.
pub(super) fn corner(core: &Core, number: u32) -> Option<Vec3> {
    let n = number as usize;
    match core {
        Core::Cuboid { half_extents: h } => {
            let signed = |axis: usize| if n >> axis & 1 == 1 { -h[axis] } else { h[axis] };
            (n < 8).then(|| Vec3::new(signed(0), signed(1), signed(2)))
        }
        Core::Convex(hull) => hull.points().get(n).copied(),
        Core::Triangle(corners) => corners.get(n).copied(),
        Core::Segment(ends) => ends.get(n).copied(),
        Core::AxialSegment { half_length } => {
            (n < 2).then(|| Vec3::new(0.0, 0.0, if n == 1 { -half_length } else { *half_length }))
        }
        Core::Point => (n == 0).then_some(ORIGIN),
        Core::Column(column) => column.corners().get(n).copied(),
        Core::Block(block) => block.corners().get(n).copied(),
        Core::Cylinder { .. }
        | Core::Cone { .. }
        | Core::Ellipsoid { .. }
        | Core::HalfSpace { .. }
        | Core::Plane { .. }
        | Core::Mesh(_)
        | Core::Compound(_)
        | Core::HeightField(_)
        | Core::PointCloud(_)
        | Core::Voxels(_) => None,
    }
}

/// A point well inside of the core: where a search aims at first.
pub(super) fn center(core: &Core) -> Vec3 {
    match core {
        Core::Convex(hull) => hull.bounds().center(),
        Core::Triangle([a, b, c]) => (a + b + c) / 3.0,
        Core::Segment([a, b]) => (a + b) / 2.0,
        Core::Block(block) => block.center(),
        Core::Column(Column { top: [a, b, c], floor }) => {
            let [x, y, z] = [0, 1, 2].map(|i| (a[i] + b[i] + c[i]) / 3.0);
            Vec3::new(x, y, (z + floor) / 2.0)
        }
        Core::Point
        | Core::Cuboid { .. }
        | Core::AxialSegment { .. }
        | Core::Cylinder { .. }
        | Core::Cone { .. }
        | Core::Ellipsoid { .. }
        | Core::HalfSpace { .. }
        | Core::Plane { .. }
        | Core::Mesh(_)
        | Core::Compound(_)
        | Core::HeightField(_)
        | Core::PointCloud(_)
        | Core::Voxels(_) => ORIGIN,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Shape;

    /// The support value is not below the value at any sampled point of the shape: checked against closed forms.
    #[test]
    fn round_supports_match_their_closed_forms() {
        let directions = (0..500).map(|i| {
            let t = f64::from(i);
            Vec3::new(libm::sin(t), libm::cos(1.7 * t), libm::sin(0.3 * t + 1.0))
        });
        for d in directions {
            let value = |shape: &Shape| d.dot(&support(shape.core(), d));
            let across = libm::hypot(d.x, d.y);
            let cylinder = Shape::cylinder(0.3, 0.7).unwrap();
            assert!((value(&cylinder) - (0.3 * across + 0.7 * d.z.abs())).abs() < 1e-15);
            let cone = Shape::cone(0.3, 0.7).unwrap();
            assert!((value(&cone) - (0.7 * d.z).max(0.3 * across - 0.7 * d.z)).abs() < 1e-15);
            let ellipsoid = Shape::ellipsoid(Vec3::new(0.1, 0.5, 2.0)).unwrap();
            assert!((value(&ellipsoid) - Vec3::new(0.1 * d.x, 0.5 * d.y, 2.0 * d.z).norm()).abs() < 1e-15);
        }
    }

    #[test]
    fn directions_whose_squares_underflow_are_still_directions() {
        let d = Vec3::new(3e-200, 4e-200, 0.0);
        let p = support(Shape::cylinder(5.0, 1.0).unwrap().core(), d);
        assert!((p - Vec3::new(3.0, 4.0, 1.0)).norm() < 1e-14);
    }
}
