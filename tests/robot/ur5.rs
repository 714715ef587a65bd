//! The UR5 of `tests/data`: joints, links, pairs, and the truth's view of which pairs count.
//! Time of a pass of forward kinematics is printed by `cargo test --release --test robot -- --ignored --nocapture`.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::sync::Arc;

use clearance::geometry::{Core, Pose};
use clearance::narrow_phase::{Goal, separation};
use clearance::robot::{
    Exclusion, LinkOptions, LinkOverride, MeshRequest, MeshUse, ModelOptions, RobotModel, mesh_files,
};

fn folder() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/robot-ur5"))
}

fn text(name: &str) -> String {
    fs::read_to_string(folder().join(name)).unwrap()
}

fn ur5(options: &ModelOptions) -> RobotModel {
    let mut resolver = |request: &MeshRequest| -> Result<Arc<[u8]>, String> {
        let path = request.filename.strip_prefix("package://ur5/").ok_or("not of this package")?;
        fs::read(folder().join(path)).map(Arc::from).map_err(|e| e.to_string())
    };
    RobotModel::from_urdf(&text("ur5.urdf"), Some(&text("ur5.srdf")), &mut resolver, options).unwrap()
}

fn hulls() -> ModelOptions {
    ModelOptions::uniform(LinkOptions { mesh: MeshUse::Hull, ..LinkOptions::default() })
}

#[test]
fn joints_links_and_pairs_are_the_ur5s() {
    let model = ur5(&hulls());
    let joints: Vec<&str> = model.joints().iter().map(|joint| joint.name.as_str()).collect();
    let expected =
        ["shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint", "wrist_1_joint", "wrist_2_joint", "wrist_3_joint"];
    assert_eq!(joints, expected);
    assert_eq!(model.degrees_of_freedom(), 6);
    assert_eq!(model.links().len(), 25);
    assert_eq!(model.links().iter().filter(|link| !link.shapes.is_empty()).count(), 18);
    assert_eq!(model.links()[model.root() as usize].name, "world");
    assert_eq!(model.self_pairs().len() + model.excluded_pairs().len(), 18 * 17 / 2);
    let all_from_srdf = model.excluded_pairs().iter().all(|pair| pair.reason == Exclusion::Srdf("Default".to_owned()));
    assert!(all_from_srdf);
    assert_eq!(model.group("arm").unwrap().joints, [0, 1, 2, 3, 4, 5]);
    assert_eq!(mesh_files(&text("ur5.urdf")).unwrap().len(), 17);
}

/// The truth looks at every pair the SRDF does not disable, so each pair it reports has to be among ours.
#[test]
fn every_pair_of_the_truth_is_looked_at() {
    let model = ur5(&hulls());
    let mut met = BTreeSet::new();
    for line in text("truth.jsonl").lines() {
        let truth: serde_json::Value = serde_json::from_str(line).unwrap();
        let index = |i: usize| model.link(truth["self_pair"][i].as_str().unwrap()).unwrap();
        let (a, b) = (index(0), index(1));
        met.insert((a.min(b), a.max(b)));
    }
    assert!(met.len() > 1);
    for pair in met {
        assert!(model.self_pairs().binary_search(&pair).is_ok(), "{pair:?}");
    }
}

/// Nearest pair of links in each of the 400 states, by brute force over our pairs and poses, against truth of 400 bits.
#[test]
fn self_distances_are_the_truths() {
    let model = ur5(&hulls());
    let (queries, truths) = (text("queries.jsonl"), text("truth.jsonl"));
    let (mut poses, mut worst) = (Vec::new(), 0.0f64);
    for (query, truth) in queries.lines().zip(truths.lines()) {
        let json = |line| serde_json::from_str::<serde_json::Value>(line).unwrap();
        let (query, truth) = (json(query), json(truth));
        assert_eq!(query["id"], truth["id"]);
        let positions: Vec<f64> = query["q"].as_array().unwrap().iter().map(|q| q.as_f64().unwrap()).collect();
        model.check_positions(&positions).unwrap();
        model.link_poses(&positions, &Pose::identity(), &mut poses);
        let placed = |link: u32| {
            let shape = &model.links()[link as usize].shapes[0];
            (&*shape.shape, poses[link as usize].compose(&shape.pose).placement())
        };
        let distance = |&(a, b): &(u32, u32)| {
            let ((a, at_a), (b, at_b)) = (placed(a), placed(b));
            separation(a, b, &at_a, &at_b, &Goal::penetration()).unwrap().signed_distance
        };
        let least = model.self_pairs().iter().map(distance).fold(f64::INFINITY, f64::min);
        worst = worst.max((least - truth["self_min"].as_f64().unwrap()).abs());
    }
    assert!(worst < 1e-14, "{worst:e}");
}

#[test]
fn meshes_become_what_each_link_asks_for() {
    let mut options = hulls();
    let exact = LinkOverride { mesh: Some(MeshUse::Exact), padding: Some(0.01), ..LinkOverride::default() };
    options.links.insert("forearm_link_0".to_owned(), exact);
    let model = ur5(&options);
    let shape = |link: &str| &model.links()[model.link(link).unwrap() as usize].shapes[0].shape;
    assert!(matches!(shape("forearm_link_0").core(), Core::Mesh(_)));
    assert_eq!(shape("forearm_link_0").swept_radius(), 0.01);
    assert!(matches!(shape("wrist_1_link_0").core(), Core::Convex(_)));
    assert_eq!(shape("wrist_1_link_0").swept_radius(), 0.0);
}

#[test]
#[ignore = "prints a time; run it by name"]
fn time_of_forward_kinematics() {
    let model = ur5(&hulls());
    let mut poses = Vec::new();
    let rounds = 200_000;
    let start = std::time::Instant::now();
    for i in 0..rounds {
        let positions = [0.1, -1.2, 0.7, f64::from(i) * 1e-5, 1.0, -2.0];
        model.link_poses(&positions, &Pose::identity(), &mut poses);
        std::hint::black_box(&poses);
    }
    println!("{:.3} us", start.elapsed().as_secs_f64() * 1e6 / f64::from(rounds));
}
