//! Search directions with a memory: the accelerated variants of GJK.
//!
//! GJK is Frank-Wolfe on `min |x|^2` with a full correction, so its direction, the gradient at the nearest point x, can be
//! mixed with earlier ones as in accelerated descent (Montaut, Le Lidec, Petrik, Sivic and Carpentier, "Collision detection
//! accelerated", RSS 2022). A vertex found with such a direction need not be the one that plain GJK would have found: when it
//! brings no progress that says nothing about the optimum, and the search goes on plainly for good. Bounds are valid for any
//! direction, so momentum never touches the proof.
//!
//! The weights are those that were seen to work, not all those in print: Polyak's weight 1/(k+1) dies out, as in Coal, where
//! the paper prints (k+1)/(k+3), which on smooth shapes takes two to three times as many rounds as plain GJK.

use super::solver::Solver;
use super::support::unit;
use crate::geometry::Vec3;

/// Rounds after which a search goes on plainly in any case. Pairs that momentum suits are done in 30; where two large faces
/// are nearly parallel and nearly touch it can circle for ever.
const LONGEST: u32 = 64;

/// Cores are far apart when the first direction tells more than this part of their distance.
const FAR: f64 = 0.5;

/// What chooses the directions of a search.
pub(super) trait Steering {
    /// Told what the first direction found: bounds of the distance, metres.
    fn begin(&mut self, lower: f64, upper: f64);

    /// The next direction, of any length, from the nearest point `x` and the vertex `w` found last; none: that of the nearest
    /// feature.
    fn direction(&mut self, x: Vec3, w: Vec3) -> Option<Vec3>;

    /// Told that the last vertex brought no progress: whether it was found by a direction of one's own, and there will be no more
    /// of those.
    fn gave_up(&mut self) -> bool;
}

/// GJK as it is.
pub(super) struct Plain;

impl Steering for Plain {
    #[inline]
    fn begin(&mut self, _: f64, _: f64) {}

    #[inline]
    fn direction(&mut self, _: Vec3, _: Vec3) -> Option<Vec3> {
        None
    }

    #[inline]
    fn gave_up(&mut self) -> bool {
        false
    }
}

/// How the next direction is mixed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Rule {
    Polyak,
    /// The same for one direction, half way between the first and the vertex it found; then plainly.
    PolyakOnce,
    Nesterov,
    NesterovNormalised,
}

/// The memory of an accelerated search.
#[derive(Clone, Copy, Debug)]
pub(super) struct Momentum {
    /// None: plain GJK by now.
    rule: Option<Rule>,
    /// Takes its place where the cores are far apart.
    apart: Option<Rule>,
    /// The last direction, of the length its rule gave it.
    last: Vec3,
    /// Directions so far.
    round: u32,
}

impl Momentum {
    /// The one that the solver is named after, of a search whose first direction is `first`: of the length of a nearest point that
    /// one would guess.
    pub fn new(solver: Solver, first: Vec3) -> Self {
        let rule = match solver {
            Solver::GjkPolyak => Some(Rule::Polyak),
            Solver::GjkNesterov => Some(Rule::Nesterov),
            Solver::GjkNesterovNormalised => Some(Rule::NesterovNormalised),
            Solver::Default | Solver::FrankWolfe | Solver::Gjk | Solver::Sat | Solver::Qp | Solver::Exact => None,
        };
        Self::by_distance([rule; 2], first)
    }

    /// One that mixes by `apart` where the first direction shows that the cores are far apart, and by `near` where it does not.
    pub fn by_distance([near, apart]: [Option<Rule>; 2], first: Vec3) -> Self {
        Self { rule: near, apart, last: first, round: 1 }
    }
}

impl Steering for Momentum {
    #[inline]
    fn begin(&mut self, lower: f64, upper: f64) {
        if lower > FAR * upper {
            self.rule = self.apart;
        }
    }

    #[inline]
    fn direction(&mut self, x: Vec3, w: Vec3) -> Option<Vec3> {
        self.rule?;
        self.mixed(x, w)
    }

