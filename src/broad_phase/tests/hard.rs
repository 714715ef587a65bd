//! Boxes that trees get wrong: extreme coordinates, needles, everything on one spot, in every order. Reference: looking at
//! all boxes.

use super::{Random, unit_box_at};
use crate::broad_phase::DynamicTree;
use crate::broad_phase::walk_by_distance::lower_distance;
use crate::geometry::{Aabb, BoxCast, Vec3};
use std::ops::ControlFlow;

/// Every question about `boxes`, built at once and put in one by one, against looking at all.
fn check(name: &str, boxes: &[Aabb]) {
    let (built, _) = DynamicTree::build(boxes.len(), |i| (boxes[i], i as u64));
    let mut grown = DynamicTree::new();
    for (i, aabb) in (0..).zip(boxes) {
        grown.insert(*aabb, i);
        grown.settle();
    }
    let mut moved = DynamicTree::new();
    let names: Vec<_> = (0..).zip(boxes).map(|(i, _)| moved.insert(unit_box_at(i as f64, 0.0, 0.0), i)).collect();
    moved.settle();
    for (name, aabb) in names.iter().zip(boxes) {
        moved.move_to(*name, *aabb);
    }
    moved.settle();
    for (how, tree) in [("built", &built), ("grown", &grown), ("moved", &moved)] {
        let name = format!("{name}, {how}");
        assert_eq!(tree.validate(), Ok(()), "{name}");
        check_pairs(&name, tree, boxes);
        for query in boxes.iter().step_by(1 + boxes.len() / 40) {
            check_near(&name, tree, boxes, query);
        }
    }
}

fn check_pairs(name: &str, tree: &DynamicTree, boxes: &[Aabb]) {
    let mut found = Vec::new();
    tree.self_pairs(|a, b| {
        found.push((a, b));
        ControlFlow::Continue(())
    });
    found.sort_unstable();
    let mut expected = Vec::new();
    for (a, one) in (0_u64..).zip(boxes) {
        expected.extend(
            (a + 1..).zip(&boxes[a as usize + 1..]).filter(|(_, other)| one.overlaps(other)).map(|(b, _)| (a, b)),
        );
    }
    assert_eq!(found, expected, "{name}");
}

fn check_near(name: &str, tree: &DynamicTree, boxes: &[Aabb], query: &Aabb) {
    let mut found = Vec::new();
    tree.overlap(query, |payload| {
        found.push(payload);
        ControlFlow::Continue(())
    });
    found.sort_unstable();
    let meeting = (0..).zip(boxes).filter(|(_, aabb)| aabb.overlaps(query)).map(|(i, _)| i);
    assert_eq!(found, meeting.collect::<Vec<u64>>(), "{name}");

    let mut nearest = f64::INFINITY;
    let far = Aabb { min: query.min * 1.5, max: query.min * 1.5 };
    tree.nearest(&far, f64::INFINITY, |payload, bound| {
        let distance = boxes[payload as usize].distance(&far);
        assert!(bound <= distance, "{name}: {bound} {distance}");
        nearest = nearest.min(distance);
        nearest
    });
    let least = boxes.iter().map(|aabb| aabb.distance(&far)).fold(f64::INFINITY, f64::min);
    assert_eq!(nearest, least, "{name}");

    for within in [0.0, least, query.max.norm(), f64::INFINITY] {
        check_walk(name, tree, boxes, query, within);
    }

    for motion in [query.max, -3.0 * query.min, Vec3::new(query.max.x, 0.0, 0.0), Vec3::new(0.0, 1e-40, 5.0)] {
        let cast = BoxCast { start: *query, motion };
        let mut met = Vec::new();
        tree.cast(&cast, 1.0, |payload, _| {
            met.push(payload);
            1.0
        });
        met.sort_unstable();
        let expected = (0..).zip(boxes).filter(|(_, aabb)| cast.first_touch(aabb).is_some()).map(|(i, _)| i);
        assert_eq!(met, expected.collect::<Vec<u64>>(), "{name}: {cast:?}");
    }
}

/// What is visited within a distance, and in which order. How many of them touch.
fn check_walk(name: &str, tree: &DynamicTree, boxes: &[Aabb], query: &Aabb, within: f64) -> usize {
    let mut visited = Vec::new();
    tree.nearest(query, within, |payload, distance| {
        visited.push((distance, payload));
        within
    });
    let all = boxes.iter().map(|aabb| lower_distance(aabb, query)).zip(0..);
    let mut expected: Vec<(f64, u64)> = all.filter(|(distance, _)| *distance <= within).collect();
    expected.sort_by(|one, two| one.partial_cmp(two).unwrap());
    assert_eq!(visited, expected, "{name}, {query:?} within {within}");
    visited.iter().filter(|(distance, _)| *distance == 0.0).count()
}

