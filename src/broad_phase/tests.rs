//! The tree against brute force: after every one of a random sequence of changes the tree is valid, and every
//! traversal finds exactly what looking at all tight boxes finds.
//!
//! Reference: the list of entries. It shares `Aabb::overlaps` and `Aabb::distance` with the tree, nothing else.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::ops::ControlFlow;

use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};

use super::{DynamicTree, ProxyId};
use crate::geometry::{Aabb, BoxCast, Vec3};

#[derive(Clone, Debug)]
enum Command {
    Insert(Aabb),
    Remove(prop::sample::Index),
    Nudge(prop::sample::Index, Vec3),
    Replace(prop::sample::Index, Aabb),
    Overlap(Aabb),
    Nearest(Aabb, f64),
    Cast(Aabb, Vec3, f64),
    AllPairs,
}

/// How often each regime was met in a sweep.
#[derive(Debug, Default)]
struct Reached {
    empty: usize,
    moved_inside: usize,
    reinserted: usize,
    removed: usize,
    degenerate: usize,
    overlaps: usize,
    pairs: usize,
    near: usize,
    near_ties: usize,
    met: usize,
    met_first: usize,
    deep: usize,
}

/// Coordinates on a coarse grid (boxes touch, coincide and tie) and off it; sides from zero up.
fn boxes() -> impl Strategy<Value = Aabb> {
    let grid = |range: std::ops::Range<i32>| range.prop_map(f64::from);
    let coordinate = prop_oneof![3 => grid(-2..3), 1 => -2.0..2.0];
    let side = prop_oneof![3 => grid(0..3), 1 => 0.0..0.5];
    let corner = [coordinate.clone(), coordinate.clone(), coordinate].prop_map(Vec3::from);
    let sides = prop_oneof![
        4 => [side.clone(), side.clone(), side].prop_map(Vec3::from),
        1 => Just(Vec3::zeros()),
    ];
    (corner, sides).prop_map(|(min, sides)| Aabb { min, max: min + sides })
}

/// Along axes, askew, and none at all.
fn motions() -> impl Strategy<Value = Vec3> {
    let along = prop_oneof![2 => Just(0.0), 3 => (-3..4).prop_map(f64::from), 2 => -4.0..4.0];
    [along.clone(), along.clone(), along].prop_map(Vec3::from)
}

fn commands() -> impl Strategy<Value = Vec<Command>> {
    let index = any::<prop::sample::Index>;
    let step = [-0.05..0.05_f64, -0.05..0.05, -0.05..0.05].prop_map(Vec3::from);
    let command = prop_oneof![
        6 => boxes().prop_map(Command::Insert),
        3 => index().prop_map(Command::Remove),
        3 => (index(), step).prop_map(|(i, step)| Command::Nudge(i, step)),
        2 => (index(), boxes()).prop_map(|(i, aabb)| Command::Replace(i, aabb)),
        2 => boxes().prop_map(Command::Overlap),
        2 => (boxes(), 0.0..5.0_f64).prop_map(|(aabb, within)| Command::Nearest(aabb, within)),
        2 => (boxes(), motions(), 0.0..1.5_f64).prop_map(|(start, motion, within)| Command::Cast(start, motion, within)),
        1 => Just(Command::AllPairs),
    ];
    prop::collection::vec(command, 1..80)
}

/// The tree and what should be in it.
#[derive(Default)]
struct Compared {
    tree: DynamicTree,
    expected: BTreeMap<u64, (ProxyId, Aabb)>,
    next: u64,
}

impl Compared {
    fn run(&mut self, command: &Command, reached: &mut Reached) {
        match command {
            Command::Insert(aabb) => {
                reached.degenerate += usize::from(aabb.min == aabb.max);
                let proxy = self.tree.insert(*aabb, self.next);
                self.expected.insert(self.next, (proxy, *aabb));
                self.next += 1;
            }
            Command::Remove(index) => {
                if let Some(key) = self.pick(index) {
                    let (proxy, _) = self.expected.remove(&key).unwrap();
                    self.tree.remove(proxy);
                    reached.removed += 1;
                }
            }
            Command::Nudge(index, step) => {
                if let Some(key) = self.pick(index) {
                    let aabb = self.expected[&key].1;
                    self.move_to(key, Aabb { min: aabb.min + step, max: aabb.max + step }, reached);
                }
            }
            Command::Replace(index, aabb) => {
                if let Some(key) = self.pick(index) {
                    self.move_to(key, *aabb, reached);
                }
            }
            Command::Overlap(query) => {
                let mut found = Vec::new();
                let stats = self.tree.overlap(query, |payload| {
                    found.push(payload);
                    ControlFlow::Continue(())
                });
                found.sort_unstable();
                let expected: Vec<u64> = self.meeting(query).collect();
                reached.overlaps += expected.len();
                assert_eq!(found, expected);
                assert!(stats.leaves >= found.len() as u64 && stats.nodes >= stats.leaves);
            }
            Command::Nearest(query, within) => self.check_nearest(query, *within, reached),
            Command::Cast(start, motion, within) => {
                self.check_cast(&BoxCast { start: *start, motion: *motion }, *within, reached);
            }
            Command::AllPairs => self.check_pairs(reached),
        }
    }

