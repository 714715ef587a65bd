//! Support points of all convex, bounded cores in double-doubles.

use super::number::DoubleDouble;
use super::vector::Vector;
use crate::geometry::{Core, Vec3};

/// A point of the core where `direction . x` is greatest, to rounding: times `scale`, in the core's frame.
///
/// # Panics
/// For cores that are not convex and bounded, as the support function in doubles does.
pub(super) fn support(core: &Core, direction: Vector, scale: f64) -> Vector {
    let [x, y, z] = direction.0;
    let length = |value: f64| DoubleDouble::from(value * scale);
    let signed = |value: f64, d: DoubleDouble| length(value.copysign(d.to_f64()));
    let zero = DoubleDouble::ZERO;
    match core {
        Core::Point => Vector::default(),
        Core::Cuboid { half_extents: h } => Vector([signed(h.x, x), signed(h.y, y), signed(h.z, z)]),
        Core::AxialSegment { half_length } => Vector([zero, zero, signed(*half_length, z)]),
        Core::Cylinder { radius, half_length } => rim(length(*radius), signed(*half_length, z), direction),
        Core::Cone { radius, half_length } => {
            let base = rim(length(*radius), -length(*half_length), direction);
            let apex = Vector([zero, zero, length(*half_length)]);
            if direction.dot(apex) < direction.dot(base) { base } else { apex }
        }
        Core::Ellipsoid { radii } => {
            let radii = Vector::from(*radii).scaled(scale);
            let stretched = Vector(std::array::from_fn(|i| radii.0[i] * direction.0[i]));
            stretched.unit().map_or_else(Vector::default, |u| Vector(std::array::from_fn(|i| radii.0[i] * u.0[i])))
        }
        Core::Convex(hull) => farthest(hull.points(), direction, scale),
        Core::Triangle(corners) => farthest(corners, direction, scale),
        Core::Segment(ends) => farthest(ends, direction, scale),
        Core::Block(block) => farthest(&block.corners(), direction, scale),
        Core::Column(column) => farthest(&column.corners(), direction, scale),
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

/// Point of the disc of that radius at that height, farthest along `d`.
fn rim(radius: DoubleDouble, height: DoubleDouble, d: Vector) -> Vector {
    let [x, y, _] = d.0;
    let across = Vector([x, y, DoubleDouble::ZERO]).unit().unwrap_or_default();
    Vector([across.0[0] * radius, across.0[1] * radius, height])
}

/// The point farthest along `d`; the first among equals. Doubles sort out those that are surely nearer.
fn farthest(points: &[Vec3], d: Vector, scale: f64) -> Vector {
    let rounded = d.rounded();
    let value = |p: &Vec3| rounded.dot(&(p * scale));
    let greatest = points.iter().map(value).fold(f64::NEG_INFINITY, f64::max);
    // Three products and sums of lengths up to about 1, twice.
    let near =
        greatest - 16.0 * f64::EPSILON * rounded.norm() * points.iter().map(|p| p.amax() * scale).fold(0.0, f64::max);
    let mut best = (Vector::default(), DoubleDouble::from(f64::NEG_INFINITY));
    for p in points.iter().filter(|p| value(p) >= near) {
        let p = Vector::from(*p).scaled(scale);
        let value = d.dot(p);
        if best.1 < value {
            best = (p, value);
        }
    }
    best.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Shape;

    /// Support values have closed forms, and those are the oracle; scaled by a power of two they scale.
    #[test]
    fn support_values_are_those_of_the_closed_forms() {
        let two = DoubleDouble::from(2.0);
        let third = DoubleDouble::ONE / DoubleDouble::from(3.0);
        let d = Vector([two * third, -third, two * third]); // Of length 1, but no double is.
        let value = |shape: Shape| d.dot(support(shape.core(), d, 0.25)).scaled(4.0);
        let close = |found: DoubleDouble, expected: DoubleDouble| {
            assert!((found - expected).abs().to_f64() < 1e-30, "{found:?} {expected:?}");
        };
        let across = DoubleDouble::from(5.0).sqrt() * third;
        let (r, h) = (DoubleDouble::from(0.3), DoubleDouble::from(0.7));
        close(value(Shape::cylinder(0.3, 0.7).unwrap()), r * across + h * two * third);
        close(value(Shape::cone(0.3, 0.7).unwrap()), h * two * third);
        close(value(Shape::cone(3.0, 0.7).unwrap()), DoubleDouble::from(3.0) * across - h * two * third);
        let radii = [0.1, 0.5, 2.0].map(DoubleDouble::from);
        let stretched = Vector(std::array::from_fn(|i| radii[i] * d.0[i]));
        close(value(Shape::ellipsoid(Vec3::new(0.1, 0.5, 2.0)).unwrap()), stretched.norm());
        close(value(Shape::cuboid(Vec3::new(0.3, 0.7, 0.3)).unwrap()), r * two * two * third + h * third);
        let corner = Vec3::new(0.3, 0.0, 0.7);
        close(value(Shape::segment(corner, Vec3::zeros()).unwrap()), (r + h) * two * third);
    }
}
