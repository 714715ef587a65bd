//! What lasts: poses that are streamed.

use std::time::Duration;

use super::Path;
use super::scene::{body_ref, required_pose};
use crate::service::{NewPose, PoseOf, ServiceError};
use crate::transports::wire::v1;

/// Longest time between two revisions of one stream of poses.
const LONGEST_INTERVAL: f64 = 10.0;

/// The poses of a message, and those of them that cannot be: field and what is wrong with it.
#[must_use]
pub fn poses(message: &v1::PoseStreamRequest) -> (Vec<NewPose>, Vec<(String, String)>) {
    let body = |(index, message): (usize, &v1::BodyPose)| -> Result<NewPose, ServiceError> {
        let path = Path::root_item("bodies", index);
        let of = PoseOf::Body(body_ref(&path.field("body"), message.body.as_ref())?);
        let pose = required_pose(&path.field("pose"), message.pose.as_ref())?;
        Ok(NewPose { of, pose, field: path.field("body").to_string() })
    };
    let robot = |(index, message): (usize, &v1::RobotPose)| -> Result<NewPose, ServiceError> {
        let path = Path::root_item("robots", index);
        let pose = required_pose(&path.field("base"), message.base.as_ref())?;
        Ok(NewPose { of: PoseOf::Robot(message.robot.clone()), pose, field: path.field("robot").to_string() })
    };
    let bodies = message.bodies.iter().enumerate().map(body);
    let all = bodies.chain(message.robots.iter().enumerate().map(robot));
    let (mut poses, mut refused) = (Vec::new(), Vec::new());
    for pose in all {
        match pose {
            Ok(pose) => poses.push(pose),
            Err(error) => refused.push(named(error)),
        }
    }
    (poses, refused)
}

/// Field and problem of an error in a message.
fn named(error: ServiceError) -> (String, String) {
    let text = error.to_string();
    if let ServiceError::Invalid { field, problem } = error { (field, problem) } else { (String::new(), text) }
}

/// How long a stream of poses waits between two revisions.
///
/// # Errors
/// It is no length of time, or too long.
pub fn pose_interval(seconds: f64) -> Result<Duration, ServiceError> {
    if !(0.0..=LONGEST_INTERVAL).contains(&seconds) {
        let problem = format!("{seconds} is not a number of seconds from 0 to {LONGEST_INTERVAL}");
        return Err(ServiceError::invalid("interval", problem));
    }
    Ok(Duration::from_secs_f64(seconds))
}