    fn pick(&self, index: &prop::sample::Index) -> Option<u64> {
        (!self.expected.is_empty()).then(|| *self.expected.keys().nth(index.index(self.expected.len())).unwrap())
    }

    fn move_to(&mut self, key: u64, aabb: Aabb, reached: &mut Reached) {
        let entry = self.expected.get_mut(&key).unwrap();
        entry.1 = aabb;
        let reinserted = self.tree.move_to(entry.0, aabb);
        reached.reinserted += usize::from(reinserted);
        reached.moved_inside += usize::from(!reinserted);
    }

    fn meeting<'a>(&'a self, query: &'a Aabb) -> impl Iterator<Item = u64> + 'a {
        self.expected.iter().filter(|(_, (_, aabb))| aabb.overlaps(query)).map(|(key, _)| *key)
    }

    fn check_pairs(&self, reached: &mut Reached) {
        let mut found = Vec::new();
        self.tree.self_pairs(|a, b| {
            found.push((a, b));
            ControlFlow::Continue(())
        });
        found.sort_unstable();
        let mut expected = Vec::new();
        for (a, (_, aabb)) in &self.expected {
            expected.extend(self.meeting(aabb).filter(|b| b > a).map(|b| (*a, b)));
        }
        reached.pairs += expected.len();
        assert_eq!(found, expected);

        // Against a tree of the same boxes: each unordered pair both ways round, and every entry meets itself.
        let mut rebuilt = DynamicTree::new();
        for (key, (_, aabb)) in self.expected.iter().rev() {
            rebuilt.insert(*aabb, *key);
        }
        let mut both_ways: Vec<(u64, u64)> = expected.iter().flat_map(|(a, b)| [(*a, *b), (*b, *a)]).collect();
        both_ways.extend(self.expected.keys().map(|key| (*key, *key)));
        both_ways.sort_unstable();
        let mut between = Vec::new();
        self.tree.pairs_with(&rebuilt, |a, b| {
            between.push((a, b));
            ControlFlow::Continue(())
        });
        between.sort_unstable();
        assert_eq!(between, both_ways);
    }

    fn check_nearest(&self, query: &Aabb, within: f64, reached: &mut Reached) {
        let mut visited = Vec::new();
        self.tree.nearest(query, within, |payload, distance| {
            visited.push((distance, payload));
            within
        });
        for pair in visited.windows(2) {
            assert!(pair[0] < pair[1], "not in order: {pair:?}");
            reached.near_ties += usize::from(pair[0].0 == pair[1].0);
        }
        let mut found: Vec<u64> = visited.iter().map(|(_, payload)| *payload).collect();
        found.sort_unstable();
        let near = |aabb: &Aabb| aabb.distance(query);
        let certain: Vec<u64> =
            self.expected.iter().filter(|(_, (_, aabb))| near(aabb) <= within).map(|(key, _)| *key).collect();
        reached.near += certain.len();
        // The walk rounds distances down, so it may visit what lies within rounding beyond the bound.
        for key in &found {
            assert!(certain.contains(key) || near(&self.expected[key].1) <= within * (1.0 + 1e-14));
        }
        assert!(certain.iter().all(|key| found.contains(key)));

        // With a bound that shrinks to the best so far, the nearest of all is still among the visited.
        let mut best = f64::INFINITY;
        self.tree.nearest(query, f64::INFINITY, |payload, bound| {
            let distance = near(&self.expected[&payload].1);
            assert!(bound <= distance && distance <= bound * (1.0 + 1e-14));
            best = best.min(distance);
            best
        });
        let least = self.expected.values().map(|(_, aabb)| near(aabb)).fold(f64::INFINITY, f64::min);
        assert_eq!(best, least);
    }
}

