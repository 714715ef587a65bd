//! The bounds on the errors of witness points and normals.
//!
//! Oracle: the same pair to a relative 1e-12. Its own errors are added, so it is trusted fully. Whether a point is in a shape is
//! asked of the library as the distance of the shape from that point.

use clearance::geometry::{Placement, Shape};
use clearance::narrow_phase::{Accuracy, Depth, Goal, Solver, separation};

use crate::samples::{Random, convex_shapes};

#[test]
fn normals_and_points_are_as_near_the_truth_as_they_say() {
    let mut random = Random::new(51);
    let shapes = convex_shapes();
    let accuracy = |relative| Accuracy { absolute: 0.0, relative };
    let exact = Goal { accuracy: accuracy(1e-12), ..Goal::penetration() };
    let (mut turned, mut narrow, mut inside) = (0, 0, 0);
    for a in &shapes {
        for b in &shapes {
            let (at_a, at_b) = (random.pose(0.8).placement(), random.pose(0.8).placement());
            let truth = separation(a, b, &at_a, &at_b, &exact).unwrap();
            for (relative, depth) in [
                (1e-1, Depth::Distance),
                (1e-3, Depth::Distance),
                (1e-6, Depth::Distance),
                (1e-1, Depth::Penetration),
                (1e-9, Depth::Penetration),
            ] {
                for solver in [Solver::Default, Solver::GjkNesterov, Solver::FrankWolfe] {
                    let goal = Goal { accuracy: accuracy(relative), depth, solver, ..Goal::penetration() };
                    let found = separation(a, b, &at_a, &at_b, &goal).unwrap();
                    let what = || format!("{} and {}, {solver}: {found:?}, {truth:?}", a.kind(), b.kind());
                    assert!(found.normal_error > 0.0 && found.point_error > 0.0, "{}", what());
                    if truth.bracket.lower > 0.0 {
                        let chord = (found.normal - truth.normal).norm();
                        assert!(chord <= found.normal_error + truth.normal_error, "{}", what());
                        let vector = |s: &clearance::narrow_phase::Separation| s.point_on_b - s.point_on_a;
                        let apart = (vector(&found) - vector(&truth)).norm();
                        assert!(apart <= found.point_error + truth.point_error, "{}", what());
                        turned += usize::from(chord > 0.1 * found.normal_error);
                        narrow += usize::from(relative < 1e-5 && found.normal_error < 1e-2 && found.point_error < 1e-2);
                    }
                    for (shape, at, point) in [(a, &at_a, found.point_on_a), (b, &at_b, found.point_on_b)] {
                        let probe = Placement { translation: point, ..*at };
                        let off = separation(shape, &Shape::point(), at, &probe, &Goal::penetration()).unwrap();
                        assert!(off.bracket.lower <= found.point_error, "{off:?} {}", what());
                        inside += usize::from(off.bracket.lower < 1e-9);
                    }
                }
            }
        }
    }
    // The bounds are reached to within a factor of ten now and then, and mostly say something.
    assert!(turned > 10 && narrow > 100 && inside > 1000, "{turned}, {narrow}, {inside}");
}
