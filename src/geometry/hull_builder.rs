//! Which of many points span their convex hull, and by which triangles.

use std::collections::HashMap;

use super::hull_surface::{HullSurface, side};
use super::{Aabb, Vec3};

/// The points a hull is made of, in the order given, and its surface where that is proved.
pub(super) struct Spanning {
    pub points: Vec<Vec3>,
    pub surface: Option<HullSurface>,
}

/// Exact tests of left-over points against faces that are made at most: some 0.1 s.
const MOST_TESTS: usize = 10_000_000;

/// The points that span the hull of at least one finite point.
///
/// The hull builder's answer is a choice among the points. Those it passed over are left out when they are proved to be
/// inside of its surface; where the surface itself is not proved, those that lie deep inside of it.
pub(super) fn spanning(points: &[Vec3]) -> Spanning {
    let distinct = distinct(points);
    let Some(faces) = built(&distinct) else { return Spanning { points: distinct, surface: None } };
    let mut is_corner = vec![false; distinct.len()];
    faces.iter().flatten().for_each(|&i| is_corner[i as usize] = true);
    let corners = chosen(&distinct, &is_corner);
    let mut renumbered = vec![0; distinct.len()];
    for (next, old) in (0u32..).zip((0..distinct.len()).filter(|&old| is_corner[old])) {
        renumbered[old] = next;
    }
    let triangles: Vec<[u32; 3]> = faces.iter().map(|face| face.map(|i| renumbered[i as usize])).collect();
    if (distinct.len() - corners.len()).saturating_mul(triangles.len()) <= MOST_TESTS
        && let Some(surface) = HullSurface::proved(&corners, &triangles)
    {
        let at = |i: u32| corners[i as usize];
        let holds = |p: Vec3| triangles.iter().all(|&[a, b, c]| side(at(a), at(b), at(c), p) >= 0.0);
        if distinct.iter().zip(&is_corner).all(|(p, is_corner)| *is_corner || holds(*p)) {
            return Spanning { points: corners, surface: Some(surface) };
        }
    }
    match not_deep_inside(&distinct, &faces, is_corner) {
        Some(points) => Spanning { points, surface: None },
        None => Spanning { points: distinct, surface: None },
    }
}

fn chosen(points: &[Vec3], kept: &[bool]) -> Vec<Vec3> {
    points.iter().zip(kept).filter(|(_, kept)| **kept).map(|(p, _)| *p).collect()
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

/// The hull's faces by parry's hull builder, as indices of `points`; none where it gives up.
fn built(points: &[Vec3]) -> Option<Vec<[u32; 3]>> {
    use parry3d_f64::math::Vector;
    use parry3d_f64::transformation::try_convex_hull;

    if points.len() < 4 {
        return None; // Flat.
    }
    // The builder has absolute tolerances, so it is shown points of unit size, centred. Both steps round, but its
    // answer is only a choice among our points, and what it is used for is checked with the points as given.
    let bounds = Aabb::around(points.iter().copied());
    let (center, size) = (bounds.center(), bounds.half_extents().amax());
    if size <= f64::MIN_POSITIVE {
        return None;
    }
    let unit: Vec<Vector> = points.iter().map(|p| (p - center) / size).map(|p| Vector::new(p.x, p.y, p.z)).collect();
    // A builder that panics on a degenerate cloud is a builder that gave up.
    let (corners, faces) = std::panic::catch_unwind(|| try_convex_hull(&unit)).ok()?.ok()?;
    let bits = |p: &Vector| [p.x, p.y, p.z].map(|c| (c + 0.0).to_bits()); // + 0.0: -0 equals 0
    let mut first_at = HashMap::with_capacity(unit.len());
    (0u32..).zip(&unit).for_each(|(i, p)| _ = first_at.entry(bits(p)).or_insert(i));
    let index: Vec<u32> = corners.iter().map(|corner| first_at.get(&bits(corner)).copied()).collect::<Option<_>>()?;
    Some(faces.iter().map(|face| face.map(|corner| index[corner as usize])).collect())
}

/// The points that are corners, or not deep behind every face.
fn not_deep_inside(points: &[Vec3], faces: &[[u32; 3]], mut kept: Vec<bool>) -> Option<Vec<Vec3>> {
    if kept.iter().any(|kept| !kept) {
        let size = Aabb::around(points.iter().copied()).half_extents().amax();
        let planes: Vec<Plane> = faces.iter().map(|face| Plane::through(*face, points, size)).collect::<Option<_>>()?;
        for (p, kept) in points.iter().zip(&mut kept) {
            *kept = *kept || !planes.iter().all(|plane| plane.has_deep_behind(*p));
        }
    }
    Some(chosen(points, &kept))
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
    fn through(face: [u32; 3], points: &[Vec3], size: f64) -> Option<Self> {
        let [a, b, c] = face.map(|i| points[i as usize]);
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
