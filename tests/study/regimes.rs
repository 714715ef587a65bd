//! Is everything that the report promises in it: every regime, with a time?

use crate::folder::{Row, maybe, number, table, values};

#[test]
fn every_table_has_its_times() {
    for (name, least) in [
        ("distance", 3000),
        ("outputs", 27),
        ("precision", 100),
        ("penetration", 400),
        ("geometry", 20),
        ("motion", 10),
        ("lecture", 12),
    ] {
        let rows = table(name);
        assert!(rows.len() >= least, "{name} has {} rows", rows.len());
        for row in rows {
            let (median, p99) = (number(&row, "time_median_ns"), number(&row, "time_p99_ns"));
            assert!(median > 0.0 && p99 >= median, "{name}: {row:?}");
        }
    }
    for row in table("batches") {
        assert!(number(&row, "time_median_ns") > 0.0 && number(&row, "states_per_second") > 0.0, "{row:?}");
    }
    for row in table("broad_phase") {
        assert!(number(&row, "step_median_ns") > 0.0, "{row:?}");
    }
}

#[test]
fn distance_has_every_solver_tolerance_family_gap_and_start() {
    let rows = table("distance");
    assert_eq!(values(&rows, "solver").len(), 9);
    assert_eq!(values(&rows, "relative_tolerance").len(), 12);
    assert_eq!(values(&rows, "family").len(), 9);
    assert_eq!(values(&rows, "start"), ["cold", "warm"].into());
    assert_eq!(values(&rows, "truth_by"), ["double-double", "doubles", "exact"].into());
    for gap in ["1", "0.1", "0.01", "0.001"] {
        for family in values(&rows, "family") {
            let of = |start: &str| {
                let own = rows.iter().filter(|row| row["family"] == family && row["signed_distance_m"] == gap);
                own.filter(|row| row["solver"] == "default" && row["start"] == start).count()
            };
            assert_eq!((of("cold"), of("warm")), (12, 12), "{family} {gap}");
        }
    }
}

#[test]
fn precision_goes_down_to_where_doubles_fail_and_polytopes_are_decided_all_the_same() {
    let rows = table("precision");
    let of = |precision: &'static str| rows.iter().filter(move |row| row["precision"] == precision);
    let doubles: f64 = of("doubles alone").map(|row| number(row, "undecided")).sum();
    assert!(doubles > 0.0);
    let needed = of("as needed (the library)");
    // What touches exactly and is round is left open, and said to be; everything that is apart is decided.
    let touching = |row: &&Row| row["gap_wanted_m"] == "0" && row["family"] == "ellipsoids";
    assert!(needed.clone().filter(|row| !touching(row)).all(|row| row["undecided"] == "0"));
    let polytopes = needed.filter(|row| row["family"] != "ellipsoids");
    assert!(polytopes.clone().all(|row| row["undecided"] == "0"));
    for column in ["decided_by_doubles", "decided_by_double_doubles", "decided_by_exact"] {
        assert!(polytopes.clone().map(|row| number(row, column)).sum::<f64>() > 0.0, "{column}");
    }
    assert!(of("exact for every pair").all(|row| row["undecided"] == "0"));
    let apart = rows.iter().filter(|row| row["gap_wanted_m"] != "0");
    let least = apart.map(|row| number(row, "gap_median_m")).fold(f64::INFINITY, f64::min);
    assert!(least > 0.0 && least < 1e-15, "{least}");
}

#[test]
fn penetration_has_epa_axes_and_exact_arithmetic() {
    let rows = table("penetration");
    for solver in ["default", "gjk", "sat", "exact"] {
        assert!(values(&rows, "solver").contains(solver), "{solver}");
    }
    assert!(rows.iter().all(|row| number(row, "signed_distance_m") < 0.0));
}

