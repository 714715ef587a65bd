//! A string of bytes as commands to all three broad phases at once, each outcome held against looking at every box. The
//! fuzz target `broad_phase` runs the same.
//!
//! Oracle: a map from numbers to boxes. Where a walk rounds distances down, the oracle allows what lies within rounding
//! beyond the bound, and the three walks must be the same to the bit.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use clearance::broad_phase::{BroadPhase, BroadPhaseKind, ProxyId};
use clearance::geometry::{Aabb, BoxCast, Vec3};

pub const KINDS: [BroadPhaseKind; 3] =
    [BroadPhaseKind::Tree, BroadPhaseKind::SweepAndPrune, BroadPhaseKind::Exhaustive];

/// What a run came by; a sweep asserts that it came by everything.
#[derive(Debug, Default)]
pub struct Reached {
    pub removed: usize,
    pub moved: usize,
    pub overlaps: usize,
    pub pairs: usize,
    pub near: usize,
    pub ties: usize,
    pub met: usize,
    pub met_first: usize,
    pub many: usize,
    pub empty: usize,
    pub extreme: usize,
    pub needles: usize,
    pub identical: usize,
    pub earlier_versions: usize,
    pub ended_early: usize,
    pub resorted: usize,
}

/// Runs all commands of a string.
///
/// # Panics
/// An outcome is not the oracle's, or a broad phase is not what it claims to be.
pub fn run(bytes: &[u8], reached: &mut Reached) {
    let mut reader = Reader(bytes);
    let mut state = State::new();
    while let Some(()) = state.step(&mut reader, reached) {}
    state.settle(reached);
    state.check_pairs(reached);
}

struct Reader<'a>(&'a [u8]);

impl Reader<'_> {
    fn byte(&mut self) -> Option<u8> {
        let (first, rest) = self.0.split_first()?;
        self.0 = rest;
        Some(*first)
    }

    /// A multiple of an eighth, so that boxes touch often.
    fn eighths(&mut self) -> Option<f64> {
        Some(f64::from(self.byte()? as i8) / 8.0)
    }

    fn vector(&mut self) -> Option<Vec3> {
        Some(Vec3::new(self.eighths()?, self.eighths()?, self.eighths()?))
    }

    fn aabb(&mut self, reached: &mut Reached) -> Option<Aabb> {
        let form = self.byte()?;
        let center = self.vector()?;
        let half = self.vector()?.abs() / 8.0;
        let along = |axis: u8, length: f64| {
            let mut half = half / 64.0;
            half[usize::from(axis % 3)] = length;
            half
        };
        Some(match form % 16 {
            0 => Aabb::centred(center, Vec3::zeros()),
            1 => Aabb::centred(Vec3::zeros(), half),
            2 | 3 => {
                reached.needles += 1;
                Aabb::centred(center, along(form / 16, 50.0))
            }
            4 => {
                reached.identical += 1;
                Aabb::centred(Vec3::repeat(1.0), Vec3::repeat(0.5))
            }
            5 => {
                reached.extreme += 1;
                Aabb::centred(center * 1e100, half * 1e99)
            }
            6 => Aabb::centred(center * 1e-160, half * 1e-160),
            7 => Aabb::centred(center + Vec3::new(1e7, 0.0, 0.0), half),
            8 => Aabb::centred(center, half * 40.0),
            _ => Aabb::centred(center, half),
        })
    }
}

struct State {
    phases: [BroadPhase; 3],
    boxes: BTreeMap<u64, (Aabb, [ProxyId; 3])>,
    next: u64,
    /// A version from before, with what was in it.
    earlier: Option<([BroadPhase; 3], BTreeMap<u64, Aabb>)>,
}

impl State {
    fn new() -> Self {
        Self { phases: KINDS.map(BroadPhase::new), boxes: BTreeMap::new(), next: 0, earlier: None }
    }

