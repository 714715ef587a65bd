//! Scenes and joint vectors on disk, as `clearance states` reads them. `docs/cases.md` describes both formats.

use std::path::Path;
use std::sync::Arc;

use serde_json::Value;

use super::case::{read_pose, read_shape};
use super::json_field::{Field, FieldError};
use super::robot_files::read_text;
use super::scene_effects::{DeclaredPair, read_effects, read_groups};
use crate::geometry::{Pose, Shape};

/// One scene of a scene file.
#[derive(Clone, Debug)]
pub struct SceneEntry {
    /// For people; need not be unique.
    pub name: String,
    /// What stands in it.
    pub objects: Vec<SceneObject>,
    /// What may be asked of which pairs; of others everything.
    pub effects: Vec<DeclaredPair>,
}

/// A body of a scene.
#[derive(Clone, Debug)]
pub struct SceneObject {
    /// Unique in its scene.
    pub name: String,
    /// In the body's frame.
    pub shape: Arc<Shape>,
    /// The body's frame in the world.
    pub pose: Pose,
    /// Groups that it is in.
    pub groups: Vec<String>,
}

/// One line of a file of joint vectors.
#[derive(Clone, Debug, PartialEq)]
pub struct StateLine {
    /// Echoed with the answer.
    pub id: Value,
    /// The scene and the joint positions, or what is wrong with the line.
    pub state: Result<State, String>,
}

/// A robot's state in a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Index in the scene file.
    pub scene: usize,
    /// Joint positions, radians or metres, in the order of the robot's joints.
    pub positions: Vec<f64>,
}

/// Reads a scene file: a list of `{name, objects: [{name, shape, pose, groups}], effects}`; `groups` and `effects` may be left out.
///
/// # Errors
/// Names file and field.
pub fn read_scenes(path: &Path) -> Result<Vec<SceneEntry>, String> {
    scenes_from(&read_text(path)?, &path.display().to_string())
}

/// Reads the text of a scene file that is called `name`.
///
/// # Errors
/// Names file and field.
pub fn scenes_from(text: &str, name: &str) -> Result<Vec<SceneEntry>, String> {
    let document: Value = serde_json::from_str(text).map_err(|error| format!("{name}: {error}"))?;
    scenes_of(&document).map_err(|error| format!("{name}: {error}"))
}

fn scenes_of(document: &Value) -> Result<Vec<SceneEntry>, FieldError> {
    Field { value: document, path: "scenes".to_owned() }.elements()?.iter().map(scene_of).collect()
}

fn scene_of(scene: &Field) -> Result<SceneEntry, FieldError> {
    let mut objects = Vec::new();
    for object in scene.member("objects")?.elements()? {
        objects.push(SceneObject {
            name: object.member("name")?.text()?.to_owned(),
            shape: Arc::new(read_shape(&object.member("shape")?)?),
            pose: read_pose(&object.member("pose")?)?,
            groups: read_groups(object.optional("groups").as_ref())?,
        });
    }
    let effects = read_effects(scene.optional("effects").as_ref())?;
    Ok(SceneEntry { name: scene.member("name")?.text()?.to_owned(), objects, effects })
}

/// Reads joint vectors: JSON lines `{id, scene, q}`. A bad line is kept with what is wrong with it.
///
/// # Errors
/// The file cannot be read.
pub fn read_states(path: &Path, scenes: usize, degrees_of_freedom: usize) -> Result<Vec<StateLine>, String> {
    Ok(states_from(&read_text(path)?, scenes, degrees_of_freedom))
}

/// Reads the text of a file of joint vectors.
#[must_use]
pub fn states_from(text: &str, scenes: usize, degrees_of_freedom: usize) -> Vec<StateLine> {
    let lines = text.lines().filter(|line| !line.trim().is_empty());
    lines.map(|line| state_line(line, scenes, degrees_of_freedom)).collect()
}

fn state_line(line: &str, scenes: usize, degrees_of_freedom: usize) -> StateLine {
    match serde_json::from_str::<Value>(line) {
        Ok(document) => StateLine {
            id: document.get("id").cloned().unwrap_or(Value::Null),
            state: state_of(&Field::root(&document), scenes, degrees_of_freedom).map_err(|error| error.to_string()),
        },
        Err(error) => StateLine { id: Value::Null, state: Err(format!("line: is not JSON: {error}")) },
    }
}

fn state_of(line: &Field, scenes: usize, degrees_of_freedom: usize) -> Result<State, FieldError> {
    let scene = line.member("scene")?;
    let index: usize = scene.index()?;
    if index >= scenes {
        return Err(scene.error(format!("is {index}, but there are {scenes} scenes")));
    }
    let q = line.member("q")?;
    let positions = q.numbers()?;
    if positions.len() != degrees_of_freedom {
        return Err(q.error(format!("has {} numbers, the robot has {degrees_of_freedom}", positions.len())));
    }
    Ok(State { scene: index, positions })
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn scenes_are_read_and_complaints_name_object_and_field() {
        let pose = json!({"t": [0, 0, 1], "q": [1, 0, 0, 0]});
        let ball = json!({"name": "ball", "shape": {"type": "sphere", "params": {"radius": 1}}, "pose": pose});
        let mut document = json!([{"name": "empty", "objects": []}, {"name": "one", "objects": [ball]}]);
        let scenes = scenes_of(&document).unwrap();
        assert_eq!((scenes.len(), scenes[1].objects[0].name.as_str()), (2, "ball"));
        document[1]["objects"][0]["shape"]["params"] = json!({"radius": "big"});
        let complaint = scenes_of(&document).unwrap_err().to_string();
        assert_eq!(complaint, "scenes[1].objects[0].shape.params.radius: is a text, not a number");
    }

    #[test]
    fn a_bad_state_line_says_what_is_wrong_and_keeps_its_id() {
        for (line, complaint) in [
            (r#"{"id": 1, "scene": 2, "q": [0, 0]}"#, "scene: is 2, but there are 2 scenes"),
            (r#"{"id": 1, "scene": 0, "q": [0]}"#, "q: has 1 numbers, the robot has 2"),
            (r#"{"id": 1, "scene": 0, "q": [0, "x"]}"#, "q[1]: is a text, not a number"),
            (r#"{"id": 1, "q": [0, 0]}"#, "scene: is missing"),
        ] {
            let read = state_line(line, 2, 2);
            assert_eq!((read.id, read.state.unwrap_err().as_str()), (json!(1), complaint));
        }
        let read = state_line(r#"{"id": "a", "scene": 1, "kind": "start", "q": [0.5, 2]}"#, 2, 2);
        assert_eq!(read.state, Ok(State { scene: 1, positions: vec![0.5, 2.0] }));
        assert!(state_line("{", 2, 2).state.is_err());
    }
}
