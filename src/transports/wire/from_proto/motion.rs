//! Questions about motions and clearances, and what a client reads of motions in answers.

use super::Path;
use super::answer::{NotAnAnswer, answer};
use super::query::{context, doubles, mode, subjects, unknown_value};
use crate::query::{
    Answer, CheckMotions, CheckStates, Clearance, ClearanceOf, Find, ItemAnswer, Mode, MotionAnswer, Motions,
    PairQuery, Worlds,
};
use crate::scene::Snapshot;
use crate::service::{Library, ServiceError};
use crate::transports::wire::v1;

/// A question about motions.
///
/// # Errors
/// A field that cannot be, a body that is not there.
pub fn check_motions(request: &v1::CheckMotionsRequest, snapshot: &Snapshot) -> Result<CheckMotions, ServiceError> {
    let effort = effort(request.effort.as_ref())?;
    Ok(CheckMotions {
        robot: request.robot.clone(),
        positions: doubles(&Path::root("positions"), request.positions.as_ref())?,
        motions: Motions::Edges,
        mode: mode(request.mode)?,
        find: effort.find,
        resolution: effort.resolution,
        max_states: effort.max_states,
        context: context(request.context.as_ref(), snapshot)?,
    })
}

/// A question about a path.
///
/// # Errors
/// A field that cannot be, a body that is not there.
pub fn check_path(request: &v1::CheckPathRequest, snapshot: &Snapshot) -> Result<CheckMotions, ServiceError> {
    let effort = effort(request.effort.as_ref())?;
    let unspecified = request.mode == i32::from(v1::Mode::Unspecified);
    Ok(CheckMotions {
        robot: request.robot.clone(),
        positions: doubles(&Path::root("waypoints"), request.waypoints.as_ref())?,
        motions: Motions::Path,
        mode: if unspecified { Mode::StopAtFirst } else { mode(request.mode)? },
        find: effort.find,
        resolution: effort.resolution,
        max_states: effort.max_states,
        context: context(request.context.as_ref(), snapshot)?,
    })
}

struct Effort {
    find: Find,
    resolution: f64,
    max_states: usize,
}

fn effort(effort: Option<&v1::MotionEffort>) -> Result<Effort, ServiceError> {
    let effort = effort.copied().unwrap_or_default();
    let find = match v1::Find::try_from(effort.find) {
        Ok(v1::Find::Unspecified | v1::Find::FirstContact) => Find::FirstContact,
        Ok(v1::Find::AnyContact) => Find::AnyContact,
        Err(_) => return Err(unknown_value(&Path::root("effort").field("find"), effort.find)),
    };
    Ok(Effort {
        find,
        resolution: effort.resolution.unwrap_or(CheckMotions::DEFAULT_RESOLUTION),
        max_states: effort.max_states.map_or(CheckMotions::DEFAULT_MAX_STATES, |states| states as usize),
    })
}

/// A question about clearances.
///
/// # Errors
/// A field that cannot be, a body or asset that is not there.
pub fn clearance(
    request: &v1::ClearanceRequest,
    worlds: &Worlds,
    library: &Library,
) -> Result<Clearance, ServiceError> {
    let snapshot = &worlds.common().snapshot;
    let (mode, context) = (mode(request.mode)?, context(request.context.as_ref(), snapshot)?);
    let subjects = match Path::root("subjects").required(request.subjects.as_ref())? {
        v1::clearance_request::Subjects::States(states) => {
            let path = Path::root("states");
            let positions = doubles(&path.field("positions"), states.positions.as_ref())?;
            ClearanceOf::States(CheckStates { robot: states.robot.clone(), positions, mode, context })
        }
        v1::clearance_request::Subjects::Items(items) => {
            ClearanceOf::Subjects(PairQuery { items: subjects(&items.items, worlds, library)?, mode, context })
        }
    };
    Ok(Clearance { subjects, within: request.within })
}

/// An answer about motions in the form of items.
///
/// # Errors
/// [`NotAnAnswer`].
pub fn motions(message: Option<&v1::Answer>, motions: &[v1::Motion]) -> Result<Answer, NotAnAnswer> {
    let mut answer = answer(message.ok_or(NotAnAnswer::missing("answer"))?)?;
    if motions.len() != answer.items.len() {
        return Err(NotAnAnswer::missing("motions"));
    }
    answer.items = answer.items.into_iter().zip(motions).map(|(item, message)| with_motion(item, message)).collect();
    Ok(answer)
}

fn with_motion(item: ItemAnswer, message: &v1::Motion) -> ItemAnswer {
    let stretch = |stretch: Option<v1::Stretch>| stretch.map(|stretch| [stretch.from, stretch.to]);
    let motion = MotionAnswer {
        free_until: message.free_until,
        reached: stretch(message.reached),
        undecided: stretch(message.undecided),
        states: message.states,
        intervals: message.intervals,
    };
    // What no work was done for was looked at in no state.
    ItemAnswer { motion: (motion.states > 0).then_some(motion), ..item }
}
