//! Where two moving bodies are at one time, as seen from the origin of the first.
//!
//! Both are placed in axes of the world with the origin of A as theirs, so that a pair far from the world's origin, or on its
//! way together, is as accurate as one that stays near it. `docs/derivations/advancement.md` adds up the errors.

use crate::geometry::tolerance::UNIT_ROUNDOFF;
use crate::geometry::vector::ORIGIN;
use crate::geometry::{Placement, RigidMotion, Vec3, length};

/// Two motions, and how they lie to one another.
pub(super) struct Approach<'a> {
    a: &'a RigidMotion,
    b: &'a RigidMotion,
    /// From A's origin to B's at the start, metres.
    between: Vec3,
    /// What B gains on A until the end, metres.
    pub gain: Vec3,
    /// What the distance of the origins may be off by at any time, metres.
    drift: f64,
    /// Whether the numbers are those that were given, so that both ends are exact.
    is_given: bool,
    /// The origins are never farther apart than this, metres.
    pub farthest: f64,
}

/// Both bodies at one time.
pub(super) struct Instant {
    /// Where A and B are, with the origin of A as theirs.
    pub at: [Placement; 2],
    /// The same in the world as it was given, where it was: what exact arithmetic starts from. Else without a quaternion.
    pub given: [Placement; 2],
    /// The origin of A in the world, metres.
    pub origin: Vec3,
    /// What the position of B's origin may be off by, metres.
    pub drift: f64,
    /// What the rotations may be off by, radians.
    pub turn_errors: [f64; 2],
}

impl<'a> Approach<'a> {
    #[inline(never)]
    pub fn new(a: &'a RigidMotion, b: &'a RigidMotion) -> Self {
        let between = b.start().translation() - a.start().translation();
        let gain = b.displacement() - a.displacement();
        let moved = length(a.displacement()) + length(b.displacement());
        let drift = UNIT_ROUNDOFF * (4.0 * length(between) + 8.0 * moved);
        // The distance of two points on straight lines is greatest at an end.
        let farthest = length(between).max(length(between + gain)) * (1.0 + 8.0 * UNIT_ROUNDOFF) + drift;
        Self { a, b, between, gain, drift, is_given: true, farthest }
    }

    /// The same of motions that were computed: the distance of the origins may be off by `error` more at any time, metres.
    pub fn computed(a: &'a RigidMotion, b: &'a RigidMotion, error: f64) -> Self {
        let exact = Self::new(a, b);
        Self { drift: exact.drift + error, is_given: false, farthest: exact.farthest + error, ..exact }
    }

    /// At a time in `0..=1`.
    #[inline(never)]
    pub fn at(&self, time: f64) -> Instant {
        let (a, b) = (self.a, self.b);
        let ends = a.end().zip(b.end()).filter(|_| time == 1.0);
        let given = if time == 0.0 { Some((a.start(), b.start())) } else { ends };
        if let Some((pose_a, pose_b)) = given.filter(|_| self.is_given) {
            let given = [pose_a.placement(), pose_b.placement()];
            let [at_a, at_b] = &given;
            let across = at_b.translation - at_a.translation;
            let at = [Placement { translation: ORIGIN, ..*at_a }, Placement { translation: across, ..*at_b }];
            return Instant { at, given, origin: pose_a.translation(), drift: 0.0, turn_errors: [0.0; 2] };
        }
        let (turned_a, turned_b) = (a.turned(time).rotation, b.turned(time).rotation);
        let at_b = Placement::computed(turned_b, self.between + self.gain * time);
        let at = [Placement::computed(turned_a, ORIGIN), at_b];
        let origin = a.start().translation() + a.displacement() * time;
        Instant { at, given: at, origin, drift: self.drift, turn_errors: [a.turn_error(), b.turn_error()] }
    }

    /// By how much each turns in all, radians along the axis.
    pub fn turns(&self) -> [Vec3; 2] {
        [self.a.turn(), self.b.turn()]
    }

    /// What a time may be off by when a point is looked for in the world: metres of A's origin.
    #[cfg(feature = "effect-motion")]
    pub fn origin_error(&self) -> f64 {
        UNIT_ROUNDOFF * (2.0 * length(self.a.start().translation()) + 4.0 * length(self.a.displacement()))
    }

    /// No point of A comes nearer to a point of B, at their distances from their origins, by more than this in all; metres.
    pub fn speed(&self, reaches: [f64; 2]) -> f64 {
        let [turn_a, turn_b] = self.turns();
        let [reach_a, reach_b] = reaches;
        let speed = length(self.gain) + length(turn_a) * reach_a + length(turn_b) * reach_b;
        speed * (1.0 + 64.0 * UNIT_ROUNDOFF)
    }
}
