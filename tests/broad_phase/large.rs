//! Many boxes: ten thousand that all overlap, needles, equal ones, and what has no pair at all. Oracle: closed forms of the
//! number of pairs, and the broad phases against each other.

use std::ops::ControlFlow;

use clearance::broad_phase::{BroadPhase, BroadPhaseKind, ProxyId};
use clearance::geometry::{Aabb, Vec3};

use crate::commands::KINDS;
use crate::random::Random;

fn filled(kind: BroadPhaseKind, boxes: impl IntoIterator<Item = Aabb>) -> (BroadPhase, Vec<ProxyId>) {
    let mut phase = BroadPhase::new(kind);
    let proxies = (0..).zip(boxes).map(|(i, aabb)| phase.insert(aabb, i)).collect();
    phase.settle();
    assert_eq!(phase.validate(), Ok(()));
    (phase, proxies)
}

/// Counts pairs and sums up what is the same in any order, so that a list need not be kept.
fn pairs(phase: &BroadPhase) -> (u64, u64) {
    let (mut count, mut sum) = (0_u64, 0_u64);
    phase.self_pairs(|a, b| {
        assert!(a < b, "the pair {a}, {b} is the wrong way round");
        count += 1;
        sum = sum.wrapping_add((a << 32 | b).wrapping_mul(0x9E37_79B9_7F4A_7C15));
        ControlFlow::Continue(())
    });
    (count, sum)
}

fn check_all_pairs(name: &str, boxes: &[Aabb], expected: Option<u64>) {
    let found = KINDS.map(|kind| pairs(&filled(kind, boxes.iter().copied()).0));
    assert!(found[0] == found[2] && found[1] == found[2], "{name}: {found:?}");
    assert!(expected.is_none_or(|expected| found[0].0 == expected), "{name}: {found:?}, not {expected:?}");
}

#[test]
fn ten_thousand_boxes_that_all_overlap_make_every_pair() {
    let count = 10_000_u64;
    let boxes: Vec<Aabb> =
        (0..count).map(|i| Aabb::centred(Vec3::repeat(1e-5 * i as f64), Vec3::repeat(0.5))).collect();
    check_all_pairs("all overlap", &boxes, Some(count * (count - 1) / 2));
}

#[test]
fn equal_boxes_make_every_pair_and_are_visited_in_the_order_of_their_numbers() {
    let count = 2_000;
    let boxes = vec![Aabb::centred(Vec3::zeros(), Vec3::repeat(0.5)); count];
    check_all_pairs("equal", &boxes, Some((count * (count - 1) / 2) as u64));
    for kind in KINDS {
        let mut visited = Vec::new();
        filled(kind, boxes.iter().copied()).0.nearest(&boxes[0], 0.0, |payload, distance| {
            assert_eq!(distance, 0.0);
            visited.push(payload);
            0.0
        });
        assert!(visited.into_iter().eq(0..count as u64), "{kind:?}");
    }
}

#[test]
fn needles_through_each_other_and_rows_that_touch_lose_no_pair() {
    let mut random = Random(1);
    let mut needle = |i: usize| {
        let mut half = Vec3::repeat(1e-3);
        half[i % 3] = 10.0;
        Aabb::centred(random.vector(2.0), half)
    };
    let needles: Vec<Aabb> = (0..1_500).map(&mut needle).collect();
    check_all_pairs("needles", &needles, None);
    // Each touches the next, exactly: numbers with few bits.
    let row = |along: usize| {
        move |i: usize| {
            let mut center = Vec3::zeros();
            center[along] = i as f64;
            Aabb::centred(center, Vec3::repeat(0.5))
        }
    };
    for along in 0..3 {
        check_all_pairs("a row", &(0..3_000).map(row(along)).collect::<Vec<_>>(), Some(2_999));
    }
    let far: Vec<Aabb> =
        (0..200).map(|i| Aabb::centred(Vec3::repeat(1e100 * f64::from(i)), Vec3::repeat(5e99))).collect();
    check_all_pairs("far away", &far, None);
}

#[test]
fn none_and_one_make_no_pair_and_are_found_all_the_same() {
    let everywhere = Aabb::centred(Vec3::zeros(), Vec3::repeat(1e9));
    for kind in KINDS {
        let (mut phase, _) = filled(kind, []);
        assert_eq!(pairs(&phase), (0, 0));
        assert_eq!(phase.nearest(&everywhere, f64::INFINITY, |_, _| panic!("nobody is there")).leaves, 0);
        let proxy = phase.insert(Aabb::around([Vec3::repeat(3.0)]), 7);
        phase.settle();
        let mut found = Vec::new();
        phase.nearest(&Aabb::around([Vec3::repeat(2.0)]), f64::INFINITY, |payload, _| {
            found.push(payload);
            0.0
        });
        assert_eq!((found, pairs(&phase)), (vec![7], (0, 0)));
        phase.remove(proxy);
        assert!(phase.is_empty() && phase.validate() == Ok(()));
    }
}

/// Churns with a scene's mixture and compares now and then: tree and sweep against the exhaustive search where that is
/// quick enough, against each other where it is not.
fn churn(bodies: usize, changes: usize, kinds: &[BroadPhaseKind]) {
    let mut random = Random(3);
    let side = 2.0 * libm::cbrt(bodies as f64 / 2.3);
    let aabb = |random: &mut Random| Aabb::centred(random.vector(side), random.vector(0.7));
    let mut boxes: Vec<Aabb> = (0..bodies).map(|_| aabb(&mut random)).collect();
    let mut phases: Vec<(BroadPhase, Vec<ProxyId>)> =
        kinds.iter().map(|kind| filled(*kind, boxes.iter().copied())).collect();
    for change in 0..changes {
        let i = random.below(bodies);
        let step = random.vector(0.2) - Vec3::repeat(0.1);
        let replaced = change % 4 == 0;
        let next =
            if replaced { aabb(&mut random) } else { Aabb { min: boxes[i].min + step, max: boxes[i].max + step } };
        boxes[i] = next;
        for (phase, proxies) in &mut phases {
            if replaced {
                phase.remove(proxies[i]);
                proxies[i] = phase.insert(next, i as u64);
            } else {
                phase.move_to(proxies[i], next);
            }
            if change % 100 == 0 {
                phase.settle();
            }
        }
        if change % (changes / 4).max(1) == changes / 8 {
            let found: Vec<(u64, u64)> = phases
                .iter_mut()
                .map(|(phase, _)| {
                    phase.settle();
                    assert_eq!(phase.validate(), Ok(()));
                    pairs(phase)
                })
                .collect();
            assert!(found[0].0 > 0 && found.iter().all(|one| one == &found[0]), "{kinds:?}: {found:?}");
        }
    }
}

#[test]
fn churn_loses_no_pair() {
    churn(3_000, 30_000, &KINDS);
}

#[test]
#[ignore = "a minute in an optimised build; belongs to the long test"]
fn a_million_changes_lose_no_pair() {
    churn(10_000, 1_000_000, &KINDS);
}

#[test]
#[ignore = "minutes in an optimised build; belongs to the long test"]
fn ten_million_changes_lose_no_pair() {
    churn(30_000, 10_000_000, &[BroadPhaseKind::Tree, BroadPhaseKind::SweepAndPrune]);
}
