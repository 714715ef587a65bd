//! Signed distances without rounding, for cores that are polytopes and balls swept over them: the top of the precision ladder.
//!
//! Doubles and quaternions of doubles are rational, and so is everything GJK and EPA do with them but the last square root,
//! which is rounded outwards. `turn` and `pair` turn a placed pair into integers, `nearest` and `depth` are the algorithms,
//! `wall` the formula for half-spaces and planes; `separation` is the door.

mod depth;
mod hull;
mod integers;
mod nearest;
mod pair;
mod polytope;
mod root;
mod separation;
mod turn;
mod vector;
mod wall;

#[cfg(test)]
mod tests;

pub(super) use separation::separation;
pub(super) use wall::height;
