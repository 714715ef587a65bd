//! Questions, as a client sends them.

use super::derivatives::derivative_options;
use super::geometry::{pose, shape};
use super::{count, little_endian};
use crate::narrow_phase::Solver;
use crate::query::{CheckStates, Context, Filter, Mode, PairQuery, Subject, Wants};
use crate::service::{RevisionRule, Rule, Target};
use crate::transports::wire::v1;

/// Joint positions go as little-endian bytes, the quickest form.
#[must_use]
pub fn check_states_request(target: &Target, question: &CheckStates) -> v1::CheckStatesRequest {
    v1::CheckStatesRequest {
        context: Some(context(target, &question.context)),
        robot: question.robot.clone(),
        positions: Some(doubles(&question.positions)),
        mode: mode(question.mode).into(),
    }
}

/// A question about touching.
#[must_use]
pub fn collide_request(target: &Target, question: &PairQuery) -> v1::CollideRequest {
    v1::CollideRequest {
        context: Some(context(target, &question.context)),
        items: question.items.iter().map(subject).collect(),
        mode: mode(question.mode).into(),
    }
}

/// A question about distance.
#[must_use]
pub fn distance_request(target: &Target, question: &PairQuery) -> v1::DistanceRequest {
    v1::DistanceRequest {
        context: Some(context(target, &question.context)),
        items: question.items.iter().map(subject).collect(),
        mode: mode(question.mode).into(),
    }
}

pub(super) fn doubles(numbers: &[f64]) -> v1::Doubles {
    let bytes = little_endian(numbers.iter().copied());
    v1::Doubles { form: Some(v1::doubles::Form::LittleEndian(bytes)) }
}

pub(super) fn context(target: &Target, context: &Context) -> v1::Context {
    let Wants { distance, witness, depth, pairs, patch, derivatives } = context.wants;
    let (absolute, relative) = (context.accuracy.absolute, context.accuracy.relative);
    v1::Context {
        scene: target.scene.clone(),
        revision: Some(revision_rule(target.revision)),
        wants: Some(v1::Wants { distance, witness, depth, pairs, patch, derivatives }),
        margin: context.margin,
        cut_off: context.cut_off,
        accuracy: Some(v1::Accuracy { absolute, relative }),
        filter: Some(filter(&context.filter)),
        max_pairs: Some(count(context.max_pairs)),
        max_patch_points: Some(count(context.max_patch_points)),
        derivatives: Some(derivative_options(&context.derivatives)),
        time_budget: None,
        answer_form: v1::AnswerForm::Items.into(),
        solver: solver(context.solver).into(),
        ..v1::Context::default()
    }
}

fn solver(solver: Solver) -> v1::Solver {
    match solver {
        Solver::Default => v1::Solver::Default,
        Solver::FrankWolfe => v1::Solver::FrankWolfe,
        Solver::Gjk => v1::Solver::Gjk,
        Solver::GjkPolyak => v1::Solver::GjkPolyak,
        Solver::GjkNesterov => v1::Solver::GjkNesterov,
        Solver::GjkNesterovNormalised => v1::Solver::GjkNesterovNormalised,
        Solver::Sat => v1::Solver::Sat,
        Solver::Qp => v1::Solver::Qp,
        Solver::Exact => v1::Solver::Exact,
    }
}

pub(super) fn revision_rule(rule: RevisionRule) -> v1::RevisionRule {
    let wire = match rule.rule {
        Rule::Latest => v1::revision_rule::Rule::Latest(v1::Latest {}),
        Rule::Exactly(revision) => v1::revision_rule::Rule::Exactly(revision.0),
        Rule::AtLeast(revision) => v1::revision_rule::Rule::AtLeast(revision.0),
    };
    v1::RevisionRule { epoch: rule.epoch.map(|epoch| epoch.0), rule: Some(wire) }
}

fn filter(filter: &Filter) -> v1::Filter {
    let by_id = |id: &crate::scene::BodyId| v1::BodyRef { by: Some(v1::body_ref::By::Id(id.0)) };
    v1::Filter {
        groups: filter.groups.clone(),
        ignore: filter.ignore.iter().map(by_id).collect(),
        disregard_allowed_collisions: filter.disregard_allowed_collisions,
        layers: filter.layers,
        mask: filter.mask,
    }
}

pub(super) fn subject(subject: &Subject) -> v1::Subject {
    let kind = match subject {
        Subject::All => v1::subject::Kind::AllPairs(v1::AllPairs {}),
        Subject::ChangedSince(since) => v1::subject::Kind::ChangedSince(v1::ChangedSince { revision: since.0 }),
        Subject::Body(id) => v1::subject::Kind::Body(v1::BodyRef { by: Some(v1::body_ref::By::Id(id.0)) }),
        Subject::Shape { shape: placed, pose: at } => {
            v1::subject::Kind::Shape(v1::PlacedShape { shape: Some(shape(placed)), pose: Some(pose(at)) })
        }
    };
    v1::Subject { kind: Some(kind) }
}

pub(super) fn mode(mode: Mode) -> v1::Mode {
    match mode {
        Mode::All => v1::Mode::All,
        Mode::StopAtFirst => v1::Mode::StopAtFirst,
    }
}