#[test]
fn covers_lose_nothing_and_reach_no_farther_than_is_proved() {
    let rows = table("geometry");
    assert_eq!(values(&rows, "kind"), ["balls", "convex pieces", "exact mesh", "hull", "voxels"].into());
    for row in &rows {
        assert!(number(row, "inflation_at_least_m") <= number(row, "inflation_at_most_m"), "{row:?}");
        assert!(number(row, "loss_at_least_m") <= number(row, "loss_at_most_m"), "{row:?}");
        assert!(number(row, "poses_free") > 0.0 && number(row, "poses_colliding") > 0.0 && number(row, "bytes") > 0.0);
        match row["kind"].as_str() {
            "exact mesh" => assert_eq!((row["false_hits"].as_str(), row["misses"].as_str()), ("0", "0")),
            // They hold the body, so what collides with it collides with them.
            "balls" | "voxels" | "hull" => assert_eq!(row["misses"], "0", "{row:?}"),
            _ => {}
        }
    }
    assert!(rows.iter().any(|row| row["kind"] == "hull" && number(row, "false_hits") > 0.0));
    // A finer grid reaches less far.
    for kind in ["balls", "voxels"] {
        for body in values(&rows, "body") {
            let own = rows.iter().filter(|row| row["kind"] == kind && row["body"] == body);
            let reach: Vec<f64> = own.map(|row| number(row, "inflation_at_most_m")).collect();
            assert!(reach.len() >= 3 && reach.windows(2).all(|w| w[1] < w[0]), "{kind} {body} {reach:?}");
        }
    }
}

#[test]
fn the_proof_of_a_motion_misses_nothing_and_two_states_do() {
    let rows = table("motion");
    let of = |check: &str| rows.iter().find(|row| row["check"] == check).unwrap();
    assert_eq!(of("proof, any contact")["missed"], "0");
    assert_eq!(of("proof, first contact bracketed")["missed"], "0");
    let blocked = number(&rows[0], "blocked");
    assert!(blocked > 0.0 && blocked < number(&rows[0], "motions"), "both free and blocked motions");
}

#[test]
fn broad_phases_lives_and_bounding_volumes_are_there() {
    let rows = table("broad_phase");
    let phases: Vec<_> = rows.iter().filter(|row| row["experiment"] == "broad phase").cloned().collect();
    assert_eq!(values(&phases, "way"), ["exhaustive", "sweep and prune", "tree"].into());
    assert_eq!(values(&phases, "life_or_shape"), ["churning", "moving", "still"].into());
    assert!(values(&phases, "bodies").len() >= 4);
    let volumes: Vec<_> = rows.iter().filter(|row| row["experiment"] == "bounding volume").cloned().collect();
    assert_eq!(values(&volumes, "way").len(), 8);
    // Larger margins spare more moves and report more pairs.
    let of =
        |way: &str| volumes.iter().find(|row| row["way"] == way && row["life_or_shape"].starts_with("cubes")).unwrap();
    let [none, some, much] = ["upright box", "upright box, margin 1/32", "upright box, margin 1/8"].map(of);
    assert!(number(none, "pairs_reported") < number(some, "pairs_reported"));
    assert!(number(some, "pairs_reported") < number(much, "pairs_reported"));
    assert!(number(some, "moves_that_change_nothing") < number(much, "moves_that_change_nothing"));
}

#[test]
fn doors_and_peers_that_were_given_are_shown() {
    assert!(table("batches").iter().any(|row| row["way"] == "grpc" && number(row, "states") == 100.0));
    let lecture = table("lecture");
    let here: Vec<_> = lecture.iter().filter(|row| row["source"] == "this run").cloned().collect();
    assert_eq!(values(&here, "solver"), ["default", "gjk", "gjk_nesterov", "qp"].into());
    assert_eq!(values(&here, "pairs_of").len(), 3);
    let peers: Vec<_> = lecture.iter().filter(|row| row["source"] == "peers").cloned().collect();
    assert!(
        values(&peers, "solver").contains("Coal") && peers.iter().all(|row| maybe(row, "time_median_ns").is_some())
    );
}