#[test]
fn a_walk_goes_by_distance_and_then_by_number_however_many_touch() {
    let mut random = Random(3);
    let boxes: Vec<Aabb> = (0..2000).map(|_| random.scattered(2000)).collect();
    let (mut none, mut few, mut many) = (0, 0, 0);
    // Numbers that fall as the boxes come, so that no order is there by chance.
    let backwards: Vec<Aabb> = boxes.iter().rev().copied().collect();
    let (tree, _) = DynamicTree::build(boxes.len(), |i| (boxes[i], 1999 - i as u64));
    for size in [0.0, 0.1, 0.5, 1.0, 2.0, 5.0, 20.0] {
        for _ in 0..20 {
            let query = Aabb::centred(random.vector(10.0), Vec3::repeat(size));
            for within in [0.0, 1e-3, 0.5, 3.0] {
                match check_walk("scattered", &tree, &backwards, &query, within) {
                    0 => none += 1,
                    1..=32 => few += 1,
                    _ => many += 1,
                }
            }
        }
    }
    assert!(none > 50 && few > 50 && many > 50, "{none} {few} {many}");
}

#[test]
fn extreme_coordinates_lose_nothing() {
    for scale in [1e-310, 1e-46, 1e-38, 1e-20, 1e-3, 1.0, 1e6, 1e12, 1e19, 1e30, 3e38, 1e39, 1e100] {
        let mut random = Random(1);
        let mut boxes: Vec<Aabb> = Vec::new();
        for _ in 0..150 {
            let Aabb { min, max } = random.scattered(100);
            // About the origin and on one side of it.
            boxes.push(Aabb { min: (min - Vec3::repeat(4.0)) * scale, max: (max - Vec3::repeat(4.0)) * scale });
            boxes.push(Aabb { min: min * scale, max: max * scale });
        }
        check(&format!("scale {scale:e}"), &boxes);
    }
}

#[test]
fn scales_mixed_and_far_from_the_origin_lose_nothing() {
    let mut random = Random(4);
    let mut boxes: Vec<Aabb> = Vec::new();
    for i in 0..300_i32 {
        let scale = libm::pow(10.0, f64::from(i % 61) - 30.0);
        let Aabb { min, max } = random.scattered(100);
        boxes.push(Aabb { min: min * scale, max: max * scale });
    }
    boxes.extend((0..100).map(|i| unit_box_at(5e6 + f64::from(i) * 0.9, -5e6, 7e6)));
    boxes.extend((0..50).map(|i| unit_box_at(1e12 + f64::from(i) * 0.9, 1e12, 0.0)));
    check("mixed", &boxes);
}

#[test]
fn boxes_that_touch_in_the_last_bit_are_told_apart() {
    let mut boxes = Vec::new();
    for i in 0..100 {
        let x = f64::from(i);
        let edge = 0.1 * x;
        boxes.push(Aabb { min: Vec3::new(edge - 0.05, x, 0.0), max: Vec3::new(edge, x + 0.5, 1.0) });
        boxes.push(Aabb { min: Vec3::new(edge, x, 0.0), max: Vec3::new(edge + 0.01, x + 0.5, 1.0) });
        boxes.push(Aabb { min: Vec3::new(edge.next_up(), x, 0.0), max: Vec3::new(edge + 0.02, x + 0.5, 1.0) });
    }
    check("last bit", &boxes);
}

#[test]
fn needles_points_planes_and_floors_lose_nothing() {
    let mut random = Random(8);
    let mut boxes: Vec<Aabb> = (0..300).map(|_| random.scattered(300)).collect();
    for i in 0..100 {
        let at = random.vector(13.0);
        let mut half = Vec3::zeros();
        half[i % 3] = 10.0;
        boxes.push(Aabb::centred(at, half));
        boxes.push(Aabb::centred(at, Vec3::zeros()));
    }
    boxes.push(Aabb { min: Vec3::new(-1e3, -1e3, -0.1), max: Vec3::new(1e3, 1e3, 0.0) });
    boxes.push(Aabb { min: Vec3::new(-1e3, -0.1, -1e3), max: Vec3::new(1e3, 0.0, 1e3) });
    check("needles", &boxes);
    check("one box many times", &[unit_box_at(0.1, 0.2, 0.3); 300]);
    check("one point many times", &[Aabb::around([Vec3::repeat(1.0 / 3.0)]); 300]);
    check("nested", &(0..200).map(|i| Aabb::centred(Vec3::zeros(), Vec3::repeat(f64::from(i)))).collect::<Vec<_>>());
    check("nothing", &[]);
    check("one", &[unit_box_at(0.0, 0.0, 0.0)]);
    check("two", &[unit_box_at(0.0, 0.0, 0.0), unit_box_at(1.0, 0.0, 0.0)]);
}

