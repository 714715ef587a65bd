//! `clearance states --server`: a daemon gives the bytes that the library gives.

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};

use serde_json::{Value, json};

use crate::robot_states::{arguments, states};
use crate::{clearance, data, json_lines};

/// A daemon on a free port; it ends with the test.
struct Daemon {
    process: Child,
    address: String,
}

impl Daemon {
    fn start() -> Self {
        let mut daemon = Self::start_at("127.0.0.1:0", &[]);
        daemon.address = format!("http://{}", daemon.address);
        daemon
    }

    fn start_at(address: &str, more: &[&str]) -> Self {
        let mut process = Command::new(env!("CARGO_BIN_EXE_clearance"))
            .args(["serve", "--grpc-address", address, "--no-shared-memory", "--no-zenoh"])
            .args(more)
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut line = String::new();
        BufReader::new(process.stdout.take().unwrap()).read_line(&mut line).unwrap();
        let address = line.trim().strip_prefix("listening grpc ").unwrap_or_else(|| panic!("{line:?}"));
        Self { process, address: address.to_owned() }
    }
}

impl Drop for Daemon {
    fn drop(&mut self) {
        // It may be gone already, which is fine here.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

#[test]
fn a_daemon_gives_the_same_bytes() {
    let daemon = Daemon::start();
    for want in ["verdict", "distance"] {
        let here = states(&["--want", want]);
        let there = states(&["--want", want, "--server", &daemon.address]);
        assert!(here == there, "--want {want}");
    }
}

/// Oracle: the same scenes without declarations. What is declared empty is left out, and said so; what is wanted beyond what is
/// declared is refused with its name; through the library and a daemon alike.
#[test]
fn a_scene_file_declares_effects() {
    let daemon = Daemon::start();
    let folder = tempfile::tempdir().unwrap();
    let scenes = folder.path().join("scenes.json");
    let mut document: Value = serde_json::from_slice(&std::fs::read(data("robot-ur5/scenes.json")).unwrap()).unwrap();
    let ask = |document: &Value, more: &[&str]| {
        std::fs::write(&scenes, document.to_string()).unwrap();
        let mut arguments = arguments(scenes.to_str().unwrap());
        arguments.extend(more.iter().map(|flag| (*flag).to_owned()));
        let output = clearance(&arguments);
        let lines = output.status.success().then(|| json_lines(&output.stdout));
        lines.ok_or_else(|| String::from_utf8_lossy(&output.stderr).into_owned())
    };
    let both = |document: &Value, more: &[&str]| {
        let here = ask(document, more);
        let there = ask(document, &[more, &["--server", &daemon.address]].concat());
        if let (Ok(here), Ok(there)) = (&here, &there) {
            assert_eq!(here, there);
        }
        (here, there)
    };
    let plain = ask(&document, &["--want", "verdict"]).unwrap();
    for scene in document.as_array_mut().unwrap() {
        for object in scene["objects"].as_array_mut().unwrap() {
            object["groups"] = json!(["all"]);
        }
        scene["effects"] = json!([
            {"between": ["robot", {"group": "all"}], "effects": []},
            {"between": ["robot", "robot"], "effects": ["verdict"]},
        ]);
    }
    let verdict = both(&document, &["--want", "verdict"]).0.unwrap();
    let mut differ = 0;
    for (line, plain) in verdict.iter().zip(&plain) {
        assert_eq!(line["declared_empty"], json!([["robot", "all"]]));
        // Collisions with itself stay, those with objects are not looked at.
        let of_itself = line["verdict"] == "COLLISION";
        assert!(!of_itself || plain["verdict"] == "COLLISION");
        differ += usize::from(line["verdict"] != plain["verdict"]);
    }
    assert!(differ > 50 && plain.iter().all(|line| line.get("declared_empty").is_none()), "{differ}");
    let (here, there) = both(&document, &["--want", "distance"]);
    for refused in [here.unwrap_err(), there.unwrap_err()] {
        let pair = "the pair of robot robot and robot robot is declared without the effect `distance`, which is wanted";
        assert!(refused.contains(pair), "{refused}");
    }
    document[1]["effects"][0]["effects"] = json!(["colour"]);
    assert!(ask(&document, &[]).unwrap_err().contains("scenes[1].effects[0].effects[0]: is \"colour\""));
}

#[test]
fn a_daemon_that_wants_a_token_is_shown_one_from_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (token, wrong, config) = (path("token"), path("wrong"), path("clearance.toml"));
    std::fs::write(&token, "a-token-of-the-planner\n").unwrap();
    std::fs::write(&wrong, "another-token-altogether\n").unwrap();
    let scopes = "scopes = [\"read\", \"write\"]";
    std::fs::write(&config, format!("[[grpc.tokens]]\nname = \"planner\"\nfile = {token:?}\n{scopes}\n")).unwrap();
    let daemon = Daemon::start_at(&format!("unix:{}", path("socket")), &["--config", &config]);
    let here = states(&["--want", "verdict"]);
    assert!(here == states(&["--want", "verdict", "--server", &daemon.address, "--server-token", &token]));
    let robot = path("arm.urdf");
    std::fs::write(&robot, r#"<robot name="arm"><link name="base"/></robot>"#).unwrap();
    let (scenes, queries) = (path("scenes.json"), path("states.jsonl"));
    std::fs::write(&scenes, "[]").unwrap();
    std::fs::write(&queries, "").unwrap();
    let asked = |more: &[&str]| {
        let files = ["states", "--robot", &robot, "--scenes", &scenes, "--states", &queries];
        let output = clearance(&[&files[..], more].concat());
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    let (code, text) = asked(&["--server", &daemon.address]);
    assert!(code == Some(4) && text.contains("a token is needed"), "{code:?} {text}");
    let (code, text) = asked(&["--server", &daemon.address, "--server-token", &wrong]);
    assert!(code == Some(4) && text.contains("the token is not known"), "{code:?} {text}");
    let (code, text) = asked(&["--server", &daemon.address, "--server-token", &path("missing")]);
    assert!(code == Some(3) && text.contains("missing: No such file"), "{code:?} {text}");
    assert_eq!(asked(&["--server-token", &token]).0, Some(2));
}

#[test]
fn nobody_at_the_address_has_its_exit_code() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let robot = file("arm.urdf", r#"<robot name="arm"><link name="base"/></robot>"#);
    let (scenes, queries) = (file("scenes.json", "[]"), file("states.jsonl", ""));
    let files = ["states", "--robot", &robot, "--scenes", &scenes, "--states", &queries];
    let output = clearance(&[&files[..], &["--server", "http://127.0.0.1:1"]].concat());
    assert_eq!(output.status.code(), Some(4), "{}", String::from_utf8_lossy(&output.stderr));
}
