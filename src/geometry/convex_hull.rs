//! The convex hull of a cloud of points, as the few points that support it.

use std::collections::HashMap;

use super::shape::position;
use super::{Aabb, InvalidShape, Vec3, length};

/// The convex hull of some points, possibly flat, a segment or a single point.
///
/// Only the points are kept: a support function needs no faces. The hull builder's answer is used to leave out points that
/// are well inside; a point that it passed over, but that is near its surface, is kept. Where the builder gives up, as
/// builders do on slivers, all distinct points are kept. So a hull is as exact as the points it was made from.
#[derive(Clone, Debug)]
pub struct ConvexHull {
    points: Vec<Vec3>,
    /// The points again, coordinate by coordinate, filled up with copies of the first to whole blocks.
    blocks: Vec<[[f64; LANES]; 3]>,
    bounds: Aabb,
    radius: f64,
}

/// Points that are looked at together: as many as an AVX-512 register holds, two or four of the narrower ones.
const LANES: usize = 8;

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
        let distinct = distinct(points);
        Ok(Self::spanned_by(extreme_points(&distinct).unwrap_or(distinct)))
    }

    /// The points that span the hull, in the order given, without duplicates.
    #[must_use]
    pub fn points(&self) -> &[Vec3] {
        &self.points
    }

    /// The point farthest along `direction` (of any length); among equals the first. Metres, the hull's frame.
    #[must_use]
    pub fn support(&self, direction: Vec3) -> Vec3 {
        // First the greatest value, lane by lane and without branches; then the first point that has it, found by
        // evaluating the same expression again.
        let dot = |block: &[[f64; LANES]; 3], lane: usize| {
            block[0][lane] * direction.x + block[1][lane] * direction.y + block[2][lane] * direction.z
        };
        let mut greatest = [f64::NEG_INFINITY; LANES];
        for block in &self.blocks {
            for lane in 0..LANES {
                let value = dot(block, lane);
                greatest[lane] = if value > greatest[lane] { value } else { greatest[lane] };
            }
        }
        let greatest = greatest.into_iter().fold(f64::NEG_INFINITY, f64::max);
        for (b, block) in self.blocks.iter().enumerate() {
            for lane in 0..LANES {
                if dot(block, lane) == greatest {
                    return self.points.get(b * LANES + lane).copied().unwrap_or(self.points[0]);
                }
            }
        }
        self.points[0] // The direction has a component that is not a number.
    }

    /// Bounds in the hull's frame.
    #[must_use]
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Largest distance of a point from the origin, metres.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Every length multiplied by `factor`, which keeps the corners the corners.
    pub(super) fn scaled(&self, factor: f64) -> Result<Self, InvalidShape> {
        let points: Vec<Vec3> = self.points.iter().map(|p| p * factor).collect();
        for (i, p) in points.iter().enumerate() {
            position(|| format!("points[{i}]"), *p)?;
        }
        Ok(Self::spanned_by(points))
    }

    fn spanned_by(points: Vec<Vec3>) -> Self {
        let bounds = Aabb::around(points.iter().copied());
        let radius = points.iter().map(|p| length(*p)).fold(0.0, f64::max);
        let block = |chunk: &[Vec3]| {
            [0, 1, 2].map(|axis| std::array::from_fn(|lane| chunk.get(lane).unwrap_or(&points[0])[axis]))
        };
        let blocks = points.chunks(LANES).map(block).collect();
        Self { points, blocks, bounds, radius }
    }
}

/// The points without repetitions, first occurrences in order.
fn distinct(points: &[Vec3]) -> Vec<Vec3> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    let key = |i: usize| [points[i].x + 0.0, points[i].y + 0.0, points[i].z + 0.0]; // + 0.0: -0 equals 0
    order.sort_by(|&i, &j| key(i).partial_cmp(&key(j)).expect("points are finite").then(i.cmp(&j)));
    order.dedup_by(|later, first| key(*later) == key(*first));
    order.sort_unstable();
    order.into_iter().map(|i| points[i]).collect()
}

/// The hull's corners, by parry's hull builder, if its answer stands up to a check; `None` means keep every point.
fn extreme_points(points: &[Vec3]) -> Option<Vec<Vec3>> {
    use parry3d_f64::math::Vector;
    use parry3d_f64::transformation::try_convex_hull;

    if points.len() < 5 {
        return None; // Nothing much to leave out.
    }
    // The builder has absolute tolerances, so it is shown points of unit size, centred. Both steps round, but its
    // answer is only a choice among our points, and the check below is made with the points as given.
    let bounds = Aabb::around(points.iter().copied());
    let (center, size) = (bounds.center(), bounds.half_extents().amax());
    if size <= f64::MIN_POSITIVE {
        return None;
    }
    let unit: Vec<Vector> = points.iter().map(|p| (p - center) / size).map(|p| Vector::new(p.x, p.y, p.z)).collect();
    // A builder that panics on a degenerate cloud is a builder that gave up.
    let (corners, faces) = std::panic::catch_unwind(|| try_convex_hull(&unit)).ok()?.ok()?;
    let mut kept = vec![false; points.len()];
    let mut faces_by_point = Vec::with_capacity(faces.len());
    let bits = |p: &Vector| [p.x, p.y, p.z].map(|c| (c + 0.0).to_bits()); // + 0.0: -0 equals 0
    let mut first_at = HashMap::with_capacity(unit.len());
    unit.iter().enumerate().for_each(|(i, p)| _ = first_at.entry(bits(p)).or_insert(i));
    let index: Vec<usize> = corners.iter().map(|corner| first_at.get(&bits(corner)).copied()).collect::<Option<_>>()?;
    for face in &faces {
        let face = face.map(|corner| index[corner as usize]);
        face.iter().for_each(|&i| kept[i] = true);
        faces_by_point.push(face);
    }
    if kept.iter().any(|kept| !kept) {
        let planes: Vec<Plane> =
            faces_by_point.iter().map(|face| Plane::through(*face, points, size)).collect::<Option<_>>()?;
        for (p, kept) in points.iter().zip(&mut kept) {
            *kept = *kept || !planes.iter().all(|plane| plane.has_deep_behind(*p));
        }
    }
    Some(points.iter().zip(&kept).filter(|(_, kept)| **kept).map(|(p, _)| *p).collect())
}

/// A point is left out only if it is this far behind every face, in units of the hull's size. The builder's faces are off
/// by some 1e-15 of the size, and where two of them meet at an angle t the true hull may end 1e-15 / sin(t / 2) before
/// their planes do; a hull whose faces meet at less than 1e-8 is thinner than this depth, so nothing in it is left out.
const DEPTH_OF_INNER_POINTS: f64 = 1e-6;

/// The plane of a face.
struct Plane {
    point: Vec3,
    normal: Vec3,
    /// What the product with the normal has to stay below, for a point deep enough behind.
    depth: f64,
}

impl Plane {
    /// None for a face too thin to have a plane that can be trusted to a millionth: it encloses nothing.
    fn through(face: [usize; 3], points: &[Vec3], size: f64) -> Option<Self> {
        let [a, b, c] = face.map(|i| points[i]);
        let normal = (b - a).cross(&(c - a));
        let area = normal.norm();
        // The negation also catches an area that is NaN by overflow.
        let thin = !(area > 1e-8 * (b - a).norm() * (c - a).norm());
        (!thin).then_some(Self { point: a, normal, depth: -DEPTH_OF_INNER_POINTS * size * area })
    }

    fn has_deep_behind(&self, p: Vec3) -> bool {
        self.normal.dot(&(p - self.point)) < self.depth
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
