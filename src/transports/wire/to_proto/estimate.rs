//! Estimates: the request as a client sends it, and what was measured.

use std::time::Duration;

use super::motion::{check_motions_request, check_path_request, clearance_request};
use super::numbers::count;
use super::question::{check_states_request, collide_request, distance_request};
use crate::query::{BatchQuestion, Motions, Output};
use crate::service::{Estimate, EstimateEnd, Estimated, MeanCost, Price, Target, Verdicts};
use crate::transports::wire::v1;

/// What was measured.
#[must_use]
pub fn estimate_response(estimated: &Estimated) -> v1::EstimateResponse {
    let end = match estimated.end {
        EstimateEnd::Complete => v1::EstimateEnd::Complete,
        EstimateEnd::Time => v1::EstimateEnd::Time,
        EstimateEnd::Deadline => v1::EstimateEnd::Deadline,
    };
    v1::EstimateResponse {
        epoch: estimated.epoch.0,
        revision: estimated.revision.0,
        items: estimated.items as u64,
        sample: estimated.sample as u64,
        turns: count(estimated.turns),
        asked: estimated.asked,
        seconds: estimated.seconds,
        end: end.into(),
        rows: estimated.rows.iter().map(price).collect(),
    }
}

fn price(price: &Price) -> v1::Price {
    v1::Price {
        output: output(price.output).into(),
        tolerance: price.tolerance,
        items: price.items as u64,
        complete: price.complete,
        verdicts: Some(verdict_counts(price.verdicts)),
        times: price.times.map(|times| v1::ItemTimes { median: times.median, p99: times.p99 }),
        widths: price.widths.map(|widths| v1::ItemWidths {
            items: widths.items as u64,
            median: widths.median,
            largest: widths.largest,
            wider: widths.wider as u64,
        }),
        mean_cost: price.mean_cost.map(mean_cost),
    }
}

fn output(output: Output) -> v1::Output {
    match output {
        Output::Verdict => v1::Output::Verdict,
        Output::Pairs => v1::Output::Pairs,
        Output::Distance => v1::Output::Distance,
        Output::Witness => v1::Output::Witness,
        Output::Depth => v1::Output::Depth,
        Output::Patch => v1::Output::Patch,
        Output::Derivatives => v1::Output::Derivatives,
    }
}

fn verdict_counts(verdicts: Verdicts) -> v1::VerdictCounts {
    let Verdicts { free, margin, collision, rounding, iteration_limit, time_limit, resolution, not_run, invalid_input } =
        verdicts;
    v1::VerdictCounts {
        free,
        margin,
        collision,
        rounding,
        iteration_limit,
        time_limit,
        resolution,
        not_run,
        invalid_input,
    }
}

fn mean_cost(cost: MeanCost) -> v1::MeanCost {
    let MeanCost {
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
    } = cost;
    v1::MeanCost {
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

/// What would this question cost?
#[must_use]
pub fn estimate_request(target: &Target, estimate: &Estimate) -> v1::EstimateRequest {
    use v1::estimate_request::Question;
    let question = match &estimate.question {
        BatchQuestion::CheckStates(question) => Question::CheckStates(check_states_request(target, question)),
        BatchQuestion::CheckMotions(question) => match question.motions {
            Motions::Edges => Question::CheckMotions(check_motions_request(target, question)),
            Motions::Path => Question::CheckPath(check_path_request(target, question)),
        },
        BatchQuestion::Collide(question) => Question::Collide(collide_request(target, question)),
        BatchQuestion::Distance(question) => Question::Distance(distance_request(target, question)),
        BatchQuestion::Clearance(question) => Question::Clearance(clearance_request(target, question)),
    };
    v1::EstimateRequest {
        question: Some(question),
        tolerances: estimate.tolerances.clone(),
        outputs: estimate.outputs.iter().map(|asked| output(*asked).into()).collect(),
        sample: estimate.sample.map(count),
        time: estimate.time.as_ref().map(Duration::as_secs_f64),
    }
}
