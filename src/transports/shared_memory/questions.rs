//! Asks a request of a snapshot and encodes the answer, on the thread that answers it.

use super::answer;
use super::request::{Nonce, PairsOf, Question, Request};
use super::sections::Malformed;
use super::subjects;
use crate::limits::LimitExceeded;
use crate::query::{Motions, PairQuery, Wants};
use crate::scene::Snapshot;
use crate::service::{ServiceError, View};

/// The answer to a request as a message.
///
/// # Errors
/// What the service says, rows of another width than the robot has joints, or an answer beyond `most_bytes`.
pub(super) fn answered(
    request: &Request,
    nonce: Nonce,
    most_bytes: usize,
    view: &View,
) -> Result<Vec<u8>, ServiceError> {
    let frame = answer::Frame { nonce, question: request.question_number, wants_sides: request.wants_sides };
    let message = match &request.question {
        Question::States(states, width) => {
            check_width(view.snapshot(), &states.robot, *width)?;
            answer::message(&frame, &view.check_states(states)?, states.context.wants, false)
        }
        Question::Motions(motions, width) => {
            check_width(view.snapshot(), &motions.robot, *width)?;
            check_vectors(motions.motions, request.items)?;
            answer::message(&frame, &view.check_motions(motions)?, motions.context.wants, true)
        }
        Question::Pairs { what, items, mode, context } => {
            let items = subjects::resolve(items, view.snapshot())?;
            let query = PairQuery { items, mode: *mode, context: context.clone() };
            let (found, wants) = match what {
                PairsOf::Collide => (view.collide(&query)?, context.wants),
                PairsOf::Distance => (view.distance(&query)?, Wants { distance: true, ..context.wants }),
            };
            answer::message(&frame, &found, wants, false)
        }
        Question::Rays(rays) => answer::rays_message(&frame, &view.cast_rays(rays)?),
    };
    LimitExceeded::check("max_shared_memory_response_bytes", message.len(), most_bytes)?;
    Ok(message)
}

/// Rows of numbers have to be what the caller takes them for: with another width the same numbers make other items.
fn check_width(snapshot: &Snapshot, robot: &str, width: usize) -> Result<(), Malformed> {
    // A robot that is not there is for the query to refuse.
    let Some(robot) = snapshot.robot(robot) else { return Ok(()) };
    let joints = robot.model.degrees_of_freedom();
    if width == joints {
        return Ok(());
    }
    Err(Malformed::new("positions", format!("has {width} numbers for each state; the robot has {joints} joints")))
}

/// A path of one waypoint is no motion, and has no row in the answer.
fn check_vectors(motions: Motions, items: usize) -> Result<(), Malformed> {
    match motions {
        Motions::Path if items == 1 => Err(Malformed::new("positions", "has one waypoint, which is no path")),
        Motions::Path | Motions::Edges => Ok(()),
    }
}