impl Compared {
    fn check_cast(&self, cast: &BoxCast, within: f64, reached: &mut Reached) {
        let touch = |aabb: &Aabb| cast.first_touch(aabb);
        let mut found = Vec::new();
        self.tree.cast(cast, within, |payload, fraction| {
            assert_eq!(Some(fraction), touch(&self.expected[&payload].1));
            found.push(payload);
            within
        });
        found.sort_unstable();
        let meets = |aabb: &Aabb| touch(aabb).is_some_and(|fraction| fraction <= within);
        let expected: Vec<u64> =
            self.expected.iter().filter(|(_, (_, aabb))| meets(aabb)).map(|(key, _)| *key).collect();
        reached.met += expected.len();
        assert_eq!(found, expected);

        // With a bound that shrinks to the earliest so far, the first of all is still among the visited.
        let mut first = f64::INFINITY;
        self.tree.cast(cast, 1.0, |_, fraction| {
            first = first.min(fraction);
            first
        });
        let least = self.expected.values().filter_map(|(_, aabb)| touch(aabb)).fold(f64::INFINITY, f64::min);
        reached.met_first += usize::from(first > 0.0 && first <= 1.0);
        assert_eq!(first, least);
    }
}

#[test]
fn random_changes_agree_with_brute_force() {
    let reached = RefCell::new(Reached::default());
    let config = Config { cases: 600, failure_persistence: None, ..Config::default() };
    TestRunner::new(config)
        .run(&commands(), |commands| {
            let reached = &mut *reached.borrow_mut();
            let mut compared = Compared::default();
            for command in &commands {
                compared.run(command, reached);
                assert_eq!(compared.tree.validate(), Ok(()));
                assert_eq!(compared.tree.len(), compared.expected.len());
                reached.empty += usize::from(compared.tree.is_empty());
            }
            reached.deep += usize::from(compared.tree.health().height > 4);
            compared.check_pairs(reached);
            Ok(())
        })
        .unwrap();
    let Reached {
        empty,
        moved_inside,
        reinserted,
        removed,
        degenerate,
        overlaps,
        pairs,
        near,
        near_ties,
        met,
        met_first,
        deep,
    } = reached.into_inner();
    for (regime, count) in [
        ("empty tree", empty),
        ("move inside the fat box", moved_inside),
        ("reinsertion", reinserted),
        ("removal", removed),
        ("box without extent", degenerate),
        ("overlap found", overlaps),
        ("pair found", pairs),
        ("entry within a distance", near),
        ("equal distances", near_ties),
        ("entry on the way of a moving box", met),
        ("first entry on the way", met_first),
        ("tree of several levels", deep),
    ] {
        assert!(count >= 20, "{regime}: only {count}");
    }
}

/// Inserts `boxes` in their order; the height must stay below `times` the least possible one.
fn check_height(name: &str, times: u32, boxes: impl IntoIterator<Item = Aabb>) {
    let mut tree = DynamicTree::new();
    for (i, aabb) in boxes.into_iter().enumerate() {
        tree.insert(aabb, i as u64);
    }
    tree.validate().unwrap();
    let health = tree.health();
    assert!(health.height <= times * health.least_height, "{name}: {health:?}");
}

fn unit_box_at(x: f64, y: f64, z: f64) -> Aabb {
    Aabb::centred(Vec3::new(x, y, z), Vec3::repeat(0.5))
}

#[test]
fn height_stays_low_whatever_the_order_of_insertion() {
    let row = |i: i32| f64::from(i);
    check_height("sorted row", 2, (0..3000).map(|i| unit_box_at(row(i), 0.0, 0.0)));
    check_height("row from the far end", 2, (0..3000).rev().map(|i| unit_box_at(2.0 * row(i), 0.0, 0.0)));
    check_height("points on a line", 2, (0..3000).map(|i| Aabb::around([Vec3::new(row(i), 0.0, 0.0)])));
    check_height("one box many times", 2, (0..3000).map(|_| unit_box_at(0.0, 0.0, 0.0)));
    check_height("one point many times", 2, (0..3000).map(|_| Aabb::around([Vec3::zeros()])));
    check_height("growing boxes", 5, (0..3000).map(|i| Aabb::centred(Vec3::zeros(), Vec3::repeat(1.0 + row(i)))));
    check_height("shrinking boxes", 5, (0..3000).rev().map(|i| Aabb::centred(Vec3::zeros(), Vec3::repeat(row(i)))));
    check_height("ever wider", 5, (0..600).map(|i| unit_box_at(libm::exp2(row(i) / 2.0), 0.0, 0.0)));
    check_height("floor by rows", 3, (0..3600).map(|i| unit_box_at(row(i % 60), row(i / 60), 0.0)));
}

#[test]
fn no_pair_is_dropped_when_everything_overlaps_everything() {
    let mut tree = DynamicTree::new();
    let count = 1500_u64;
    for i in 0..count {
        tree.insert(unit_box_at(1e-4 * i as f64, 0.0, 0.0), i);
    }
    let mut pairs = 0_u64;
    let stats = tree.self_pairs(|_, _| {
        pairs += 1;
        ControlFlow::Continue(())
    });
    assert_eq!(pairs, count * (count - 1) / 2);
    assert!(stats.leaves >= pairs);
}

