//! What does each rpc do, whatever door it came through? One function for each: decode, ask the service, encode.
//!
//! `timeout` is how long the caller listens, as far as the door knows. Decoding and encoding of questions happen on the
//! threads that answer them, so that no connection waits for another's message.

mod assets;
mod call;
mod effort;
mod motions;
mod poses;
mod queries;
mod query_stream;
mod robots;
mod rpc;
mod scenes;
mod server;
mod steps;
mod watch;

pub use assets::{describe_mesh, has_assets, put_asset_response};
pub use call::call;
pub use motions::{check_motions, check_path, clearance};
pub use poses::{PoseMessages, pose_stream};
pub use queries::{
    cast_rays, cast_shapes, check_moving_pairs, check_states, collide, distance, estimate, nearest_bodies, overlap,
    watch_contacts,
};
pub use query_stream::{QueryMessages, query_stream};
pub use robots::{get_robot, list_robots, load_robot};
pub use rpc::rpc_named;
pub use scenes::{apply, create_scene, delete_scene, get_scene, get_scene_health, list_scenes};
pub use server::get_server_info;
pub use steps::{StepMessage, Steps, steps};
pub use watch::{SceneMessages, watch};
