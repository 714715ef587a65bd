//! The convex hull of a cloud of points, and its support function.

use super::hull_builder::{self, Spanning};
use super::hull_climb::{self, StartTable};
use super::hull_scan::Scan;
use super::hull_surface::HullSurface;
use super::shape::position;
use super::{Aabb, CornerSums, CornerWeights, HullInterior, InvalidShape, Vec3, length};

/// The convex hull of some points, possibly flat, a segment or a single point.
///
/// It is as exact as the points it was made from: a hull builder's answer is used only as far as it is proved
/// ([`HullSurface`]), and where the builder gives up, as builders do on slivers, all distinct points are kept.
#[derive(Clone, Debug)]
pub struct ConvexHull {
    points: Vec<Vec3>,
    scan: Scan,
    surface: Option<HullSurface>,
    /// Of hulls that are large enough for climbing to pay.
    starts: Option<StartTable>,
    interior: Option<HullInterior>,
    bounds: Aabb,
    radius: f64,
}

/// From this many points on the support function climbs along edges instead of looking at every point.
const CLIMBED: usize = 56;

/// From this many points on an ellipsoid fills enough of the hull to be worth asking.
const ROUND: usize = 24;

impl ConvexHull {
    /// # Errors
    /// No points, or one that is not finite or out of reach.
    pub fn new(points: &[Vec3]) -> Result<Self, InvalidShape> {
        if points.is_empty() {
            return Err(InvalidShape::Empty { field: "points" });
        }
        for (i, p) in points.iter().enumerate() {
            position(|| format!("points[{i}]"), *p)?;
        }
        Ok(Self::spanned_by(hull_builder::spanning(points)))
    }

    /// The points that span the hull, in the order given, without duplicates.
    #[must_use]
    pub fn points(&self) -> &[Vec3] {
        &self.points
    }

    /// Bytes on the heap.
    #[must_use]
    pub fn memory(&self) -> usize {
        let surface = self.surface.as_ref().map_or(0, HullSurface::memory);
        size_of_val(&*self.points) + self.scan.memory() + surface + self.starts.as_ref().map_or(0, StartTable::memory)
    }

    /// The triangles of the hull; none for hulls that are flat, or whose surface could not be proved convex.
    #[must_use]
    pub fn surface(&self) -> Option<&HullSurface> {
        self.surface.as_ref()
    }

    /// Index of a point where `direction . x` is greatest, for a direction of any length. `hint` is a guess, such as the
    /// last answer for a direction nearby; anything else than an index of a point is no guess.
    ///
    /// The product at that point, in exact arithmetic, is less than the greatest by no more than `6 u |direction|
    /// radius`, u being the unit roundoff.
    #[must_use]
    #[inline]
    pub fn farthest(&self, direction: Vec3, hint: u32) -> u32 {
        match self.scan.farthest_of_few(direction) {
            Some(found) => found as u32,
            None => self.farthest_of_many(direction, hint),
        }
    }

    #[inline(never)]
    fn farthest_of_many(&self, direction: Vec3, hint: u32) -> u32 {
        if let (Some(surface), Some(starts)) = (&self.surface, &self.starts) {
            let start = if (hint as usize) < self.points.len() { hint } else { starts.start(direction) };
            if let Some(vertex) = hull_climb::highest(&self.points, surface, self.radius, start, direction) {
                return vertex;
            }
        }
        self.scan.farthest(direction) as u32
    }

    /// Bounds in the hull's frame.
    #[must_use]
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// What is known about its inside. Nothing where it has no proved surface, or its bounds' middle is not inside; nor of hulls of
    /// few corners, into which no large ellipsoid fits.
    #[must_use]
    pub fn interior(&self) -> Option<&HullInterior> {
        self.interior.as_ref()
    }

    /// Largest distance of a point from the origin, metres.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Sums over the corners, weighed by their heights.
    #[must_use]
    pub fn weighted(&self, weights: &CornerWeights) -> CornerSums {
        self.scan.weighted(weights, self.points.len())
    }

    /// Every length multiplied by `factor`, which keeps the corners the corners.
    pub(super) fn scaled(&self, factor: f64) -> Result<Self, InvalidShape> {
        let points: Vec<Vec3> = self.points.iter().map(|p| p * factor).collect();
        for (i, p) in points.iter().enumerate() {
            position(|| format!("points[{i}]"), *p)?;
        }
        // Products round, so the surface has to be proved anew.
        let surface = self.surface.as_ref().and_then(|surface| HullSurface::proved(&points, surface.triangles()));
        Ok(Self::spanned_by(Spanning { points, surface }))
    }

    fn spanned_by(Spanning { points, surface }: Spanning) -> Self {
        let bounds = Aabb::around(points.iter().copied());
        let radius = points.iter().map(|p| length(*p)).fold(0.0, f64::max);
        let climbed = surface.as_ref().filter(|_| points.len() >= CLIMBED);
        let starts = climbed.map(|surface| StartTable::new(&points, surface));
        let round = surface.as_ref().filter(|_| points.len() >= ROUND);
        let interior = round.and_then(|surface| HullInterior::of(&points, surface, &bounds, radius));
        Self { scan: Scan::new(&points), points, surface, starts, interior, bounds, radius }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube_corners() -> Vec<Vec3> {
        (0..8).map(|i| Vec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2))).collect()
    }

    #[test]
    fn duplicates_and_inner_points_are_left_out() {
        let mut points = cube_corners();
        points.push(Vec3::new(0.5, 0.5, 0.5));
        points.extend(cube_corners());
        points.push(Vec3::new(0.25, 0.5, 0.75));
        let hull = ConvexHull::new(&points).unwrap();
        assert_eq!(hull.points(), cube_corners());
    }

    #[test]
    fn flat_and_collinear_clouds_keep_what_spans_them() {
        let square: Vec<Vec3> = (0..25).map(|i| Vec3::new(f64::from(i % 5), f64::from(i / 5), 2.0)).collect();
        let hull = ConvexHull::new(&square).unwrap();
        for corner in [(0.0, 0.0), (4.0, 0.0), (0.0, 4.0), (4.0, 4.0)] {
            assert!(hull.points().contains(&Vec3::new(corner.0, corner.1, 2.0)));
        }
        let line: Vec<Vec3> = (0..9).map(|i| Vec3::new(f64::from(i), 0.0, 0.0)).collect();
        let hull = ConvexHull::new(&line).unwrap();
        assert!(hull.points().contains(&line[0]) && hull.points().contains(&line[8]));
        let point = ConvexHull::new(&[Vec3::x(), Vec3::x(), Vec3::x()]).unwrap();
        assert_eq!(point.points(), [Vec3::x()]);
    }

    #[test]
    fn empty_and_non_finite_clouds_are_refused_by_name() {
        assert_eq!(ConvexHull::new(&[]).unwrap_err(), InvalidShape::Empty { field: "points" });
        let error = ConvexHull::new(&[Vec3::zeros(), Vec3::new(0.0, f64::NAN, 0.0)]).unwrap_err();
        assert_eq!(error.to_string(), "points[1] is not finite");
    }
}
