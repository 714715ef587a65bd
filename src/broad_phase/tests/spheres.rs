//! The tree over bounding spheres: all that is written over the trait, held against looking at all spheres.

use super::Random;
use crate::broad_phase::{BoundingSphere, BoundingVolume, DynamicTree, ProxyId};
use crate::geometry::Vec3;
use std::collections::BTreeMap;
use std::ops::ControlFlow;

/// Sequences of changes to volumes that `some` makes, with every question after each list.
fn changes_agree_with_brute_force<V: BoundingVolume>(mut some: impl FnMut(&mut Random) -> V) {
    let mut random = Random(17);
    let (mut pairs, mut met, mut removed, mut moved) = (0, 0, 0, 0);
    let mut tree: DynamicTree<V> = DynamicTree::new();
    let mut expected: BTreeMap<u64, (ProxyId, V)> = BTreeMap::new();
    let mut next = 0;
    for list in 0..60 {
        for _ in 0..20 {
            let at = random.below(expected.len().max(1));
            let some_key = expected.keys().nth(at).copied();
            match (random.below(4), some_key) {
                (0, Some(key)) if list > 20 => {
                    tree.remove(expected.remove(&key).unwrap().0);
                    removed += 1;
                }
                (1, Some(key)) => {
                    let volume = some(&mut random);
                    let entry = expected.get_mut(&key).unwrap();
                    entry.1 = volume;
                    tree.move_to(entry.0, volume);
                    moved += 1;
                }
                _ => {
                    let volume = some(&mut random);
                    expected.insert(next, (tree.insert(volume, next), volume));
                    next += 1;
                }
            }
        }
        tree.settle();
        assert_eq!((tree.validate(), tree.len()), (Ok(()), expected.len()));
        let (rebuilt, _) = DynamicTree::build(expected.iter().map(|(key, (_, volume))| (*volume, *key)));
        assert_eq!(rebuilt.validate(), Ok(()));
        for tree in [&tree, &rebuilt] {
            let query = some(&mut random);
            let mut found = Vec::new();
            tree.overlap(&query, |payload| {
                found.push(payload);
                ControlFlow::Continue(())
            });
            found.sort_unstable();
            let meeting = expected.iter().filter(|(_, (_, volume))| volume.overlaps(&query));
            assert_eq!(found, meeting.map(|(key, _)| *key).collect::<Vec<u64>>());
            met += found.len();
            let mut found = Vec::new();
            tree.self_pairs(|a, b| {
                found.push((a, b));
                ControlFlow::Continue(())
            });
            found.sort_unstable();
            let mut meeting = Vec::new();
            for (a, (_, one)) in &expected {
                let later = expected.range(a + 1..).filter(|(_, (_, other))| one.overlaps(other));
                meeting.extend(later.map(|(b, _)| (*a, *b)));
            }
            assert_eq!(found, meeting);
            pairs += found.len();
        }
    }
    let health = tree.health();
    assert!(health.depth <= 2 * health.least_depth + 1, "{health:?}");
    for (regime, count) in [("pair", pairs), ("overlap", met), ("removal", removed), ("move", moved)] {
        assert!(count >= 50, "{regime}: only {count}");
    }
}

#[test]
fn spheres_agree_with_brute_force() {
    changes_agree_with_brute_force(|random| BoundingSphere { center: random.vector(12.0), radius: random.next() });
}

#[test]
fn spheres_of_all_scales_agree_with_brute_force() {
    changes_agree_with_brute_force(|random| {
        let scale = libm::pow(10.0, 80.0 * random.next() - 40.0);
        BoundingSphere { center: random.vector(scale) - Vec3::repeat(scale / 2.0), radius: random.next() * scale / 3.0 }
    });
}

#[test]
fn boxes_agree_with_brute_force() {
    changes_agree_with_brute_force(|random| random.scattered(400));
}
