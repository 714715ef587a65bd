//! A ball that surely holds a shape, in the shape's own frame: what bounds the way of its points when it turns.

use super::{Core, Shape, Vec3, length};

/// Center and radius of a ball, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// Its middle.
    pub center: Vec3,
    /// No point of what it holds is farther from the middle.
    pub radius: f64,
}

/// Radii are rounded up by this factor: a dozen roundings of sums, squares and roots go into one.
const ROUNDING_UP: f64 = 1.0 + 32.0 * f64::EPSILON;

impl Ball {
    /// A ball around the middle of the shape's box, swept radius included; none for half-spaces and planes.
    ///
    /// It touches what it holds where corners are known; of a compound it holds the balls of the parts.
    #[must_use]
    pub fn around(shape: &Shape) -> Option<Self> {
        let center = shape.bounds()?.center();
        let farthest = |points: &[Vec3]| points.iter().map(|p| length(p - center)).fold(0.0, f64::max);
        let core = match shape.core() {
            Core::Point => 0.0,
            Core::Cuboid { half_extents } => length(*half_extents),
            Core::AxialSegment { half_length } => *half_length,
            Core::Cylinder { radius, half_length } | Core::Cone { radius, half_length } => {
                length(Vec3::new(*radius, *half_length, 0.0))
            }
            Core::Ellipsoid { radii } => radii.amax(),
            Core::Convex(hull) => farthest(hull.points()),
            Core::Triangle(corners) => farthest(corners),
            Core::Segment(ends) => farthest(ends),
            Core::Mesh(mesh) => farthest(mesh.vertices()),
            Core::Compound(compound) => {
                let reach = |part: &super::Part| {
                    let ball = Self::around(&part.shape)?;
                    Some(length(part.pose.placement().point(ball.center) - center) + ball.radius)
                };
                compound.parts().iter().filter_map(reach).fold(0.0, f64::max)
            }
            Core::Column(column) => farthest(&column.corners()),
            Core::Block(block) => farthest(&block.corners()),
            // Of many points the box tells enough: its middle is that of the ball.
            Core::HeightField(_) | Core::PointCloud(_) | Core::Voxels(_) => {
                length(shape.core().bounds()?.half_extents())
            }
            Core::HalfSpace { .. } | Core::Plane { .. } => return None,
        };
        // Differences from a middle far from the origin round by the middle's own size.
        let radius = (core + shape.swept_radius()) * ROUNDING_UP + 32.0 * f64::EPSILON * length(center);
        Some(Self { center, radius })
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::geometry::{Compound, Part, Pose, Quaternion};

    /// Oracle: known farthest points.
    #[test]
    fn balls_hold_their_shapes_and_are_tight_where_corners_are_known() {
        let points = [Vec3::new(1.0, 0.0, 0.0), Vec3::new(-1.0, 0.0, 0.0), Vec3::new(0.0, 2.0, 3.0)];
        for (shape, center, radius) in [
            (Shape::sphere(0.5).unwrap(), Vec3::zeros(), 0.5),
            (Shape::cuboid(Vec3::new(3.0, 4.0, 12.0)).unwrap(), Vec3::zeros(), 13.0),
            (Shape::capsule(0.5, 2.0).unwrap(), Vec3::zeros(), 2.5),
            (Shape::cylinder(3.0, 4.0).unwrap().swept(0.25).unwrap(), Vec3::zeros(), 5.25),
            (Shape::ellipsoid(Vec3::new(1.0, 2.0, 0.5)).unwrap(), Vec3::zeros(), 2.0),
            (Shape::convex(&points).unwrap(), Vec3::new(0.0, 1.0, 1.5), 4.25f64.sqrt()),
            (Shape::triangle(points[0], points[1], points[2]).unwrap(), Vec3::new(0.0, 1.0, 1.5), 4.25f64.sqrt()),
        ] {
            let ball = Ball::around(&shape).unwrap();
            assert!((ball.center - center).norm() < 1e-12, "{shape:?}: {ball:?}");
            assert!(ball.radius >= radius && ball.radius < radius + 1e-12, "{shape:?}: {ball:?}");
        }
        assert_eq!(Ball::around(&Shape::plane(Vec3::z(), 0.0).unwrap()), None);
    }

    #[test]
    fn the_ball_of_a_compound_holds_its_parts() {
        let pose = Pose::new(Vec3::new(2.0, 0.0, 0.0), Quaternion { w: 1.0, x: 0.3, y: -0.2, z: 0.5 }).unwrap();
        let part = Part { shape: Shape::cuboid(Vec3::new(1.0, 0.1, 0.1)).unwrap(), pose };
        let other = Part { shape: Shape::sphere(0.2).unwrap(), pose: Pose::identity() };
        let ball = Ball::around(&Shape::compound(Arc::new(Compound::new(vec![part, other]).unwrap()))).unwrap();
        for signs in 0..8 {
            let sign = |bit: i32| if signs >> bit & 1 == 1 { 1.0 } else { -1.0 };
            let corner = pose.placement().point(Vec3::new(sign(0), 0.1 * sign(1), 0.1 * sign(2)));
            assert!((corner - ball.center).norm() <= ball.radius);
        }
        assert!(ball.radius < 3.0);
    }
}
