//! Estimates: what is asked, and what a client reads of the answer.

use std::time::Duration;

use super::Path;
use super::answer::NotAnAnswer;
use super::motion::{check_motions, check_path, clearance};
use super::query::{check_states, collide, distance, unknown_value};
use crate::query::{BatchQuestion, Output, Worlds};
use crate::scene::{Epoch, Revision};
use crate::service::{
    Estimate, EstimateEnd, Estimated, Library, MeanCost, Price, ServiceError, Times, Verdicts, Widths,
};
use crate::transports::wire::v1;
use crate::transports::wire::v1::estimate_request::Question;

/// The context of the question whose price is asked for.
pub fn context_of(question: &mut Question) -> &mut Option<v1::Context> {
    match question {
        Question::CheckStates(asked) => &mut asked.context,
        Question::Collide(asked) => &mut asked.context,
        Question::Distance(asked) => &mut asked.context,
        Question::CheckMotions(asked) => &mut asked.context,
        Question::CheckPath(asked) => &mut asked.context,
        Question::Clearance(asked) => &mut asked.context,
    }
}

/// What would a question cost?
///
/// # Errors
/// A field that cannot be, a body or asset that is not there.
pub fn estimate(request: &v1::EstimateRequest, worlds: &Worlds, library: &Library) -> Result<Estimate, ServiceError> {
    let asked = Path::root("question").required(request.question.as_ref())?;
    let outputs = request.outputs.iter().enumerate().map(|(index, number)| output(index, *number));
    Ok(Estimate {
        question: question(asked, worlds, library).map_err(|error| error.within("question"))?,
        tolerances: request.tolerances.clone(),
        outputs: outputs.collect::<Result<_, _>>()?,
        sample: request.sample.map(|sample| sample as usize),
        time: request.time.map(seconds).transpose()?,
    })
}

fn question(asked: &Question, worlds: &Worlds, library: &Library) -> Result<BatchQuestion, ServiceError> {
    let snapshot = &worlds.common().snapshot;
    Ok(match asked {
        Question::CheckStates(asked) => BatchQuestion::CheckStates(check_states(asked, snapshot)?),
        Question::Collide(asked) => BatchQuestion::Collide(collide(asked, worlds, library)?),
        Question::Distance(asked) => BatchQuestion::Distance(distance(asked, worlds, library)?),
        Question::CheckMotions(asked) => BatchQuestion::CheckMotions(check_motions(asked, snapshot)?),
        Question::CheckPath(asked) => BatchQuestion::CheckMotions(check_path(asked, snapshot)?),
        Question::Clearance(asked) => BatchQuestion::Clearance(clearance(asked, worlds, library)?),
    })
}

fn seconds(time: f64) -> Result<Duration, ServiceError> {
    let problem = |what: &str| ServiceError::invalid("time", format!("{what}: {time}"));
    match time {
        _ if time.is_nan() => Err(problem("is no number")),
        _ if time < 0.0 => Err(problem("is negative")),
        // What is longer than can be counted is longer than any cap.
        _ => Ok(Duration::try_from_secs_f64(time).unwrap_or(Duration::MAX)),
    }
}

fn output(index: usize, number: i32) -> Result<Output, ServiceError> {
    let path = Path::root_item("outputs", index);
    match v1::Output::try_from(number) {
        Ok(known) => known_output(known).ok_or_else(|| path.invalid("is unspecified")),
        Err(_) => Err(unknown_value(&path, number)),
    }
}

fn known_output(output: v1::Output) -> Option<Output> {
    match output {
        v1::Output::Unspecified => None,
        v1::Output::Verdict => Some(Output::Verdict),
        v1::Output::Pairs => Some(Output::Pairs),
        v1::Output::Distance => Some(Output::Distance),
        v1::Output::Witness => Some(Output::Witness),
        v1::Output::Depth => Some(Output::Depth),
        v1::Output::Patch => Some(Output::Patch),
        v1::Output::Derivatives => Some(Output::Derivatives),
    }
}

/// What was measured, as a client reads it.
///
/// # Errors
/// [`NotAnAnswer`].
pub fn estimated(response: &v1::EstimateResponse) -> Result<Estimated, NotAnAnswer> {
    let end = match response.end() {
        v1::EstimateEnd::Unspecified => return Err(NotAnAnswer::missing("end")),
        v1::EstimateEnd::Complete => EstimateEnd::Complete,
        v1::EstimateEnd::Time => EstimateEnd::Time,
        v1::EstimateEnd::Deadline => EstimateEnd::Deadline,
    };
    Ok(Estimated {
        epoch: Epoch(response.epoch),
        revision: Revision(response.revision),
        items: response.items as usize,
        sample: response.sample as usize,
        turns: response.turns as usize,
        asked: response.asked,
        seconds: response.seconds,
        end,
        rows: response.rows.iter().map(price).collect::<Result<_, _>>()?,
    })
}

fn price(price: &v1::Price) -> Result<Price, NotAnAnswer> {
    let output = v1::Output::try_from(price.output).ok().and_then(known_output);
    let verdicts = price.verdicts.as_ref().ok_or(NotAnAnswer::missing("verdicts"))?;
    Ok(Price {
        output: output.ok_or(NotAnAnswer::missing("output"))?,
        tolerance: price.tolerance,
        items: price.items as usize,
        complete: price.complete,
        verdicts: verdict_counts(verdicts),
        times: price.times.map(|times| Times { median: times.median, p99: times.p99 }),
        widths: price.widths.map(|widths| Widths {
            items: widths.items as usize,
            median: widths.median,
            largest: widths.largest,
            wider: widths.wider as usize,
        }),
        mean_cost: price.mean_cost.as_ref().map(mean_cost),
    })
}

fn verdict_counts(counts: &v1::VerdictCounts) -> Verdicts {
    let v1::VerdictCounts {
        free,
        margin,
        collision,
        rounding,
        iteration_limit,
        time_limit,
        resolution,
        not_run,
        invalid_input,
    } = *counts;
    Verdicts { free, margin, collision, rounding, iteration_limit, time_limit, resolution, not_run, invalid_input }
}

fn mean_cost(cost: &v1::MeanCost) -> MeanCost {
    let v1::MeanCost {
        supports,
        gjk_iterations,
        epa_iterations,
        nodes,
        pairs,
        escalations,
        patch_corners,
        patch_cuts,
        derivative_separations,
        derivative_supports,
        derivative_corners,
    } = *cost;
    MeanCost {
        supports,
        gjk_iterations,
        epa_iterations,
        nodes,
        pairs,
        escalations,
        patch_corners,
        patch_cuts,
        derivative_separations,
        derivative_supports,
        derivative_corners,
    }
}