#[test]
fn no_pair_is_dropped_when_ten_thousand_boxes_overlap_each_other() {
    let count = 10_000_u64;
    let (tree, _) = DynamicTree::build(count as usize, |i| (unit_box_at(1e-5 * i as f64, 0.0, 0.0), i as u64));
    let (mut pairs, mut sum) = (0_u64, 0_u64);
    let stats = tree.self_pairs(|a, b| {
        pairs += 1;
        sum += a + b;
        ControlFlow::Continue(())
    });
    assert_eq!((pairs, sum), (count * (count - 1) / 2, count * (count - 1) / 2 * (count - 1)));
    assert!(stats.leaves >= pairs);
}

/// Inserts `boxes` one list at a time; the depth must stay below `times` the least possible one.
fn check_depth(name: &str, times: u32, boxes: impl IntoIterator<Item = Aabb>) {
    let mut tree = DynamicTree::new();
    for (i, aabb) in boxes.into_iter().enumerate() {
        tree.insert(aabb, i as u64);
        tree.settle();
    }
    tree.validate().unwrap();
    let health = tree.health();
    assert!(health.depth <= times * health.least_depth, "{name}: {health:?}");
}

#[test]
fn depth_stays_low_whatever_the_order_of_insertion() {
    let row = |i: i32| f64::from(i);
    check_depth("sorted row", 2, (0..3000).map(|i| unit_box_at(row(i), 0.0, 0.0)));
    check_depth("row from the far end", 2, (0..3000).rev().map(|i| unit_box_at(2.0 * row(i), 0.0, 0.0)));
    check_depth("points on a line", 2, (0..3000).map(|i| Aabb::around([Vec3::new(row(i), 0.0, 0.0)])));
    check_depth("one box many times", 2, (0..3000).map(|_| unit_box_at(0.0, 0.0, 0.0)));
    check_depth("one point many times", 2, (0..3000).map(|_| Aabb::around([Vec3::zeros()])));
    check_depth("growing boxes", 2, (0..3000).map(|i| Aabb::centred(Vec3::zeros(), Vec3::repeat(1.0 + row(i)))));
    check_depth("shrinking boxes", 2, (0..3000).rev().map(|i| Aabb::centred(Vec3::zeros(), Vec3::repeat(row(i)))));
    check_depth("ever wider", 2, (0..600).map(|i| unit_box_at(libm::exp2(row(i) / 2.0), 0.0, 0.0)));
    check_depth("floor by rows", 2, (0..3600).map(|i| unit_box_at(row(i % 60), row(i / 60), 0.0)));
}

#[test]
fn a_floor_does_not_spoil_questions_about_what_stands_on_it() {
    let mut random = Random(6);
    let count = 4000;
    let boxes: Vec<Aabb> = (0..count).map(|_| random.scattered(count)).collect();
    let floor = Aabb { min: Vec3::new(-100.0, -100.0, 0.0), max: Vec3::new(100.0, 100.0, 40.0) };
    let visited = |tree: &DynamicTree| -> u64 {
        let ask = |aabb: &Aabb| tree.overlap(aabb, |_| ControlFlow::Continue(())).nodes;
        boxes.iter().step_by(7).map(ask).sum()
    };
    let grown = |first: Option<Aabb>| {
        let mut tree = DynamicTree::new();
        for (i, aabb) in (0..).zip(first.iter().chain(&boxes)) {
            tree.insert(*aabb, i);
            tree.settle();
        }
        tree
    };
    let (alone, among) = (visited(&grown(None)), visited(&grown(Some(floor))));
    // The floor's own nodes are on the way of every question.
    let questions = count.div_ceil(7) as u64;
    assert!(among <= alone * 11 / 10 + 3 * questions, "{alone} {among}");
}

#[test]
fn a_breaking_visit_and_a_negative_bound_end_the_work() {
    let (tree, _) = DynamicTree::build(20, |i| (unit_box_at(0.0, 0.0, 0.0), i as u64));
    let mut visits = 0;
    let mut once = || {
        visits += 1;
        ControlFlow::Break(())
    };
    tree.overlap(&unit_box_at(0.0, 0.0, 0.0), |_| once());
    tree.self_pairs(|_, _| once());
    tree.pairs_with(&tree, |_, _| once());
    tree.nearest(&unit_box_at(3.0, 0.0, 0.0), f64::INFINITY, |_, _| {
        let _ = once();
        -1.0
    });
    let cast = BoxCast { start: unit_box_at(3.0, 0.0, 0.0), motion: Vec3::new(-9.0, 0.0, 0.0) };
    tree.cast(&cast, 1.0, |_, _| {
        let _ = once();
        -1.0
    });
    assert_eq!(visits, 5);
}