    fn step(&mut self, reader: &mut Reader, reached: &mut Reached) -> Option<()> {
        match reader.byte()? % 16 {
            0..=2 => {
                let aabb = reader.aabb(reached)?;
                self.insert(aabb);
            }
            3 => {
                // Enough at once that segments and nodes divide.
                let (first, step, count) = (reader.aabb(reached)?, reader.vector()?, reader.byte()?);
                for i in 0..count {
                    let by = step * f64::from(i);
                    self.insert(Aabb { min: first.min + by, max: first.max + by });
                }
            }
            4 | 5 => {
                let Some(key) = self.pick(reader.byte()?) else { return Some(()) };
                let (_, proxies) = self.boxes.remove(&key)?;
                for (phase, proxy) in self.phases.iter_mut().zip(proxies) {
                    phase.remove(proxy);
                }
                reached.removed += 1;
            }
            6 | 7 => {
                let (choice, step) = (reader.byte()?, reader.vector()? / 16.0);
                let Some(key) = self.pick(choice) else { return Some(()) };
                let aabb = self.boxes[&key].0;
                self.move_to(key, Aabb { min: aabb.min + step, max: aabb.max + step }, reached);
            }
            8 => {
                let (choice, aabb) = (reader.byte()?, reader.aabb(reached)?);
                let Some(key) = self.pick(choice) else { return Some(()) };
                self.move_to(key, aabb, reached);
            }
            9 => {
                // All at once, as on a belt.
                let step = reader.vector()? / 64.0;
                for key in self.boxes.keys().copied().collect::<Vec<_>>() {
                    let aabb = self.boxes[&key].0;
                    self.move_to(key, Aabb { min: aabb.min + step, max: aabb.max + step }, reached);
                }
            }
            10 => {
                let query = reader.aabb(reached)?;
                self.settle(reached);
                self.check_overlap(&query, reached);
            }
            11 => {
                let (query, within) = (reader.aabb(reached)?, reader.eighths()?.abs());
                self.settle(reached);
                self.check_nearest(&query, within, reached);
            }
            12 => {
                let (start, motion, within) = (reader.aabb(reached)?, reader.vector()?, reader.eighths()?.abs() / 8.0);
                self.settle(reached);
                self.check_cast(&BoxCast { start, motion }, within, reached);
            }
            13 => {
                self.settle(reached);
                self.check_pairs(reached);
            }
            14 => {
                self.check_earlier(reached);
                let boxes = self.boxes.iter().map(|(key, (aabb, _))| (*key, *aabb)).collect();
                self.earlier = Some((self.phases.clone(), boxes));
            }
            _ => {
                let query = reader.aabb(reached)?;
                self.settle(reached);
                self.check_ends(&query, reached);
            }
        }
        for (phase, kind) in self.phases.iter().zip(KINDS) {
            assert_eq!(phase.validate(), Ok(()), "{kind:?}");
            assert_eq!((phase.kind(), phase.len()), (kind, self.boxes.len()));
            assert_eq!(phase.is_empty(), self.boxes.is_empty());
        }
        reached.empty += usize::from(self.boxes.is_empty() && self.next > 0);
        reached.many += usize::from(self.boxes.len() > 200);
        Some(())
    }

    fn settle(&mut self, reached: &mut Reached) {
        let axis = |phase: &BroadPhase| match phase {
            BroadPhase::SweepAndPrune(sweep) => Some(sweep.health().axis),
            BroadPhase::Tree(_) | BroadPhase::Exhaustive(_) => None,
        };
        for phase in &mut self.phases {
            let before = axis(phase);
            phase.settle();
            reached.resorted += usize::from(axis(phase) != before);
            assert_eq!(phase.validate(), Ok(()));
        }
    }

    fn insert(&mut self, aabb: Aabb) {
        let key = self.next;
        self.next += 1;
        let proxies = self.phases.each_mut().map(|phase| phase.insert(aabb, key));
        self.boxes.insert(key, (aabb, proxies));
    }

    fn pick(&self, choice: u8) -> Option<u64> {
        let place = usize::from(choice) % self.boxes.len().max(1);
        self.boxes.keys().nth(place).copied()
    }

    fn move_to(&mut self, key: u64, aabb: Aabb, reached: &mut Reached) {
        let Some(entry) = self.boxes.get_mut(&key) else { return };
        entry.0 = aabb;
        for (phase, proxy) in self.phases.iter_mut().zip(entry.1) {
            phase.move_to(proxy, aabb);
            assert_eq!((phase.tight(proxy), phase.payload(proxy)), (aabb, key));
        }
        reached.moved += 1;
    }

    /// Asks all three; each must say the same.
    fn same<T: PartialEq + std::fmt::Debug>(&self, ask: impl Fn(&BroadPhase) -> T) -> T {
        let [tree, sweep, exhaustive] = self.phases.each_ref().map(ask);
        assert_eq!(tree, exhaustive, "the tree and the exhaustive search");
        assert_eq!(sweep, exhaustive, "sweep and prune and the exhaustive search");
        exhaustive
    }

    fn check_overlap(&self, query: &Aabb, reached: &mut Reached) {
        let found = self.same(|phase| {
            let mut found = Vec::new();
            phase.overlap(query, |payload| {
                found.push(payload);
                ControlFlow::Continue(())
            });
            found.sort_unstable();
            found
        });
        let expected: Vec<u64> =
            self.boxes.iter().filter(|(_, (aabb, _))| aabb.overlaps(query)).map(|(key, _)| *key).collect();
        assert_eq!(found, expected);
        reached.overlaps += found.len();
    }

