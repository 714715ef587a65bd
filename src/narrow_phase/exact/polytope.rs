//! The cores that are hulls of a few points with rational coordinates, as those points.

use arrayvec::ArrayVec;
use dashu_int::IBig;

use super::integers::{Span, integer};
use super::vector::Vector;
use crate::geometry::{Core, Vec3};

/// The corners of a core in its own frame. Not every one of them has to be extreme.
pub(super) struct Polytope<'a> {
    corners: Corners<'a>,
    /// Bits of the coordinates.
    pub span: Span,
}

enum Corners<'a> {
    Origin,
    /// Both signs of the half extents.
    Cuboid(Vec3),
    /// Both ends of a segment around the origin.
    Axis(Vec3),
    Listed(&'a [Vec3]),
    Few(ArrayVec<Vec3, 8>),
}

impl<'a> Polytope<'a> {
    /// The core, and a radius that is swept over it besides the shape's own; none for what is curved otherwise.
    pub fn of(core: &'a Core) -> Option<(Self, f64)> {
        let along = |half_length| Corners::Axis(Vec3::new(0.0, 0.0, half_length));
        let (corners, radius) = match core {
            Core::Point => (Corners::Origin, 0.0),
            Core::Cuboid { half_extents } => (Corners::Cuboid(*half_extents), 0.0),
            Core::AxialSegment { half_length } => (along(*half_length), 0.0),
            Core::Cylinder { radius, half_length } | Core::Cone { radius, half_length } if *radius == 0.0 => {
                (along(*half_length), 0.0)
            }
            // A ball, or flat in two directions.
            Core::Ellipsoid { radii } if radii.x == radii.y && radii.y == radii.z => (Corners::Origin, radii.x),
            Core::Ellipsoid { radii } if radii.iter().filter(|r| **r != 0.0).count() == 1 => {
                (Corners::Axis(*radii), 0.0)
            }
            Core::Convex(hull) => (Corners::Listed(hull.points()), 0.0),
            Core::Triangle(corners) => (Corners::Listed(corners), 0.0),
            Core::Segment(ends) => (Corners::Listed(ends), 0.0),
            Core::Column(column) => (Corners::Few(column.corners().into_iter().collect()), 0.0),
            Core::Block(block) => (Corners::Few(block.corners().into()), 0.0),
            Core::Cylinder { .. }
            | Core::Cone { .. }
            | Core::Ellipsoid { .. }
            | Core::HalfSpace { .. }
            | Core::Plane { .. }
            | Core::Mesh(_)
            | Core::Compound(_)
            | Core::HeightField(_)
            | Core::PointCloud(_)
            | Core::Voxels(_) => return None,
        };
        let span = match &corners {
            Corners::Origin => Span::EMPTY,
            Corners::Cuboid(half) | Corners::Axis(half) => Span::of(half.iter().copied()),
            Corners::Listed(points) => Span::of(points.iter().flat_map(|p| p.iter().copied())),
            Corners::Few(points) => Span::of(points.iter().flat_map(|p| p.iter().copied())),
        };
        Some((Self { corners, span }, radius))
    }

    fn len(&self) -> usize {
        match &self.corners {
            Corners::Origin => 1,
            Corners::Cuboid(_) => 8,
            Corners::Axis(_) => 2,
            Corners::Listed(points) => points.len(),
            Corners::Few(points) => points.len(),
        }
    }

    /// A corner, metres.
    pub fn corner(&self, index: usize) -> Vec3 {
        let signed = |bit: usize, c: f64| if index >> bit & 1 == 0 { c } else { -c };
        match &self.corners {
            Corners::Origin => Vec3::zeros(),
            Corners::Cuboid(half) => Vec3::new(signed(0, half.x), signed(1, half.y), signed(2, half.z)),
            Corners::Axis(half) => half.map(|c| signed(0, c)),
            Corners::Listed(points) => points[index],
            Corners::Few(points) => points[index],
        }
    }

