//! What would a question cost? A sample of its items asked for every output at every tolerance, and timed.

use std::time::{Duration, Instant};

use super::ServiceError;
use super::answered::Question;
use super::deadline::Stop;
use super::measured::{Measured, TURNS};
use super::prices::Price;
use super::view::{View, check_samples};
use crate::limits::{LimitExceeded, Limits};
use crate::query::{BatchQuestion, ClearanceOf, Output, Refused, Wants, Worlds};
use crate::scene::{Epoch, Revision};

/// Tolerances that are measured where none is named, metres; the last is the floor of rounding.
pub const LADDER: [f64; 10] = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 0.0];

/// The same for motions, where they are resolutions.
pub const MOTION_LADDER: [f64; 6] = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6];

/// What would this question cost?
#[derive(Clone, Debug)]
pub struct Estimate {
    /// What would be asked. Its wants and its accuracy do not count, the rows have their own; every item is asked for itself,
    /// whatever its mode.
    pub question: BatchQuestion,
    /// Metres, not negative, of motions positive; empty: [`LADDER`] or [`MOTION_LADDER`].
    pub tolerances: Vec<f64>,
    /// Of [`BatchQuestion::outputs`]; empty: all of them.
    pub outputs: Vec<Output>,
    /// Items to measure at most; none: as many as may be.
    pub sample: Option<usize>,
    /// How long to measure at most; none: as long as may be.
    pub time: Option<Duration>,
}

/// What it would cost, as measured just now on this machine.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimated {
    /// Which life of the scene was asked.
    pub epoch: Epoch,
    /// Which state of it; the same for all rows.
    pub revision: Revision,
    /// Items of the question.
    pub items: usize,
    /// How many of them make the sample.
    pub sample: usize,
    /// How often the whole sample was measured.
    pub turns: usize,
    /// Items asked in all, those not counted included: what the caller is charged for.
    pub asked: u64,
    /// Seconds spent.
    pub seconds: f64,
    /// Why it ended.
    pub end: EstimateEnd,
    /// One for each output and tolerance: in the order of the outputs, then of the tolerances.
    pub rows: Vec<Price>,
}

/// Why an estimate ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EstimateEnd {
    /// Every row has the whole sample.
    Complete,
    /// The estimate's own time, or the cap on it, was over first.
    Time,
    /// The deadline of the request came first.
    Deadline,
}

/// Items asked in all turns: in each round every row, and one that is not counted; and one item of each row to warm up.
fn most_asked(sample: usize, rows: usize) -> usize {
    TURNS * sample * (rows + 1) + rows
}

/// An output and a tolerance.
type Row = (Output, Option<f64>);

impl Estimate {
    /// Every output with every tolerance that changes what it costs.
    fn rows(&self, limits: &Limits) -> Result<Vec<Row>, ServiceError> {
        let is_motion = matches!(self.question, BatchQuestion::CheckMotions(_));
        for (index, tolerance) in self.tolerances.iter().enumerate() {
            let problem = match *tolerance {
                t if !t.is_finite() => "is not finite".to_owned(),
                t if t < 0.0 => format!("is negative: {t}"),
                0.0 if is_motion => "is zero, and the resolution of a motion is positive".to_owned(),
                _ => continue,
            };
            return Err(ServiceError::invalid(format!("tolerances[{index}]"), problem));
        }
        let makes_sense = self.question.outputs();
        if let Some(index) = self.outputs.iter().position(|output| !makes_sense.contains(output)) {
            let problem =
                format!("{:?} is no choice of this question; these are: {makes_sense:?}", self.outputs[index]);
            return Err(ServiceError::invalid(format!("outputs[{index}]"), problem));
        }
        let outputs = if self.outputs.is_empty() { makes_sense } else { &self.outputs };
        let tolerances = match (self.tolerances.as_slice(), is_motion) {
            ([], true) => &MOTION_LADDER,
            ([], false) => LADDER.as_slice(),
            (named, _) => named,
        };
        let (with, without): (Vec<Output>, Vec<Output>) =
            outputs.iter().partition(|output| self.question.has_tolerance(**output));
        let count = without.len() + with.len().saturating_mul(tolerances.len());
        LimitExceeded::check("max_estimate_rows", count, limits.max_estimate_rows)?;
        let row = |output: &Output| match self.question.has_tolerance(*output) {
            true => tolerances.iter().map(|tolerance| (*output, Some(*tolerance))).collect(),
            false => vec![(*output, None)],
        };
        Ok(outputs.iter().flat_map(row).collect())
    }

    /// What the question is refused for as such.
    fn check_limits(&self, limits: &Limits) -> Result<(), ServiceError> {
        let joint_values = match &self.question {
            BatchQuestion::CheckStates(question) => question.positions.len(),
            BatchQuestion::CheckMotions(question) => {
                LimitExceeded::check("max_motion_states", question.max_states, limits.max_motion_states)?;
                question.positions.len()
            }
            BatchQuestion::Clearance(question) => match &question.subjects {
                ClearanceOf::States(states) => states.positions.len(),
                ClearanceOf::Subjects(_) => 0,
            },
            BatchQuestion::Collide(_) | BatchQuestion::Distance(_) => 0,
        };
        LimitExceeded::check("max_joint_values", joint_values, limits.max_joint_values)?;
        let context = self.question.context();
        LimitExceeded::check("max_pairs", context.max_pairs, limits.max_pairs)?;
        let derivatives = self.outputs.is_empty() || self.outputs.contains(&Output::Derivatives);
        check_samples(Wants { derivatives, ..Wants::VERDICT }, context.derivatives.samples, limits)?;
        Ok(())
    }