#[test]
fn churn_leaves_health_flat() {
    let count = 500_u64;
    let place = |i: u64| unit_box_at((i * 7919 % 1009) as f64 * 0.1, (i * 104_729 % 997) as f64 * 0.1, 0.0);
    let mut tree = DynamicTree::new();
    let mut live: Vec<ProxyId> = (0..count).map(|i| tree.insert(place(i), i)).collect();
    let fresh = tree.health();
    for round in 1..40_u64 {
        for i in 0..count {
            let at = place(i + round * count);
            let slot = &mut live[i as usize];
            if i % 2 == 0 {
                tree.remove(*slot);
                *slot = tree.insert(at, i);
            } else {
                tree.move_to(*slot, at);
            }
        }
    }
    tree.validate().unwrap();
    let worn = tree.health();
    assert_eq!(worn.leaves, fresh.leaves);
    assert!(worn.surface_cost < 1.3 * fresh.surface_cost, "{fresh:?} {worn:?}");
    assert!(worn.height <= fresh.height + 6 && worn.inflation < 1.3, "{fresh:?} {worn:?}");
    assert!(worn.free_places <= 1, "{worn:?}");
}

#[test]
fn many_small_moves_leave_a_tree_like_a_new_one() {
    let count = 400_u64;
    let mut places: Vec<Vec3> =
        (0..count).map(|i| Vec3::new((i % 20) as f64, (i / 20) as f64, (i * 7919 % 11) as f64)).collect();
    let mut tree = DynamicTree::new();
    let around = |at: &Vec3| Aabb::centred(*at, Vec3::repeat(0.5));
    let proxies: Vec<ProxyId> = (0..).zip(&places).map(|(i, at)| tree.insert(around(at), i)).collect();
    // Each box goes its own way, ten box lengths altogether.
    for _ in 0..100 {
        for (i, (proxy, place)) in (0..).zip(proxies.iter().zip(&mut places)) {
            let (sin, cos) = libm::sincos(f64::from(i));
            *place += 0.1 * Vec3::new(sin, cos, 0.0);
            tree.move_to(*proxy, around(place));
        }
    }
    tree.validate().unwrap();
    let mut fresh = DynamicTree::new();
    for (i, at) in (0..).zip(&places) {
        fresh.insert(around(at), i);
    }
    let (worn, fresh) = (tree.health(), fresh.health());
    assert!(worn.surface_cost < 1.3 * fresh.surface_cost, "{worn:?} {fresh:?}");
    assert!(worn.height <= fresh.height + 6, "{worn:?} {fresh:?}");
}

#[test]
fn a_box_that_shrinks_far_below_its_fat_box_is_put_in_anew() {
    let mut tree = DynamicTree::new();
    let proxy = tree.insert(Aabb::centred(Vec3::zeros(), Vec3::repeat(100.0)), 0);
    assert!(!tree.move_to(proxy, Aabb::centred(Vec3::zeros(), Vec3::repeat(99.99))));
    assert!(tree.move_to(proxy, Aabb::centred(Vec3::zeros(), Vec3::repeat(1.0))));
    assert!(tree.health().inflation < 1.2);
}

#[test]
fn a_breaking_visit_and_a_negative_bound_end_the_work() {
    let mut tree = DynamicTree::new();
    for i in 0..10 {
        tree.insert(unit_box_at(0.0, 0.0, 0.0), i);
    }
    let mut visits = 0;
    tree.overlap(&unit_box_at(0.0, 0.0, 0.0), |_| {
        visits += 1;
        ControlFlow::Break(())
    });
    tree.self_pairs(|_, _| {
        visits += 1;
        ControlFlow::Break(())
    });
    tree.nearest(&unit_box_at(3.0, 0.0, 0.0), f64::INFINITY, |_, _| {
        visits += 1;
        -1.0
    });
    assert_eq!(visits, 3);
}

#[test]
fn a_change_to_a_clone_leaves_the_original_alone_and_shares_most_of_it() {
    let mut tree = DynamicTree::new();
    let proxies: Vec<ProxyId> =
        (0..4000_i32).map(|i| tree.insert(unit_box_at(f64::from(i % 63), f64::from(i / 63), 0.0), i as u64)).collect();
    let before = tree.clone();
    tree.move_to(proxies[1234], unit_box_at(-50.0, 0.0, 0.0));
    assert_eq!((before.validate(), tree.validate()), (Ok(()), Ok(())));
    assert_eq!(before.tight(proxies[1234]), unit_box_at(f64::from(1234 % 63), f64::from(1234 / 63), 0.0));
    let pages = before.nodes.len().div_ceil(64);
    assert!(tree.nodes.shared_with(&before.nodes) > pages * 3 / 4);
}
