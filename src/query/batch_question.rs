//! Any of the questions that are answered in a batch: what it computes in any case, and a few of its items asked in another way.

use super::answer::Refused;
use super::batch::Prepared;
use super::overlay::Asked;
use super::request::{CheckMotions, CheckStates, Clearance, ClearanceOf, Context, Mode, Motions, PairQuery, Wants};

/// A question of many items, whichever it is.
#[derive(Clone, Debug)]
pub enum BatchQuestion {
    /// Is the robot free in these states?
    CheckStates(CheckStates),
    /// Is the robot free all along these motions?
    CheckMotions(CheckMotions),
    /// Which pairs touch?
    Collide(PairQuery),
    /// How far is the nearest?
    Distance(PairQuery),
    /// Which pairs are within a distance?
    Clearance(Clearance),
}

/// What is computed of an item, one thing at a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Output {
    /// The verdict alone.
    Verdict,
    /// The pairs that are in the way.
    Pairs,
    /// The bracket of the minimum.
    Distance,
    /// Points and normal.
    Witness,
    /// A tight bracket in an overlap, too.
    Depth,
    /// Where faces touch.
    Patch,
    /// How pairs change when their bodies move.
    Derivatives,
}

impl Output {
    /// Every one, each after what it needs.
    pub const ALL: [Self; 7] =
        [Self::Verdict, Self::Pairs, Self::Distance, Self::Witness, Self::Depth, Self::Patch, Self::Derivatives];

    /// What a question wants for it.
    #[must_use]
    pub fn wants(self) -> Wants {
        match self {
            Self::Verdict => Wants::VERDICT,
            Self::Pairs => Wants { pairs: true, ..Wants::VERDICT },
            Self::Distance => Wants { distance: true, ..Wants::VERDICT },
            Self::Witness => Wants { witness: true, ..Wants::VERDICT },
            Self::Depth => Wants { depth: true, ..Wants::VERDICT },
            Self::Patch => Wants { patch: true, ..Wants::VERDICT },
            Self::Derivatives => Wants { derivatives: true, ..Wants::VERDICT },
        }
    }
}

impl BatchQuestion {
    /// What it carries beside its items.
    #[must_use]
    pub fn context(&self) -> &Context {
        match self {
            Self::CheckStates(question) => &question.context,
            Self::CheckMotions(question) => &question.context,
            Self::Collide(question) | Self::Distance(question) => &question.context,
            Self::Clearance(question) => match &question.subjects {
                ClearanceOf::States(states) => &states.context,
                ClearanceOf::Subjects(pairs) => &pairs.context,
            },
        }
    }

    fn context_mut(&mut self) -> &mut Context {
        match self {
            Self::CheckStates(question) => &mut question.context,
            Self::CheckMotions(question) => &mut question.context,
            Self::Collide(question) | Self::Distance(question) => &mut question.context,
            Self::Clearance(question) => match &mut question.subjects {
                ClearanceOf::States(states) => &mut states.context,
                ClearanceOf::Subjects(pairs) => &mut pairs.context,
            },
        }
    }

    /// Which outputs differ for this question. `Collide` always lists pairs, `Distance` and `Clearance` always tell the
    /// distance, and motions list no pairs.
    #[must_use]
    pub fn outputs(&self) -> &'static [Output] {
        const MOTIONS: [Output; 6] =
            [Output::Verdict, Output::Distance, Output::Witness, Output::Depth, Output::Patch, Output::Derivatives];
        let [_, with_pairs @ ..] = &Output::ALL;
        let [_, _, of_distance @ ..] = &Output::ALL;
        match self {
            Self::CheckStates(_) => &Output::ALL,
            Self::CheckMotions(_) => &MOTIONS,
            Self::Collide(_) | Self::Distance(_) => with_pairs,
            Self::Clearance(_) => of_distance,
        }
    }

    /// Whether a tolerance changes what it costs to tell `output`: where brackets are narrowed, and of motions always, because the
    /// resolution is one.
    #[must_use]
    pub fn has_tolerance(&self, output: Output) -> bool {
        let narrows = output.wants().closed().distance;
        match self {
            Self::CheckStates(_) | Self::Collide(_) => narrows,
            Self::CheckMotions(_) | Self::Distance(_) | Self::Clearance(_) => true,
        }
    }

    /// The same question for `output` alone, and as accurate as `tolerance` (metres) says, if it says something. Of motions it is
    /// the resolution, too.
    #[must_use]
    pub fn asking(mut self, output: Output, tolerance: Option<f64>) -> Self {
        if let (Self::CheckMotions(question), Some(tolerance)) = (&mut self, tolerance) {
            question.resolution = tolerance;
        }
        let context = self.context_mut();
        context.wants = output.wants();
        if let Some(tolerance) = tolerance {
            context.accuracy.absolute = tolerance;
            context.accuracy.relative = 0.0;
        }
        self
    }

    /// The same question about the chosen items alone, each of which is answered whatever the others are. `width`: how many joints move
    /// ([`Prepared::width`]).
    #[must_use]
    pub fn chosen(&self, items: &[usize], width: usize) -> Self {
        match self {
            Self::CheckStates(question) => Self::CheckStates(chosen_states(question, items, width)),
            Self::CheckMotions(question) => {
                let first = |item: usize| match question.motions {
                    Motions::Edges => 2 * item,
                    Motions::Path => item,
                };
                let ends = items.iter().flat_map(|&item| [first(item), first(item) + 1]);
                let positions = ends.flat_map(|vector| vector_of(&question.positions, vector, width)).collect();
                let robot = question.robot.clone();
                let context = question.context.clone();
                let (motions, mode) = (Motions::Edges, Mode::All);
                Self::CheckMotions(CheckMotions { robot, positions, motions, mode, context, ..*question })
            }
            Self::Collide(question) => Self::Collide(chosen_subjects(question, items)),
            Self::Distance(question) => Self::Distance(chosen_subjects(question, items)),
            Self::Clearance(question) => {
                let subjects = match &question.subjects {
                    ClearanceOf::States(states) => ClearanceOf::States(chosen_states(states, items, width)),
                    ClearanceOf::Subjects(pairs) => ClearanceOf::Subjects(chosen_subjects(pairs, items)),
                };
                Self::Clearance(Clearance { subjects, within: question.within })
            }
        }
    }

    /// The question, checked.
    ///
    /// # Errors
    /// As for the functions of [`Prepared`].
    pub fn prepare<'a>(&'a self, asked: impl Into<Asked<'a>>) -> Result<Prepared<'a>, Refused> {
        match self {
            Self::CheckStates(question) => Prepared::check_states(asked, question),
            Self::CheckMotions(question) => Prepared::check_motions(asked, question),
            Self::Collide(question) => Prepared::collide(asked, question),
            Self::Distance(question) => Prepared::distance(asked, question),
            Self::Clearance(question) => Prepared::clearance(asked, question),
        }
    }
}

fn chosen_states(question: &CheckStates, items: &[usize], width: usize) -> CheckStates {
    let positions = items.iter().flat_map(|&item| vector_of(&question.positions, item, width)).collect();
    let (robot, context) = (question.robot.clone(), question.context.clone());
    CheckStates { robot, positions, mode: Mode::All, context }
}

fn chosen_subjects(question: &PairQuery, items: &[usize]) -> PairQuery {
    let items = items.iter().map(|&item| question.items[item].clone()).collect();
    PairQuery { items, mode: Mode::All, context: question.context.clone() }
}

fn vector_of(positions: &[f64], vector: usize, width: usize) -> impl Iterator<Item = f64> {
    positions[vector * width..(vector + 1) * width].iter().copied()
}
