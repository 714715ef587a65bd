//! The tree over every bounding volume: all that is written over the trait, held against looking at all of them.

use super::Random;
use super::turned::corners;
use crate::broad_phase::{BoundingSphere, BoundingVolume, Dop18, Dop26, DynamicTree, KDop, ProxyId};
use crate::geometry::{Aabb, Mat3, OrientedBox, Vec3};
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
        let all: Vec<(V, u64)> = expected.iter().map(|(key, (_, volume))| (*volume, *key)).collect();
        let (rebuilt, _) = DynamicTree::build(all.len(), |i| all[i]);
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

/// Boxes turned at random, near the origin and far from it.
fn turned_boxes_of(mut check: impl FnMut(&mut dyn FnMut(&mut Random) -> OrientedBox)) {
    for origin in [0.0, 1e6, -1e9] {
        check(&mut |random| {
            let center = random.vector(12.0) + Vec3::repeat(origin);
            random.turned(center, 2.0)
        });
    }
}

fn at_any_scale(random: &mut Random) -> OrientedBox {
    let scale = libm::pow(10.0, 80.0 * random.next() - 40.0);
    let center = random.vector(scale) - Vec3::repeat(scale / 2.0);
    random.turned(center, scale / 2.0)
}

#[test]
fn turned_boxes_agree_with_brute_force() {
    turned_boxes_of(|some| changes_agree_with_brute_force(some));
}

#[test]
fn turned_boxes_of_all_scales_agree_with_brute_force() {
    changes_agree_with_brute_force(at_any_scale);
}

#[test]
fn polytopes_agree_with_brute_force() {
    turned_boxes_of(|some| {
        changes_agree_with_brute_force(|random| Dop18::around(corners(&some(random))));
        changes_agree_with_brute_force(|random| Dop26::around(corners(&some(random))));
    });
    changes_agree_with_brute_force(|random| Dop18::from(random.scattered(400)));
}

#[test]
fn polytopes_of_all_scales_agree_with_brute_force() {
    changes_agree_with_brute_force(|random| Dop18::around(corners(&at_any_scale(random))));
    changes_agree_with_brute_force(|random| Dop26::around(corners(&at_any_scale(random))));
}

/// On a grid, so that they coincide, touch and lie in one plane: plates, rods and points among them.
#[test]
fn flat_and_touching_volumes_agree_with_brute_force() {
    let upright = |random: &mut Random| {
        let mut some = |many: usize| random.below(many) as f64;
        let center = Vec3::new(some(6), some(6), some(6));
        Aabb::centred(center, 0.5 * Vec3::new(some(3), some(3), some(3)))
    };
    changes_agree_with_brute_force(|random| OrientedBox::upright(&upright(random)));
    changes_agree_with_brute_force(|random| Dop18::from(upright(random)));
    changes_agree_with_brute_force(|random| Dop26::from(upright(random)));
}

/// Upright boxes and their polytopes of three pairs: the same answers, by different code.
#[test]
fn a_polytope_of_three_pairs_is_an_upright_box() {
    let mut random = Random(4);
    let (mut met, mut apart) = (0, 0);
    for _ in 0..20_000 {
        let [a, b] = [random.scattered(20), random.scattered(20)];
        let overlap = a.overlaps(&b);
        assert_eq!(KDop::<3>::from(a).overlaps(&KDop::<3>::from(b)), overlap);
        // Cutting no corner of an upright box away changes nothing.
        assert_eq!(Dop26::from(a).overlaps(&Dop26::from(b)), overlap);
        *(if overlap { &mut met } else { &mut apart }) += 1;
    }
    assert!(met > 500 && apart > 500, "{met} {apart}");
}

/// Every pair of `count` volumes meets, and every one is met by each.
fn all_meet<V: BoundingVolume>(count: u64, mut some: impl FnMut(&mut Random) -> V) {
    let mut random = Random(23);
    let volumes: Vec<V> = (0..count).map(|_| some(&mut random)).collect();
    let (built, _) = DynamicTree::build(volumes.len(), |i| (volumes[i], i as u64));
    let mut grown = DynamicTree::new();
    for (i, volume) in (0..).zip(&volumes) {
        grown.insert(*volume, i);
        grown.settle();
    }
    for tree in [built, grown] {
        assert_eq!(tree.validate(), Ok(()));
        let mut found = Vec::new();
        tree.self_pairs(|a, b| {
            found.push(a * count + b);
            ControlFlow::Continue(())
        });
        found.sort_unstable();
        found.dedup();
        assert_eq!(found.len() as u64, count * (count - 1) / 2);
        let mut met = 0;
        tree.overlap(&volumes[0], |_| {
            met += 1;
            ControlFlow::Continue(())
        });
        assert_eq!(met, count);
    }
}

#[test]
fn two_thousand_that_all_overlap_are_all_found() {
    let heap = |random: &mut Random| {
        let center = random.vector(0.5);
        OrientedBox { center, axes: random.frame(), half_extents: Vec3::repeat(1.0) }
    };
    all_meet(2000, heap);
    all_meet(2000, |random| Dop18::around(corners(&heap(random))));
    all_meet(2000, |random| Dop26::around(corners(&heap(random))));
    all_meet(2000, |random| BoundingSphere { center: random.vector(0.5), radius: 1.0 });
}

#[test]
fn identical_volumes_are_all_found() {
    let same = |half_extents| OrientedBox { center: Vec3::new(3.0, -1.0, 1e5), axes: Random(9).frame(), half_extents };
    for half in [Vec3::zeros(), Vec3::new(1.0, 0.0, 0.0), Vec3::new(1.0, 2.0, 0.5)] {
        all_meet(300, |_| same(half));
        all_meet(300, |_| Dop18::around(corners(&same(half))));
        all_meet(300, |_| Dop26::around(corners(&same(half))));
    }
    all_meet(300, |_| OrientedBox { center: Vec3::zeros(), axes: Mat3::identity(), half_extents: Vec3::zeros() });
}
