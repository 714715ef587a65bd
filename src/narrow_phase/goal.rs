//! What a caller needs to know of a pair, so that work stops as soon as it is known.

use crate::geometry::tolerance::DEFAULT_RELATIVE_TOLERANCE;

use super::Bracket;
use super::solver::Solver;

/// How narrow a bracket has to be: `upper - lower <= max(absolute, relative * min(|lower|, |upper|))`, or as narrow
/// as rounding lets it be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// Metres.
    pub absolute: f64,
    /// A factor.
    pub relative: f64,
}

impl Default for Accuracy {
    fn default() -> Self {
        Self { absolute: 0.0, relative: DEFAULT_RELATIVE_TOLERANCE }
    }
}

impl Accuracy {
    /// Whether the bracket is narrow enough.
    #[must_use]
    pub fn is_met(&self, bracket: &Bracket) -> bool {
        let scale =
            if bracket.lower > 0.0 || bracket.upper < 0.0 { bracket.lower.abs().min(bracket.upper.abs()) } else { 0.0 };
        bracket.width() <= self.absolute.max(self.relative * scale)
    }
}

/// How far the work on a pair goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Depth {
    /// Until the bracket decides between collision, margin and free.
    Verdict,
    /// Until the bracket is narrow when apart; an overlap is only proved, not measured.
    Distance,
    /// Until the bracket is narrow, in an overlap too.
    Penetration,
}

/// What is asked of a pair.
#[derive(Clone, Copy)]
pub struct Goal<'a> {
    /// How far the work goes.
    pub depth: Depth,
    /// How narrow the bracket has to be where it has to be narrow.
    pub accuracy: Accuracy,
    /// Who does the work.
    pub solver: Solver,
    /// Apart but nearer than this is a verdict of its own; metres, not negative.
    pub margin: f64,
    /// Nothing more needs to be known of a pair proved farther apart than this; metres.
    pub cut_off: f64,
    /// Asked between rounds; true ends the work with the bracket reached so far.
    pub stop: &'a dyn Fn() -> bool,
}

impl Goal<'_> {
    /// Everything about the pair, at the default accuracy, without a limit on time.
    #[must_use]
    pub fn penetration() -> Self {
        Self {
            depth: Depth::Penetration,
            accuracy: Accuracy::default(),
            solver: Solver::Default,
            margin: 0.0,
            cut_off: f64::INFINITY,
            stop: &|| false,
        }
    }

    /// Whether they touch.
    #[must_use]
    pub fn verdict() -> Self {
        Self { depth: Depth::Verdict, ..Self::penetration() }
    }

    /// Whether the bracket decides the question before it is narrow.
    #[must_use]
    pub(super) fn is_decided(&self, bracket: &Bracket) -> bool {
        if bracket.lower > self.cut_off {
            return true;
        }
        match self.depth {
            Depth::Penetration => false,
            Depth::Distance => bracket.upper <= 0.0,
            Depth::Verdict => self.gives_a_verdict(bracket),
        }
    }

    /// Whether the bracket is as narrow as asked. However loose that is, a bracket that straddles the verdict is not: a
    /// pair does not become indeterminate because its distance was wanted less exactly.
    #[must_use]
    pub(super) fn is_met(&self, bracket: &Bracket) -> bool {
        self.accuracy.is_met(bracket) && self.gives_a_verdict(bracket)
    }

    /// Whether the bracket is on one side of contact and of the margin.
    #[must_use]
    pub(super) fn gives_a_verdict(&self, bracket: &Bracket) -> bool {
        let apart = bracket.lower > 0.0 && (bracket.lower > self.margin || bracket.upper <= self.margin);
        bracket.upper <= 0.0 || apart
    }
}

impl std::fmt::Debug for Goal<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Goal")
            .field("depth", &self.depth)
            .field("accuracy", &self.accuracy)
            .field("solver", &self.solver)
            .field("margin", &self.margin)
            .field("cut_off", &self.cut_off)
            .finish_non_exhaustive()
    }
}
