//! Do the accuracy tables keep what a bracket promises?

use std::collections::BTreeMap;

use crate::folder::{Row, maybe, number, table};

const TABLES: [&str; 2] = ["distance", "penetration"];

/// The table has six digits.
const DIGITS: f64 = 1.0 + 1e-5;

#[test]
fn no_error_is_beyond_its_width_and_no_bracket_misses_the_truth() {
    for name in TABLES {
        let rows = table(name);
        for row in &rows {
            assert_eq!(
                (row["errors_beyond_width"].as_str(), row["brackets_beside_truth"].as_str()),
                ("0", "0"),
                "{row:?}"
            );
            if let Some(error) = maybe(row, "error_max_m") {
                // The largest of each, so a bound that holds pair by pair; a step of doubles is what the truth is rounded to.
                let step = 2.0 * f64::EPSILON * number(row, "signed_distance_m").abs();
                assert!(error <= number(row, "width_max_m") * DIGITS + step, "{row:?}");
            }
        }
        let compared: f64 = rows.iter().map(|row| number(row, "compared_with_truth")).sum();
        let pairs: f64 = rows.iter().map(|row| number(row, "pairs")).sum();
        assert!(compared > 0.5 * pairs, "{name}: {compared} of {pairs} were held against a truth");
    }
}

#[test]
fn widths_are_what_was_asked_or_what_rounding_leaves() {
    let mut met = 0;
    for row in TABLES.iter().flat_map(|name| table(name)) {
        // What a cap stopped says so, and is wider.
        if number(&row, "stopped_by_cap") == 0.0 {
            // A depth ends at rounding, too, when the face that holds it back is on the boundary: some floors wide, and it says so.
            let deep = number(&row, "signed_distance_m") < 0.0 && number(&row, "stopped_by_rounding") > 0.0;
            let floor = number(&row, "width_floor_m") * if deep { 16.0 } else { 1.0 };
            let allowed = number(&row, "width_asked_m").max(floor);
            assert!(number(&row, "width_max_m") <= allowed * DIGITS, "{row:?}");
            met += 1;
        } else {
            assert!(number(&row, "stopped_by_cap") <= number(&row, "pairs"));
        }
    }
    assert!(met > 1000, "{met}");
}

/// Rows that differ in their tolerance alone, from loose to tight.
fn by_setting(rows: Vec<Row>) -> Vec<Vec<Row>> {
    let mut groups: BTreeMap<[String; 4], Vec<Row>> = BTreeMap::new();
    for row in rows {
        let key = ["family", "signed_distance_m", "solver", "start"].map(|column| row[column].clone());
        groups.entry(key).or_default().push(row);
    }
    let mut groups: Vec<Vec<Row>> = groups.into_values().collect();
    for group in &mut groups {
        group.sort_by(|a, b| number(b, "relative_tolerance").total_cmp(&number(a, "relative_tolerance")));
    }
    groups
}

#[test]
fn tighter_tolerances_bring_no_wider_medians() {
    let mut steps = 0;
    for group in TABLES.iter().flat_map(|name| by_setting(table(name))) {
        for pair in group.windows(2) {
            let [loose, tight] = pair else { unreachable!() };
            // At the floor of rounding widths differ by what the last rounds happen to be; from a cache, by what the search before
            // happened to leave there, which depends on the tolerance, too.
            let slack = if tight["start"] == "warm" { 1.5 } else { DIGITS };
            let floor = number(loose, "width_floor_m");
            assert!(
                number(tight, "width_median_m") <= number(loose, "width_median_m").max(floor) * slack,
                "{loose:?} {tight:?}"
            );
            let noise = number(loose, "noise_m");
            // What met a cap is estimated from another end of the bracket than what converged.
            let capped = [loose, tight].iter().any(|row| row["stopped_by_cap"] != "0");
            if let (Some(loose_error), Some(tight_error)) =
                (maybe(loose, "error_median_m"), maybe(tight, "error_median_m"))
                && loose["compared_with_truth"] == tight["compared_with_truth"]
                && !capped
            {
                // Frank-Wolfe goes back and forth, and its estimate may be good by luck; it is as good as was asked.
                let asked = if tight["solver"] == "frank_wolfe" { number(tight, "width_asked_m") } else { 0.0 };
                assert!(tight_error <= loose_error.max(noise).max(asked) * slack, "{loose:?} {tight:?}");
            }
            steps += 1;
        }
    }
    assert!(steps > 1000, "{steps}");
}
