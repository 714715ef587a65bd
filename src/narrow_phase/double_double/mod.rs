//! Signed distances in double-doubles, for all convex cores: the rung of the precision ladder between doubles and exact numbers.
//!
//! Some 106 bits tell apart what is 1e-28 of the pair's size from contact. `number` is the arithmetic, `frames` composes the
//! poses, `support` has the support points; `nearest` is GJK on them, `wall` the formula for half-spaces and planes. Errors are
//! derived in `docs/derivations/escalation.md`.

mod frames;
mod nearest;
mod number;
mod simplex;
mod support;
mod vector;
mod wall;

pub(super) use nearest::separation;
pub(super) use wall::height;
