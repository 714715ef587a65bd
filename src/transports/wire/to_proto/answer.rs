//! Answers to questions.

use super::declared::coverage;
use super::derivatives::pair_derivatives;
use super::geometry::vec3;
use super::{count, little_endian};
use crate::narrow_phase::{Bracket, ContactPatch, ContactPoint, Cost, Termination};
use crate::query::{Answer, Indeterminacy, ItemAnswer, PairAnswer, Side, Verdict, Witness, World, Worlds};
use crate::scene::BodyId;
use crate::transports::wire::from_proto::AnswerForm;
use crate::transports::wire::v1;

/// An answer in the form that was asked for.
#[must_use]
pub fn answer(answer: &Answer, form: AnswerForm) -> v1::Answer {
    match form {
        AnswerForm::Items => v1::Answer { items: answer.items.iter().map(item).collect(), ..frame(answer) },
        AnswerForm::Bulk { brackets } => v1::Answer { bulk: Some(bulk(&answer.items, brackets)), ..frame(answer) },
    }
}

/// What an answer says of the request as a whole.
fn frame(answer: &Answer) -> v1::Answer {
    v1::Answer {
        epoch: answer.epoch.0,
        revision: answer.revision.0,
        items: Vec::new(),
        bulk: None,
        stopped_at: answer.stopped_at.map(count),
        out_of_time: answer.out_of_time,
        cost: Some(cost(answer.cost)),
        added_bodies: Vec::new(),
        coverage: coverage(&answer.coverage),
    }
}

/// The bodies that overlays added, as an answer names them.
#[must_use]
pub fn added_bodies(worlds: &Worlds) -> Vec<v1::AddedBody> {
    let of_world = |(number, world): (usize, &World)| {
        let body = |id: &BodyId| {
            let name = world.snapshot.body(*id).map(|body| body.name.to_string());
            v1::AddedBody { overlay: count(number), id: id.0, name: name.unwrap_or_default() }
        };
        world.added.iter().map(body).collect::<Vec<_>>()
    };
    worlds.all().iter().enumerate().flat_map(of_world).collect()
}

fn item(item: &ItemAnswer) -> v1::ItemAnswer {
    let (verdict, indeterminacy) = verdict(item.verdict);
    v1::ItemAnswer {
        verdict: verdict.into(),
        indeterminacy: indeterminacy.into(),
        nearest: item.nearest.as_ref().map(pair),
        nearest_self: item.nearest_self.as_ref().map(pair),
        nearest_scene: item.nearest_scene.as_ref().map(pair),
        pairs: item.pairs.iter().map(pair).collect(),
        truncated: item.truncated,
        problem: item.problem.clone().unwrap_or_default(),
        cost: Some(cost(item.cost)),
    }
}

fn bulk(items: &[ItemAnswer], brackets: bool) -> v1::BulkAnswer {
    // Verdicts and reasons are small enumerations; their numbers fit a byte.
    let (verdicts, indeterminacies): (Vec<u8>, Vec<u8>) =
        items.iter().map(|item| verdict(item.verdict)).map(|(verdict, why)| (verdict as u8, why as u8)).unzip();
    let problem = |(index, item): (usize, &ItemAnswer)| {
        item.problem.clone().map(|problem| v1::BulkProblem { item: count(index), problem })
    };
    // The pair that decides a verdict is not the nearest.
    let brackets_of = |pair_of: fn(&ItemAnswer) -> Option<&PairAnswer>| {
        if brackets { bulk_brackets(items, pair_of) } else { None }
    };
    v1::BulkAnswer {
        verdicts: verdicts.into(),
        indeterminacies: indeterminacies.into(),
        nearest: brackets_of(|item| item.nearest.as_ref()),
        nearest_self: brackets_of(|item| item.nearest_self.as_ref()),
        nearest_scene: brackets_of(|item| item.nearest_scene.as_ref()),
        problems: items.iter().enumerate().filter_map(problem).collect(),
    }
}

/// One column of brackets; none when no item has that pair.
fn bulk_brackets(
    items: &[ItemAnswer],
    pair_of: impl Fn(&ItemAnswer) -> Option<&PairAnswer>,
) -> Option<v1::BulkBrackets> {
    items.iter().any(|item| pair_of(item).is_some()).then(|| {
        let column = |number: fn(&PairAnswer) -> f64| {
            let numbers = items.iter().map(|item| pair_of(item).map_or(f64::NAN, number));
            little_endian(numbers)
        };
        v1::BulkBrackets {
            lower: column(|pair| pair.bracket.lower),
            upper: column(|pair| pair.bracket.upper),
            signed_distance: column(|pair| pair.signed_distance),
        }
    })
}

