//! A line of `clearance pairs`: read or refused by name, never a panic; what was read can be asked about.
#![no_main]

use clearance::cli::read_line;
use clearance::narrow_phase::{Goal, separation};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|line: &[u8]| {
    let (_, case) = read_line(line);
    if let Ok(case) = case {
        // Two unbounded shapes have no distance and are refused by name; everything else has an answer.
        if let Ok(found) =
            separation(&case.a, &case.b, &case.pose_a.placement(), &case.pose_b.placement(), &Goal::verdict())
        {
            assert!(found.bracket.lower <= found.bracket.upper, "{found:?}");
        }
    }
});
