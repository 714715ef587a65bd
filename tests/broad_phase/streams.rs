//! Random streams of commands, and that they came by every regime.

use std::cell::RefCell;

use proptest::collection::vec;
use proptest::prelude::any;
use proptest::test_runner::{Config, TestRunner};

use crate::commands::{Reached, run};

#[test]
fn random_streams_agree_with_looking_at_every_box() {
    let reached = RefCell::new(Reached::default());
    let config = Config { failure_persistence: None, ..Config::default() };
    TestRunner::new(config)
        .run(&vec(any::<u8>(), 0..1200), |bytes| {
            run(&bytes, &mut reached.borrow_mut());
            Ok(())
        })
        .unwrap();
    let reached = reached.into_inner();
    for (regime, count) in [
        ("removal", reached.removed),
        ("move", reached.moved),
        ("overlap found", reached.overlaps),
        ("pair found", reached.pairs),
        ("entry within a distance", reached.near),
        ("equal distances", reached.ties),
        ("entry on the way", reached.met),
        ("first entry on the way", reached.met_first),
        ("more than 200 boxes", reached.many),
        ("all boxes gone", reached.empty),
        ("extreme coordinates", reached.extreme),
        ("needle", reached.needles),
        ("identical boxes", reached.identical),
        ("version from before", reached.earlier_versions),
        ("work ended early", reached.ended_early),
        ("sorted along another axis", reached.resorted),
    ] {
        assert!(count >= 10, "{regime}: only {count} of {reached:?}");
    }
}
