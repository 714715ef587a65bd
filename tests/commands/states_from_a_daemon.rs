//! `clearance states --server`: a daemon gives the bytes that the library gives.

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};

use crate::clearance;
use crate::robot_states::states;

/// A daemon on a free port; it ends with the test.
struct Daemon {
    process: Child,
    address: String,
}

impl Daemon {
    fn start() -> Self {
        let mut process = Command::new(env!("CARGO_BIN_EXE_clearance"))
            .args(["serve", "--grpc-address", "127.0.0.1:0", "--no-shared-memory"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut line = String::new();
        BufReader::new(process.stdout.take().unwrap()).read_line(&mut line).unwrap();
        let address = line.trim().strip_prefix("listening grpc ").unwrap_or_else(|| panic!("{line:?}"));
        Self { process, address: format!("http://{address}") }
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
