//! Questions about motions and clearances as a client sends them, and what answers say of motions.

use super::question::{context, doubles, mode, subject};
use super::{count, little_endian};
use crate::query::{Answer, CheckMotions, Clearance, ClearanceOf, Find, ItemAnswer, MotionAnswer};
use crate::service::Target;
use crate::transports::wire::from_proto::AnswerForm;
use crate::transports::wire::v1;

/// What is proved of the motions of an answer's items, in the form that was asked for.
#[must_use]
pub fn motions(answer: &Answer, form: AnswerForm) -> (Vec<v1::Motion>, Option<v1::BulkMotions>) {
    match form {
        AnswerForm::Items => (answer.items.iter().map(motion).collect(), None),
        AnswerForm::Bulk { .. } => (Vec::new(), Some(bulk(&answer.items))),
    }
}

fn motion(item: &ItemAnswer) -> v1::Motion {
    let stretch = |stretch: Option<[f64; 2]>| stretch.map(|[from, to]| v1::Stretch { from, to });
    item.motion.map_or_else(v1::Motion::default, |motion| v1::Motion {
        free_until: motion.free_until,
        reached: stretch(motion.reached),
        undecided: stretch(motion.undecided),
        states: motion.states,
        intervals: motion.intervals,
    })
}

fn bulk(items: &[ItemAnswer]) -> v1::BulkMotions {
    let column = |number: fn(&MotionAnswer) -> Option<f64>| {
        let numbers = items.iter().map(|item| item.motion.as_ref().and_then(number).unwrap_or(f64::NAN));
        little_endian(numbers)
    };
    v1::BulkMotions {
        free_until: column(|motion| Some(motion.free_until)),
        reached_from: column(|motion| motion.reached.map(|[from, _]| from)),
        reached_to: column(|motion| motion.reached.map(|[_, to]| to)),
        undecided_from: column(|motion| motion.undecided.map(|[from, _]| from)),
        undecided_to: column(|motion| motion.undecided.map(|[_, to]| to)),
        states: column(|motion| Some(motion.states as f64)),
    }
}

/// Joint positions go as little-endian bytes, the quickest form.
#[must_use]
pub fn check_motions_request(target: &Target, question: &CheckMotions) -> v1::CheckMotionsRequest {
    v1::CheckMotionsRequest {
        context: Some(context(target, &question.context)),
        robot: question.robot.clone(),
        positions: Some(doubles(&question.positions)),
        mode: mode(question.mode).into(),
        effort: Some(effort(question)),
    }
}

/// A question about a path.
#[must_use]
pub fn check_path_request(target: &Target, question: &CheckMotions) -> v1::CheckPathRequest {
    v1::CheckPathRequest {
        context: Some(context(target, &question.context)),
        robot: question.robot.clone(),
        waypoints: Some(doubles(&question.positions)),
        mode: mode(question.mode).into(),
        effort: Some(effort(question)),
    }
}

fn effort(question: &CheckMotions) -> v1::MotionEffort {
    let find = match question.find {
        Find::FirstContact => v1::Find::FirstContact,
        Find::AnyContact => v1::Find::AnyContact,
    };
    v1::MotionEffort {
        find: find.into(),
        resolution: Some(question.resolution),
        max_states: Some(count(question.max_states)),
    }
}

/// A question about clearances.
#[must_use]
pub fn clearance_request(target: &Target, question: &Clearance) -> v1::ClearanceRequest {
    let (of, its_mode, its_context) = match &question.subjects {
        ClearanceOf::States(states) => {
            let of = v1::RobotStates { robot: states.robot.clone(), positions: Some(doubles(&states.positions)) };
            (v1::clearance_request::Subjects::States(of), states.mode, &states.context)
        }
        ClearanceOf::Subjects(pairs) => {
            let of = v1::ClearanceSubjects { items: pairs.items.iter().map(subject).collect() };
            (v1::clearance_request::Subjects::Items(of), pairs.mode, &pairs.context)
        }
    };
    v1::ClearanceRequest {
        context: Some(context(target, its_context)),
        within: question.within,
        mode: mode(its_mode).into(),
        subjects: Some(of),
    }
}
