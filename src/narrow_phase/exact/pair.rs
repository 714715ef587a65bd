//! Two polytopes in their places, with all coordinates integers: a common factor is taken out of both.
//!
//! In A's frame the rotation of B is an integer matrix over one integer, and the translation an integer vector over another.
//! Everything is multiplied by their least common multiple and by the power of two that makes the doubles integers, so
//! that no fraction is left, and directions and signs are what they were.

use dashu_int::IBig;
use dashu_int::ops::{BitTest, Gcd};

use super::integers::{Span, integer};
use super::polytope::Polytope;
use super::turn::Turn;
use super::vector::{Matrix, Vector};
use crate::geometry::{Placement, Pose, Vec3};
use crate::narrow_phase::given::Given;

/// Bits of an integer coordinate at most. Ordinary pairs need 280 to 400, a metre beside 1e-150 m some 1200. Products of six
/// coordinates occur, so this bounds the time: at the limit one decision takes milliseconds.
pub(super) const MOST_BITS: usize = 4096;

/// A corner of the Minkowski difference: a corner of A less one of B.
#[derive(Clone, Debug)]
pub(super) struct Corner {
    /// Which of A's.
    pub a: usize,
    /// Integer coordinates in A's frame.
    pub w: Vector,
}

/// B's place in A's frame. An integer coordinate is `factor / 2^exponent` times the metres.
pub(super) struct Frames {
    pub factor: IBig,
    pub exponent: i32,
    /// The rotation from B's axes to A's, times `factor`.
    rotation: Matrix,
    /// B's origin.
    translation: Vector,
    /// No integer coordinate of a difference needs more.
    pub bits: usize,
}

/// The pose of one side: rotation, and the translation of a whole and of a part in it.
struct Chain {
    outer: Turn,
    whole: Turn,
    translation: Vec3,
    inner: Option<Vec3>,
}

impl Chain {
    fn new(given: &Given) -> Option<Self> {
        let Placement { quaternion, translation, .. } = *given.at;
        let outer = Turn::new(quaternion?, MOST_BITS / 4)?;
        let inner = given.part.map(|part| part.pose);
        let whole = match inner {
            Some(pose) => outer.compose(&Turn::new(pose.rotation(), MOST_BITS / 4)?),
            None => outer.clone(),
        };
        Some(Self { outer, whole, translation, inner: inner.as_ref().map(Pose::translation) })
    }

    fn span(&self) -> Span {
        Span::of(self.translation.iter().chain(self.inner.iter().flatten()).copied())
    }

    /// Position of the origin times the integer that comes with it, in units of `2^exponent`.
    fn origin(&self, exponent: i32) -> (Vector, IBig) {
        let vector = |v: Vec3| Vector([v.x, v.y, v.z].map(|c| integer(c, exponent)));
        let outer = vector(self.translation);
        let Some(inner) = self.inner else { return (outer, IBig::ONE) };
        let (matrix, scale) = self.outer.matrix();
        (outer.times(&scale).plus(&matrix.apply(&vector(inner))), scale)
    }
}

impl Frames {
    /// None where the numbers need more bits than the limit, or are not known exactly. `span`: of the shapes' coordinates.
    pub fn new(a: &Given, b: &Given, span: Span) -> Option<Self> {
        let (a, b) = (Chain::new(a)?, Chain::new(b)?);
        let span = span.union(a.span()).union(b.span());
        let exponent = if span == Span::EMPTY { 0 } else { span.lowest };
        if span.bits() > MOST_BITS {
            return None;
        }
        let ((from, of_a), (to, of_b)) = (a.origin(exponent), b.origin(exponent));
        let apart = to.times(&of_a).minus(&from.times(&of_b));
        let (turn_a, scale_a) = a.whole.matrix();
        let (turn, own) = a.whole.inverse().compose(&b.whole).matrix();
        let (translation, rest) =
            if apart.is_zero() { (apart, IBig::ONE) } else { (turn_a.apply_transposed(&apart), scale_a * of_a * of_b) };
        // The least common multiple of the two denominators.
        let common = IBig::from((&own).gcd(&rest));
        let (of_rotation, of_translation) = (&rest / &common, &own / &common);
        let factor = own * &of_rotation;
        // A rotated or shifted coordinate is at most sqrt(3) times the largest; three such are added.
        let bits = factor.bit_len() + span.bits() + 3;
        let rotation = turn.times(&of_rotation);
        let translation = translation.times(&of_translation);
        (bits <= MOST_BITS).then_some(Self { factor, exponent, rotation, translation, bits })
    }

    /// A direction of A's frame in B's, times the factor.
    pub fn direction_into_b(&self, direction: &Vector) -> Vector {
        self.rotation.apply_transposed(direction)
    }

    /// The point of A with these coordinates in units of `2^exponent`.
    pub fn point_of_a(&self, p: &Vector) -> Vector {
        p.times(&self.factor)
    }

    /// The point of B with these coordinates in units of `2^exponent`, in A's frame.
    pub fn point_of_b(&self, p: &Vector) -> Vector {
        self.rotation.apply(p).plus(&self.translation)
    }
}

/// Two polytopes.
pub(super) struct Pair<'a> {
    pub a: Polytope<'a>,
    pub b: Polytope<'a>,
    pub frames: Frames,
    /// How many corners were asked for.
    pub supports: u64,
}

impl<'a> Pair<'a> {
    pub fn new(a: Polytope<'a>, b: Polytope<'a>, frames: Frames) -> Self {
        Self { a, b, frames, supports: 0 }
    }

    /// The corner of the difference where `direction . w` is least.
    pub fn lowest(&mut self, direction: &Vector) -> Corner {
        self.supports += 1;
        let a = self.a.lowest(direction, self.frames.exponent);
        let b = self.b.lowest(&self.frames.direction_into_b(direction).negated(), self.frames.exponent);
        self.corner(a, b)
    }

    fn corner(&self, a: usize, b: usize) -> Corner {
        let on_a = self.frames.point_of_a(&self.a.integer_corner(a, self.frames.exponent));
        let on_b = self.frames.point_of_b(&self.b.integer_corner(b, self.frames.exponent));
        Corner { a, w: on_a.minus(&on_b) }
    }
}
