//! What is known about the inside of a hull: enough to say of a point, without looking at its faces, that it is well inside.

use super::hull_surface::HullSurface;
use super::tolerance::{UNIT_ROUNDOFF, UNSCALED_EXTENT};
use super::{Aabb, Vec3};

/// A ball and an ellipsoid around one middle, both within the hull; metres.
#[derive(Clone, Copy, Debug)]
pub struct HullInterior {
    /// The middle of the hull's bounds.
    pub center: Vec3,
    /// Radius of the ball.
    pub inradius: f64,
    /// Semi-axes of the ellipsoid, which has the proportions of the bounds.
    pub radii: Vec3,
}

impl HullInterior {
    /// None where the middle of the bounds is not clearly inside. `radius`: no point is farther from the origin, metres.
    ///
    /// With n the product of two edges of a face, a one of its corners, c the middle and D the half extents, the plane is at
    /// n . (a - c) / |n| from the middle, and the ellipsoid c + k D u is on its inner side when k |D n| <= n . (a - c). No edge is
    /// longer than L = 2 radius, nor a half extent, nor a - c; n is off by less than 8 u L^2, the products with it round another
    /// 4 u L^3.
    pub(super) fn of(points: &[Vec3], surface: &HullSurface, bounds: &Aabb, radius: f64) -> Option<Self> {
        if !(UNSCALED_EXTENT.0..=UNSCALED_EXTENT.1).contains(&radius) {
            return None;
        }
        let (center, half, longest) = (bounds.center(), bounds.half_extents(), 2.0 * radius);
        let error_of_normal = 16.0 * UNIT_ROUNDOFF * longest * longest;
        let error = error_of_normal * longest;
        let (mut inradius, mut scale) = (f64::INFINITY, f64::INFINITY);
        for triangle in surface.triangles() {
            let [a, b, c] = triangle.map(|i| points[i as usize]);
            let normal = (b - a).cross(&(c - a));
            let room = normal.dot(&(a - center)) - error;
            inradius = inradius.min(room / (normal.norm() + error_of_normal));
            scale = scale.min(room / (half.component_mul(&normal).norm() + error));
        }
        // Quotients and roots: a few units in the last place.
        let inner = 1.0 - 16.0 * UNIT_ROUNDOFF;
        (inradius > 0.0 && scale > 0.0).then(|| Self {
            center,
            inradius: inradius * inner,
            radii: half * (scale * inner),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::ConvexHull;
    use super::*;

    fn interior(points: &[Vec3]) -> Option<HullInterior> {
        let hull = ConvexHull::new(points).unwrap();
        HullInterior::of(hull.points(), hull.surface()?, &hull.bounds(), hull.radius())
    }

    #[test]
    fn ball_and_ellipsoid_of_a_box_touch_its_faces() {
        let corner = |i: usize| Vec3::new((i & 1) as f64, 2.0 * (i >> 1 & 1) as f64, 4.0 * (i >> 2) as f64);
        let inside = interior(&(0..8).map(corner).collect::<Vec<Vec3>>()).unwrap();
        assert_eq!(inside.center, Vec3::new(0.5, 1.0, 2.0));
        assert!(inside.inradius < 0.5 && inside.inradius > 0.5 - 1e-11);
        let short = Vec3::new(0.5, 1.0, 2.0) - inside.radii;
        assert!(short.min() > 0.0 && short.max() < 1e-11, "{short:?}");
        assert!(interior(&[Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()]).is_none(), "the middle is outside");
    }

    /// Oracle: the planes of all faces, straight from the corners.
    #[test]
    fn what_is_said_to_be_inside_of_random_hulls_is() {
        let mut seed = 7u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        let mut found = 0;
        for count in [5, 6, 8, 10, 30, 200] {
            let points: Vec<Vec3> =
                (0..count).map(|_| Vec3::new(random(), 0.1 * random(), 2.0 * random()) + Vec3::x()).collect();
            let hull = ConvexHull::new(&points).unwrap();
            let (Some(inside), Some(surface)) = (interior(&points), hull.surface()) else { continue };
            found += 1;
            let least_height = |p: Vec3| {
                let height = |triangle: &[u32; 3]| {
                    let [a, b, c] = triangle.map(|i| hull.points()[i as usize]);
                    (b - a).cross(&(c - a)).normalize().dot(&(a - p))
                };
                surface.triangles().iter().map(height).fold(f64::INFINITY, f64::min)
            };
            assert!(least_height(inside.center) >= inside.inradius - 1e-13);
            for _ in 0..200 {
                let u = Vec3::new(random(), random(), random()).normalize();
                assert!(least_height(inside.center + inside.radii.component_mul(&u)) > -1e-13, "{count}: {u:?}");
            }
        }
        assert!(found >= 4, "{found} hulls");
    }
}