    fn gave_up(&mut self) -> bool {
        self.rule.take().is_some()
    }
}

impl Momentum {
    #[inline(never)]
    fn mixed(&mut self, x: Vec3, w: Vec3) -> Option<Vec3> {
        if self.round == LONGEST {
            self.rule = None;
        }
        let rule = self.rule?;
        let k = f64::from(self.round);
        self.round += 1;
        let last = self.last;
        let mixed = match rule {
            Rule::PolyakOnce if self.round > 2 => {
                self.rule = None;
                return None;
            }
            Rule::Polyak | Rule::PolyakOnce => mix(1.0 / (k + 1.0), last, x),
            Rule::Nesterov => {
                let weight = (k + 1.0) / (k + 3.0);
                mix(weight, last, mix(weight, x, w))
            }
            Rule::NesterovNormalised => {
                let weight = (k + 2.0) / (k + 3.0);
                mix(weight, unit(last)?, unit(mix(weight, x, w))?)
            }
        };
        self.last = mixed;
        Some(mixed)
    }
}

/// `weight` of the one, the rest of the other.
fn mix(weight: f64, one: Vec3, other: Vec3) -> Vec3 {
    one * weight + other * (1.0 - weight)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_are_those_of_the_sources() {
        let (x, w, first) = (Vec3::x(), Vec3::y(), Vec3::z());
        let third = |solver| {
            let mut momentum = Momentum::new(solver, first);
            [x, x].map(|x| momentum.direction(x, w))[1]
        };
        // Polyak, k = 1, 2: half of the first and of x, then a third of that and two of x.
        let expected = first / 6.0 + x * (1.0 / 6.0 + 2.0 / 3.0);
        assert!((third(Solver::GjkPolyak).unwrap() - expected).norm() < 1e-15);
        // Nesterov, k = 1, 2: weights 1/2 and 3/5.
        let (y1, y2) = ((x + w) / 2.0, x * 0.6 + w * 0.4);
        let expected = (first + y1) * 0.5 * 0.6 + y2 * 0.4;
        assert!((third(Solver::GjkNesterov).unwrap() - expected).norm() < 1e-15);
        assert!(third(Solver::Gjk).is_none());
    }

    #[test]
    fn normalised_directions_do_not_depend_on_lengths_and_end() {
        let mut one = Momentum::new(Solver::GjkNesterovNormalised, Vec3::z());
        let mut other = Momentum::new(Solver::GjkNesterovNormalised, Vec3::z() * 1e9);
        let (x, w) = (Vec3::new(1.0, 2.0, 3.0), Vec3::new(-2.0, 0.5, 1.0));
        for _ in 1..LONGEST {
            let (a, b) = (one.direction(x, w).unwrap(), other.direction(x * 1e-6, w * 1e-6).unwrap());
            assert!((a - b).norm() < 1e-14);
        }
        assert!(one.direction(x, w).is_none() && !one.gave_up());
        assert!(Momentum::new(Solver::GjkPolyak, Vec3::z()).gave_up());
    }

    #[test]
    fn what_the_first_direction_tells_chooses_the_rule() {
        let (x, w, first) = (Vec3::x(), Vec3::y(), Vec3::z());
        let begun = |lower: f64| {
            let mut momentum = Momentum::by_distance([None, Some(Rule::PolyakOnce)], first);
            momentum.begin(lower, 1.0);
            [(); 2].map(|()| momentum.direction(x, w))
        };
        assert_eq!(begun(-1.0), [None, None]);
        assert_eq!(begun(0.49), [None, None]);
        // One direction half way, and no more.
        assert_eq!(begun(0.51), [Some((first + x) / 2.0), None]);
        // Given up, if the one direction has not helped, and only then.
        let mut momentum = Momentum::by_distance([None, Some(Rule::PolyakOnce)], first);
        momentum.begin(0.9, 1.0);
        assert!(momentum.direction(x, w).is_some() && momentum.gave_up() && !momentum.gave_up());
    }
}
