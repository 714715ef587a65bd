//! The robot and scenes that ship with the program: a UR5 with a Robotiq gripper from MotionBenchMaker's problems.
//! `tests/data/robot-ur5/NOTICE` says where they come from and under which licences.

use std::collections::BTreeMap;

use super::robot_files::RobotFiles;
use super::scene_file::{SceneEntry, StateLine, scenes_from, states_from};

macro_rules! data {
    ($name:literal) => {
        concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/robot-ur5/", $name)
    };
}

macro_rules! meshes {
    ($($link:literal),* $(,)?) => {
        [$((
            concat!("package://ur5/meshes/", $link, "_0.obj"),
            include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/robot-ur5/meshes/", $link, "_0.obj")).as_slice(),
        )),*]
    };
}

/// What each scene of the tour is called there, and its name in the file.
#[cfg(feature = "grpc")]
pub const SCENES: [(&str, &str); 3] =
    [("table top", "table_pick/0012"), ("shelf", "bookshelf_tall/0066"), ("cage", "cage/0059")];

/// The robot's description with its meshes.
pub fn robot() -> RobotFiles {
    let meshes = meshes![
        "base_link",
        "forearm_link",
        "fts_robotside",
        "robotiq_85_base_link",
        "robotiq_85_left_finger_link",
        "robotiq_85_left_finger_tip_link",
        "robotiq_85_left_inner_knuckle_link",
        "robotiq_85_left_knuckle_link",
        "robotiq_85_right_finger_link",
        "robotiq_85_right_finger_tip_link",
        "robotiq_85_right_inner_knuckle_link",
        "robotiq_85_right_knuckle_link",
        "shoulder_link",
        "upper_arm_link",
        "wrist_1_link",
        "wrist_2_link",
        "wrist_3_link",
    ];
    RobotFiles {
        urdf: include_str!(data!("ur5.urdf")).to_owned(),
        srdf: Some(include_str!(data!("ur5.srdf")).to_owned()),
        meshes: meshes.into_iter().map(|(name, bytes)| (name.to_owned(), bytes.to_vec())).collect::<BTreeMap<_, _>>(),
    }
}

/// All scenes, and all states with the index of their scene.
///
/// # Errors
/// The data that was built in is broken.
pub fn workload(degrees_of_freedom: usize) -> Result<(Vec<SceneEntry>, Vec<StateLine>), String> {
    let scenes = scenes_from(include_str!(data!("scenes.json")), "scenes.json")?;
    let states = states_from(include_str!(data!("queries.jsonl")), scenes.len(), degrees_of_freedom);
    Ok((scenes, states))
}
