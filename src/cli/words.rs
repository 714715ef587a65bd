//! How verdicts and terminations are written in the output of commands: as on the wire, without prefixes.

use crate::narrow_phase::Termination;
use crate::query::Verdict;

/// `FREE`, `COLLISION` and so on.
#[must_use]
pub fn verdict(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Free => "FREE",
        Verdict::Margin => "MARGIN",
        Verdict::Collision => "COLLISION",
        Verdict::Indeterminate(_) => "INDETERMINATE",
        Verdict::NotRun => "NOT_RUN",
        Verdict::InvalidInput => "INVALID_INPUT",
    }
}

/// `CONVERGED`, `ROUNDING_FLOOR` and so on.
#[must_use]
pub fn termination(termination: Termination) -> &'static str {
    match termination {
        Termination::ClosedForm => "CLOSED_FORM",
        Termination::Converged => "CONVERGED",
        Termination::Decided => "DECIDED",
        Termination::RoundingFloor => "ROUNDING_FLOOR",
        Termination::IterationLimit => "ITERATION_LIMIT",
        Termination::TimeLimit => "TIME_LIMIT",
        Termination::Exact => "EXACT",
    }
}
