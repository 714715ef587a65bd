//! `clearance bench transports` in short: every door and every floor is measured, and the doors answer as the library does,
//! which the command itself checks. What the figures are is not asserted.

use crate::clearance;
use crate::json_lines;

#[test]
fn every_door_stands_beside_the_work_and_its_floor() {
    let done = clearance(&["bench", "transports", "--items", "1,20", "--seconds", "0.02", "--json"]);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let lines = json_lines(&done.stdout);
    let of = |what: &str| lines.iter().filter(|line| line["what"] == what).collect::<Vec<_>>();
    let doors = 2 + usize::from(cfg!(feature = "shared-memory")) + usize::from(cfg!(feature = "zenoh"));
    assert_eq!(of("door").len(), 2 * doors);
    for row in of("door") {
        for time in ["through", "within", "bare"] {
            assert!(row[time]["p50"].as_f64().is_some_and(|seconds| seconds > 0.0), "{row}");
            assert!(row[time]["p99"].as_f64() >= row[time]["p50"].as_f64(), "{row}");
        }
        assert!(row["sent"].as_u64() > Some(40 * row["items"].as_u64().unwrap()), "{row}");
        assert!(row["overhead"].is_f64() && row["target"].is_f64() && row["met"].is_boolean(), "{row}");
    }
    assert_eq!(of("sockets").len(), 2);
    assert_eq!(of("throughput").len(), 1 + doors);
    assert!(of("throughput").iter().all(|row| row["per_second"].as_f64().is_some_and(|rate| rate > 0.0)));
}
