//! What may be asked of a pair? A scene declares it for pairs of parties; what it does not declare is not computed.

use std::fmt;

/// Something that a question can want of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Effect {
    /// Whether it touches.
    Verdict,
    /// Whether it is nearer than a margin above zero.
    Margin,
    /// The bracket of its signed distance.
    Distance,
    /// Points and normal.
    Witness,
    /// A tight bracket in an overlap, too.
    Depth,
    /// Where its faces touch.
    Patch,
    /// What it does along a motion.
    Motion,
    /// How its distance changes with its poses.
    Derivatives,
    /// When its contact begins and ends.
    Events,
}

impl Effect {
    /// Every effect.
    pub const EACH: [Self; 9] = [
        Self::Verdict,
        Self::Margin,
        Self::Distance,
        Self::Witness,
        Self::Depth,
        Self::Patch,
        Self::Motion,
        Self::Derivatives,
        Self::Events,
    ];

    /// As messages call it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Verdict => "verdict",
            Self::Margin => "margin",
            Self::Distance => "distance",
            Self::Witness => "witness",
            Self::Depth => "depth",
            Self::Patch => "patch",
            Self::Motion => "motion",
            Self::Derivatives => "derivatives",
            Self::Events => "events",
        }
    }

    /// What it cannot be told without.
    const fn needs(self) -> Effects {
        match self {
            Self::Verdict => Effects::NONE,
            Self::Margin | Self::Distance | Self::Motion | Self::Events => Effects::of(Self::Verdict),
            Self::Witness | Self::Depth => Effects::of(Self::Distance),
            Self::Patch => Effects::of(Self::Witness).and(Effects::of(Self::Depth)),
            Self::Derivatives => Effects::of(Self::Witness),
        }
    }
}

impl fmt::Display for Effect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A set of effects that has with each what it needs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Effects(u16);

impl Effects {
    /// Nothing: the pair is not looked at.
    pub const NONE: Self = Self(0);

    /// One effect, and what it needs.
    #[must_use]
    pub const fn of(effect: Effect) -> Self {
        effect.needs().and(Self(1 << effect as u16))
    }

    /// These and those.
    #[must_use]
    pub const fn and(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Whether the effect is among them.
    #[must_use]
    pub const fn contains(self, effect: Effect) -> bool {
        self.0 & 1 << effect as u16 != 0
    }

    /// Whether none is.
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Those among them.
    pub fn each(self) -> impl Iterator<Item = Effect> {
        Effect::EACH.into_iter().filter(move |effect| self.contains(*effect))
    }

    /// The first of `wanted` that is not among these.
    #[must_use]
    pub fn lacking(self, wanted: Self) -> Option<Effect> {
        wanted.each().find(|effect| !self.contains(*effect))
    }
}

impl FromIterator<Effect> for Effects {
    fn from_iter<I: IntoIterator<Item = Effect>>(effects: I) -> Self {
        effects.into_iter().fold(Self::NONE, |all, effect| all.and(Self::of(effect)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_has_what_it_needs() {
        let names = |effects: Effects| effects.each().map(Effect::name).collect::<Vec<_>>().join(" ");
        assert_eq!(names(Effects::of(Effect::Patch)), "verdict distance witness depth patch");
        assert_eq!(names(Effects::of(Effect::Derivatives)), "verdict distance witness derivatives");
        assert_eq!(names([Effect::Margin, Effect::Motion].into_iter().collect()), "verdict margin motion");
        assert_eq!(Effects::NONE.each().count(), 0);
    }

    #[test]
    fn the_first_that_is_lacking_is_told() {
        let declared = Effects::of(Effect::Distance);
        assert_eq!(declared.lacking(Effects::of(Effect::Distance)), None);
        assert_eq!(declared.lacking(Effects::of(Effect::Patch)), Some(Effect::Witness));
    }
}