    /// How long to measure.
    fn longest(&self, limits: &Limits) -> Result<Duration, ServiceError> {
        let longest = Duration::from_secs(limits.max_estimate_seconds as u64);
        match self.time {
            Some(Duration::ZERO) => Err(ServiceError::invalid("time", "is zero: there is no time to measure")),
            time => Ok(time.map_or(longest, |time| time.min(longest))),
        }
    }

    /// How many items to measure. All that is asked then is within the cap on items.
    fn most(&self, rows: usize, limits: &Limits) -> Result<usize, ServiceError> {
        if self.sample == Some(0) {
            return Err(ServiceError::invalid("sample", "is zero: there is nothing to measure"));
        }
        LimitExceeded::check("max_items", most_asked(1, rows), limits.max_items)?;
        let fitting = (limits.max_items - most_asked(0, rows)) / (most_asked(1, rows) - most_asked(0, rows));
        Ok(self.sample.unwrap_or(usize::MAX).min(limits.max_estimate_sample.max(1)).min(fitting))
    }

    /// Checks the question of each row.
    fn begin<'a>(
        &self,
        rows: &[Row],
        questions: &'a [BatchQuestion],
        worlds: &'a Worlds,
        stop: &Stop,
    ) -> Result<Measured<'a>, ServiceError> {
        let mut measured = Measured::new(matches!(self.question, BatchQuestion::Clearance(_)));
        let mut not_permitted = None;
        for (&(output, tolerance), question) in rows.iter().zip(questions) {
            match question.prepare(worlds) {
                _ if stop.now() => measured.begin(output, tolerance, None),
                Ok(prepared) => measured.begin(output, tolerance, Some(prepared)),
                // Where none is named, those that may be asked for are meant.
                Err(error @ (Refused::NotDeclared { .. } | Refused::NotBuilt { .. })) if self.outputs.is_empty() => {
                    not_permitted.get_or_insert(error);
                }
                Err(error) => return Err(of_question(error)),
            }
        }
        match not_permitted {
            Some(error) if measured.has_no_rows() => Err(of_question(error)),
            _ => Ok(measured),
        }
    }

    fn of(&self) -> &'static str {
        match &self.question {
            BatchQuestion::CheckStates(_) => "states",
            BatchQuestion::CheckMotions(_) => "motions",
            BatchQuestion::Collide(_) | BatchQuestion::Distance(_) => "subjects",
            BatchQuestion::Clearance(question) => match question.subjects {
                ClearanceOf::States(_) => "states",
                ClearanceOf::Subjects(_) => "subjects",
            },
        }
    }

    fn empty(&self) -> ServiceError {
        let positions = matches!(self.of(), "states" | "motions");
        let field = if positions { "question.positions" } else { "question.items" };
        ServiceError::invalid(field, "is empty: there is nothing to measure")
    }
}

impl View {
    /// What a question would cost: measured on this thread, on a sample of its items.
    ///
    /// # Errors
    /// What the question is refused for, with its fields below `question`; an empty question, a tolerance or an output that cannot be, a cap,
    /// or a deadline that came before any item was measured.
    pub fn estimate(&self, estimate: &Estimate) -> Result<Estimated, ServiceError> {
        let begun = Instant::now();
        let rows = estimate.rows(&self.limits)?;
        // A cap beyond what the clock can tell is none.
        let until = begun.checked_add(estimate.longest(&self.limits)?);
        let stop = until.map_or_else(|| self.stop.clone(), |until| self.stop.not_after(until));
        estimate.check_limits(&self.limits)?;
        let plain = estimate.question.clone().asking(Output::Verdict, None);
        let (items, width) = {
            let whole = plain.prepare(&self.worlds).map_err(of_question)?;
            (whole.len(), whole.width())
        };
        LimitExceeded::check("max_items", items, self.limits.max_items)?;
        let chosen = spread(items, estimate.most(rows.len(), &self.limits)?);
        let sample = chosen.len();
        if sample == 0 {
            return Err(estimate.empty());
        }
        if let Some(notes) = &self.notes {
            let most_asked = most_asked(sample, rows.len());
            notes.note_question(Question::new(estimate.of(), most_asked, estimate.question.context()));
        }
        let worlds = self.worlds.chosen(&chosen);
        let few = estimate.question.chosen(&chosen, width);
        let asking = |&(output, tolerance): &Row| few.clone().asking(output, tolerance);
        let questions: Vec<BatchQuestion> = rows.iter().map(asking).collect();
        let mut measured = estimate.begin(&rows, &questions, &worlds, &stop)?;
        measured.measure(sample, &stop);
        let end = match measured.turns() {
            0 if self.stop.now() => EstimateEnd::Deadline,
            0 => EstimateEnd::Time,
            _ => EstimateEnd::Complete,
        };
        if let Some(notes) = &self.notes {
            notes.note_answered(measured.answered(end != EstimateEnd::Complete));
        }
        if end == EstimateEnd::Deadline && measured.is_empty() {
            return Err(ServiceError::DeadlineExceeded);
        }
        Ok(Estimated {
            epoch: self.snapshot().epoch(),
            revision: self.snapshot().revision(),
            items,
            sample,
            turns: measured.turns(),
            asked: measured.asked(),
            seconds: begun.elapsed().as_secs_f64(),
            end,
            rows: measured.prices(sample),
        })
    }
}

fn of_question(refused: Refused) -> ServiceError {
    ServiceError::from(refused).within("question")
}

/// At most `most` of `items` items, evenly over all of them.
fn spread(items: usize, most: usize) -> Vec<usize> {
    let count = items.min(most);
    (0..count).map(|k| (2 * k + 1) * items / (2 * count)).collect()
}

#[cfg(test)]
mod tests;
