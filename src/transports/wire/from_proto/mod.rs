//! What does a message mean? Every conversion from messages to plain structs. Total: whatever the bytes, the outcome is
//! a checked value or an error that names the field.

mod answer;
mod fields;
mod geometry;
mod path;
mod query;
mod robot;
mod scene;

pub use answer::{NotAnAnswer, answer};
pub use geometry::{mesh_card_request, unusable_mesh};
pub use query::{AnswerForm, answer_form, check_states, collide, distance, patience, revision_rule, target};
pub use robot::robot_description;
pub use scene::change;

use path::Path;
