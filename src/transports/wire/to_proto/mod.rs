//! What does something look like on the wire? Every conversion from plain structs to messages; none can fail.

mod answer;
mod count;
mod geometry;
mod mesh_card;
mod question;
mod robot;
mod scene;

pub use answer::answer;
pub use geometry::{pose, shape};
pub use mesh_card::mesh_card;
pub use question::{check_states_request, collide_request, distance_request};
pub use robot::{load_robot_request, robot_model, robot_summary};
pub use scene::{add_body, apply_response, body_ref, door, limit, scene_contents, scene_summary};

use count::count;
