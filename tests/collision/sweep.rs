//! Random pairs against a sweep of directions.
//!
//! Oracle: the signed distance is the greatest, over unit directions n, of the least n . (a - b); every direction tried
//! bounds it from below. The best of 1000 directions is improved by a random walk with shrinking steps, which ends within
//! 1e-3 m of a maximum for the shapes used here (half a metre, no needles), in an overlap perhaps of a lesser one. So the
//! sweep is trusted fully as a lower bound, and to 5e-3 as a value.

use clearance::geometry::{Core, Placement, Shape, Vec3};
use clearance::narrow_phase::{Goal, separation};

use crate::samples::{Random, convex_shapes};

/// Least `direction . x` over the placed shape, by a formula of its own for each kind.
pub fn least(shape: &Shape, at: &Placement, direction: Vec3) -> f64 {
    let d = at.direction_into(direction);
    let across = libm::hypot(d.x, d.y);
    let core = match shape.core() {
        Core::Point => 0.0,
        Core::Cuboid { half_extents } => -half_extents.dot(&d.abs()),
        Core::AxialSegment { half_length } => -half_length * d.z.abs(),
        Core::Cylinder { radius, half_length } => -radius * across - half_length * d.z.abs(),
        Core::Cone { radius, half_length } => (half_length * d.z).min(-radius * across - half_length * d.z),
        Core::Ellipsoid { radii } => -radii.component_mul(&d).norm(),
        Core::Convex(hull) => hull.points().iter().map(|p| p.dot(&d)).fold(f64::INFINITY, f64::min),
        Core::Triangle(corners) => corners.iter().map(|p| p.dot(&d)).fold(f64::INFINITY, f64::min),
        Core::Segment(ends) => ends.iter().map(|p| p.dot(&d)).fold(f64::INFINITY, f64::min),
        Core::HalfSpace { .. }
        | Core::Plane { .. }
        | Core::Mesh(_)
        | Core::Compound(_)
        | Core::HeightField(_)
        | Core::PointCloud(_)
        | Core::Voxels(_)
        | Core::Column(_)
        | Core::Block(_) => unreachable!("convex only"),
    };
    direction.dot(&at.translation) + core - shape.swept_radius()
}

#[test]
fn random_pairs_agree_with_the_sweep() {
    let mut random = Random::new(11);
    let directions: Vec<Vec3> = (0..1000).map(|_| random.direction()).collect();
    let shapes = convex_shapes();
    let (mut apart, mut touching, mut deep) = (0, 0, 0);
    for a in &shapes {
        for b in &shapes {
            let (at_a, at_b) = (random.pose(0.5).placement(), random.pose(0.5).placement());
            let found = separation(a, b, &at_a, &at_b, &Goal::penetration()).unwrap();
            let bound = |d: &Vec3| least(a, &at_a, *d) + least(b, &at_b, -d);
            let mut best = directions.iter().copied().max_by(|d, e| bound(d).total_cmp(&bound(e))).unwrap();
            let mut step = 0.1;
            while step > 1e-4 {
                let nearby = (best + random.direction() * step).normalize();
                if bound(&nearby) > bound(&best) { best = nearby } else { step *= 0.98 }
            }
            let sweep = bound(&best);
            let what = format!("{} and {}: {found:?}, sweep {sweep}", a.kind(), b.kind());
            assert!(found.bracket.upper >= sweep - 1e-12, "{what}");
            assert!(found.signed_distance <= sweep + 5e-3, "{what}");
            match found.signed_distance {
                d if d > 0.05 => apart += 1,
                d if d < -0.05 => deep += 1,
                _ => touching += 1,
            }
        }
    }
    assert!(apart > 20 && deep > 20 && touching > 5, "{apart} apart, {touching} near contact, {deep} deep");
}
