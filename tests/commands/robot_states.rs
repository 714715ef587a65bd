//! `clearance states` on the UR5 and its 400 states (`tests/data/README.md`).
//!
//! The oracle is `truth.jsonl`: deciding pairs were solved in 400-bit arithmetic.

use std::fs;

use serde_json::Value;

use crate::{clearance, data, json_lines, number};

/// Metres within which a minimum has to be the truth's.
const CLOSE: f64 = 1e-9;

/// What asks for the 400 states in the scenes of a file.
pub fn arguments(scenes: &str) -> Vec<String> {
    let file = |name: &str| data("robot-ur5").join(name).to_str().unwrap().to_owned();
    let (urdf, srdf, queries) = (file("ur5.urdf"), file("ur5.srdf"), file("queries.jsonl"));
    ["states", "--robot", &urdf, "--srdf", &srdf, "--mesh", "hull", "--scenes", scenes, "--states", &queries]
        .map(str::to_owned)
        .to_vec()
}

/// What the command prints for the 400 states, with more flags.
pub fn states(more: &[&str]) -> Vec<u8> {
    let mut arguments = arguments(data("robot-ur5").join("scenes.json").to_str().unwrap());
    arguments.extend(more.iter().map(|flag| (*flag).to_owned()));
    let output = clearance(&arguments);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    output.stdout
}

fn truth() -> Vec<Value> {
    json_lines(&fs::read(data("robot-ur5").join("truth.jsonl")).unwrap())
}

/// The names of a pair in alphabetical order: the truth does not say which side is A.
fn sorted(pair: &Value) -> Vec<&str> {
    let mut names: Vec<&str> = pair.as_array().unwrap().iter().map(|name| name.as_str().unwrap()).collect();
    names.sort_unstable();
    names
}

#[test]
fn verdicts_minima_and_brackets_are_those_of_the_truth() {
    let (answers, truth) = (json_lines(&states(&["--want", "distance"])), truth());
    assert_eq!(answers.len(), truth.len());
    let mut collisions = 0;
    for (answer, truth) in answers.iter().zip(&truth) {
        assert_eq!(answer["id"], truth["id"]);
        let expected = if truth["in_collision"] == true { "COLLISION" } else { "FREE" };
        assert_eq!(answer["verdict"], expected, "{answer}\n{truth}");
        collisions += usize::from(expected == "COLLISION");

        let minimum = number(&truth["min_distance"]);
        let (lower, upper) = (number(&answer["lower"]), number(&answer["upper"]));
        assert!(lower <= minimum && minimum <= upper, "{answer}\n{truth}");
        let minima = [("signed_distance", "min_distance"), ("self_distance", "self_min"), ("env_distance", "env_min")];
        for (ours, theirs) in minima {
            let off = (number(&answer[ours]) - number(&truth[theirs])).abs();
            assert!(off <= CLOSE, "{ours} is off by {off}: {answer}\n{truth}");
        }
        // A pair is only told apart from its runner-up where the minima of both kinds differ.
        let minima = [number(&truth["self_min"]), number(&truth["env_min"])];
        if (minima[0] - minima[1]).abs() > 1e-6 {
            let kind = if minima[0] < minima[1] { "self_pair" } else { "env_pair" };
            assert_eq!(answer["pair"], answer[kind], "{answer}");
        }
    }
    assert!(collisions > 50 && collisions < truth.len() - 50, "{collisions} collisions");
}

#[test]
fn most_deciding_pairs_are_those_of_the_truth() {
    let (answers, truth) = (json_lines(&states(&["--want", "distance"])), truth());
    let same = |(answer, truth): &(&Value, &Value)| sorted(&answer["pair"]) == sorted(&truth["pair"]);
    let agreeing = answers.iter().zip(&truth).filter(same).count();
    // The truth names one pair even where a second is as near; those few may differ.
    assert!(agreeing * 100 >= 95 * truth.len(), "{agreeing} of {}", truth.len());
}

#[test]
fn verdicts_alone_are_the_same_verdicts() {
    let verdicts = |want: &str| -> Vec<Value> {
        json_lines(&states(&["--want", want])).into_iter().map(|mut line| line["verdict"].take()).collect()
    };
    assert_eq!(verdicts("verdict"), verdicts("distance"));
}

#[test]
fn bad_input_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (urdf, scenes, queries) = (at("arm.urdf"), at("scenes.json"), at("states.jsonl"));
    let arm = r#"<robot name="arm"><link name="base"/><link name="tip"><collision><geometry>
        <sphere radius="0.1"/></geometry></collision></link><joint name="turn" type="continuous"><parent link="base"/>
        <child link="tip"/><origin xyz="1 0 0"/><axis xyz="0 0 1"/></joint></robot>"#;
    let ball = r#"[{"name": "s", "objects": [{"name": "ball", "shape": {"type": "sphere", "params": {"radius": 0.5}},
        "pose": {"t": [3, 0, 0], "q": [1, 0, 0, 0]}}]}]"#;
    let run = || clearance(&["states", "--robot", &urdf, "--scenes", &scenes, "--states", &queries]);
    fs::write(&urdf, arm).unwrap();
    fs::write(&scenes, ball).unwrap();
    fs::write(&queries, "{\"id\": 1, \"scene\": 0, \"q\": [0]}\nnonsense\n{\"id\": 3, \"scene\": 0, \"q\": [0, 0]}\n")
        .unwrap();

    let answers = json_lines(&run().stdout);
    assert_eq!(answers.len(), 3);
    assert_eq!((&answers[0]["verdict"], &answers[0]["env_pair"][1]), (&"FREE".into(), &"ball".into()));
    assert!((number(&answers[0]["env_distance"]) - 1.4).abs() < 1e-12);
    assert_eq!(answers[1]["verdict"], "INVALID_INPUT");
    assert_eq!(answers[2]["message"], "q: has 2 numbers, the robot has 1");

    let complains = |what: &str| {
        let output = run();
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(3) && message.contains(what), "{:?} {message}", output.status);
    };
    fs::write(&scenes, ball.replace("0.5", "-0.5")).unwrap();
    complains("scenes[0].objects[0].shape.params: radius is negative");
    fs::write(&scenes, ball).unwrap();
    fs::write(&urdf, arm.replace("tip\"/>", "nobody\"/>")).unwrap();
    complains("nobody");
    fs::write(&urdf, arm.replace("<sphere radius=\"0.1\"/>", "<mesh filename=\"package://arm/missing.stl\"/>"))
        .unwrap();
    complains("package://arm/missing.stl");
}
