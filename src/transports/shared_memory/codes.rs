//! Which number stands for what? The same numbers as the enumerations of `proto/clearance/v1`, to which a test holds
//! them; this door does without the protobuf code.

use crate::narrow_phase::{Solver, Termination};
use crate::query::{CastMode, CastVerdict, Find, Indeterminacy, Mode, Verdict, Wants};

/// A verdict and, if it is none, why.
pub(super) fn verdict(verdict: Verdict) -> (u8, u8) {
    match verdict {
        Verdict::Free => (1, 0),
        Verdict::Margin => (2, 0),
        Verdict::Collision => (3, 0),
        Verdict::Indeterminate(why) => (4, indeterminacy(why)),
        Verdict::NotRun => (5, 0),
        Verdict::InvalidInput => (6, 0),
    }
}

/// The same of a ray.
pub(super) fn cast_verdict(verdict: CastVerdict) -> (u8, u8) {
    match verdict {
        CastVerdict::Clear => (1, 0),
        CastVerdict::Hit => (2, 0),
        CastVerdict::Indeterminate(why) => (3, indeterminacy(why)),
        CastVerdict::NotRun => (4, 0),
        CastVerdict::InvalidInput => (5, 0),
    }
}

pub(super) fn indeterminacy(why: Indeterminacy) -> u8 {
    match why {
        Indeterminacy::Rounding => 1,
        Indeterminacy::IterationLimit => 2,
        Indeterminacy::TimeLimit => 3,
        Indeterminacy::Resolution => 4,
    }
}

pub(super) fn termination(termination: Termination) -> u8 {
    match termination {
        Termination::ClosedForm => 1,
        Termination::Converged => 2,
        Termination::Decided => 3,
        Termination::RoundingFloor => 4,
        Termination::IterationLimit => 5,
        Termination::TimeLimit => 6,
        Termination::Exact => 7,
    }
}

/// Solvers by their numbers from 1 on; 0 is the first, too.
const SOLVERS: [Solver; 9] = [
    Solver::Default,
    Solver::FrankWolfe,
    Solver::Gjk,
    Solver::GjkPolyak,
    Solver::GjkNesterov,
    Solver::GjkNesterovNormalised,
    Solver::Sat,
    Solver::Qp,
    Solver::Exact,
];

pub(super) fn solver(number: u32) -> Option<Solver> {
    SOLVERS.get((number as usize).saturating_sub(1)).copied()
}

pub(super) fn solver_number(solver: Solver) -> u32 {
    SOLVERS.iter().position(|one| *one == solver).map_or(0, |index| index as u32 + 1)
}

pub(super) fn mode(number: u32) -> Option<Mode> {
    match number {
        0 => Some(Mode::All),
        1 => Some(Mode::StopAtFirst),
        _ => None,
    }
}

pub(super) fn mode_number(mode: Mode) -> u32 {
    match mode {
        Mode::All => 0,
        Mode::StopAtFirst => 1,
    }
}

pub(super) fn cast_mode(number: u32) -> Option<CastMode> {
    match number {
        0 => Some(CastMode::First),
        1 => Some(CastMode::All),
        2 => Some(CastMode::Any),
        _ => None,
    }
}

pub(super) fn cast_mode_number(mode: CastMode) -> u32 {
    match mode {
        CastMode::First => 0,
        CastMode::All => 1,
        CastMode::Any => 2,
    }
}

pub(super) fn find(number: u32) -> Option<Find> {
    match number {
        0 => Some(Find::FirstContact),
        1 => Some(Find::AnyContact),
        _ => None,
    }
}

pub(super) fn find_number(find: Find) -> u32 {
    match find {
        Find::FirstContact => 0,
        Find::AnyContact => 1,
    }
}

/// The bit of [`super::layout::RequestHeader::wants`] that asks for the sides of the nearest pair.
pub(super) const WANTS_SIDES: u32 = 16;

/// The bit that would ask for contact patches: a batch has no columns for them, and is refused by name.
pub(super) const WANTS_PATCH: u32 = 32;

/// The bit that would ask for derivatives: as for contact patches.
pub(super) const WANTS_DERIVATIVES: u32 = 64;

