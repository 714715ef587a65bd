//! Clones: nothing that happens to one of them is seen in another, and they share what did not change.

use super::{Random, unit_box_at};
use crate::broad_phase::node::Kid;
use crate::broad_phase::{DynamicTree, ProxyId};
use crate::geometry::Aabb;
use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::sync::Arc;

/// The addresses of all nodes.
fn nodes(tree: &DynamicTree) -> BTreeSet<usize> {
    let mut found = BTreeSet::new();
    let mut stack: Vec<&Kid<Aabb>> = tree.root.iter().collect();
    while let Some(kid) = stack.pop() {
        match kid {
            Kid::Leaf(leaf) => drop(found.insert(Arc::as_ptr(leaf) as usize)),
            Kid::Inner(inner) => {
                found.insert(Arc::as_ptr(inner) as usize);
                stack.extend(&inner.kids);
            }
        }
    }
    found
}

fn listed(tree: &DynamicTree) -> Vec<(u64, Aabb)> {
    let mut entries: Vec<_> = tree.iter().collect();
    entries.sort_unstable_by_key(|(payload, _)| *payload);
    entries
}

#[test]
fn old_versions_stay_what_they_were_through_thousands_of_changes() {
    let mut random = Random(3);
    let mut tree = DynamicTree::new();
    let mut live: Vec<ProxyId> = (0..3000).map(|i| tree.insert(random.scattered(3000), i)).collect();
    let mut versions: Vec<(DynamicTree, Vec<(u64, Aabb)>)> = Vec::new();
    for version in 0..40_u64 {
        tree.settle();
        versions.push((tree.clone(), listed(&tree)));
        for i in 0..100 {
            let at = random.below(live.len());
            match i % 3 {
                0 => {
                    tree.remove(live[at]);
                    live[at] = tree.insert(random.scattered(3000), 3000 + 100 * version + i);
                }
                1 => {
                    tree.move_to(live[at], random.scattered(3000));
                }
                _ => {
                    let step = random.vector(0.1);
                    let before = tree.tight(live[at]);
                    tree.move_to(live[at], Aabb { min: before.min + step, max: before.max + step });
                }
            }
        }
    }
    for (version, entries) in &versions {
        assert_eq!(version.validate(), Ok(()));
        assert_eq!(&listed(version), entries);
        let query = random.scattered(3000).grown(2.0);
        let mut found = Vec::new();
        version.overlap(&query, |payload| {
            found.push(payload);
            ControlFlow::Continue(())
        });
        found.sort_unstable();
        let meeting = entries.iter().filter(|(_, aabb)| aabb.overlaps(&query)).map(|(payload, _)| *payload);
        assert_eq!(found, meeting.collect::<Vec<_>>());
    }
}

#[test]
fn what_a_change_copies_is_in_proportion_to_it_and_not_to_the_tree() {
    for count in [4_000_usize, 64_000] {
        let mut random = Random(9);
        let boxes: Vec<Aabb> = (0..count).map(|_| random.scattered(count)).collect();
        let (mut tree, names) = DynamicTree::build(boxes.len(), |i| (boxes[i], i as u64));
        for moves in [1, 10, 100] {
            let before = tree.clone();
            for _ in 0..moves {
                let at = random.below(count);
                let step = random.vector(0.05);
                let moved = tree.tight(names[at]);
                tree.move_to(names[at], Aabb { min: moved.min + step, max: moved.max + step });
            }
            tree.settle();
            let (old, new) = (nodes(&before), nodes(&tree));
            let copied = new.difference(&old).count();
            // The way from the root to each leaf; and the leaf's neighbours, where upkeep has been.
            let upkeep = 256;
            let bound = moves * tree.health().depth as usize + upkeep;
            assert!(copied <= bound, "{count} entries, {moves} moves: {copied} nodes copied");
            assert!(copied >= moves.min(2), "{count} entries, {moves} moves: {copied} nodes copied");
            assert_eq!(before.validate(), Ok(()));
        }
        let shared = tree.places.pages_shared_with(&tree.clone().places);
        assert_eq!(shared, count.div_ceil(64) + tree.places.node_count().div_ceil(64));
    }
}

#[test]
fn moving_one_box_leaves_the_places_of_all_others_shared() {
    let (mut tree, names) =
        DynamicTree::build(4000, |i| (unit_box_at((i % 63) as f64, (i / 63) as f64, 0.0), i as u64));
    let before = tree.clone();
    tree.move_to(names[1234], unit_box_at(-50.0, 0.0, 0.0));
    tree.settle();
    assert_eq!((before.validate(), tree.validate()), (Ok(()), Ok(())));
    assert_eq!(before.tight(names[1234]), unit_box_at(f64::from(1234 % 63), f64::from(1234 / 63), 0.0));
    assert_eq!(tree.tight(names[1234]), unit_box_at(-50.0, 0.0, 0.0));
    let shared = nodes(&before).intersection(&nodes(&tree)).count();
    assert!(shared > nodes(&before).len() * 3 / 4, "{shared}");
}