pub(super) fn pair(pair: &PairAnswer) -> v1::PairAnswer {
    let (verdict, indeterminacy) = verdict(pair.verdict);
    v1::PairAnswer {
        a: Some(side(&pair.a)),
        b: Some(side(&pair.b)),
        verdict: verdict.into(),
        indeterminacy: indeterminacy.into(),
        bracket: Some(bracket(pair.bracket)),
        signed_distance: pair.signed_distance,
        witness: pair.witness.as_ref().map(witness),
        termination: termination(pair.termination).into(),
        patch: pair.patch.as_deref().map(patch),
        derivatives: pair.derivatives.as_deref().map(pair_derivatives),
    }
}

fn patch(patch: &ContactPatch) -> v1::ContactPatch {
    let point = |point: &ContactPoint| v1::ContactPoint {
        point_on_a: Some(vec3(point.point_on_a)),
        point_on_b: Some(vec3(point.point_on_b)),
        signed_distance: point.signed_distance,
    };
    v1::ContactPatch {
        normal: Some(vec3(patch.normal)),
        points: patch.points().iter().map(point).collect(),
        corners: count(patch.polygon().len()),
        truncated: patch.truncated,
    }
}

fn side(side: &Side) -> v1::Side {
    let kind = match *side {
        Side::Link { link, shape, subshape } => v1::side::Kind::Link(v1::LinkSide { link, shape, subshape }),
        Side::Query { subshape } => v1::side::Kind::Query(v1::QuerySide { subshape }),
        Side::Body { id, subshape } => v1::side::Kind::Body(v1::BodySide { id: id.0, subshape }),
    };
    v1::Side { kind: Some(kind) }
}

/// A verdict and, if it is none, why.
pub(super) fn verdict(verdict: Verdict) -> (v1::Verdict, v1::Indeterminacy) {
    let decided = |verdict| (verdict, v1::Indeterminacy::Unspecified);
    match verdict {
        Verdict::Free => decided(v1::Verdict::Free),
        Verdict::Margin => decided(v1::Verdict::Margin),
        Verdict::Collision => decided(v1::Verdict::Collision),
        Verdict::Indeterminate(why) => (v1::Verdict::Indeterminate, indeterminacy(why)),
        Verdict::NotRun => decided(v1::Verdict::NotRun),
        Verdict::InvalidInput => decided(v1::Verdict::InvalidInput),
    }
}

pub(super) fn indeterminacy(why: Indeterminacy) -> v1::Indeterminacy {
    match why {
        Indeterminacy::Rounding => v1::Indeterminacy::Rounding,
        Indeterminacy::IterationLimit => v1::Indeterminacy::IterationLimit,
        Indeterminacy::TimeLimit => v1::Indeterminacy::TimeLimit,
        Indeterminacy::Resolution => v1::Indeterminacy::Resolution,
    }
}

fn termination(termination: Termination) -> v1::Termination {
    match termination {
        Termination::ClosedForm => v1::Termination::ClosedForm,
        Termination::Converged => v1::Termination::Converged,
        Termination::Decided => v1::Termination::Decided,
        Termination::RoundingFloor => v1::Termination::RoundingFloor,
        Termination::IterationLimit => v1::Termination::IterationLimit,
        Termination::TimeLimit => v1::Termination::TimeLimit,
        Termination::Exact => v1::Termination::Exact,
    }
}

fn witness(witness: &Witness) -> v1::Witness {
    v1::Witness {
        point_on_a: Some(vec3(witness.point_on_a)),
        point_on_b: Some(vec3(witness.point_on_b)),
        normal: Some(vec3(witness.normal)),
        point_error: witness.point_error,
        normal_error: witness.normal_error,
    }
}

fn bracket(bracket: Bracket) -> v1::Bracket {
    v1::Bracket { lower: bracket.lower, upper: bracket.upper }
}

pub(super) fn cost(cost: Cost) -> v1::Cost {
    let Cost {
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
    v1::Cost {
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
