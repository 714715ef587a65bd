//! What does something look like on the wire? Every conversion from plain structs to messages; none can fail.

mod answer;
mod cast;
mod cast_question;
mod contact;
mod declared;
mod derivatives;
mod error;
mod estimate;
mod geometry;
mod health;
mod mesh_card;
mod motion;
mod numbers;
mod question;
mod robot;
mod scene;
mod stream;

pub use answer::{added_bodies, answer};
pub use cast::{
    cast_rays_response, cast_shapes_response, check_moving_pairs_response, nearest_bodies_response, overlap_response,
};
pub use cast_question::{
    cast_rays_request, cast_shapes_request, check_moving_pairs_request, nearest_bodies_request, overlap_request,
};
pub use contact::contact_messages;
pub use declared::declare_effects;
pub use derivatives::pair_derivatives;
pub use error::{ErrorCard, query_error, reason_name};
pub use estimate::{estimate_request, estimate_response};
pub use geometry::{pose, shape};
pub use health::scene_health;
pub use mesh_card::mesh_card;
pub use motion::{check_motions_request, check_path_request, clearance_request, motions};
pub use question::{check_states_request, collide_request, distance_request};
pub use robot::{load_robot_request, robot_model, robot_summary};
pub use scene::{add_body, apply_response, body_ref, door, limit, scene_contents, scene_summary};
pub use stream::{Told, pose_stream_response, watch_response};

use numbers::{count, little_endian};
