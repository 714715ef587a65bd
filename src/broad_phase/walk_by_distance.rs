//! In which order are entries met that are near a box? By distance, then by number, whatever holds them.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use crate::geometry::Aabb;

/// Distances between boxes are rounded down by this much, relatively, so that none is above the true one: four
/// roundings at most (difference, square, sum, root) go into it.
const ROUNDING_DOWN: f64 = 1.0 - 4.0 * f64::EPSILON;

/// Below this many metres a box distance counts as none: its square would lose digits to underflow.
const LEAST_DISTANCE: f64 = 1e-150;

/// At most the distance between the boxes, metres, and no less for a box that holds another one.
pub(super) fn lower_distance(a: &Aabb, b: &Aabb) -> f64 {
    let distance = a.distance(b) * ROUNDING_DOWN;
    if distance < LEAST_DISTANCE { 0.0 } else { distance }
}

/// What a walk has seen and not visited yet, the nearest first. `P` is a part that holds entries.
pub(super) struct Waiting<P> {
    heap: BinaryHeap<Step<P>>,
}

/// What comes next.
pub(super) enum Next<P> {
    /// A part to look into.
    Part(P),
    /// An entry to visit: its number, and at most its distance in metres.
    Entry(u64, f64),
}

impl<P> Waiting<P> {
    pub(super) fn new() -> Self {
        Self { heap: BinaryHeap::with_capacity(64) }
    }

    pub(super) fn add_part(&mut self, distance: f64, part: P) {
        self.heap.push(Step { distance, part: Some(part), payload: 0 });
    }

    pub(super) fn add_entry(&mut self, distance: f64, payload: u64) {
        self.heap.push(Step { distance, part: None, payload });
    }

    /// The nearest, if it is within `bound` metres.
    pub(super) fn next_within(&mut self, bound: f64) -> Option<Next<P>> {
        let step = self.heap.pop().filter(|step| step.distance <= bound)?;
        Some(match step.part {
            Some(part) => Next::Part(part),
            None => Next::Entry(step.payload, step.distance),
        })
    }
}

struct Step<P> {
    distance: f64,
    part: Option<P>,
    payload: u64,
}

/// The greatest comes out of the heap first, so the order is reversed. Parts come before entries of the same distance,
/// and entries in the order of their numbers: then the order of visits does not depend on the parts.
impl<P> Ord for Step<P> {
    fn cmp(&self, other: &Self) -> Ordering {
        let by_kind = self.part.is_some().cmp(&other.part.is_some());
        other.distance.total_cmp(&self.distance).then(by_kind).then(other.payload.cmp(&self.payload))
    }
}

impl<P> PartialOrd for Step<P> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<P> PartialEq for Step<P> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl<P> Eq for Step<P> {}
