//! Any pair of shapes: the bracket holds the truth, the verdict does not contradict it, points and normal fit the distance.
//!
//! Oracle: the double-double bracket of the collision tests, with a cap on its work. Where it stays wide the check is weak,
//! never wrong.
#![no_main]

use clearance::narrow_phase::{Accuracy, Depth, Goal};
use clearance_fuzz::oracle::truth;
use clearance_fuzz::pair_bytes;
use clearance_fuzz::specimen::ask;
use clearance_fuzz::verdict_of_truth::faults;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Some((choice, a, b)) = pair_bytes::read(bytes) else { return };
    let full = Goal::penetration();
    let goal = match choice % 4 {
        0 => full,
        1 => Goal { accuracy: Accuracy { absolute: 0.0, relative: 0.0 }, ..full },
        2 => Goal { depth: Depth::Distance, ..full },
        _ => Goal::verdict(),
    };
    let found = ask(&a, &b, &goal);
    let truth = truth(&a.body, &b.body, 1e-3 * found.bracket.width(), 120);
    let wrong = faults(&found, &goal, &truth);
    assert!(wrong.is_empty(), "{wrong:?}\n  A {:?}\n  B {:?}\n  {goal:?}\n  {found:?}\n  {truth:?}", a.body, b.body);
});
