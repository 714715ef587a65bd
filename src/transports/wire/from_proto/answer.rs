//! Answers, as a client reads them.

use super::Path;
use super::derivatives::derivatives;
use super::scene::party;
use crate::geometry::Vec3;
use crate::narrow_phase::{Bracket, ContactPatch, ContactPoint, Cost, Termination};
use crate::query::{Answer, Coverage, Indeterminacy, ItemAnswer, PairAnswer, Side, Verdict, Witness};
use crate::scene::{BodyId, Epoch, Revision};
use crate::transports::wire::v1;

/// A message that is no answer: a field is missing, or a number stands for nothing this version knows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the answer's field `{0}` is missing or unknown to this version")]
pub struct NotAnAnswer(&'static str);

impl NotAnAnswer {
    pub(super) fn missing(field: &'static str) -> Self {
        Self(field)
    }
}

/// An answer in the form of items.
///
/// # Errors
/// [`NotAnAnswer`].
pub fn answer(message: &v1::Answer) -> Result<Answer, NotAnAnswer> {
    Ok(Answer {
        epoch: Epoch(message.epoch),
        revision: Revision(message.revision),
        items: message.items.iter().map(item).collect::<Result<_, _>>()?,
        stopped_at: message.stopped_at.map(|index| index as usize),
        out_of_time: message.out_of_time,
        coverage: coverage(message.coverage.as_ref())?,
        cost: cost(message.cost)?,
    })
}

pub(super) fn coverage(message: Option<&v1::Coverage>) -> Result<Coverage, NotAnAnswer> {
    let unknown = |_| NotAnAnswer("coverage");
    let party = |side: Option<&v1::Party>| party(&Path::root("coverage"), side).map_err(unknown);
    let pair = |pair: &v1::PartyPair| Ok((party(pair.a.as_ref())?, party(pair.b.as_ref())?));
    let declared_empty = message.into_iter().flat_map(|message| &message.declared_empty).map(pair);
    let not_listed = message.map_or(0, |message| message.not_listed as usize);
    Ok(Coverage { declared_empty: declared_empty.collect::<Result<_, NotAnAnswer>>()?, not_listed })
}

fn item(item: &v1::ItemAnswer) -> Result<ItemAnswer, NotAnAnswer> {
    Ok(ItemAnswer {
        verdict: verdict(item.verdict, item.indeterminacy)?,
        nearest: item.nearest.as_ref().map(pair).transpose()?,
        nearest_self: item.nearest_self.as_ref().map(pair).transpose()?,
        nearest_scene: item.nearest_scene.as_ref().map(pair).transpose()?,
        pairs: item.pairs.iter().map(pair).collect::<Result<_, _>>()?,
        problem: (!item.problem.is_empty()).then(|| item.problem.clone()),
        truncated: item.truncated,
        motion: None, // Motions come beside the items: `from_proto::motions`.
        cost: cost(item.cost)?,
    })
}

pub(super) fn pair(pair: &v1::PairAnswer) -> Result<PairAnswer, NotAnAnswer> {
    let bracket = pair.bracket.ok_or(NotAnAnswer("bracket"))?;
    Ok(PairAnswer {
        a: side(pair.a.as_ref())?,
        b: side(pair.b.as_ref())?,
        verdict: verdict(pair.verdict, pair.indeterminacy)?,
        bracket: Bracket { lower: bracket.lower, upper: bracket.upper },
        signed_distance: pair.signed_distance,
        witness: pair.witness.as_ref().map(witness).transpose()?,
        patch: pair.patch.as_ref().map(patch).transpose()?.map(Box::new),
        derivatives: pair.derivatives.as_ref().map(derivatives).transpose()?.map(Box::new),
        termination: termination(pair.termination)?,
    })
}

fn side(side: Option<&v1::Side>) -> Result<Side, NotAnAnswer> {
    let kind = side.and_then(|side| side.kind.as_ref()).ok_or(NotAnAnswer("side"))?;
    Ok(match *kind {
        v1::side::Kind::Link(v1::LinkSide { link, shape, subshape }) => Side::Link { link, shape, subshape },
        v1::side::Kind::Query(v1::QuerySide { subshape }) => Side::Query { subshape },
        v1::side::Kind::Body(v1::BodySide { id, subshape }) => Side::Body { id: BodyId(id), subshape },
    })
}

pub(super) fn verdict(number: i32, why: i32) -> Result<Verdict, NotAnAnswer> {
    match v1::Verdict::try_from(number) {
        Ok(v1::Verdict::Free) => Ok(Verdict::Free),
        Ok(v1::Verdict::Margin) => Ok(Verdict::Margin),
        Ok(v1::Verdict::Collision) => Ok(Verdict::Collision),
        Ok(v1::Verdict::Indeterminate) => indeterminacy(why).map(Verdict::Indeterminate),
        Ok(v1::Verdict::NotRun) => Ok(Verdict::NotRun),
        Ok(v1::Verdict::InvalidInput) => Ok(Verdict::InvalidInput),
        Ok(v1::Verdict::Unspecified) | Err(_) => Err(NotAnAnswer("verdict")),
    }
}

pub(super) fn indeterminacy(number: i32) -> Result<Indeterminacy, NotAnAnswer> {
    match v1::Indeterminacy::try_from(number) {
        Ok(v1::Indeterminacy::Rounding) => Ok(Indeterminacy::Rounding),
        Ok(v1::Indeterminacy::IterationLimit) => Ok(Indeterminacy::IterationLimit),
        Ok(v1::Indeterminacy::TimeLimit) => Ok(Indeterminacy::TimeLimit),
        Ok(v1::Indeterminacy::Resolution) => Ok(Indeterminacy::Resolution),
        Ok(v1::Indeterminacy::Unspecified) | Err(_) => Err(NotAnAnswer("indeterminacy")),
    }
}

fn termination(number: i32) -> Result<Termination, NotAnAnswer> {
    match v1::Termination::try_from(number) {
        Ok(v1::Termination::ClosedForm) => Ok(Termination::ClosedForm),
        Ok(v1::Termination::Converged) => Ok(Termination::Converged),
        Ok(v1::Termination::Decided) => Ok(Termination::Decided),
        Ok(v1::Termination::RoundingFloor) => Ok(Termination::RoundingFloor),
        Ok(v1::Termination::IterationLimit) => Ok(Termination::IterationLimit),
        Ok(v1::Termination::TimeLimit) => Ok(Termination::TimeLimit),
        Ok(v1::Termination::Exact) => Ok(Termination::Exact),
        Ok(v1::Termination::Unspecified) | Err(_) => Err(NotAnAnswer("termination")),
    }
}

fn vec3(v: Option<v1::Vec3>, field: &'static str) -> Result<Vec3, NotAnAnswer> {
    v.map(|v| Vec3::new(v.x, v.y, v.z)).ok_or(NotAnAnswer(field))
}

fn patch(patch: &v1::ContactPatch) -> Result<ContactPatch, NotAnAnswer> {
    let point = |point: &v1::ContactPoint| {
        Ok(ContactPoint {
            point_on_a: vec3(point.point_on_a, "patch")?,
            point_on_b: vec3(point.point_on_b, "patch")?,
            signed_distance: point.signed_distance,
        })
    };
    let points: Vec<ContactPoint> = patch.points.iter().map(point).collect::<Result<_, _>>()?;
    let normal = vec3(patch.normal, "patch")?;
    ContactPatch::told(normal, &points, patch.corners as usize, patch.truncated).ok_or(NotAnAnswer("patch"))
}

fn witness(witness: &v1::Witness) -> Result<Witness, NotAnAnswer> {
    Ok(Witness {
        point_on_a: vec3(witness.point_on_a, "witness")?,
        point_on_b: vec3(witness.point_on_b, "witness")?,
        normal: vec3(witness.normal, "witness")?,
        point_error: witness.point_error,
        normal_error: witness.normal_error,
    })
}

pub(super) fn cost(cost: Option<v1::Cost>) -> Result<Cost, NotAnAnswer> {
    let v1::Cost {
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
    } = cost.ok_or(NotAnAnswer("cost"))?;
    Ok(Cost {
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
    })
}
