//! Queries that start where the last one of the pair ended.
//!
//! Oracle: the same query without a cache. Both brackets hold the truth, so they overlap, and verdicts never contradict.

use clearance::geometry::{Placement, Pose, Quaternion, Vec3};
use clearance::narrow_phase::{Accuracy, Depth, Goal, PairCache, Separation, separation, separation_again};

use crate::samples::{Random, convex_shapes};

/// Small steps of a body that drifts and turns past the origin.
fn track(random: &mut Random, steps: usize) -> Vec<Placement> {
    let (start, drift, axis) = (random.direction() * 1.1, random.direction() * 0.02, random.direction());
    let place = |step: usize| {
        let translation = start * (1.0 - 0.03 * step as f64) + drift * step as f64;
        Pose::new(translation, Quaternion::about_axis(axis, 0.02 * step as f64)).unwrap().placement()
    };
    (0..steps).map(place).collect()
}

fn assert_agree(cached: &Separation, fresh: &Separation, what: &str) {
    let (one, other) = (cached.bracket, fresh.bracket);
    assert!(one.lower <= other.upper && other.lower <= one.upper, "{what}: {cached:?} and {fresh:?}");
}

#[test]
fn tracks_through_a_cache_agree_with_fresh_queries_and_cost_less() {
    let mut random = Random::new(31);
    let shapes = convex_shapes();
    let origin = random.pose(0.1).placement();
    let accuracy = Accuracy { relative: 1e-6, ..Accuracy::default() };
    for depth in [Depth::Verdict, Depth::Distance, Depth::Penetration] {
        let goal = Goal { depth, accuracy, ..Goal::penetration() };
        let (mut cached_cost, mut fresh_cost, mut apart, mut deep) = (0, 0, 0, 0);
        for (i, a) in shapes.iter().enumerate() {
            let b = &shapes[(i * 5 + 3) % shapes.len()];
            let mut cache = PairCache::new();
            for at_b in track(&mut random, 50) {
                let cached = separation_again(a, b, &origin, &at_b, &goal, &mut cache).unwrap();
                let fresh = separation(a, b, &origin, &at_b, &goal).unwrap();
                assert_agree(&cached, &fresh, &format!("{} and {}, {depth:?}", a.kind(), b.kind()));
                cached_cost += cached.cost.supports;
                fresh_cost += fresh.cost.supports;
                apart += usize::from(fresh.bracket.lower > 0.0);
                deep += usize::from(fresh.bracket.upper < 0.0);
            }
        }
        assert!(cached_cost < fresh_cost, "{depth:?}: {cached_cost} supports with, {fresh_cost} without");
        assert!(apart > 100 && deep > 100, "{depth:?}: {apart} apart, {deep} deep");
    }
}

#[test]
fn a_cache_of_another_pair_costs_time_and_not_truth() {
    let mut random = Random::new(32);
    let shapes = convex_shapes();
    let mut cache = PairCache::new();
    for _ in 0..400 {
        let (a, b) = (&shapes[random.index(shapes.len())], &shapes[random.index(shapes.len())]);
        let (at_a, at_b) = (random.pose(0.4).placement(), random.pose(0.4).placement());
        let cached = separation_again(a, b, &at_a, &at_b, &Goal::penetration(), &mut cache).unwrap();
        let fresh = separation(a, b, &at_a, &at_b, &Goal::penetration()).unwrap();
        assert_agree(&cached, &fresh, &format!("{} and {}", a.kind(), b.kind()));
    }
}

#[test]
fn what_was_apart_is_told_apart_again_by_one_direction() {
    let mut random = Random::new(33);
    let shapes = convex_shapes();
    for a in &shapes {
        for b in &shapes {
            let mut cache = PairCache::new();
            let (at_a, mut at_b) = (random.pose(0.2).placement(), random.pose(0.2).placement());
            at_b.translation += random.direction() * 1.6;
            let ask = |at_b: &Placement, cache: &mut PairCache| {
                separation_again(a, b, &at_a, at_b, &Goal::verdict(), cache).unwrap()
            };
            let first = ask(&at_b, &mut cache);
            assert!(first.bracket.lower > 0.0, "{} and {}: {first:?}", a.kind(), b.kind());
            at_b.translation += Vec3::repeat(1e-3);
            assert!(ask(&at_b, &mut cache).cost.supports <= 1);
        }
    }
}

/// An overlap that the remembered simplex decides at once once had a lower bound of minus infinity, and points to match.
#[test]
fn an_overlap_decided_from_memory_has_finite_numbers() {
    let shapes = convex_shapes();
    let at = Pose::identity().placement();
    for a in &shapes {
        for b in &shapes {
            let mut cache = PairCache::new();
            for depth in [Depth::Penetration, Depth::Distance, Depth::Verdict] {
                let goal = Goal { depth, ..Goal::penetration() };
                let found = separation_again(a, b, &at, &at, &goal, &mut cache).unwrap();
                let numbers = [found.bracket.lower, found.signed_distance, found.point_on_b.norm(), found.point_error];
                assert!(numbers.iter().all(|x| x.is_finite()), "{} and {}, {depth:?}: {found:?}", a.kind(), b.kind());
            }
        }
    }
}
