//! The UR5 of `tests/data` with its scenes and states, as the library is given them.

use std::fs;
use std::path::Path;
use std::sync::Arc;

use clearance::geometry::{Pose, Quaternion, Shape, Vec3};
use clearance::robot::{LinkOptions, MeshRequest, MeshUse, ModelOptions, RobotModel};
use clearance::scene::{Edit, Epoch, NewBody, Scene, Snapshot};
use serde_json::Value;

fn read(name: &str) -> String {
    fs::read_to_string(folder().join(name)).unwrap()
}

fn folder() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/robot-ur5"))
}

pub fn ur5() -> Arc<RobotModel> {
    let mut resolver = |request: &MeshRequest| -> Result<Arc<[u8]>, String> {
        let path = request.filename.strip_prefix("package://ur5/").ok_or("not of this package")?;
        fs::read(folder().join(path)).map(Arc::from).map_err(|e| e.to_string())
    };
    let options = ModelOptions::uniform(LinkOptions { mesh: MeshUse::Hull, ..LinkOptions::default() });
    let srdf = read("ur5.srdf");
    Arc::new(RobotModel::from_urdf(&read("ur5.urdf"), Some(&srdf), &mut resolver, &options).unwrap())
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
}

fn shape(value: &Value) -> Shape {
    let params = &value["params"];
    let number = |name: &str| params[name].as_f64().unwrap();
    match value["type"].as_str().unwrap() {
        "box" => Shape::cuboid(Vec3::from_vec(numbers(&params["half_extents"]))).unwrap(),
        "cylinder" => Shape::cylinder(number("radius"), number("half_length")).unwrap(),
        "sphere" => Shape::sphere(number("radius")).unwrap(),
        other => panic!("the workload has no {other}"),
    }
}

fn pose(value: &Value) -> Pose {
    let [w, x, y, z] = numbers(&value["q"]).try_into().unwrap();
    Pose::new(Vec3::from_vec(numbers(&value["t"])), Quaternion { w, x, y, z }).unwrap()
}

/// The scenes of the workload, each with the robot in it.
pub fn scenes(robot: &Arc<RobotModel>) -> Vec<Arc<Snapshot>> {
    let scenes: Value = serde_json::from_str(&read("scenes.json")).unwrap();
    let scene = |entry: &Value| {
        let body = |o: &Value| {
            let name = o["name"].as_str().unwrap();
            Edit::AddBody(NewBody::new(name, Arc::new(shape(&o["shape"])), pose(&o["pose"])))
        };
        let mut edits: Vec<Edit> = entry["objects"].as_array().unwrap().iter().map(body).collect();
        edits.push(Edit::AddRobot { name: "ur5".to_owned(), model: Arc::clone(robot), base: Pose::identity() });
        let mut scene = Scene::new(Epoch(1));
        scene.apply(&edits, None).unwrap();
        scene.snapshot()
    };
    scenes.as_array().unwrap().iter().map(scene).collect()
}

/// Scene and joint positions of every state, and its truth.
pub fn states() -> Vec<(usize, Vec<f64>, Value)> {
    let lines = |name| read(name).lines().map(|l| serde_json::from_str(l).unwrap()).collect::<Vec<Value>>();
    let pair = |(q, t): (Value, Value)| {
        assert_eq!(q["id"], t["id"]);
        (q["scene"].as_u64().unwrap() as usize, numbers(&q["q"]), t)
    };
    lines("queries.jsonl").into_iter().zip(lines("truth.jsonl")).map(pair).collect()
}
