//! What a scene declares of pairs, and what answers leave out for it.

use super::scene::body_ref;
use crate::query::Coverage;
use crate::scene::{Effect, Effects, Party};
use crate::transports::wire::v1;

pub(super) fn party(party: &Party) -> v1::Party {
    use v1::party::Kind;
    let kind = match party {
        Party::Body(body) => Kind::Body(body_ref(body)),
        Party::Link { robot, link } => Kind::Link(v1::LinkRef { robot: robot.clone(), link: link.clone() }),
        Party::Group(group) => Kind::Group(group.clone()),
        Party::Robot(robot) => Kind::Robot(robot.clone()),
        Party::Everything => Kind::Everything(v1::Everything {}),
    };
    v1::Party { kind: Some(kind) }
}

/// What may be asked of the pairs of two parties.
#[must_use]
pub fn declare_effects(a: &Party, b: &Party, declared: Option<Effects>) -> v1::DeclareEffects {
    v1::DeclareEffects { a: Some(party(a)), b: Some(party(b)), effects: declared.map(effects) }
}

pub(super) fn effects(effects: Effects) -> v1::Effects {
    v1::Effects { effects: effects.each().map(|each| effect(each).into()).collect() }
}

fn effect(effect: Effect) -> v1::Effect {
    match effect {
        Effect::Verdict => v1::Effect::Verdict,
        Effect::Margin => v1::Effect::Margin,
        Effect::Distance => v1::Effect::Distance,
        Effect::Witness => v1::Effect::Witness,
        Effect::Depth => v1::Effect::Depth,
        Effect::Patch => v1::Effect::Patch,
        Effect::Motion => v1::Effect::Motion,
        Effect::Derivatives => v1::Effect::Derivatives,
        Effect::Events => v1::Effect::Events,
    }
}

/// None where nothing was left out, so that it takes no bytes.
pub(super) fn coverage(coverage: &Coverage) -> Option<v1::Coverage> {
    let pair = |(a, b): &(Party, Party)| v1::PartyPair { a: Some(party(a)), b: Some(party(b)) };
    let declared_empty: Vec<_> = coverage.declared_empty.iter().map(pair).collect();
    let not_listed = coverage.not_listed as u64;
    (!declared_empty.is_empty() || not_listed > 0).then_some(v1::Coverage { declared_empty, not_listed })
}