pub(super) fn wants(bits: u32) -> Option<Wants> {
    let has = |bit| bits & bit != 0;
    let known = bits < 2 * WANTS_DERIVATIVES;
    known.then(|| Wants {
        distance: has(1),
        witness: has(2),
        depth: has(4),
        pairs: has(8),
        patch: has(WANTS_PATCH),
        derivatives: has(WANTS_DERIVATIVES),
    })
}

pub(super) fn wants_bits(wants: Wants) -> u32 {
    let bit = |wanted, bit| if wanted { bit } else { 0 };
    bit(wants.distance, 1)
        | bit(wants.witness, 2)
        | bit(wants.depth, 4)
        | bit(wants.pairs, 8)
        | bit(wants.patch, WANTS_PATCH)
        | bit(wants.derivatives, WANTS_DERIVATIVES)
}

#[cfg(all(test, feature = "grpc"))]
mod tests {
    use super::*;
    use crate::transports::wire::v1;

    #[test]
    fn the_numbers_are_those_of_the_protobuf_files() {
        let why = Indeterminacy::Resolution;
        let verdicts = [
            (Verdict::Free, v1::Verdict::Free),
            (Verdict::Margin, v1::Verdict::Margin),
            (Verdict::Collision, v1::Verdict::Collision),
            (Verdict::Indeterminate(why), v1::Verdict::Indeterminate),
            (Verdict::NotRun, v1::Verdict::NotRun),
            (Verdict::InvalidInput, v1::Verdict::InvalidInput),
        ];
        verdicts.iter().for_each(|(ours, theirs)| assert_eq!(i32::from(verdict(*ours).0), *theirs as i32));
        let casts = [
            (CastVerdict::Clear, v1::CastVerdict::Clear),
            (CastVerdict::Hit, v1::CastVerdict::Hit),
            (CastVerdict::Indeterminate(why), v1::CastVerdict::Indeterminate),
            (CastVerdict::NotRun, v1::CastVerdict::NotRun),
            (CastVerdict::InvalidInput, v1::CastVerdict::InvalidInput),
        ];
        casts.iter().for_each(|(ours, theirs)| assert_eq!(i32::from(cast_verdict(*ours).0), *theirs as i32));
        let whys = [
            (Indeterminacy::Rounding, v1::Indeterminacy::Rounding),
            (Indeterminacy::IterationLimit, v1::Indeterminacy::IterationLimit),
            (Indeterminacy::TimeLimit, v1::Indeterminacy::TimeLimit),
            (why, v1::Indeterminacy::Resolution),
        ];
        whys.iter().for_each(|(ours, theirs)| assert_eq!(i32::from(indeterminacy(*ours)), *theirs as i32));
        let ends = [
            (Termination::ClosedForm, v1::Termination::ClosedForm),
            (Termination::Converged, v1::Termination::Converged),
            (Termination::Decided, v1::Termination::Decided),
            (Termination::RoundingFloor, v1::Termination::RoundingFloor),
            (Termination::IterationLimit, v1::Termination::IterationLimit),
            (Termination::TimeLimit, v1::Termination::TimeLimit),
            (Termination::Exact, v1::Termination::Exact),
        ];
        ends.iter().for_each(|(ours, theirs)| assert_eq!(i32::from(termination(*ours)), *theirs as i32));
        let solvers = [
            (Solver::Default, v1::Solver::Default),
            (Solver::FrankWolfe, v1::Solver::FrankWolfe),
            (Solver::Gjk, v1::Solver::Gjk),
            (Solver::GjkPolyak, v1::Solver::GjkPolyak),
            (Solver::GjkNesterov, v1::Solver::GjkNesterov),
            (Solver::GjkNesterovNormalised, v1::Solver::GjkNesterovNormalised),
            (Solver::Sat, v1::Solver::Sat),
            (Solver::Qp, v1::Solver::Qp),
            (Solver::Exact, v1::Solver::Exact),
        ];
        for (ours, theirs) in solvers {
            assert_eq!((solver_number(ours) as i32, solver(theirs as u32)), (theirs as i32, Some(ours)));
        }
        assert_eq!((solver(0), solver(10)), (Some(Solver::Default), None));
    }

    #[test]
    fn wants_are_bits_and_unknown_bits_are_refused() {
        assert_eq!(wants(wants_bits(Wants::ALL)), Some(Wants::ALL));
        assert_eq!((wants(WANTS_SIDES), wants(128)), (Some(Wants::VERDICT), None));
    }
}
