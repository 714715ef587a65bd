//! May this be asked of the pairs that a question is about, and which of them are never looked at? By what the scene declares alone,
//! so that the answer does not hang on where the bodies are.

use super::answer::Refused;
use super::context::Sieve;
use super::request::{Context, Wants};
use crate::scene::{Asker, Declaration, Effect, Effects, Party, Snapshot};

/// What an answer says nothing about.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Coverage {
    /// Parties whose pairs the scene declares empty and that the question could have been about, the asker's side first where only
    /// one side is; sorted. Their pairs were not looked at: `FREE` says nothing of them.
    pub declared_empty: Vec<(Party, Party)>,
    /// How many more such pairs of parties there are than the context's `max_pairs` lets the list have.
    pub not_listed: usize,
}

impl Coverage {
    /// What is left out in any of several worlds, as far as `max_pairs` lets it be listed.
    pub(super) fn of(mut declared_empty: Vec<(Party, Party)>, max_pairs: usize) -> Self {
        declared_empty.sort_unstable();
        declared_empty.dedup();
        let not_listed = declared_empty.len().saturating_sub(max_pairs);
        declared_empty.truncate(max_pairs);
        Self { declared_empty, not_listed }
    }
}

/// The effects that outputs and a margin stand for. That every pair is listed is none: it is the same verdicts.
pub(super) fn effects_of(wants: Wants, margin: f64) -> Effects {
    let Wants { distance, witness, depth, pairs: _, patch, derivatives } = wants.closed();
    let wanted = [
        (distance, Effect::Distance),
        (witness, Effect::Witness),
        (depth, Effect::Depth),
        (patch, Effect::Patch),
        (derivatives, Effect::Derivatives),
        (margin > 0.0, Effect::Margin),
    ];
    let wanted = wanted.into_iter().filter(|(is_wanted, _)| *is_wanted).map(|(_, effect)| effect);
    wanted.chain([Effect::Verdict]).collect()
}

/// Whose pairs are left out: looks at every declaration that speaks of the asker and of somebody whom the filter lets through.
///
/// # Errors
/// [`Refused::NotDeclared`] for the first, in the order of the parties, that permits something, and not all that is wanted.
pub(super) fn declared_empty(
    snapshot: &Snapshot,
    asker: &Asker<'_>,
    context: &Context,
    wanted: Effects,
) -> Result<Vec<(Party, Party)>, Refused> {
    if !snapshot.declares_effects() {
        return Ok(Vec::new());
    }
    let sieve = Sieve::unchecked(context);
    let filtered = &context.filter.groups;
    // A body of a group in the filter may be in another group as well; what is left out is told rather once too often.
    let may_be_met = |party: &Party| match party {
        Party::Body(body) => snapshot.found(body).is_some_and(|body| sieve.passes(body)),
        Party::Link { .. } | Party::Group(_) | Party::Robot(_) | Party::Everything => true,
    };
    let is_let_through = |party: &Party| match party {
        Party::Group(group) => filtered.is_empty() || filtered.contains(group),
        Party::Body(_) | Party::Link { .. } | Party::Robot(_) | Party::Everything => may_be_met(party),
    };
    let both = matches!(asker, Asker::Everybody);
    let mut declared = snapshot.declared_of(asker);
    declared.sort_unstable_by(|one, two| (&one.own, &one.other).cmp(&(&two.own, &two.other)));
    let mut empty = Vec::new();
    for Declaration { own, other, is_own_too, effects } in declared {
        let concerns = |passes: &dyn Fn(&Party) -> bool| (is_own_too || passes(&other)) && (!both || passes(&own));
        if effects.is_empty() {
            if concerns(&may_be_met) {
                // A pair of two askers is told once.
                let turned = both && other < own;
                empty.push(if turned { (other, own) } else { (own, other) });
            }
        } else if concerns(&is_let_through)
            && let Some(effect) = effects.lacking(wanted)
        {
            return Err(Refused::NotDeclared { effect, a: own, b: other });
        }
    }
    Ok(empty)
}
