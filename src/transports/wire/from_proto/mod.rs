//! What does a message mean? Every conversion from messages to plain structs. Total: whatever the bytes, the outcome is
//! a checked value or an error that names the field.

mod answer;
mod cast;
mod cast_answer;
mod contact;
mod derivatives;
mod estimate;
mod fields;
mod geometry;
mod motion;
mod overlay;
mod path;
mod query;
mod robot;
mod scene;
mod stream;

pub use answer::{NotAnAnswer, answer};
pub use cast::{cast_rays, cast_shapes, check_moving_pairs, nearest_bodies, overlap};
pub use cast_answer::{
    cast_rays_answers, cast_shapes_answers, check_moving_pairs_answers, nearest_bodies_answers, overlap_answers,
};
pub use contact::contact_question;
pub use estimate::{context_of, estimate, estimated};
pub use geometry::{mesh_card_request, unusable_mesh};
pub use motion::{check_motions, check_path, clearance, motions};
pub use overlay::{has_overlays, no_overlays, overlays};
pub use query::{AnswerForm, answer_form, check_states, collide, distance, patience, revision_rule, target};
pub use robot::robot_description;
pub use scene::{BodyPage, body_page, change, scene_options};
pub use stream::{pose_interval, poses};

use path::Path;
