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
use crate::geometry::{Aabb, BoxCast, Mat3, OrientedBox, Vec3};

mod churn;
mod hard;
mod turned;
mod versions;
mod volumes;

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
    /// Makes the changes so far; what is asked before answers by them all the same.
    Settle,
}

/// How often each regime was met in a sweep.
#[derive(Debug, Default)]
struct Reached {
    empty: usize,
    nudged: usize,
    replaced: usize,
    asked_unsettled: usize,
    moved_unsettled: usize,
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
        5 => Just(Command::Settle),
    ];
    prop::collection::vec(command, 1..160)
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
                    reached.nudged += 1;
                    self.move_to(key, Aabb { min: aabb.min + step, max: aabb.max + step }, reached);
                }
            }
            Command::Replace(index, aabb) => {
                if let Some(key) = self.pick(index) {
                    reached.replaced += 1;
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
                assert!(stats.leaves >= found.len() as u64 && 8 * stats.nodes >= stats.leaves);
                reached.asked_unsettled += usize::from(!self.tree.is_settled());
            }
            Command::Nearest(query, within) => self.check_nearest(query, *within, reached),
            Command::Cast(start, motion, within) => {
                self.check_cast(&BoxCast { start: *start, motion: *motion }, *within, reached);
            }
            Command::AllPairs => self.check_pairs(reached),
            Command::Settle => self.tree.settle(),
        }
    }

    fn pick(&self, index: &prop::sample::Index) -> Option<u64> {
        (!self.expected.is_empty()).then(|| *self.expected.keys().nth(index.index(self.expected.len())).unwrap())
    }

    fn move_to(&mut self, key: u64, aabb: Aabb, reached: &mut Reached) {
        let entry = self.expected.get_mut(&key).unwrap();
        entry.1 = aabb;
        reached.moved_unsettled += usize::from(!self.tree.is_settled());
        self.tree.move_to(entry.0, aabb);
        assert_eq!((self.tree.tight(entry.0), self.tree.payload(entry.0)), (aabb, key));
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
        rebuilt.settle();
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
            reached.deep += usize::from(compared.tree.health().depth > 1);
            let mut listed: Vec<(u64, Aabb)> = compared.tree.iter().collect();
            listed.sort_unstable_by_key(|(key, _)| *key);
            assert!(listed.into_iter().eq(compared.expected.iter().map(|(key, (_, aabb))| (*key, *aabb))));
            compared.check_pairs(reached);
            Ok(())
        })
        .unwrap();
    let Reached {
        empty,
        nudged,
        replaced,
        asked_unsettled,
        moved_unsettled,
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
        ("small move", nudged),
        ("move to elsewhere", replaced),
        ("question before the changes were made", asked_unsettled),
        ("move of an entry that may not be in the tree yet", moved_unsettled),
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

pub(super) fn unit_box_at(x: f64, y: f64, z: f64) -> Aabb {
    Aabb::centred(Vec3::new(x, y, z), Vec3::repeat(0.5))
}

/// Numbers in 0..1 from a linear congruential generator (Knuth's MMIX constants), the same in every run.
pub(super) struct Random(pub(super) u64);

impl Random {
    pub(super) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(super) fn vector(&mut self, side: f64) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next()) * side
    }

    /// A right-handed frame turned at random, orthonormal to a few roundings.
    pub(super) fn frame(&mut self) -> Mat3 {
        let mut direction = || self.vector(2.0) - Vec3::repeat(1.0);
        let first = direction().normalize();
        let across = direction();
        let once = (across - first * first.dot(&across)).normalize();
        let second = (once - first * first.dot(&once)).normalize();
        Mat3::from_columns(&[first, second, first.cross(&second)])
    }

    /// A box turned at random about `center`, its half extents up to `longest`: often a needle, a plate, or a point.
    pub(super) fn turned(&mut self, center: Vec3, longest: f64) -> OrientedBox {
        let mut half = || [1.0, 1.0, 0.01, 0.0][self.below(4)] * longest * self.next();
        let half_extents = Vec3::new(half(), half(), half());
        OrientedBox { center, axes: self.frame(), half_extents }
    }

    pub(super) fn below(&mut self, count: usize) -> usize {
        ((self.next() * count as f64) as usize).min(count - 1)
    }

    /// A box of sides 0.5 to 1.5 in a cube in which `count` of them have about half an overlap each.
    pub(super) fn scattered(&mut self, count: usize) -> Aabb {
        let center = self.vector(2.0 * libm::cbrt(count as f64));
        Aabb::centred(center, Vec3::repeat(0.25) + self.vector(0.5))
    }
}
