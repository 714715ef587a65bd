//! Every ordered pair of convex kinds: the swapped question, and less of a question. `laws` has more such laws, for every scale.

use clearance::geometry::{Placement, Shape};
use clearance::narrow_phase::{Bracket, Depth, Goal, separation};

use crate::samples::{Random, convex_shapes};

fn intersect(one: Bracket, other: Bracket) -> bool {
    one.lower <= other.upper && other.lower <= one.upper
}

/// Calls `check` with every ordered pair of kinds in `rounds` random places, and counts apart and overlapping ones.
fn for_all_pairs(rounds: usize, seed: u64, mut check: impl FnMut(&Shape, &Shape, &Placement, &Placement)) {
    let mut random = Random::new(seed);
    let shapes = convex_shapes();
    for a in &shapes {
        for b in &shapes {
            for _ in 0..rounds {
                check(a, b, &random.pose(0.6).placement(), &random.pose(0.6).placement());
            }
        }
    }
}

#[test]
fn swapped_sides_give_the_mirrored_answer() {
    let (mut apart, mut overlapping) = (0, 0);
    for_all_pairs(6, 1, |a, b, at_a, at_b| {
        let goal = Goal::penetration();
        let (one, other) = (separation(a, b, at_a, at_b, &goal).unwrap(), separation(b, a, at_b, at_a, &goal).unwrap());
        let what = || format!("{} and {}\n{one:?}\n{other:?}", a.kind(), b.kind());
        assert!(intersect(one.bracket, other.bracket), "{}", what());
        assert!((one.signed_distance - other.signed_distance).abs() < 2e-9, "{}", what());
        assert!(one.bracket.width() < 1e-8 && one.bracket.lower <= one.signed_distance, "{}", what());
        if one.signed_distance > 1e-3 {
            apart += 1;
            assert!((one.normal + other.normal).norm() < 1e-3, "{}", what());
        } else {
            overlapping += 1;
        }
    });
    assert!(apart > 200 && overlapping > 200, "{apart} apart, {overlapping} overlapping");
}

#[test]
fn asking_for_less_gives_a_looser_bracket_around_the_same_answer() {
    let (mut early, mut total) = (0, 0);
    for_all_pairs(4, 3, |a, b, at_a, at_b| {
        let full = separation(a, b, at_a, at_b, &Goal::penetration()).unwrap();
        for goal in [Goal::verdict(), Goal { depth: Depth::Distance, ..Goal::penetration() }] {
            let less = separation(a, b, at_a, at_b, &goal).unwrap();
            let what = || format!("{} and {}\n{full:?}\n{less:?}", a.kind(), b.kind());
            assert!(intersect(full.bracket, less.bracket), "{}", what());
            // What the full bracket decides, the loose one decides alike.
            assert_eq!(full.bracket.upper <= 0.0, less.bracket.upper <= 0.0, "{}", what());
            assert_eq!(full.bracket.lower > 0.0, less.bracket.lower > 0.0, "{}", what());
            assert!(less.cost.supports <= full.cost.supports, "{}", what());
            early += usize::from(less.cost.supports < full.cost.supports);
            total += 1;
        }
        let near = Goal { margin: 0.05, cut_off: 0.2, ..Goal::verdict() };
        let cut = separation(a, b, at_a, at_b, &near).unwrap();
        assert!(intersect(full.bracket, cut.bracket));
        assert_eq!(full.bracket.lower > 0.05, cut.bracket.lower > 0.05);
    });
    assert!(early > total / 2, "only {early} of {total} stopped early");
}

#[test]
fn the_cap_on_time_leaves_a_valid_bracket() {
    for_all_pairs(2, 4, |a, b, at_a, at_b| {
        let full = separation(a, b, at_a, at_b, &Goal::penetration()).unwrap();
        let hurried = Goal { stop: &|| true, ..Goal::penetration() };
        let cut = separation(a, b, at_a, at_b, &hurried).unwrap();
        assert!(intersect(full.bracket, cut.bracket), "{full:?}\n{cut:?}");
        assert!(cut.bracket.lower <= full.bracket.upper);
    });
}
