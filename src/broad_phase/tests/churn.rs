//! Does the tree stay as good as a new one? Nodes that questions visit, beside a tree built of the same boxes.

use super::{Random, unit_box_at};
use crate::broad_phase::{DynamicTree, ProxyId};
use crate::geometry::{Aabb, BoxCast, Vec3};
use std::ops::ControlFlow;

/// Nodes that a fixed set of boxes and rays visits.
fn visited(tree: &DynamicTree, count: usize) -> (u64, u64) {
    let mut random = Random(11);
    let (mut boxes, mut rays) = (0, 0);
    for _ in 0..1000 {
        let query = random.scattered(count).grown(0.75);
        boxes += tree.overlap(&query, |_| ControlFlow::Continue(())).nodes;
        let motion = random.scattered(count).min - query.min;
        let mut first = 1.0;
        let cast = BoxCast { start: Aabb::around([query.min]), motion };
        let earlier = |_, fraction| {
            first = f64::min(first, fraction);
            first
        };
        rays += tree.cast(&cast, 1.0, earlier).nodes;
    }
    (boxes, rays)
}

/// Changes `count` boxes at random until `changes` were made, `list` at a time: a quarter removals with an insertion, a
/// quarter moves to anywhere, and small moves. Gives the ratios of the nodes visited afterwards to those in a new tree.
fn wear(count: usize, changes: usize, list: usize) -> (f64, f64) {
    let mut random = Random(5);
    let boxes: Vec<Aabb> = (0..count).map(|_| random.scattered(count)).collect();
    let (mut tree, mut live) = DynamicTree::build(count, |i| (boxes[i], i as u64));
    let (mut made, mut next) = (0, count as u64);
    while made < changes {
        for _ in 0..list {
            let at = random.below(count);
            match random.below(4) {
                0 => {
                    tree.remove(live[at]);
                    live[at] = tree.insert(random.scattered(count), next);
                    next += 1;
                    made += 2;
                }
                1 => {
                    tree.move_to(live[at], random.scattered(count));
                    made += 1;
                }
                _ => {
                    let step = random.vector(0.2) - Vec3::repeat(0.1);
                    let before = tree.tight(live[at]);
                    tree.move_to(live[at], Aabb { min: before.min + step, max: before.max + step });
                    made += 1;
                }
            }
        }
        tree.settle();
    }
    tree.validate().unwrap();
    let (worn, fresh) = (tree.health(), tree.rebuilt().health());
    let ((boxes, rays), (new_boxes, new_rays)) = (visited(&tree, count), visited(&tree.rebuilt(), count));
    let (boxes, rays) = (boxes as f64 / new_boxes as f64, rays as f64 / new_rays as f64);
    println!("{count} boxes, {made} changes in lists of {list}: boxes {boxes:.3}, rays {rays:.3}\n{worn:?}\n{fresh:?}");
    assert!(worn.surface_cost <= 1.15 * fresh.surface_cost, "{worn:?} {fresh:?}");
    assert!(worn.depth <= fresh.depth + 2 && worn.rounds > 0, "{worn:?} {fresh:?}");
    (boxes, rays)
}

#[test]
fn churn_leaves_the_tree_like_a_new_one() {
    for (list, most) in [(10, 1.1), (500, 1.1)] {
        let (boxes, rays) = wear(2000, 60_000, list);
        assert!(boxes <= most && rays <= most, "lists of {list}: boxes {boxes}, rays {rays}");
    }
}

/// Minutes without optimisation: `cargo test --release --lib -- --ignored churn --nocapture`.
#[test]
#[ignore = "ten million changes"]
fn churn_of_ten_million_changes() {
    let begun = std::time::Instant::now();
    let (boxes, rays) = wear(20_000, 10_000_000, 100);
    println!("{:.1} s", begun.elapsed().as_secs_f64());
    assert!(boxes <= 1.1 && rays <= 1.1, "boxes {boxes}, rays {rays}");
}

#[test]
fn many_small_moves_leave_a_tree_like_a_new_one() {
    let count = 2000_usize;
    let mut random = Random(21);
    let mut boxes: Vec<Aabb> = (0..count).map(|_| random.scattered(count)).collect();
    let (mut tree, names) = DynamicTree::build(boxes.len(), |i| (boxes[i], i as u64));
    // Each box goes its own way, ten box lengths altogether.
    for _ in 0..100 {
        for (i, (name, aabb)) in (0..).zip(names.iter().zip(&mut boxes)) {
            let (sin, cos) = libm::sincos(f64::from(i));
            let step = 0.1 * Vec3::new(sin, cos, 0.0);
            *aabb = Aabb { min: aabb.min + step, max: aabb.max + step };
            tree.move_to(*name, *aabb);
        }
        tree.settle();
    }
    tree.validate().unwrap();
    let (worn, fresh) = (tree.health(), tree.rebuilt().health());
    assert!(worn.surface_cost < 1.3 * fresh.surface_cost, "{worn:?} {fresh:?}");
}

#[test]
fn upkeep_is_bounded_by_the_changes() {
    let count = 5000_usize;
    let mut random = Random(2);
    let boxes: Vec<Aabb> = (0..count).map(|_| random.scattered(count)).collect();
    let (mut tree, names) = DynamicTree::build(count, |i| (boxes[i], i as u64));
    for list in [1_usize, 10, 100, 1000] {
        for _ in 0..20 {
            let before = tree.health();
            for _ in 0..list {
                tree.move_to(names[random.below(count)], random.scattered(count));
            }
            tree.settle();
            let after = tree.health();
            // At most what the list owes (one and a half for an entry that is put in anew), and one part in advance.
            assert!(after.upkeep - before.upkeep <= 3 * list as u64 + 512, "{before:?} {after:?}");
            assert!(after.debt <= 0.0 && after.debt > -513.0, "{after:?}");
        }
    }
    assert!(tree.health().rounds > 0);
}

#[test]
fn a_tree_that_is_emptied_and_filled_again_uses_the_same_places() {
    let mut tree = DynamicTree::new();
    for round in 0..5_u64 {
        let names: Vec<ProxyId> = (0..500).map(|i| tree.insert(unit_box_at(i as f64, round as f64, 0.0), i)).collect();
        tree.settle();
        assert_eq!((tree.validate(), tree.len()), (Ok(()), 500));
        names.into_iter().for_each(|name| tree.remove(name));
        tree.settle();
        assert_eq!((tree.validate(), tree.health().depth), (Ok(()), 0));
    }
    assert_eq!(tree.places.slot_count(), 500);
}
