//! From brackets to verdicts.

use super::answer::{Indeterminacy, Verdict};
use crate::narrow_phase::{Bracket, Termination};

impl Verdict {
    /// What a bracket decides against a margin. Metres.
    #[must_use]
    pub fn of(bracket: &Bracket, margin: f64, termination: Termination) -> Self {
        if bracket.upper <= 0.0 {
            return Self::Collision;
        }
        if bracket.lower > 0.0 && bracket.lower > margin {
            return Self::Free;
        }
        if bracket.lower > 0.0 && bracket.upper <= margin {
            return Self::Margin;
        }
        Self::Indeterminate(match termination {
            Termination::IterationLimit => Indeterminacy::IterationLimit,
            Termination::TimeLimit => Indeterminacy::TimeLimit,
            Termination::ClosedForm
            | Termination::Converged
            | Termination::Decided
            | Termination::RoundingFloor
            | Termination::Exact => Indeterminacy::Rounding,
        })
    }

    /// The verdict on a whole of which this and `other` are verdicts on parts: the first that applies in the order
    /// collision, indeterminate, margin, free.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        if other.rank() < self.rank() { other } else { self }
    }

    /// Whether a batch that stops at the first hit stops here: a state that is not known to be free is not used.
    #[must_use]
    pub fn stops_batch(self) -> bool {
        match self {
            Self::Collision | Self::Indeterminate(_) | Self::InvalidInput => true,
            Self::Free | Self::Margin | Self::NotRun => false,
        }
    }

    fn rank(self) -> u8 {
        match self {
            Self::InvalidInput => 0,
            Self::Collision => 1,
            Self::Indeterminate(Indeterminacy::TimeLimit) => 2,
            Self::Indeterminate(Indeterminacy::IterationLimit) => 3,
            Self::Indeterminate(Indeterminacy::Resolution) => 4,
            Self::Indeterminate(Indeterminacy::Rounding) => 5,
            Self::NotRun => 6,
            Self::Margin => 7,
            Self::Free => 8,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_verdict_is_given_only_when_the_bracket_decides_it() {
        let of = |lower, upper, margin| Verdict::of(&Bracket { lower, upper }, margin, Termination::RoundingFloor);
        let open = Verdict::Indeterminate(Indeterminacy::Rounding);
        assert_eq!(of(-1.0, 0.0, 0.0), Verdict::Collision, "touching collides");
        assert_eq!(of(0.0, 1e-300, 0.0), open);
        assert_eq!(of(1e-300, 1.0, 0.0), Verdict::Free);
        assert_eq!(of(0.1, 0.2, 0.2), Verdict::Margin);
        assert_eq!(of(0.1, 0.2, 0.15), open);
        assert_eq!(of(0.1, 0.2, 0.05), Verdict::Free);
        assert_eq!(of(-1e-9, 1e-9, 1.0), open);
    }

    #[test]
    fn the_gravest_part_decides_the_whole() {
        let open = Verdict::Indeterminate(Indeterminacy::Rounding);
        assert_eq!(Verdict::Free.and(Verdict::Margin).and(open), open);
        assert_eq!(open.and(Verdict::Collision).and(Verdict::Free), Verdict::Collision);
    }
}
