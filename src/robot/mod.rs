//! Robots: from URDF and SRDF text to links that stand somewhere.
//!
//! A [`RobotModel`] is made once, checked as a whole, and never fails afterwards: joint positions in, poses of links out.
//! It knows no scene, opens no file, and does not interpret `package://`: meshes come from a resolver of the caller.
//! Metres and radians; sines and cosines are `libm`'s, so that poses are the same bytes on every machine.
//!
//! URDF is read here from its XML, not through `urdf-rs`, for four reasons: that crate turns `quat_xyzw` into angles
//! with the system's arc functions (other bytes on other machines), skips words that are not numbers, cannot tell a
//! missing `<limit>` from zeros, and recurses as deep as the text nests. The tests hold the two side by side.

mod attributes;
mod collision_pairs;
mod groups;
mod joint;
mod joint_gradient;
mod joint_line;
mod kinematics;
mod link;
mod model;
mod options;
mod robot_error;
mod srdf;
mod urdf;

pub use collision_pairs::{ExcludedPair, Exclusion};
pub use groups::{Group, GroupState};
pub use joint::{BadPositions, Joint, JointKind, Limits, OutsideLimits};
pub use joint_gradient::LinkGradient;
pub use joint_line::{Axis, JointLine, MovedBall, MovingJoints, NotALine};
pub use link::{Link, LinkShape, MeshRequest, MeshResolver};
pub use model::{MOST_LINKS, RobotModel, mesh_files};
pub use options::{LinkOptions, LinkOverride, MeshUse, ModelOptions};
pub use robot_error::RobotError;