    fn check_pairs(&self, reached: &mut Reached) {
        let found = self.same(|phase| {
            let mut found = Vec::new();
            phase.self_pairs(|a, b| {
                found.push((a, b));
                ControlFlow::Continue(())
            });
            found.sort_unstable();
            found
        });
        let mut expected = Vec::new();
        for (a, (one, _)) in &self.boxes {
            let later = self.boxes.range(a + 1..);
            expected.extend(later.filter(|(_, (other, _))| one.overlaps(other)).map(|(b, _)| (*a, *b)));
        }
        assert_eq!(found, expected);
        reached.pairs += found.len();
    }

    fn check_nearest(&self, query: &Aabb, within: f64, reached: &mut Reached) {
        let visited = self.same(|phase| {
            let mut visited = Vec::new();
            phase.nearest(query, within, |payload, distance| {
                visited.push((distance, payload));
                within
            });
            visited
        });
        assert!(visited.windows(2).all(|pair| pair[0] < pair[1]), "not in order: {visited:?}");
        reached.ties += visited.windows(2).filter(|pair| pair[0].0 == pair[1].0).count();
        reached.near += visited.len();
        let distance = |key: &u64| self.boxes[key].0.distance(query);
        for (lower, key) in &visited {
            assert!(*lower <= distance(key), "{lower} is no lower bound of {}", distance(key));
        }
        let mut found: Vec<u64> = visited.into_iter().map(|(_, key)| key).collect();
        found.sort_unstable();
        for key in self.boxes.keys() {
            let (is_found, apart) = (found.binary_search(key).is_ok(), distance(key));
            assert!(is_found || apart > within, "the entry {key}, {apart} m away, is lost");
            assert!(!is_found || apart <= within * (1.0 + 1e-14) + 1e-149, "the entry {key} is {apart} m away");
        }
        // With a bound that shrinks to the best so far, the walks are still the same.
        let walk = self.same(|phase| {
            let (mut best, mut order) = (f64::INFINITY, Vec::new());
            phase.nearest(query, f64::INFINITY, |payload, lower| {
                order.push((payload, lower));
                best = best.min(distance(&payload));
                best
            });
            (best, order)
        });
        let least = self.boxes.keys().map(distance).fold(f64::INFINITY, f64::min);
        assert_eq!(walk.0, least);
    }

    fn check_cast(&self, cast: &BoxCast, within: f64, reached: &mut Reached) {
        let found = self.same(|phase| {
            let mut found = Vec::new();
            phase.cast(cast, within, |payload, fraction| {
                found.push((payload, fraction));
                within
            });
            found.sort_unstable_by_key(|(payload, _)| *payload);
            found
        });
        let touch = |key: &u64| cast.first_touch(&self.boxes[key].0);
        let expected: Vec<(u64, f64)> = self
            .boxes
            .keys()
            .filter_map(|key| Some((*key, touch(key)?)))
            .filter(|(_, fraction)| *fraction <= within)
            .collect();
        assert_eq!(found, expected);
        reached.met += found.len();
        let first = self.same(|phase| {
            let mut first = f64::INFINITY;
            phase.cast(cast, 1.0, |_, fraction| {
                first = first.min(fraction);
                first
            });
            first
        });
        let least = self.boxes.keys().filter_map(touch).fold(f64::INFINITY, f64::min);
        assert_eq!(first, least);
        reached.met_first += usize::from(first > 0.0 && first <= 1.0);
    }

    /// A visit that breaks, and a bound that is negative, end the work of all three at once.
    fn check_ends(&self, query: &Aabb, reached: &mut Reached) {
        let visits = self.same(|phase| {
            let (mut overlaps, mut pairs, mut near) = (0, 0, 0);
            phase.overlap(query, |_| {
                overlaps += 1;
                ControlFlow::Break(())
            });
            phase.self_pairs(|_, _| {
                pairs += 1;
                ControlFlow::Break(())
            });
            phase.nearest(query, f64::INFINITY, |_, _| {
                near += 1;
                -1.0
            });
            (overlaps, pairs, near)
        });
        assert!(visits.0 <= 1 && visits.1 <= 1 && visits.2 == usize::from(!self.boxes.is_empty()), "{visits:?}");
        reached.ended_early += usize::from(visits.0 == 1);
    }

    /// What was done since has not changed the version from before.
    fn check_earlier(&self, reached: &mut Reached) {
        let Some((phases, boxes)) = &self.earlier else { return };
        for phase in phases {
            assert_eq!(phase.validate(), Ok(()));
            let mut entries: Vec<(u64, Aabb)> = phase.iter().collect();
            entries.sort_unstable_by_key(|(key, _)| *key);
            assert!(entries.into_iter().eq(boxes.iter().map(|(key, aabb)| (*key, *aabb))), "{:?}", phase.kind());
        }
        reached.earlier_versions += 1;
    }
}
