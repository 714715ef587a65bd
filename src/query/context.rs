//! Checks of what every query carries, and which bodies its filter lets through.

use super::answer::Refused;
use super::request::Context;
use crate::narrow_phase::{DerivativeGoal, MOST_POINTS, MOST_SAMPLES};
use crate::scene::{Body, BodyId, Snapshot};

/// The filter of a request, checked against the scene.
pub(super) struct Sieve<'a> {
    groups: &'a [String],
    ignore: Vec<BodyId>,
    disregard_allowed: bool,
}

impl<'a> Sieve<'a> {
    /// Checks the whole context.
    ///
    /// # Errors
    /// Numbers that are negative, not finite or beyond their cap; an effect that this build is without; groups and bodies that
    /// are not in the scene.
    pub fn new(snapshot: &Snapshot, context: &'a Context) -> Result<Self, Refused> {
        length("context.margin", context.margin)?;
        if let Some(cut_off) = context.cut_off {
            length("context.cut_off", cut_off)?;
        }
        length("context.accuracy.absolute", context.accuracy.absolute)?;
        length("context.accuracy.relative", context.accuracy.relative)?;
        let points = context.max_patch_points;
        if points == 0 || points > MOST_POINTS {
            let problem = format!("is {points}, not from 1 to {MOST_POINTS}");
            return Err(Refused::Invalid { field: "context.max_patch_points".to_owned(), problem });
        }
        if context.wants.patch && cfg!(not(feature = "effect-patch")) {
            return Err(Refused::NotBuilt { field: "context.wants", effect: "patch" });
        }
        derivatives(&context.derivatives)?;
        if context.wants.derivatives && cfg!(not(feature = "effect-derivatives")) {
            return Err(Refused::NotBuilt { field: "context.wants", effect: "derivatives" });
        }
        let not_found = |what, name: String| Refused::NotFound { what, name, revision: snapshot.revision() };
        let filter = &context.filter;
        if let Some(group) = filter.groups.iter().find(|g| !snapshot.has_group(g)) {
            return Err(not_found("group", group.clone()));
        }
        if let Some(body) = filter.ignore.iter().find(|id| snapshot.body(**id).is_none()) {
            return Err(not_found("body", body.to_string()));
        }
        Ok(Self::unchecked(context))
    }

    /// Of a context that was checked against an earlier revision: a group or body of the filter that is not there any more
    /// lets nothing through or keeps nothing out.
    pub fn unchecked(context: &'a Context) -> Self {
        let filter = &context.filter;
        let mut ignore = filter.ignore.clone();
        ignore.sort_unstable();
        Self { groups: &filter.groups, ignore, disregard_allowed: filter.disregard_allowed_collisions }
    }

    /// Whether the body counts at all.
    pub fn passes(&self, body: &Body) -> bool {
        let in_groups = self.groups.is_empty() || self.groups.iter().any(|group| body.is_in(group));
        body.enabled && in_groups && self.ignore.binary_search(&body.id).is_err()
    }

    /// Whether the body counts as part of a robot that holds it: the groups of the filter are those of what it is held
    /// against.
    pub fn admits_held(&self, body: &Body) -> bool {
        body.enabled && self.ignore.binary_search(&body.id).is_err()
    }

    /// Whether pairs that the scene allows to collide are looked at all the same.
    pub fn disregards_allowed_collisions(&self) -> bool {
        self.disregard_allowed
    }
}

/// What random methods are asked for, whichever method it is.
fn derivatives(goal: &DerivativeGoal) -> Result<(), Refused> {
    length("context.derivatives.epsilon", goal.epsilon)?;
    let samples = goal.samples;
    if samples == 0 || samples > MOST_SAMPLES {
        let problem = format!("is {samples}, not from 1 to {MOST_SAMPLES}");
        return Err(Refused::Invalid { field: "context.derivatives.samples".to_owned(), problem });
    }
    Ok(())
}

/// A finite number that is not negative.
pub(super) fn length(field: &str, value: f64) -> Result<(), Refused> {
    let problem = match value {
        v if !v.is_finite() => "is not finite".to_owned(),
        v if v < 0.0 => format!("is negative: {v}"),
        _ => return Ok(()),
    };
    Err(Refused::Invalid { field: field.to_owned(), problem })
}
