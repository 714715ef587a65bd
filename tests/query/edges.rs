//! Straight motions between the states of the UR5 of `tests/data`: what a planner asks about.
#![cfg(feature = "effect-motion")]

use serde_json::Value;

/// A motion of the arm in one of the scenes.
#[derive(Clone, Debug)]
pub struct Edge {
    pub scene: usize,
    /// `start-goal`, `noisy line`, `noisy goal` or `random`.
    pub kind: &'static str,
    pub start: Vec<f64>,
    pub goal: Vec<f64>,
}

/// Per scene: both starts to their goals, the starts over states beside those lines to the goals, the goals to states
/// near them, and random states one after the other.
pub fn edges() -> Vec<Edge> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/robot-ur5/queries.jsonl");
    let text = std::fs::read_to_string(path).unwrap();
    let states: Vec<Value> = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let scenes = states.iter().map(|state| state["scene"].as_u64().unwrap()).max().unwrap();
    let mut edges = Vec::new();
    for scene in 0..=scenes {
        let of_kind = |kind: &str| -> Vec<Vec<f64>> {
            let fits = |state: &&Value| state["scene"] == scene && state["kind"] == kind;
            let numbers = |state: &Value| state["q"].as_array().unwrap().iter().map(|q| q.as_f64().unwrap()).collect();
            states.iter().filter(fits).map(numbers).collect()
        };
        let mut add = |kind, start: &[f64], goal: &[f64]| {
            edges.push(Edge { scene: scene as usize, kind, start: start.to_vec(), goal: goal.to_vec() });
        };
        let (starts, goals) = (of_kind("start"), of_kind("goal"));
        for (start, goal) in starts.iter().zip(&goals) {
            add("start-goal", start, goal);
        }
        for (i, beside) in of_kind("line_noise").iter().enumerate() {
            add("noisy line", &starts[i % starts.len()], beside);
            add("noisy line", beside, &goals[i % goals.len()]);
        }
        for (i, beside) in of_kind("goal_noise").iter().enumerate() {
            add("noisy goal", &goals[i % goals.len()], beside);
        }
        for pair in of_kind("random").windows(2) {
            add("random", &pair[0], &pair[1]);
        }
    }
    edges
}
