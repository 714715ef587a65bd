//! `clearance demo`, as a new user runs it.

use std::collections::BTreeMap;

use super::{clearance, json_lines};

#[test]
fn the_demo_shows_three_scenes_an_edit_and_what_it_changed() {
    let done = clearance(&["demo", "--json"]);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let lines = json_lines(&done.stdout);
    let mut steps = BTreeMap::new();
    for line in &lines {
        *steps.entry(line["step"].as_str().unwrap()).or_insert(0_usize) += 1;
    }
    // Each of them with one state and with many.
    let doors = 1 + usize::from(cfg!(feature = "shared-memory")) + usize::from(cfg!(feature = "zenoh"));
    let expected = [
        ("daemon", 1),
        ("door", 2 * doors),
        ("doors", 2),
        ("edit", 1),
        ("path", 1),
        ("robot", 1),
        ("scene", 3),
        ("state", 3 * 6 + 2),
        ("verdicts", 3),
    ];
    assert_eq!(steps, BTreeMap::from(expected));

    let edit = lines.iter().position(|line| line["step"] == "edit").unwrap();
    assert_eq!(lines[edit]["revision"], 2);
    let [after, before] = [&lines[edit + 1]["answer"], &lines[edit + 2]["answer"]];
    assert_eq!((&after["verdict"], &after["revision"]), (&"COLLISION".into(), &2.into()));
    assert_eq!((&before["verdict"], &before["revision"]), (&"FREE".into(), &1.into()));
    let path = lines.iter().find(|line| line["step"] == "path").unwrap();
    assert!(path["blocked_at"].as_u64().is_some_and(|at| at > 0), "{path}");
}

#[test]
fn the_demo_for_people_names_verdicts_pairs_and_speed() {
    let done = clearance(&["demo"]);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let text = String::from_utf8(done.stdout).unwrap();
    for part in ["table top", "shelf", "cage", "FREE", "COLLISION", " mm ", "forearm_link_0", "states a second"] {
        assert!(text.contains(part), "no {part:?} in\n{text}");
    }
}