    /// A corner divided by `2^exponent`.
    pub fn integer_corner(&self, index: usize, exponent: i32) -> Vector {
        let p = self.corner(index);
        Vector([p.x, p.y, p.z].map(|c| integer(c, exponent)))
    }

    /// The corner where `direction . corner` is least: the first among equals. Doubles sort out all but those that are
    /// nearly as low as the lowest; among these integers decide.
    pub fn lowest(&self, direction: &Vector, exponent: i32) -> usize {
        // Coordinates are scaled into [-1, 1], in two steps because one factor may not be a double. The products are off by
        // less than 2^-49 then: three terms of at most 1, each by 2^-52 of the direction and three roundings.
        let half = self.span.highest.clamp(-1100, 1100) / 2;
        let (one, other) =
            (libm::exp2(f64::from(-half)), libm::exp2(f64::from(half - self.span.highest.clamp(-1100, 1100))));
        let d = direction.normalised().0;
        let value = |index: usize| d.dot(&(self.corner(index) * one * other));
        let least = (0..self.len()).map(value).fold(f64::INFINITY, f64::min);
        let mut candidates = (0..self.len()).filter(|&index| value(index) <= least + 2.0 * PRODUCT_ERROR);
        let first = candidates.next().unwrap_or(0);
        let exact = |index: usize| direction.dot(&self.integer_corner(index, exponent));
        let mut best: Option<(usize, IBig)> = None;
        for index in candidates {
            let (_, least) = best.get_or_insert_with(|| (first, exact(first)));
            let value = exact(index);
            if value < *least {
                best = Some((index, value));
            }
        }
        best.map_or(first, |(index, _)| index)
    }
}

/// How far a product of a direction and a scaled corner may be off.
const PRODUCT_ERROR: f64 = 1.0 / (1u64 << 49) as f64;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Shape;

    #[test]
    fn the_lowest_corner_is_the_lowest_by_the_last_bit() {
        let low = |i: u32| Vec3::new(f64::from(i), 1.0 - f64::from(i % 3) * f64::EPSILON / 2.0, 0.5);
        let points: Vec<Vec3> = (0..7).map(low).collect();
        let shape = Shape::convex(&points).unwrap();
        let (polytope, radius) = Polytope::of(shape.core()).unwrap();
        let lowest = polytope.lowest(&Vector::axis(1), polytope.span.lowest);
        assert_eq!((radius, polytope.corner(lowest).y), (0.0, 1.0 - f64::EPSILON));
    }

    #[test]
    fn boxes_have_their_eight_corners_at_any_scale() {
        for scale in [1e-300, 1.0, 1e150] {
            let shape = Shape::cuboid(Vec3::new(1.0, 2.0, 3.0) * scale).unwrap();
            let (polytope, _) = Polytope::of(shape.core()).unwrap();
            let direction = Vector([3, -1, 1].map(IBig::from));
            let lowest = polytope.lowest(&direction, polytope.span.lowest);
            assert_eq!(polytope.corner(lowest), Vec3::new(-1.0, 2.0, -3.0) * scale);
        }
    }

    #[test]
    fn balls_and_thin_bodies_are_polytopes_in_disguise() {
        let of = |shape: Shape| Polytope::of(shape.core()).map(|(polytope, radius)| (polytope.len(), radius));
        assert_eq!(of(Shape::ellipsoid(Vec3::repeat(0.3)).unwrap()), Some((1, 0.3)));
        assert_eq!(of(Shape::ellipsoid(Vec3::new(0.0, 0.3, 0.0)).unwrap()), Some((2, 0.0)));
        assert_eq!(of(Shape::cylinder(0.0, 2.0).unwrap()), Some((2, 0.0)));
        assert_eq!(of(Shape::cylinder(0.1, 0.0).unwrap()), None);
        assert_eq!(of(Shape::ellipsoid(Vec3::new(0.1, 0.1, 0.2)).unwrap()), None);
    }
}
